#include "drivers/port/guided_corners.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr GuidedStep kCornerSteps[] = {
    {"top left", "touch the top left corner of the picture with one finger, and hold it there"},
    {"top right", "the same at the top right corner"},
    {"bottom left", "the same at the bottom left corner"},
};
enum Step : std::size_t { kTopLeft, kTopRight, kBottomLeft };

// Least distance of two corners; the image may be smaller than the surface.
constexpr float kLeastSide = 0.3F;

SurfacePlace between(const SurfacePlace& from, const SurfacePlace& to) {
  return {to[0] - from[0], to[1] - from[1]};
}

bool isAlongX(const SurfacePlace& way) { return std::abs(way[0]) >= std::abs(way[1]); }

}  // namespace

std::span<const GuidedStep> cornerSteps() { return kCornerSteps; }

void GuidedCorners::begin(std::size_t step) {
  step_ = step;
  samples_ = 0;
  several_ = false;
  sum_ = {};
}

void GuidedCorners::add(const TouchSample& sample) {
  if (sample.fingers == 0) return;
  several_ |= sample.fingers > 1;
  ++samples_;
  for (std::size_t i = 0; i < 2; ++i) sum_[i] += sample.position[0][i];
}

Result<SurfacePlace> GuidedCorners::end() {
  const auto refuse = [](std::string what) { return Error{Errc::kMalformed, std::move(what)}; };
  if (samples_ == 0) return refuse("nothing touched the surface");
  if (several_) return refuse("several fingers touched it: use one");
  const auto count = static_cast<float>(samples_);
  const SurfacePlace place = {sum_[0] / count, sum_[1] / count};
  if (step_ != kTopLeft) {
    const SurfacePlace way = between(corners_[kTopLeft], place);
    const float length = std::max(std::abs(way[0]), std::abs(way[1]));
    if (length < kLeastSide)
      return refuse(
          fmt::format("it lies only {:.2f} of the surface away from the top left corner "
                      "({} are needed); a mouse, which has no corners, needs --mouse-counts",
                      length, kLeastSide));
    if (step_ == kBottomLeft &&
        isAlongX(way) == isAlongX(between(corners_[kTopLeft], corners_[kTopRight])))
      return refuse("it lies in the same direction as the top right corner");
  }
  corners_[step_] = place;
  return place;
}

// The device's axes are swapped first, then the resulting axes of the surface are reversed.
TouchOrientation GuidedCorners::solve() const {
  const SurfacePlace right = between(corners_[kTopLeft], corners_[kTopRight]);
  const SurfacePlace down = between(corners_[kTopLeft], corners_[kBottomLeft]);
  TouchOrientation solved;
  solved.swap_axes = !isAlongX(right);
  solved.invert_x = right[solved.swap_axes ? 1 : 0] < 0;
  solved.invert_y = down[solved.swap_axes ? 0 : 1] < 0;
  return solved;
}

}  // namespace merlin
