#include "render/governor/ladder.h"

#include <algorithm>

namespace merlin::render {
namespace {

constexpr double kLateFrame = 1.139434;    // ln(0.25 / 0.08)
constexpr double kFrameInTime = 0.204300;  // ln(0.92 / 0.75)
constexpr double kEnough = 11;             // ten late frames in a row are enough, nine are not
constexpr int kCleanFrames = 300;

}  // namespace

bool Ladder::observe(bool late, bool least, bool higher_fits) noexcept {
  // A late frame that had more than the fewest triangles says nothing about the fewest; a frame in
  // time says that the fewest come in time, however many it had.
  if (!late)
    evidence_ = std::max(0.0, evidence_ - kFrameInTime);
  else if (least)
    evidence_ += kLateFrame;
  clean_ = late ? 0 : clean_ + 1;
  if (rung_ < most_ && evidence_ >= kEnough) return go(rung_ + 1);
  if (rung_ > 0 && clean_ >= kCleanFrames && higher_fits) return go(rung_ - 1);
  return false;
}

bool Ladder::go(int rung) noexcept {
  rung_ = rung;
  evidence_ = 0;
  clean_ = 0;
  return true;
}

}  // namespace merlin::render
