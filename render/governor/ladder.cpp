#include "render/governor/ladder.h"

#include <bit>

namespace merlin::render {
namespace {

constexpr int kLateFrames = 10, kCleanFrames = 300;
constexpr std::uint64_t kLast60 = (std::uint64_t{1} << 60) - 1;

}  // namespace

bool Ladder::observe(bool late, bool least, bool higher_fits) noexcept {
  late_ = (late_ << 1 | (late && least ? 1U : 0U)) & kLast60;
  clean_ = late ? 0 : clean_ + 1;
  if (rung_ < most_ && std::popcount(late_) >= kLateFrames) return go(rung_ + 1);
  if (rung_ > 0 && clean_ >= kCleanFrames && higher_fits) return go(rung_ - 1);
  return false;
}

bool Ladder::go(int rung) noexcept {
  rung_ = rung;
  late_ = 0;
  clean_ = 0;
  return true;
}

}  // namespace merlin::render
