// FrameStats: what the last second and minute of frames were like. Pure.
#pragma once

#include <array>
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

  // A frame was drawn while something moved, of so many triangles.
  void frame(Timestamp finished, Duration work, Duration period, std::size_t triangles);

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

  // Deadlines from the first of two or more late ones in a row to the first of five that were met:
  // of the last time that it happened; 0 before the first.
  std::uint32_t settleFrames() const noexcept { return settle_; }

  // (p95 - p5) / mean of the last 100 frames' triangles; 0 before there are as many.
  double oscillation() const;

  // Frames by work / period, buckets of 1/16; the last holds all that is longer.
  static constexpr std::size_t kBuckets = 32;
  const std::array<std::uint32_t, kBuckets>& histogram() const noexcept { return histogram_; }

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
  void settle(bool met);
  std::uint32_t unsettled_ = 0, met_run_ = 5, settle_ = 0;
  std::array<std::uint32_t, kBuckets> histogram_{};
  std::array<double, 100> triangles_{};
  std::size_t frames_ = 0;
};

}  // namespace merlin::wall
