#include "drivers/port/touch_frames.h"

#include <algorithm>
#include <utility>

namespace merlin {
namespace {

// Limits a value to 0..1; NaN becomes 0.
float share(float value) noexcept { return value > 0 ? std::min(value, 1.0F) : 0; }

bool isSame(const TouchSample& a, const TouchSample& b) noexcept {
  if (a.fingers != b.fingers || a.buttons != b.buttons || a.wheel != b.wheel) return false;
  for (std::size_t i = 0; i < a.fingers; ++i) {
    if (a.id[i] != b.id[i] || a.position[i][0] != b.position[i][0] ||
        a.position[i][1] != b.position[i][1])
      return false;
  }
  return true;
}

}  // namespace

TouchFrames::TouchFrames(SampleSink& sink, TouchOrientation orientation) noexcept
    : sink_(sink), orientation_(orientation) {
  next_.aspect = kUsualAspect;
}

void TouchFrames::add(std::uint32_t id, float x, float y) noexcept {
  if (next_.fingers >= kFingers) return;
  x = share(x);
  y = share(y);
  if (orientation_.swap_axes) std::swap(x, y);
  const std::size_t at = next_.fingers++;
  next_.id[at] = id;
  next_.position[at][0] = orientation_.invert_x ? 1 - x : x;
  next_.position[at][1] = orientation_.invert_y ? 1 - y : y;
}

void TouchFrames::setMouse(std::uint16_t buttons, int notches) noexcept {
  next_.buttons = buttons;
  next_.wheel = static_cast<std::uint16_t>(next_.wheel + notches);
}

void TouchFrames::publish(Timestamp at) noexcept {
  if (!isSame(next_, newest_)) publishAnyway(at);
}

void TouchFrames::publishAnyway(Timestamp at) noexcept {
  for (std::size_t i = next_.fingers; i < kFingers; ++i) {
    next_.id[i] = 0;
    next_.position[i][0] = next_.position[i][1] = 0;
  }
  next_.received_ns = toNanoseconds(at);
  next_.counter = newest_.counter + 1;
  newest_ = next_;
  ++samples_;
  sink_.publish(newest_);
}

void TouchFrames::lift(Timestamp at) noexcept {
  begin();
  setMouse(0, 0);
  publish(at);
}

}  // namespace merlin
