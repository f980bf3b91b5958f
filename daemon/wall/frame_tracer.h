// FrameTracer: collects the times of the steps of one frame, and the further periods that the frame
// covered because it was late, in the form in which shared memory stores them. Pure.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "render/frame/frame_step.h"

namespace merlin::wall {

// Thread-bound. For each frame, call begin(), add() for each step, and end(); then publish
// frames(). frames() has one late entry for each late deadline that FrameStats counts, unless
// runOver() has dropped some.
class FrameTracer {
 public:
  void begin(Timestamp at, Timestamp deadline, bool moving);
  // Adds a step that lasted from `from` to `to`. Steps beyond the capacity of FrameTrace::steps are
  // dropped.
  void add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile = 0);
  void add(std::span<const render::frame::FrameStep> steps);
  // Marks the frame as omitted, because there is no time to draw it.
  void leaveOut() noexcept { left_out_ = true; }
  // To be called for each further period, from `begin` to `deadline`, that the frame took. Of more
  // than 200 such periods, the first ones are dropped.
  void runOver(Timestamp begin, Timestamp deadline);
  // Ends the frame at `at`. `cost`: cost of the detail of the frame that is shown. If a frame is
  // late, the end that is stored is after its deadline, also for a frame that was omitted.
  void end(Timestamp at, std::uint32_t cost);
  // Returns the frame, followed by an entry without steps for each period of runOver().
  std::span<const shm::FrameTrace> frames() const noexcept { return frames_; }

 private:
  shm::FrameTrace& frame() { return frames_.front(); }

  std::vector<shm::FrameTrace> frames_ = std::vector<shm::FrameTrace>(1);
  bool left_out_ = false;
  std::uint64_t periods_ = 0;
};

}  // namespace merlin::wall
