#include "render/content/wires.h"

#include "render/gl/shader.h"

namespace merlin::render::content {
namespace {

constexpr const char* kWireVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_model;
void main() { gl_Position = clip_from_model * vec4(position, 1.0); }
)";

constexpr const char* kWireFragmentShader = R"(#version 330 core
uniform vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1.0); }
)";

}  // namespace

Result<Ok> Wires::build() {
  const auto program = gl::linkProgram(gl_, kWireVertexShader, kWireFragmentShader);
  if (!program) return program.error();
  program_ = *program;
  clip_location_ = gl_.GetUniformLocation(program_, "clip_from_model");
  colour_location_ = gl_.GetUniformLocation(program_, "colour");
  return Ok{};
}

void Wires::setColour(const std::array<float, 3>& rgb) const {
  gl_.Uniform3f(colour_location_, rgb[0], rgb[1], rgb[2]);
}

void Wires::draw(const Eigen::Matrix4f& clip_from_model, const RenderStyle& style,
                 const std::function<void()>& triangles) const {
  gl_.UseProgram(program_);
  gl_.UniformMatrix4fv(clip_location_, 1, GL_FALSE, clip_from_model.data());
  setColour(style.background);
  // Faces are drawn slightly farther away, so that they do not hide their own edges.
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1, 1);
  triangles();
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  std::array<float, 3> colour = style.colour;
  for (float& x : colour) x *= style.brightness;
  setColour(colour);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  triangles();
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace merlin::render::content
