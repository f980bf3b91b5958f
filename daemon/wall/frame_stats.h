// FrameStats: statistics of deadlines and frames over the last second, the last minute and since
// the start. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "daemon/base/clock.h"

namespace merlin::wall {

// Thread-bound. Memory is bounded by a minute of deadlines.
class FrameStats {
 public:
  static constexpr Duration kSecond = std::chrono::seconds(1), kMinute = std::chrono::seconds(60);

  // Records a deadline that has passed. `moving`: something moved, so a new frame was due;
  // otherwise the frame shown was still valid. `met`: the frame came in time, or none was due.
  void deadline(Timestamp at, bool moving, bool met);

  // Records a frame that was drawn while something moved, with detail of this cost.
  void frame(Timestamp finished, Duration work, Duration period, std::size_t cost);

  // To be called once a period: forgets deadlines older than a minute and frames older than a
  // second.
  void advance(Timestamp now);

  // Share of the last second's deadlines that were met, times asked_hz [Hz].
  double heldRate(Timestamp now, double asked_hz) const;
  // Of the deadlines of the last `over` at which something moved, the share that was late; 0 if
  // there were none.
  double lateShare(Timestamp now, Duration over) const;
  double medianWorkSeconds() const;  // of the frames of the last second; 0 if there were none
  double utilisation() const;        // mean of work / period of the same frames
  // Deadlines while something moved, since the start: all, the late ones, and the longest run of
  // late ones.
  std::uint64_t deadlines() const noexcept { return deadlines_; }
  std::uint64_t late() const noexcept { return late_; }
  std::uint32_t longestLate() const noexcept { return longest_late_; }

  // Length of the last disturbance in deadlines: from the first late one until five in a row were
  // met, without these five. A single late deadline does not count; 0 before the first disturbance.
  std::uint32_t settleFrames() const noexcept { return settle_; }

  // (95th - 5th percentile) / mean of the costs of the last 100 frames; 0 before there are 100.
  double oscillation() const;

  // Histogram of work / period in buckets of 1/16; the last bucket holds all larger values.
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
  std::array<double, 100> costs_{};
  std::size_t frames_ = 0;
};

}  // namespace merlin::wall
