#include "render/content/model_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "render/gl/shader.h"

namespace merlin::render::content {

// The vertex attributes of a node.
struct ModelRenderer::Vertex {
  float position[3];
  std::int8_t normal[4];  // unit normal x 127
  // Red, green, blue; for a textured model instead u and v, two 16-bit numbers scaled to the range
  // of the model's texture coordinates.
  std::uint8_t attribute[4];
};

namespace {

constexpr GLuint kPosition = 0, kNormal = 1, kAttribute = 2;

constexpr const char* kTextured = "#version 330 core\n#define TEXTURED\n";
constexpr const char* kPlain = "#version 330 core\n";

// One light near the eye, slightly from above, plus ambient light and weak light from behind.
constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 value;
uniform mat4 clip_from_model;
uniform mat3 eye_from_model;
uniform vec3 tint;
out vec3 shade;
#ifdef TEXTURED
uniform vec4 range;  // lowest u and v, and how far they reach
out vec2 place;
#endif
void main() {
  gl_Position = clip_from_model * vec4(position, 1.0);
  vec3 n = eye_from_model * normal;
  float facing = dot(n, normalize(vec3(0.15, 0.35, 1.0)));
  float light = 0.30 + 0.80 * max(facing, 0.0) + 0.10 * max(-facing, 0.0);
#ifdef TEXTURED
  // v goes upwards, the picture's rows downwards.
  vec2 uv = range.xy + value.xy * range.zw;
  place = vec2(uv.x, 1.0 - uv.y);
  shade = tint * light;
#else
  shade = min(value * tint * light, vec3(1.0));
#endif
}
)";

constexpr const char* kFragmentShader = R"(
in vec3 shade;
out vec4 pixel;
#ifdef TEXTURED
in vec2 place;
uniform sampler2D picture;
void main() { pixel = vec4(min(texture(picture, place).rgb * shade, vec3(1.0)), 1.0); }
#else
void main() { pixel = vec4(shade, 1.0); }
#endif
)";

// Rounds to the nearest integer without a call of the C library, since a large model needs tens of
// millions of these.
std::int8_t quantise(float component) {
  const float v = component >= -1 ? std::min(127 * component, 127.0F)
                                  : (component < -1 ? -127.0F : 0.0F);  // 0 for NaN
  return static_cast<std::int8_t>(static_cast<int>(double{v} + 127.5) - 127);
}

float mixed(float from, float to, float share) { return from + share * (to - from); }

using Place = std::array<std::uint16_t, 2>;

}  // namespace

ModelRenderer::ModelRenderer(const gl::GlApi& gl, const lod::Dendrogram& model)
    : gl_(gl), model_(model), wires_(gl) {}

Result<std::unique_ptr<ModelRenderer>> ModelRenderer::make(const gl::GlApi& gl,
                                                           const lod::Dendrogram& model,
                                                           std::span<const std::uint32_t> full,
                                                           const ShownFeature& show,
                                                           const gl::TextureImage* texture) {
  static_assert(sizeof(Vertex) == 20);
  if (model.nodeCount() > std::numeric_limits<std::int32_t>::max() / sizeof(Vertex) * 8) {
    return Error{Errc::kUnsupported,
                 fmt::format("{} nodes do not fit into one buffer of OpenGL", model.nodeCount())};
  }
  std::unique_ptr<ModelRenderer> r(new ModelRenderer(gl, model));
  if (const lod::FeatureView* normal = model.find("normal"); normal && normal->dimension == 3)
    r->normal_ = normal;
  const lod::FeatureView* texcoord = model.find("texcoord");
  if (texture && show.feature.empty() && texcoord && texcoord->dimension == 2) {
    r->useTexture(*texcoord, *texture);
  } else {
    auto colours = coloursOf(model, show);
    if (!colours) return colours.error();
    r->colours_ = *std::move(colours);
  }
  if (const auto built = r->buildProgram(); !built) return built.error();
  r->uploadNodes();
  r->makeArray(&r->cut_array_, &r->cut_indices_);
  r->makeArray(&r->full_array_, &r->full_indices_);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(full.size_bytes()), full.data(),
                GL_STATIC_DRAW);
  r->full_triangles_ = full.size() / 3;
  gl.BindVertexArray(0);
  if (const GLenum error = gl.GetError(); error != GL_NO_ERROR) {
    return Error{
        Errc::kUnsupported,
        fmt::format(
            "the GPU does not have enough memory for {} nodes and {} triangles: GL error 0x{:04X}",
            model.nodeCount(), model.triangleCount(), error)};
  }
  return r;
}

ModelRenderer::~ModelRenderer() {
  gl_.DeleteProgram(program_);
  for (GLuint array : {cut_array_, full_array_}) gl_.DeleteVertexArrays(1, &array);
  for (GLuint buffer : {nodes_, cut_indices_, full_indices_}) gl_.DeleteBuffers(1, &buffer);
}

void ModelRenderer::useTexture(const lod::FeatureView& texcoord, const gl::TextureImage& image) {
  texture_ = std::make_unique<gl::Texture>(gl_, image);
  texcoord_ = &texcoord;
  for (std::size_t k = 0; k < 2; ++k) {
    float low = texcoord.values[k], high = low;
    for (std::size_t i = k; i < texcoord.values.size(); i += 2) {
      low = std::min(low, texcoord.values[i]);
      high = std::max(high, texcoord.values[i]);
    }
    texcoords_.low[k] = low;
    texcoords_.size[k] = high - low;
  }
}

Result<Ok> ModelRenderer::buildProgram() {
  const std::string begin = texture_ ? kTextured : kPlain;
  const auto program =
      gl::linkProgram(gl_, (begin + kVertexShader).c_str(), (begin + kFragmentShader).c_str());
  if (!program) return program.error();
  program_ = *program;
  clip_location_ = gl_.GetUniformLocation(program_, "clip_from_model");
  eye_location_ = gl_.GetUniformLocation(program_, "eye_from_model");
  colour_location_ = gl_.GetUniformLocation(program_, "tint");
  range_location_ = gl_.GetUniformLocation(program_, "range");
  return wires_.build();
}

ModelRenderer::Vertex ModelRenderer::vertexOf(std::uint32_t node) const {
  const auto& a = model_.arrays();
  Vertex v{};
  const std::size_t n = node;
  for (std::size_t k = 0; k < 3; ++k) {
    v.position[k] = a.positions[3 * n + k];
    v.normal[k] = quantise(normal_ ? normal_->values[3 * n + k] : (k == 2 ? 1.0F : 0.0F));
    v.attribute[k] = colours_.rgb.empty() ? 255 : colours_.rgb[n][k];
  }
  if (texcoord_) {
    Place place{};
    for (std::size_t k = 0; k < 2; ++k) {
      const float from_low = texcoord_->values[2 * n + k] - texcoords_.low[k];
      const float share = texcoords_.size[k] > 0 ? from_low / texcoords_.size[k] : 0;
      place[k] = static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0F, 1.0F)));
    }
    std::memcpy(v.attribute, &place, sizeof place);
  }
  return v;
}

// Returns the vertex at the fraction `share` of the way from its parent to its own position: 0 at
// the parent, 1 at its own.
ModelRenderer::Vertex ModelRenderer::between(const Vertex& parent, const Vertex& own,
                                             float share) const {
  Vertex v{};
  float normal[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    v.position[k] = mixed(parent.position[k], own.position[k], share);
    normal[k] = mixed(parent.normal[k], own.normal[k], share);
    square += normal[k] * normal[k];
    v.attribute[k] =
        static_cast<std::uint8_t>(std::lround(mixed(parent.attribute[k], own.attribute[k], share)));
  }
  for (int k = 0; k < 3; ++k) v.normal[k] = quantise(normal[k] / std::sqrt(square));
  if (texcoord_) {
    Place from{}, to{};
    std::memcpy(&from, parent.attribute, sizeof from);
    std::memcpy(&to, own.attribute, sizeof to);
    for (std::size_t k = 0; k < 2; ++k)
      to[k] = static_cast<std::uint16_t>(std::lround(mixed(from[k], to[k], share)));
    std::memcpy(v.attribute, &to, sizeof to);
  }
  return v;
}

// Returns the current, possibly displaced, vertex of a node's parent. REQUIRES: the node has a
// parent, and the parent's vertex is in morphed_ if it is displaced.
ModelRenderer::Vertex ModelRenderer::parentOf(std::uint32_t node) const {
  const std::uint32_t parent = model_.parentOf(node);
  const auto end = morphs_.begin() + static_cast<std::ptrdiff_t>(morphed_.size());
  const auto found =
      std::lower_bound(morphs_.begin(), end, parent,
                       [](const lod::Morph& morph, std::uint32_t n) { return morph.node < n; });
  if (found == end || found->node != parent) return vertexOf(parent);
  return morphed_[static_cast<std::size_t>(found - morphs_.begin())];
}

// The buffer is mapped unsynchronised and its old contents are kept: only scattered vertices
// change, and the GPU does not read them meanwhile.
void ModelRenderer::morph(std::span<const lod::Morph> morphs) {
  if (morphs_.empty() && morphs.empty()) return;
  std::uint32_t first = ~std::uint32_t{0}, last = 0;
  for (const std::span<const lod::Morph> list : {std::span<const lod::Morph>(morphs_), morphs}) {
    if (list.empty()) continue;
    first = std::min(first, list.front().node);
    last = std::max(last, list.back().node);
  }
  gl_.BindBuffer(GL_ARRAY_BUFFER, nodes_);
  auto* at = static_cast<Vertex*>(
      gl_.MapBufferRange(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof(Vertex)),
                         static_cast<GLsizeiptr>((last - first + 1) * sizeof(Vertex)),
                         GL_MAP_WRITE_BIT | GL_MAP_UNSYNCHRONIZED_BIT));
  if (!at) return;
  for (const lod::Morph& morph : morphs_) at[morph.node - first] = vertexOf(morph.node);
  morphs_.assign(morphs.begin(), morphs.end());
  morphed_.clear();
  for (const lod::Morph& morph : morphs_) {
    morphed_.push_back(between(parentOf(morph.node), vertexOf(morph.node), morph.own));
    at[morph.node - first] = morphed_.back();
  }
  gl_.UnmapBuffer(GL_ARRAY_BUFFER);
}

// Writes the vertices directly into the mapped buffer. If there is not enough memory, make() finds
// the GL error.
void ModelRenderer::uploadNodes() {
  const auto nodes = static_cast<std::uint32_t>(model_.nodeCount());
  const auto bytes = static_cast<GLsizeiptr>(nodes * sizeof(Vertex));
  gl_.GenBuffers(1, &nodes_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, nodes_);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, nullptr, GL_STATIC_DRAW);
  auto* at = static_cast<Vertex*>(gl_.MapBufferRange(
      GL_ARRAY_BUFFER, 0, bytes, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
  if (!at) return;
  for (std::uint32_t n = 0; n < nodes; ++n) at[n] = vertexOf(n);
  gl_.UnmapBuffer(GL_ARRAY_BUFFER);
}

void ModelRenderer::makeArray(GLuint* array, GLuint* indices) {
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  gl_.GenVertexArrays(1, array);
  gl_.BindVertexArray(*array);
  gl_.BindBuffer(GL_ARRAY_BUFFER, nodes_);
  gl_.VertexAttribPointer(kPosition, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          offset(offsetof(Vertex, position)));
  gl_.VertexAttribPointer(kNormal, 3, GL_BYTE, GL_TRUE, sizeof(Vertex),
                          offset(offsetof(Vertex, normal)));
  gl_.VertexAttribPointer(kAttribute, texture_ ? 2 : 3,
                          texture_ ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex),
                          offset(offsetof(Vertex, attribute)));
  for (const GLuint attribute : {kPosition, kNormal, kAttribute})
    gl_.EnableVertexAttribArray(attribute);
  gl_.GenBuffers(1, indices);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, *indices);
}

void ModelRenderer::uploadCut(std::span<const std::uint32_t> indices) {
  gl_.BindVertexArray(cut_array_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()),
                 indices.data(), GL_STREAM_DRAW);
  cut_triangles_ = indices.size() / 3;
}

void ModelRenderer::begin(int width, int height, const Camera& camera, const RenderStyle& style) {
  gl_.Viewport(0, 0, width, height);
  gl_.ClearColor(style.background[0], style.background[1], style.background[2], 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_DEPTH_TEST);
  if (style.draw_back_faces)
    gl_.Disable(GL_CULL_FACE);
  else
    gl_.Enable(GL_CULL_FACE);
  // The first row of the image is the upper one, so y is negated, which also reverses the winding
  // order of triangles.
  clip_ = camera.clip_from_model;
  clip_.row(1) *= -1;
  style_ = style;
  gl_.FrontFace(GL_CW);
  gl_.UseProgram(program_);
  gl_.UniformMatrix4fv(clip_location_, 1, GL_FALSE, clip_.data());
  gl_.UniformMatrix3fv(eye_location_, 1, GL_FALSE, camera.eye_from_model.data());
  const std::array<float, 3> white{1, 1, 1};
  const auto& tint = colours_.rgb.empty() && !texture_ ? style.colour : white;
  gl_.Uniform3f(colour_location_, tint[0] * style.brightness, tint[1] * style.brightness,
                tint[2] * style.brightness);
  if (!texture_) return;
  texture_->bind();
  gl_.Uniform4f(range_location_, texcoords_.low[0], texcoords_.low[1], texcoords_.size[0],
                texcoords_.size[1]);
}

void ModelRenderer::draw(Source source, std::size_t first, std::size_t count) {
  gl_.BindVertexArray(source == Source::kCut ? cut_array_ : full_array_);
  const auto triangles = [&] {
    const auto offset = reinterpret_cast<const void*>(first * 3 * sizeof(std::uint32_t));
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT, offset);
  };
  if (style_.wireframe)
    wires_.draw(clip_, style_, triangles);
  else
    triangles();
}

}  // namespace merlin::render::content
