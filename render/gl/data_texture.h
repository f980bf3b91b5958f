// DataTexture: a number or a colour for each pixel, which a shader reads by texelFetch().
#pragma once

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"

namespace merlin::render::gl {

// Thread-bound to its context, which must outlive it.
class DataTexture {
 public:
  // Type of a texel, and the type of sampler that reads it in a shader.
  enum class Texels {
    kRgba8,   // 4 bytes; sampler2D
    kInt32,   // isampler2D
    kUint16,  // usampler2D
    kUint8,   // usampler2D
  };
  // Makes a texture of this size [texels]. Errors: kUnsupported (larger than this OpenGL allows, or
  // no memory).
  static Result<DataTexture> make(const GlApi& gl, Texels texels, int width, int height);

  DataTexture(DataTexture&& other) noexcept;
  DataTexture& operator=(DataTexture&&) = delete;
  DataTexture(const DataTexture&) = delete;
  DataTexture& operator=(const DataTexture&) = delete;
  ~DataTexture();

  // Replaces all texels by width * height ones, row by row without padding.
  void write(const void* texels) const;

  // Binds to the texture unit of this number; unit 0 is the active one afterwards.
  void bind(int unit) const;

 private:
  DataTexture(const GlApi& gl, Texels texels, int width, int height)
      : gl_(&gl), texels_(texels), width_(width), height_(height) {}

  const GlApi* gl_;
  Texels texels_;
  int width_, height_;
  GLuint name_ = 0;
};

}  // namespace merlin::render::gl
