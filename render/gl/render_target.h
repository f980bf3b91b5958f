// RenderTarget: an off-screen picture, RGBA bytes and depth, and how its pixels come out.
#pragma once

#include <cstdint>

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"

namespace merlin::render {

// Thread-bound to its context, which outlives it.
class RenderTarget {
 public:
  // Errors: kUnsupported (the context cannot make one of this size).
  static Result<RenderTarget> make(const GlApi& gl, int width, int height);

  RenderTarget(RenderTarget&& other) noexcept;
  RenderTarget& operator=(RenderTarget&&) = delete;
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;
  ~RenderTarget();

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

  void bind() const;

  // Copies the picture to `pixels`, RGBA, rows from top to bottom (MERLIN draws with y downwards,
  // so no row is turned), the next row `stride_px` pixels on. Waits until all is drawn.
  void read(std::uint8_t* pixels, int stride_px) const { read(pixels, stride_px, width_, height_); }
  // The same of its upper left corner. REQUIRES: no larger than the picture.
  void read(std::uint8_t* pixels, int stride_px, int width, int height) const;

 private:
  RenderTarget(const GlApi& gl, int width, int height) : gl_(&gl), width_(width), height_(height) {}

  const GlApi* gl_;
  int width_, height_;
  GLuint frame_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace merlin::render
