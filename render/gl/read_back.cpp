#include "render/gl/read_back.h"

#include <cassert>
#include <cstring>
#include <utility>

namespace merlin::render::gl {
namespace {

constexpr GLuint64 kLook_ns = 1'000'000'000;  // the wait is repeated after this time; it ends even
                                              // if the GPU is reset, which signals its fences

}  // namespace

ReadBack::ReadBack(ReadBack&& other) noexcept
    : gl_(other.gl_),
      buffer_(std::exchange(other.buffer_, 0)),
      fence_(std::exchange(other.fence_, nullptr)),
      width_(other.width_),
      height_(other.height_),
      capacity_(std::exchange(other.capacity_, 0)) {}

ReadBack::~ReadBack() {
  if (fence_) gl_->DeleteSync(fence_);
  if (buffer_) gl_->DeleteBuffers(1, &buffer_);
}

void ReadBack::start(const RenderTarget& target, int width, int height) {
  assert(width <= target.width() && height <= target.height());
  bindFor(width, height);
  target.bind();
  gl_->ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  setFence();
}

void ReadBack::startRows(const RenderTarget& target, int x, int width, std::span<const int> rows) {
  bindFor(width, static_cast<int>(rows.size()));
  target.bind();
  std::uintptr_t offset = 0;
  for (const int y : rows) {
    assert(x >= 0 && x + width <= target.width() && y >= 0 && y < target.height());
    gl_->ReadPixels(x, y, width, 1, GL_RGBA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(offset));
    offset += std::uintptr_t{4} * static_cast<std::uintptr_t>(width);
  }
  setFence();
}

// Makes the pixel buffer large enough and binds it.
void ReadBack::bindFor(int width, int height) {
  width_ = width;
  height_ = height;
  if (!buffer_) gl_->GenBuffers(1, &buffer_);
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, buffer_);
  const std::int64_t bytes = std::int64_t{4} * width * height;
  if (bytes > capacity_) {
    gl_->BufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    capacity_ = bytes;
  }
  gl_->PixelStorei(GL_PACK_ROW_LENGTH, 0);
}

void ReadBack::setFence() {
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (fence_) gl_->DeleteSync(fence_);
  fence_ = gl_->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void ReadBack::finish(std::uint8_t* pixels, int stride_px) {
  assert(fence_ && stride_px >= width_);
  while (gl_->ClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, kLook_ns) == GL_TIMEOUT_EXPIRED)
    continue;
  gl_->DeleteSync(std::exchange(fence_, nullptr));
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width_);
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, buffer_);
  const auto* from = static_cast<const std::uint8_t*>(gl_->MapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(row * static_cast<std::size_t>(height_)),
      GL_MAP_READ_BIT));
  for (int y = 0; from && y < height_; ++y) {
    std::memcpy(pixels + std::ptrdiff_t{4} * y * stride_px,
                from + static_cast<std::size_t>(y) * row, row);
  }
  if (from) gl_->UnmapBuffer(GL_PIXEL_PACK_BUFFER);
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

}  // namespace merlin::render::gl
