// The frame rate control of [GOURLEY98]: the number of triangles per frame that holds a desired
// rate. Pure: time is passed in.
//
// Figure 5.36 of [GOURLEY98] 5.4: the triangles of all frames drawn in one second, divided by the
// desired rate, are the new triangles per frame; the resolution changes unless that is within
// tolerance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace merlin::render::inventor {

class FrameRateLaw {
 public:
  static constexpr double kWindow_s = 1.0;
  static constexpr double kTolerance = 0.1;  // relative to the triangles of the last frame

  // To be called for each frame: it has drawn `triangles` triangles at `now_s` of any clock that
  // never goes back. At the end of a window, returns the triangles per frame, 0 .. 2^31 - 1, that
  // would hold `desired_hz` > 0, if they are out of tolerance; else nothing. A time that is not
  // finite, or not later than the one before, begins a new window.
  std::optional<std::int32_t> frameDrawn(double now_s, std::size_t triangles, double desired_hz);

  // Drawing pauses: the next frame begins a new window.
  void rest() noexcept { started_ = false; }

 private:
  void start(double now_s) noexcept;

  bool started_ = false;
  double start_s_ = 0;
  double last_s_ = 0;
  double triangles_ = 0;  // drawn since start_s_
};

}  // namespace merlin::render::inventor
