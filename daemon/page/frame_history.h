// FrameHistory: the times of the wall's last frames, for the chart. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "daemon/shm/layout.h"

namespace merlin::page {

struct FrameTime {
  std::uint64_t number = 0;  // of the frame, or of the period while nothing moves
  double work_ms = 0;        // from its begin to its end
  std::uint32_t cost = 0;
  bool moving = false, late = false;
};

// Thread-bound. Keeps 2,400 frames: 40 s at 60 Hz.
class FrameHistory {
 public:
  // Takes the frames that are new in the wall's trace. `generation`: of the segment; if it differs
  // from that of the last call, the numbers continue, but older frames are forgotten.
  void follow(const shm::Channel<shm::FrameTrace>& trace, std::uint64_t generation);

  // {"next": N, "frames": [[number, work_ms, cost, flags], ...]}: the frames after number `since`,
  // at most the last 1,200; flags: 1 moving, 2 late.
  std::string since(std::uint64_t since) const;

 private:
  void add(const shm::FrameTrace& frame);

  std::deque<FrameTime> frames_;
  std::uint64_t next_ = 1;        // number of the next frame
  std::uint64_t read_ = 0;        // of the trace
  std::uint64_t generation_ = 0;  // 0: none yet
};

}  // namespace merlin::page
