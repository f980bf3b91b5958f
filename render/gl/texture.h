// Texture: an image on the GPU that is mapped onto a model by texture coordinates ([GOURLEY98]
// figure A.2).
#pragma once

#include <cstdint>
#include <span>

#include "render/gl/gl_api.h"

namespace merlin::render::gl {

// RGB, rows from top to bottom.
struct TextureImage {
  int width = 0, height = 0;  // [px]
  std::span<const std::uint8_t> rgb;
};

// Repeats in both directions and has mipmaps. An image that exceeds the context's maximum texture
// size is halved until it fits. Thread-bound to its context, which must outlive it.
class Texture {
 public:
  // REQUIRES: width, height > 0, and 3 * width * height bytes of rgb. O(pixels). On failure
  // gl.GetError() returns the error.
  Texture(const GlApi& gl, const TextureImage& image);
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void bind() const;  // to texture unit 0

 private:
  const GlApi& gl_;
  GLuint name_ = 0;
};

}  // namespace merlin::render::gl
