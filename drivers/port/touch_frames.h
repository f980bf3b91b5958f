// TouchFrames: publishes the fingers of a touch surface, turned as the surface is mounted, whenever
// they change.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

// How a device's axes lie on the surface as a person sees it: first the axes are swapped, then the
// resulting ones are reversed.
struct TouchOrientation {
  bool swap_axes = false, invert_x = false, invert_y = false;
};

// The aspect ratio that is assumed if none is known: that of most screens.
inline constexpr float kUsualAspect = 16.0F / 9;

// Thread-bound; allocates nothing.
class TouchFrames {
 public:
  TouchFrames(SampleSink& sink, TouchOrientation orientation) noexcept;

  // Sets the surface's width divided by its height, as a person sees it.
  void setAspect(float aspect) noexcept { next_.aspect = aspect; }

  // A frame consists of begin(), add() for each finger that touches, and publish(). `x` and `y` are
  // shares of the device's own axes, to its right and down; they are limited to 0..1 (NaN counts as
  // 0). Fingers beyond kFingers are left out.
  void begin() noexcept { next_.fingers = 0; }
  // For a mouse: sets TouchSample::buttons, and adds the notches that the wheel has turned since
  // the last frame.
  void setMouse(std::uint16_t buttons, int notches) noexcept;
  void add(std::uint32_t id, float x, float y) noexcept;
  // Publishes the frame unless fingers, their places, buttons and wheel are as in the frame before.
  void publish(Timestamp at) noexcept;
  // Publishes the frame in any case.
  void publishAnyway(Timestamp at) noexcept;

  // Returns the longest time for which the driver may wait for bytes before it calls hold(), which
  // triggers the later effects of a held button or pinch.
  Duration wait(Timestamp now) const noexcept { return untilDue(sink_, now, kLongestWait); }
  void hold(Timestamp now) noexcept { tickIfDue(sink_, now); }

  // Removes all fingers and releases all buttons; publishes the change if there were any.
  void lift(Timestamp at) noexcept;

  std::uint64_t samples() const noexcept { return samples_; }
  const TouchSample& newest() const noexcept { return newest_; }

 private:
  // The longest wait that Device::poll() allows.
  static constexpr Duration kLongestWait = std::chrono::milliseconds(250);

  SampleSink& sink_;
  TouchOrientation orientation_;
  TouchSample next_{}, newest_{};
  std::uint64_t samples_ = 0;
};

}  // namespace merlin
