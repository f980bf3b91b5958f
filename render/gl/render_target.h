// RenderTarget: an off-screen image (8-bit RGBA, and depth) to draw into, and the read-back of its
// pixels.
#pragma once

#include <cstdint>

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"

namespace merlin::render::gl {

enum class Depth { kNone, k24Bits };

// Thread-bound to its context, which must outlive it.
class RenderTarget {
 public:
  // Makes a target of this size [px]. Errors: kUnsupported (the context cannot create a target of
  // this size).
  static Result<RenderTarget> make(const GlApi& gl, int width, int height,
                                   Depth depth = Depth::k24Bits);
  // Makes a target of a renderbuffer that has its memory already, and takes it over. Errors:
  // kUnsupported (OpenGL cannot draw there); the renderbuffer is deleted then.
  static Result<RenderTarget> makeOf(const GlApi& gl, GLuint renderbuffer, int width, int height);

  RenderTarget(RenderTarget&& other) noexcept;
  RenderTarget& operator=(RenderTarget&&) = delete;
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;
  ~RenderTarget();

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

  void bind() const;

  // Copies the image to `pixels` as RGBA, rows from top to bottom (MERLIN draws with y pointing
  // downwards, so rows need no reversal); rows begin `stride_px` pixels apart. Waits until drawing
  // has finished.
  void read(std::uint8_t* pixels, int stride_px) const { read(pixels, stride_px, width_, height_); }
  // Copies only the upper left width x height pixels. REQUIRES: they lie within the image, and
  // stride_px >= width.
  void read(std::uint8_t* pixels, int stride_px, int width, int height) const;

 private:
  RenderTarget(const GlApi& gl, int width, int height) : gl_(&gl), width_(width), height_(height) {}

  const GlApi* gl_;
  int width_, height_;
  GLuint frame_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace merlin::render::gl
