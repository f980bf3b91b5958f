#include "render/gl/data_texture.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::render::gl {
namespace {

struct Format {
  GLint internal;
  GLenum format, type;
};

// In the order of DataTexture::Texels.
constexpr Format kFormats[] = {{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
                               {GL_R32I, GL_RED_INTEGER, GL_INT},
                               {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT},
                               {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE}};

const Format& formatOf(DataTexture::Texels texels) {
  return kFormats[static_cast<std::size_t>(texels)];
}

}  // namespace

Result<DataTexture> DataTexture::make(const GlApi& gl, Texels texels, int width, int height) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (width > most || height > most) {
    return Error{Errc::kUnsupported,
                 fmt::format("OpenGL has no texture of {} x {} texels: at most {} x {}", width,
                             height, most, most)};
  }
  DataTexture texture(gl, texels, width, height);
  const Format& f = formatOf(texels);
  while (gl.GetError() != GL_NO_ERROR) continue;
  gl.GenTextures(1, &texture.name_);
  texture.bind(0);
  gl.TexImage2D(GL_TEXTURE_2D, 0, f.internal, width, height, 0, f.format, f.type, nullptr);
  // Integers cannot be filtered; with another filter the texture would be incomplete.
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  if (const GLenum error = gl.GetError(); error != GL_NO_ERROR) {
    return Error{Errc::kUnsupported,
                 fmt::format("OpenGL cannot create a texture of {} x {} texels: error 0x{:04X}",
                             width, height, error)};
  }
  return texture;
}

DataTexture::DataTexture(DataTexture&& other) noexcept
    : gl_(other.gl_),
      texels_(other.texels_),
      width_(other.width_),
      height_(other.height_),
      name_(std::exchange(other.name_, 0)) {}

DataTexture::~DataTexture() {
  if (name_) gl_->DeleteTextures(1, &name_);
}

void DataTexture::write(const void* texels) const {
  const Format& f = formatOf(texels_);
  bind(0);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, f.format, f.type, texels);
}

void DataTexture::bind(int unit) const {
  gl_->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl_->BindTexture(GL_TEXTURE_2D, name_);
  gl_->ActiveTexture(GL_TEXTURE0);
}

}  // namespace merlin::render::gl
