#include "render/content/picture/picture_renderer.h"

#include <algorithm>
#include <cstddef>

#include "render/content/picture/picture_content.h"
#include "render/gl/shader.h"

namespace merlin::render::content {
namespace {

constexpr std::size_t kUploadsPerSlice = 8;  // of 0.1 ms each on llvmpipe
constexpr std::size_t kPiecesPerSlice = 8;   // of up to 256 x 256 pixels each

// The pieces are drawn without a depth test, in the order of the draw list. Depth 0 also keeps the
// near and far planes from cutting them.
constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec2 in_texture;
uniform mat4 clip_from_metres;
out vec2 at;
void main() {
  gl_Position = clip_from_metres * vec4(place, 1.0);
  gl_Position.z = 0.0;
  at = in_texture;
}
)";
constexpr const char* kFragmentShader = R"(#version 330 core
in vec2 at;
uniform sampler2DArray tiles;
uniform vec3 layer;
out vec4 pixel;
void main() { pixel = vec4(texture(tiles, vec3(at, layer.x)).rgb, 1.0); }
)";

constexpr GLsizei kSide = kBorderedSide, kInner = image::kTileSide;

}  // namespace

Result<std::unique_ptr<ContentRenderer>> PictureRenderer::make(const gl::GlApi& gl,
                                                               const PictureDrawList& list,
                                                               TileCache& cache) {
  const auto program = gl::linkProgram(gl, kVertexShader, kFragmentShader);
  if (!program) return program.error();
  return std::unique_ptr<ContentRenderer>(new PictureRenderer(gl, list, cache, *program));
}

PictureRenderer::PictureRenderer(const gl::GlApi& gl, const PictureDrawList& list, TileCache& cache,
                                 GLuint program)
    : gl_(gl), list_(list), cache_(cache), uploaded_(cache.join()), program_(program) {
  clip_location_ = gl_.GetUniformLocation(program_, "clip_from_metres");
  layer_location_ = gl_.GetUniformLocation(program_, "layer");
  textures_.resize((cache.size() + kSlotsPerTexture - 1) / kSlotsPerTexture);
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(1, &vertices_);
  gl_.GenBuffers(1, &indices_);
}

PictureRenderer::~PictureRenderer() {
  for (const GLuint texture : textures_) {
    if (texture != 0) gl_.DeleteTextures(1, &texture);
  }
  gl_.DeleteVertexArrays(1, &array_);
  for (const GLuint buffer : {vertices_, indices_}) gl_.DeleteBuffers(1, &buffer);
  gl_.DeleteProgram(program_);
  cache_.leave(uploaded_);
}

void PictureRenderer::beginFrame() {
  looked_at_ = 0;
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(list_.vertices.size() * sizeof(PictureVertex)),
                 list_.vertices.data(), GL_STREAM_DRAW);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PictureVertex), offset(0));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(PictureVertex),
                          offset(offsetof(PictureVertex, u)));
  for (const GLuint attribute : {0U, 1U}) gl_.EnableVertexAttribArray(attribute);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(list_.indices.size() * sizeof(std::uint32_t)),
                 list_.indices.data(), GL_STREAM_DRAW);
  // Even a context that draws no tile of this frame uploads what is new.
  uploadSome(kUploadsPerSlice);
}

void PictureRenderer::beginView(std::size_t tile, int width, int height) {
  gl_.Viewport(0, 0, width, height);
  gl_.ClearColor(list_.background[0], list_.background[1], list_.background[2], 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  Eigen::Matrix4f clip = list_.views[tile].clip_from_metres;
  clip.row(1) *= -1;  // the first row of a canvas is the upper one
  gl_.UseProgram(program_);
  gl_.UniformMatrix4fv(clip_location_, 1, GL_FALSE, clip.data());
}

// Binds a texture; creates it first if it does not exist yet.
void PictureRenderer::bindTexture(std::size_t texture) {
  if (textures_[texture] != 0) return gl_.BindTexture(GL_TEXTURE_2D_ARRAY, textures_[texture]);
  gl_.GenTextures(1, &textures_[texture]);
  gl_.BindTexture(GL_TEXTURE_2D_ARRAY, textures_[texture]);
  gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, kSide, kSide, kSlotsPerTexture, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void PictureRenderer::upload(std::size_t slot) {
  const TileSlot& from = cache_.slot(slot);
  gl_.TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 1, 1, static_cast<GLint>(slot % kSlotsPerTexture),
                    kInner, kInner, 1, GL_RGBA, GL_UNSIGNED_BYTE, from.pixels.data());
  uploaded_.pixels[slot] = from.version;
}

void PictureRenderer::uploadBorder(std::size_t slot, const TileBorder& border) {
  const auto layer = static_cast<GLint>(slot % kSlotsPerTexture);
  const auto strip = [&](GLint x, GLint y, GLsizei width, GLsizei height, const auto& texels) {
    gl_.TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, y, layer, width, height, 1, GL_RGBA,
                      GL_UNSIGNED_BYTE, texels.data());
  };
  strip(0, 0, kSide, 1, border.top);
  strip(0, kSide - 1, kSide, 1, border.bottom);
  strip(0, 1, 1, kInner, border.left);
  strip(kSide - 1, 1, 1, kInner, border.right);
}

// Uploads up to `most` tiles that are new or whose borders changed. Returns true when all are up to
// date.
bool PictureRenderer::uploadSome(std::size_t most) {
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t left = most; looked_at_ < cache_.size(); ++looked_at_) {
    const TileSlot& slot = cache_.slot(looked_at_);
    const bool pixels = uploaded_.pixels[looked_at_] != slot.version && !slot.pixels.empty();
    const bool border = uploaded_.borders[looked_at_] != slot.border_version;
    if (!slot.place || (!pixels && !border)) continue;
    if (left-- == 0) return false;
    bindTexture(looked_at_ / kSlotsPerTexture);
    if (pixels) upload(looked_at_);
    uploadBorder(looked_at_, slot.border);
    uploaded_.borders[looked_at_] = slot.border_version;
  }
  return true;
}

bool PictureRenderer::drawSlice(std::size_t tile, DrawProgress& progress) {
  if (looked_at_ < cache_.size() && !uploadSome(kUploadsPerSlice)) return false;
  const auto& pieces = list_.pieces[tile];
  gl_.UseProgram(program_);
  gl_.BindVertexArray(array_);
  for (std::size_t left = kPiecesPerSlice; left > 0 && progress.part < pieces.size(); --left) {
    const TilePiece& piece = pieces[progress.part++];
    bindTexture(piece.slot / kSlotsPerTexture);
    gl_.Uniform3f(layer_location_, static_cast<float>(piece.slot % kSlotsPerTexture), 0, 0);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
  }
  return progress.part == pieces.size();
}

}  // namespace merlin::render::content
