#include "render/correct/gpu/shader_pass.h"

#include <cassert>
#include <utility>

#include "render/gl/shader.h"

namespace merlin::render::correct {
namespace {

// A triangle that covers the target.
constexpr const char* kVertexShader = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// Names, units and signs are those of the formula in correction_map.h.
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D picture;
uniform isampler2D source_x, source_y;
uniform usampler2D gain, black, runs;
uniform mat3 colours;
uniform vec3 channel_gain, encode, black_level;
uniform float gamma, least_headroom;
out vec4 signal;

vec3 at(ivec2 p) { return texelFetch(picture, p, 0).rgb; }

// Step 1. Filtered here, since a sampler may round its weights.
vec3 filtered(ivec2 p) {
  ivec2 place = ivec2(texelFetch(source_x, p, 0).r, texelFetch(source_y, p, 0).r);
  ivec2 cell = min(place >> 8, textureSize(picture, 0) - 2);
  vec2 rest = vec2(place - (cell << 8)) / 256.0;
  vec3 top = mix(at(cell), at(cell + ivec2(1, 0)), rest.x);
  vec3 bottom = mix(at(cell + ivec2(0, 1)), at(cell + ivec2(1, 1)), rest.x);
  return mix(top, bottom, rest.y);
}

vec3 power(vec3 x, vec3 y) {
  return vec3(greaterThan(x, vec3(0.0))) * pow(max(x, vec3(5e-10)), y);
}

// Steps 2 to 6.
vec3 corrected(ivec2 p, vec3 c) {
  float root = float(texelFetch(gain, p, 0).r) / 65535.0;
  float share = float(texelFetch(black, p, 0).r) / 65535.0;
  float headroom = max(share, least_headroom);
  vec3 light = max(vec3(0.0), colours * power(c, vec3(gamma)));
  light = min(vec3(1.0), light * channel_gain) * (root * root) * (1.0 - headroom * black_level) +
          share * black_level;
  return power(min(vec3(1.0), light), encode);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint kind = texelFetch(runs, ivec2(p.x / RUN, p.y), 0).r;
  vec3 c = vec3(0.0);
  if (kind != NOTHING) c = filtered(p);
  if (kind == LIGHT) c = corrected(p, c);
  signal = vec4(c, 1.0);
}
)";

constexpr const char* kSamplers[] = {"picture", "source_x", "source_y", "gain", "black", "runs"};
constexpr std::size_t kPicture = 0;

// The shader with the constants of correction_map.h.
std::string fragmentShader() {
  std::string source = kFragmentShader;
  const std::string define = "#define RUN " + std::to_string(kRun) + "\n#define NOTHING " +
                             std::to_string(static_cast<int>(RunKind::kNothing)) +
                             "u\n#define LIGHT " +
                             std::to_string(static_cast<int>(RunKind::kLight)) + "u\n";
  return source.insert(source.find('\n') + 1, define);
}

bool isOf(const std::weak_ptr<const CorrectionMap>& held,
          const std::shared_ptr<const CorrectionMap>& map) {
  return !held.owner_before(map) && !map.owner_before(held);
}

}  // namespace

ShaderPass::~ShaderPass() { assert(!gl_); }

Result<Ok> ShaderPass::begin(const gl::GlContext& context) {
  assert(!gl_);
  const gl::GlApi& gl = context.gl();
  const auto program = gl::linkProgram(gl, kVertexShader, fragmentShader().c_str());
  if (!program) return program.error();
  program_ = *program;
  gl_ = &gl;
  gl.GenVertexArrays(1, &vertices_);
  gl.UseProgram(program_);
  int unit = 0;
  for (const char* const name : kSamplers)
    gl.Uniform1i(gl.GetUniformLocation(program_, name), unit++);
  return Ok{};
}

void ShaderPass::end() {
  if (!gl_) return;
  tables_.clear();
  refused_.clear();
  gl_->DeleteProgram(program_);
  gl_->DeleteVertexArrays(1, &vertices_);
  gl_ = nullptr;
}

std::string ShaderPass::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

Result<ShaderPass::Tables> ShaderPass::makeTables(
    const std::shared_ptr<const CorrectionMap>& map) const {
  using Texels = gl::DataTexture::Texels;
  struct Table {
    Texels texels;
    int width, height;
    const void* values;
  };
  const Table all[] = {{Texels::kRgba8, map->source_width, map->source_height, nullptr},
                       {Texels::kInt32, map->stride, map->height, map->source_x.data()},
                       {Texels::kInt32, map->stride, map->height, map->source_y.data()},
                       {Texels::kUint16, map->stride, map->height, map->gain.data()},
                       {Texels::kUint16, map->stride, map->height, map->black.data()},
                       {Texels::kUint8, map->stride / kRun, map->height, map->runs.data()}};
  auto signal = gl::RenderTarget::make(*gl_, map->width, map->height, gl::Depth::kNone);
  if (!signal) return signal.error();
  Tables tables{map, {}, *std::move(signal)};
  for (const Table& table : all) {
    auto texture = gl::DataTexture::make(*gl_, table.texels, table.width, table.height);
    if (!texture) return texture.error();
    if (table.values) texture->write(table.values);
    tables.textures.push_back(*std::move(texture));
  }
  return tables;
}

Result<ShaderPass::Tables*> ShaderPass::tablesOf(const std::shared_ptr<const CorrectionMap>& map) {
  for (Tables& tables : tables_) {
    if (isOf(tables.map, map)) return &tables;
  }
  tables_.remove_if([](const Tables& t) { return t.map.expired(); });
  refused_.remove_if([](const auto& held) { return held.expired(); });
  auto made = makeTables(map);
  if (!made) return made.error();
  tables_.push_back(*std::move(made));
  return &tables_.back();
}

void ShaderPass::setLight(const Light& light) const {
  const auto at = [this](const char* name) { return gl_->GetUniformLocation(program_, name); };
  gl_->UniformMatrix3fv(at("colours"), 1, GL_TRUE, light.matrix.data());
  gl_->Uniform3fv(at("channel_gain"), 1, light.gain.data());
  gl_->Uniform3fv(at("encode"), 1, light.encode.data());
  gl_->Uniform3fv(at("black_level"), 1, light.black.data());
  gl_->Uniform1f(at("gamma"), light.gamma);
  gl_->Uniform1f(at("least_headroom"), light.least_headroom);
}

void ShaderPass::draw(const Tables& tables, const CorrectionMap& map) const {
  tables.signal.bind();
  gl_->Viewport(0, 0, map.width, map.height);
  for (const int test : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_BLEND})
    gl_->Disable(static_cast<GLenum>(test));
  gl_->UseProgram(program_);
  setLight(map.light);
  for (std::size_t i = 0; i < tables.textures.size(); ++i)
    tables.textures[i].bind(static_cast<int>(i));
  gl_->BindVertexArray(vertices_);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
}

bool ShaderPass::run(const std::shared_ptr<const CorrectionMap>& map,
                     std::span<const std::uint8_t> picture, std::span<std::uint8_t> signal) {
  if (!gl_) return false;
  for (const auto& held : refused_) {
    if (isOf(held, map)) return false;
  }
  const auto tables = tablesOf(map);
  if (!tables) {
    refused_.push_back(map);
    const std::lock_guard lock(mutex_);
    fault_ = tables.error().what;
    return false;
  }
  (*tables)->textures[kPicture].write(picture.data());
  draw(**tables, *map);
  (*tables)->signal.read(signal.data(), map->width);
  return true;
}

}  // namespace merlin::render::correct
