// The renderer of the chequered plane in one OpenGL context.
#include <algorithm>
#include <memory>

#include "render/content/sample/chequers.h"
#include "render/gl/gl_api.h"
#include "render/gl/shader.h"

namespace merlin::render::content {
namespace {

constexpr std::size_t kSlice = 1024;  // squares per slice

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 corner;
uniform mat4 clip_from_metres;
out float brightness;
void main() {
  gl_Position = clip_from_metres * vec4(corner.xy, 0.0, 1.0);
  brightness = corner.z;
}
)";
constexpr const char* kFragmentShader = R"(#version 330 core
in float brightness;
out vec4 pixel;
void main() { pixel = vec4(vec3(brightness), 1.0); }
)";

class ChequersRenderer final : public ContentRenderer {
 public:
  ChequersRenderer(const gl::GlApi& gl, const Chequers::Chosen& chosen, GLuint program)
      : gl_(gl), chosen_(chosen), program_(program) {
    clip_location_ = gl_.GetUniformLocation(program_, "clip_from_metres");
    gl_.GenVertexArrays(1, &array_);
    gl_.GenBuffers(1, &corners_);
    gl_.GenBuffers(1, &indices_);
  }
  ~ChequersRenderer() override {
    gl_.DeleteVertexArrays(1, &array_);
    for (const GLuint buffer : {corners_, indices_}) gl_.DeleteBuffers(1, &buffer);
    gl_.DeleteProgram(program_);
  }
  ChequersRenderer(const ChequersRenderer&) = delete;
  ChequersRenderer& operator=(const ChequersRenderer&) = delete;

  void beginFrame() override {
    std::vector<std::uint32_t> order(chosen_.corners.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    gl_.BindVertexArray(array_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, corners_);
    gl_.BufferData(GL_ARRAY_BUFFER, bytesOf(chosen_.corners), chosen_.corners.data(),
                   GL_STREAM_DRAW);
    gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(0);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytesOf(order), order.data(), GL_STREAM_DRAW);
  }

  void beginView(std::size_t tile, int width, int height) override {
    gl_.Viewport(0, 0, width, height);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_DEPTH_TEST);
    Eigen::Matrix4f clip = chosen_.views[tile];
    clip.row(1) *= -1;  // the first row of a canvas is the upper one
    gl_.UseProgram(program_);
    gl_.UniformMatrix4fv(clip_location_, 1, GL_FALSE, clip.data());
  }

  bool drawSlice(std::size_t /*tile*/, DrawProgress& progress) override {
    const std::size_t squares = chosen_.corners.size() / 6;
    const std::size_t count = std::min(kSlice, squares - progress.done);
    gl_.BindVertexArray(array_);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(6 * progress.done * sizeof(std::uint32_t)));
    progress.done += count;
    return progress.done == squares;
  }

 private:
  template <typename T>
  static GLsizeiptr bytesOf(const std::vector<T>& values) {
    return static_cast<GLsizeiptr>(values.size() * sizeof(T));
  }

  const gl::GlApi& gl_;
  const Chequers::Chosen& chosen_;
  GLuint program_, array_ = 0, corners_ = 0, indices_ = 0;
  GLint clip_location_ = -1;
};

}  // namespace

Result<std::unique_ptr<ContentRenderer>> Chequers::attach(const gl::GlApi& gl) const {
  const auto program = gl::linkProgram(gl, kVertexShader, kFragmentShader);
  if (!program) return program.error();
  return std::unique_ptr<ContentRenderer>(
      std::make_unique<ChequersRenderer>(gl, chosen_, *program));
}

}  // namespace merlin::render::content
