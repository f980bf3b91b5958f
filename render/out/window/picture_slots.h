// PictureSlots: three pictures in memory that two processes map. The writer always has one slot for
// itself: of the other two, one may be read and one may wait.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::render::out {

class PictureSlots {
 public:
  static constexpr std::uint32_t kCount = 3;

  // Allocates pictures of width x height RGBA pixels, all pages at once. Errors: kIo.
  static Result<PictureSlots> make(int width, int height);
  // Maps the pictures of another process, to be read only. Errors: kIo; kMalformed (the object is
  // smaller than the pictures).
  static Result<PictureSlots> open(UniqueFd memory, int width, int height);

  PictureSlots(PictureSlots&& other) noexcept;
  PictureSlots& operator=(PictureSlots&&) = delete;
  PictureSlots(const PictureSlots&) = delete;
  PictureSlots& operator=(const PictureSlots&) = delete;
  ~PictureSlots();

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  int fd() const noexcept { return memory_.get(); }
  // Returns the pixels of picture i: RGBA, rows from top to bottom, no padding. REQUIRES: i <
  // kCount; only the process that called make() writes to them.
  std::span<std::uint8_t> slot(std::uint32_t i) const noexcept {
    return {pixels_ + i * bytes(), bytes()};
  }

 private:
  PictureSlots(UniqueFd memory, std::uint8_t* pixels, int width, int height)
      : memory_(std::move(memory)), pixels_(pixels), width_(width), height_(height) {}
  static Result<PictureSlots> map(UniqueFd memory, int protection, int width, int height);
  std::size_t bytes() const noexcept {
    return std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }

  UniqueFd memory_;
  std::uint8_t* pixels_ = nullptr;
  int width_, height_;
};

}  // namespace merlin::render::out
