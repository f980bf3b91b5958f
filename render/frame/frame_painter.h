// Port: who draws a content's frames. Implemented by FrameRenderer (OpenGL) and by a fake in tests.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "render/frame/frame_step.h"

namespace merlin::render {

struct DrawTimes {
  Duration drawing{};     // choosing, uploading, drawing; where the operator's view was coarser, an
                          // estimate of what it would have been
  Duration fixed{};       // clearing and read-back
  bool gave_way = false;  // the operator's view was coarser, for want of time
};

// Thread-bound to the wall's thread.
class FramePainter {
 public:
  virtual ~FramePainter() = default;

  struct Request {
    Eigen::Isometry3f T_eye_content;
    std::size_t step = 0;  // of the content's detail axis
    Timestamp until = Timestamp::max();
    double cost_exponent = 1;  // drawing time grows with a step's cost to this power
  };
  // Draws the whole frame, if possible by `until`. The wall's tiles come first; the operator's view
  // gets coarser where they take longer than they used to.
  virtual DrawTimes draw(const Request& request) = 0;

  // A still frame in slices: beginRefining() once, then refine() until it returns true: the frame
  // is whole and pixels() shows it. refine() draws until about `until`, at least one slice if there
  // is time for one; a slice takes a few milliseconds. draw() in between abandons it.
  virtual void beginRefining(const Eigen::Isometry3f& T_eye_content, std::size_t step) = 0;
  virtual bool refine(Timestamp until) = 0;

  // From now on draw() draws tiles at 1/divisor of their size each way, and upscales them. What is
  // refined has full size. 1 at first. REQUIRES: divisor >= 1.
  virtual void setSizeDivisor(int divisor) = 0;

  // Whether any tile of the wall may show any of the content.
  virtual bool sees(const Eigen::Isometry3f& T_eye_content) const = 0;

  // Steps of the last draw() or refine(), in order.
  virtual std::span<const FrameStep> steps() const noexcept = 0;

  // The canvas: RGBA, rows from top to bottom, of the plan's size. Overlays drawn on it are to be
  // taken out again.
  virtual std::span<std::uint8_t> pixels() noexcept = 0;
};

}  // namespace merlin::render
