// FrameStats: what the last second and minute of frames were like. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "daemon/base/clock.h"

namespace merlin::wall {

// Bounded: a minute of deadlines. Thread-bound.
class FrameStats {
 public:
  // A deadline has passed. `moving`: something moved, so a frame was due; else the picture that
  // stood was right. `met`: the frame that was due came in time (true where none was due).
  void deadline(Timestamp at, bool moving, bool met);

  // A frame was drawn while something moved.
  void frame(Timestamp finished, Duration work, Duration period);

  // Once an update: forgets what is older than a minute.
  void advance(Timestamp now);

  double heldRate(Timestamp now, double asked_hz) const;  // deadlines met over the last second, 1/s
  double lateShare(Timestamp now, Duration over) const;   // of deadlines while it moved; 0 if none
  double medianWorkSeconds() const;                       // of the last second's frames; 0 if none
  double utilisation() const;                             // mean of work / period, the same frames
  std::uint64_t deadlines() const noexcept {
    return deadlines_;
  }  // while it moved, since the start
  std::uint64_t late() const noexcept { return late_; }
  std::uint32_t longestLate() const noexcept { return longest_late_; }

 private:
  struct Deadline {
    Timestamp at;
    bool moving = false, met = false;
  };
  struct Frame {
    Timestamp at;
    double work = 0, share = 0;
  };
  std::deque<Deadline> minute_;
  std::deque<Frame> second_;
  std::uint64_t deadlines_ = 0, late_ = 0;
  std::uint32_t late_run_ = 0, longest_late_ = 0;
};

}  // namespace merlin::wall
