#include "render/out/frame_clock.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::out {
namespace {

constexpr double kSamePeriod = 0.03;
constexpr Duration kStaleAfter = std::chrono::seconds(10);
constexpr std::int64_t kMostShift = 16;  // a frame moves by at most 1 / kMostShift of a period

}  // namespace

void VblankFrameClock::start(Timestamp from, Duration period) {
  asked_ = period_ = period;
  base_ = from;
  base_k_ = 0;
}

std::int64_t VblankFrameClock::frameAt(Timestamp now) const noexcept {
  const Duration since = now - base_;
  std::int64_t frames = since / period_;
  if (since % period_ < Duration::zero()) --frames;  // a division rounds towards 0
  return std::max<std::int64_t>(base_k_ + frames, -1);
}

bool VblankFrameClock::waitFor(std::int64_t k, const std::stop_token& stop) noexcept {
  follow(k);
  return clock_.sleepUntil(begin(k), stop);
}

// From frame k on, uses the display's period; also moves frame k towards the blank nearest to it.
void VblankFrameClock::follow(std::int64_t k) {
  base_ = begin(k);
  base_k_ = k;
  period_ = asked_;
  const auto vblank = source_();
  if (!vblank || clock_.now() - vblank->last > kStaleAfter) return;
  const double ratio = toSeconds(asked_) / toSeconds(vblank->period);
  const double blanks = std::round(ratio);
  if (blanks < 1 || std::abs(ratio - blanks) > kSamePeriod * ratio) return;
  period_ = static_cast<std::int64_t>(blanks) * vblank->period;
  Duration off = (base_ - vblank->last) % vblank->period;  // since the blank before it
  if (off > vblank->period / 2) off -= vblank->period;
  if (off < -vblank->period / 2) off += vblank->period;
  const Duration most = period_ / kMostShift;
  base_ -= std::clamp(off, -most, most);
}

}  // namespace merlin::render::out
