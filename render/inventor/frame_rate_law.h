// FrameRateLaw: the frame rate control of [GOURLEY98]; it computes the number of triangles per
// frame that holds a desired frame rate. Pure, since the caller passes the time.
//
// The method is that of [GOURLEY98] 5.4, figure 5.36: the number of triangles of all frames drawn
// in one second, divided by the desired rate, is the new number of triangles per frame. The
// resolution changes only if the new number is out of tolerance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace merlin::render::inventor {

class FrameRateLaw {
 public:
  static constexpr double kWindow_s = 1.0;
  static constexpr double kTolerance = 0.1;  // relative to the triangles of the last frame

  // Call for each frame, which has drawn `triangles` triangles at time `now_s` of any clock that
  // never goes back. At the end of a window, returns the number of triangles per frame, 0 .. 2^31 -
  // 1, that would hold the rate `desired_hz` (> 0), if it is out of tolerance; else returns
  // nothing. A time that is not finite, or not later than the one before, begins a new window.
  std::optional<std::int32_t> frameDrawn(double now_s, std::size_t triangles, double desired_hz);

  // Call when drawing pauses: the next frame then begins a new window.
  void rest() noexcept { started_ = false; }

 private:
  void start(double now_s) noexcept;

  bool started_ = false;
  double start_s_ = 0;
  double last_s_ = 0;
  double triangles_ = 0;  // number of triangles drawn since start_s_
};

}  // namespace merlin::render::inventor
