#include "render/gl/texture.h"

#include <algorithm>
#include <vector>

namespace merlin::render::gl {
namespace {

// Halves the size: each pixel is the mean of 2 x 2 pixels. An odd last row or column is dropped,
// unless it is the only one.
std::vector<std::uint8_t> halved(const TextureImage& image) {
  const int width = std::max(1, image.width / 2), height = std::max(1, image.height / 2);
  std::vector<std::uint8_t> half;
  half.reserve(std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto at = [&](int x, int y, int channel) -> int {
    const auto column = static_cast<std::size_t>(std::min(x, image.width - 1)),
               row = static_cast<std::size_t>(std::min(y, image.height - 1));
    return image.rgb[3 * (row * static_cast<std::size_t>(image.width) + column) +
                     static_cast<std::size_t>(channel)];
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int sum = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) +
                        at(2 * x + 1, 2 * y + 1, c);
        half.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
    }
  }
  return half;
}

}  // namespace

Texture::Texture(const GlApi& gl, const TextureImage& image) : gl_(gl) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  TextureImage fits = image;
  std::vector<std::uint8_t> smaller;
  while (std::max(fits.width, fits.height) > std::max(most, 1)) {
    smaller = halved(fits);
    fits = {std::max(1, fits.width / 2), std::max(1, fits.height / 2), smaller};
  }
  gl.GenTextures(1, &name_);
  gl.BindTexture(GL_TEXTURE_2D, name_);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, fits.width, fits.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                fits.rgb.data());
  gl.GenerateMipmap(GL_TEXTURE_2D);
  // Trilinear filtering costs a software renderer a seventh more time, for a difference that is
  // hardly visible.
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

Texture::~Texture() { gl_.DeleteTextures(1, &name_); }

void Texture::bind() const { gl_.BindTexture(GL_TEXTURE_2D, name_); }

}  // namespace merlin::render::gl
