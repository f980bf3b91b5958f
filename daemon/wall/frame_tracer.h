// FrameTracer: collects the timed steps of one frame, in the form in which shared memory stores
// them. Pure.
#pragma once

#include <span>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "render/frame/frame_step.h"

namespace merlin::wall {

// Thread-bound. Call begin(), add() for each step and end(); then frame() can be published.
class FrameTracer {
 public:
  void begin(Timestamp at, Timestamp deadline, bool moving);
  // Adds a step that lasted from `from` to `to`; steps beyond the capacity of FrameTrace are
  // dropped.
  void add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile = 0);
  void add(std::span<const render::frame::FrameStep> steps);
  // `cost`: of the detail of the frame shown.
  void end(Timestamp at, std::uint32_t cost);
  const shm::FrameTrace& frame() const noexcept { return frame_; }

 private:
  shm::FrameTrace frame_{};
  std::uint64_t periods_ = 0;
};

}  // namespace merlin::wall
