// FrameHistory: the times of the wall's last frames, for the chart. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "daemon/shm/layout.h"

namespace merlin::page {

struct FrameTime {
  std::uint64_t number = 0;  // number of the entry in this history, from 1
  double work_ms = 0;        // from the begin of the frame to its end
  std::uint32_t cost = 0;
  bool moving = false, late = false;
};

// Thread-bound. Keeps 2,400 frames: 40 s at 60 Hz.
class FrameHistory {
 public:
  // Adds the frames that are new in the wall's trace. `generation`: that of the wall's segment; if
  // it differs from that of the last call, older frames are forgotten, but the numbers continue.
  void follow(const shm::Channel<shm::FrameTrace>& trace, std::uint64_t generation);

  // Returns {"next": N, "frames": [[number, work_ms, cost, flags], ...]}: the frames after number
  // `since`, at most the last 1,200. N is the number of the next frame; flags is the sum of 1
  // (moving) and 2 (late).
  std::string since(std::uint64_t since) const;

 private:
  void add(const shm::FrameTrace& frame);

  std::deque<FrameTime> frames_;
  std::uint64_t next_ = 1;        // number of the next frame
  std::uint64_t read_ = 0;        // number of frames read from the trace
  std::uint64_t generation_ = 0;  // 0: none yet
};

}  // namespace merlin::page
