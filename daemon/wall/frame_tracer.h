// FrameTracer: gathers one frame's steps, for shared memory. Pure.
#pragma once

#include <span>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "render/frame/frame_step.h"

namespace merlin::wall {

// Thread-bound. begin() a frame, add() its steps, end() it and publish frame().
class FrameTracer {
 public:
  void begin(Timestamp at, Timestamp deadline, bool moving);
  // Adds a step that took from `from` to `to`; steps that exceed the room are dropped.
  void add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile = 0);
  void add(std::span<const render::FrameStep> steps);
  void end(Timestamp at, std::uint32_t triangles);
  const shm::FrameTrace& frame() const noexcept { return frame_; }

 private:
  shm::FrameTrace frame_{};
  std::uint64_t periods_ = 0;
};

}  // namespace merlin::wall
