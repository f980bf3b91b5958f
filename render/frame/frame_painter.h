// Port (an interface): draws a content's frames. Implemented by FrameRenderer (OpenGL) and by a
// fake in tests.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "render/content/content.h"
#include "render/frame/frame_step.h"

namespace merlin::render::frame {

struct DrawTimes {
  // Time to choose detail, upload and draw. If the operator's view was coarser (`gave_way`), it
  // includes an estimate of that view's time at the full step.
  Duration drawing{};
  Duration fixed{};       // clearing and read-back
  bool gave_way = false;  // the operator's view was drawn coarser, for lack of time
};

// Thread-bound to the wall's thread.
class FramePainter {
 public:
  virtual ~FramePainter() = default;

  struct Request {
    Eigen::Isometry3f T_eye_content;
    std::size_t step = 0;  // on the content's detail axis; 0 is the finest
    Timestamp until = Timestamp::max();
    double cost_exponent = 1;  // drawing time grows with a step's cost to this power
  };
  // Draws the whole frame, if possible before `until`. The wall's tiles are drawn first; the
  // operator's view is drawn coarser if the remaining time is too short for it.
  virtual DrawTimes draw(const Request& request) = 0;

  // Draws a frame of a still scene in slices of a few milliseconds: call beginRefining() once, then
  // refine() until it returns true; then the frame is complete and pixels() shows it. refine()
  // draws until about `until`: at least one slice, unless the time is too short for one. A draw()
  // in between abandons the refined frame.
  virtual void beginRefining(const Eigen::Isometry3f& T_eye_content, std::size_t step) = 0;
  virtual bool refine(Timestamp until) = 0;

  // From now on draw() draws tiles at 1/divisor of their width and height and upscales them.
  // Refined frames keep full size. The divisor is 1 initially. REQUIRES: divisor >= 1.
  virtual void setSizeDivisor(int divisor) = 0;

  // Returns whether any tile of the wall may show any part of the content.
  virtual bool sees(const Eigen::Isometry3f& T_eye_content) const = 0;

  // Returns whether the frame begun last lacks parts of the content that are still being loaded.
  virtual content::Pending pending() const noexcept { return content::Pending::kNothing; }

  // Returns the timed steps of the last draw() or refine(), in order.
  virtual std::span<const FrameStep> steps() const noexcept = 0;

  // Returns the canvas: RGBA, rows from top to bottom, of the size of the plan's frame. Whoever
  // draws overlays on it must erase them again.
  virtual std::span<std::uint8_t> pixels() noexcept = 0;
};

}  // namespace merlin::render::frame
