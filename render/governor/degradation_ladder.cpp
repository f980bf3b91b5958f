#include "render/governor/degradation_ladder.h"

#include <algorithm>

namespace merlin::render::governor {
namespace {

constexpr double kLateFrame = 1.139434;    // ln(0.25 / 0.08)
constexpr double kFrameInTime = 0.204300;  // ln(0.92 / 0.75)
constexpr double kEnough = 11;             // ten late frames in a row are enough, nine are not
constexpr int kCleanFrames = 300;

}  // namespace

bool DegradationLadder::observe(bool late, bool least, bool higher_fits) noexcept {
  // A late frame of finer detail is no evidence that the coarsest would be late. A frame in time is
  // evidence that the coarsest comes in time, whatever detail the frame had.
  if (!late)
    evidence_ = std::max(0.0, evidence_ - kFrameInTime);
  else if (least)
    evidence_ += kLateFrame;
  clean_ = late ? 0 : clean_ + 1;
  if (step_ < most_ && evidence_ >= kEnough) return go(step_ + 1);
  if (step_ > 0 && clean_ >= kCleanFrames && higher_fits) return go(step_ - 1);
  return false;
}

bool DegradationLadder::setMost(int most) noexcept {
  most_ = most;
  return step_ > most && go(most);
}

bool DegradationLadder::go(int step) noexcept {
  step_ = step;
  evidence_ = 0;
  clean_ = 0;
  return true;
}

}  // namespace merlin::render::governor
