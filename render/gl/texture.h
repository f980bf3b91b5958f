// Texture: a registered picture on the GPU ([GOURLEY98] figure A.2).
#pragma once

#include <cstdint>
#include <span>

#include "render/gl/gl_api.h"

namespace merlin::render {

// RGB, rows from top to bottom.
struct TextureImage {
  int width = 0, height = 0;  // [px]
  std::span<const std::uint8_t> rgb;
};

// Repeats on all sides, mipmapped; halved until the context takes it. Thread-bound to its context,
// which outlives it.
class Texture {
 public:
  // REQUIRES: width, height > 0, rgb of that size. O(pixels). What goes wrong GetError() says.
  Texture(const GlApi& gl, const TextureImage& image);
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void bind() const;  // to unit 0

 private:
  const GlApi& gl_;
  GLuint name_ = 0;
};

}  // namespace merlin::render
