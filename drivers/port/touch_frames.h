// TouchFrames: publishes the fingers of a touch surface, turned as the surface is mounted, whenever
// they change.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

// How a device's axes lie on the surface as a person sees it: first they are swapped, then those of
// the surface are reversed.
struct TouchOrientation {
  bool swap_axes = false, invert_x = false, invert_y = false;
};

// The ratio of sides that counts where nothing is known of it: that of most screens.
inline constexpr float kUsualAspect = 16.0F / 9;

// Thread-bound; allocates nothing.
class TouchFrames {
 public:
  TouchFrames(SampleSink& sink, TouchOrientation orientation) noexcept;

  // The surface's width by its height, as a person sees it.
  void setAspect(float aspect) noexcept { next_.aspect = aspect; }

  // A frame: begin(), add() for each finger that touches, publish(). `x` and `y` are shares of the
  // device's own axes, to its right and down; they are limited to 0..1 (NaN counts as 0). Fingers
  // beyond kFingers are left out.
  void begin() noexcept { next_.fingers = 0; }
  // Of a mouse: TouchSample::buttons, and notches that the wheel has turned since the last frame.
  void setMouse(std::uint16_t buttons, int notches) noexcept;
  void add(std::uint32_t id, float x, float y) noexcept;
  // Publishes the frame, unless it has the same fingers at the same places as the one before, the
  // same buttons, and the wheel was not turned.
  void publish(Timestamp at) noexcept;
  // Publishes the frame in any case.
  void publishAnyway(Timestamp at) noexcept;

  // Longest time for which the driver may wait for bytes before it calls hold(), which lets
  // happen what a held button or pinch does later.
  Duration wait(Timestamp now) const noexcept { return untilDue(sink_, now, kLongestWait); }
  void hold(Timestamp now) noexcept { tickIfDue(sink_, now); }

  // No finger touches any more, and no button is pressed; published if one was.
  void lift(Timestamp at) noexcept;

  std::uint64_t samples() const noexcept { return samples_; }
  const TouchSample& newest() const noexcept { return newest_; }

 private:
  static constexpr Duration kLongestWait =
      std::chrono::milliseconds(250);  // as Device::poll() allows

  SampleSink& sink_;
  TouchOrientation orientation_;
  TouchSample next_{}, newest_{};
  std::uint64_t samples_ = 0;
};

}  // namespace merlin
