#include "render/inventor/frame_rate_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace merlin::render::inventor {

void FrameRateLaw::start(double now_s) noexcept {
  started_ = std::isfinite(now_s);
  start_s_ = last_s_ = now_s;
  triangles_ = 0;
}

std::optional<std::int32_t> FrameRateLaw::frameDrawn(double now_s, std::size_t triangles,
                                                     double desired_hz) {
  assert(desired_hz > 0);
  if (!started_ || !std::isfinite(now_s) || now_s <= last_s_) {
    start(now_s);
    return std::nullopt;
  }
  last_s_ = now_s;
  const auto drawn = static_cast<double>(triangles);
  triangles_ += drawn;
  const double seconds = now_s - start_s_;
  if (seconds < kWindow_s) return std::nullopt;
  const double per_frame = triangles_ / seconds / desired_hz;
  start(now_s);
  if (std::abs(per_frame - drawn) <= kTolerance * drawn) return std::nullopt;
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::min(per_frame, kMost));
}

}  // namespace merlin::render::inventor
