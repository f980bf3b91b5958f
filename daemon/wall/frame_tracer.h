// FrameTracer: collects the timed steps of one frame, and the deadlines that it ran over, in the
// form in which shared memory stores them. Pure.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "render/frame/frame_step.h"

namespace merlin::wall {

// Thread-bound. Call begin(), add() for each step and end(); then frames() can be published. It has
// as many late frames as FrameStats counts late deadlines.
class FrameTracer {
 public:
  void begin(Timestamp at, Timestamp deadline, bool moving);
  // Adds a step that lasted from `from` to `to`; steps beyond the capacity of FrameTrace are
  // dropped.
  void add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile = 0);
  void add(std::span<const render::frame::FrameStep> steps);
  // Marks the frame as left out, because there is no time to draw one.
  void leaveOut() noexcept { left_out_ = true; }
  // The frame ran over this period too, from `begin` to `deadline`. If there are too many, the
  // first are dropped.
  void runOver(Timestamp begin, Timestamp deadline);
  // `cost`: cost of the detail of the frame shown. A late frame is stored with an end after its
  // deadline; one that is left out, or that another frame ran over, with an end just after it at
  // the earliest.
  void end(Timestamp at, std::uint32_t cost);
  // The frame, and behind it one without steps for each period that it ran over.
  std::span<const shm::FrameTrace> frames() const noexcept { return frames_; }

 private:
  shm::FrameTrace& frame() { return frames_.front(); }

  std::vector<shm::FrameTrace> frames_ = std::vector<shm::FrameTrace>(1);
  bool left_out_ = false;
  std::uint64_t periods_ = 0;
};

}  // namespace merlin::wall
