// The control loop of 1998: the triangles a frame that hold a rate. Pure: time is passed in.
//
// Figure 5.36 of [GOURLEY98] 5.4: frames counted over a second x triangles drawn = triangles a
// second; that / desired rate = triangles a frame; a new resolution unless within tolerance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace merlin::render {

class FrameRateLaw {
 public:
  static constexpr double kWindow_s = 1.0;
  static constexpr double kTolerance = 0.1;  // of the triangles drawn

  // A frame of `triangles` was drawn, at `now_s` of any clock that goes forward. Returns the
  // triangles a frame, 0 .. 2^31 - 1, with which `desired_hz` > 0 would be held, once a window is
  // over and where they are out of tolerance; else nothing. A time that is not finite, or not later
  // than the one before, begins a new window.
  std::optional<std::int32_t> frameDrawn(double now_s, std::size_t triangles, double desired_hz);

  // Nothing is drawn any more: the next frame begins a new window.
  void rest() noexcept { started_ = false; }

 private:
  void start(double now_s) noexcept;

  bool started_ = false;
  double start_s_ = 0;
  double last_s_ = 0;
  double triangles_ = 0;  // drawn since start_s_
};

}  // namespace merlin::render
