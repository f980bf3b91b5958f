// ReadBack: copies a render target's pixels into memory without waiting for the GPU at once:
// start() while further work is given to the GPU, finish() when the pixels are needed.
#pragma once

#include <cstdint>
#include <span>

#include "render/gl/gl_api.h"
#include "render/gl/render_target.h"

namespace merlin::render::gl {

// A pixel buffer on the GPU, and a fence. Thread-bound to its context, which must outlive it.
class ReadBack {
 public:
  explicit ReadBack(const GlApi& gl) : gl_(&gl) {}
  ReadBack(ReadBack&& other) noexcept;
  ReadBack& operator=(ReadBack&&) = delete;
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;
  ~ReadBack();

  // Begins to copy the upper left width x height pixels of `target`, as they are after all drawing
  // so far. Drops a copy that was started before and not finished. REQUIRES: the pixels lie within
  // the target.
  void start(const RenderTarget& target, int width, int height);

  // Begins to copy `width` pixels from column `x` on of each of these rows; finish() writes the
  // rows one below the other. Drops an unfinished copy, like start(). REQUIRES: the pixels lie
  // within the target.
  void startRows(const RenderTarget& target, int x, int width, std::span<const int> rows);

  // Waits until the copy is complete and writes it to `pixels` as RenderTarget::read() does.
  // REQUIRES: start() or startRows() was called since the last finish().
  void finish(std::uint8_t* pixels, int stride_px);

 private:
  void bindFor(int width, int height);
  void setFence();

  const GlApi* gl_;
  GLuint buffer_ = 0;
  GLsync fence_ = nullptr;
  int width_ = 0, height_ = 0;
  std::int64_t capacity_ = 0;  // of the buffer [bytes]
};

}  // namespace merlin::render::gl
