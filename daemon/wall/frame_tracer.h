// FrameTracer: collects the timed steps of one frame, and the deadlines that it ran over, in the
// form in which shared memory stores them. Pure.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "render/frame/frame_step.h"

namespace merlin::wall {

// Thread-bound. Call begin(), add() for each step and end(); then frames() can be published: of
// those that are late there are as many as of the late deadlines that FrameStats counts.
class FrameTracer {
 public:
  void begin(Timestamp at, Timestamp deadline, bool moving);
  // Adds a step that lasted from `from` to `to`; steps beyond the capacity of FrameTrace are
  // dropped.
  void add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile = 0);
  void add(std::span<const render::frame::FrameStep> steps);
  // The frame is left out, since there is no time for any.
  void leaveOut() noexcept { left_out_ = true; }
  // The frame ran over this period too, from `begin` to `deadline`. Of many the first are dropped.
  void runOver(Timestamp begin, Timestamp deadline);
  // `cost`: of the detail of the frame shown. A late frame ends after its deadline: one that is
  // left out, or that another ran over, just after it at the earliest.
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
