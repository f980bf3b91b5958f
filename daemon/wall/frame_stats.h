// FrameStats: statistics of deadlines and frames for the last second, for the last minute, and
// since the start. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "daemon/base/clock.h"

namespace merlin::wall {

// Thread-bound. Stores the deadlines of the last minute and the frames of the last second.
class FrameStats {
 public:
  static constexpr Duration kSecond = std::chrono::seconds(1), kMinute = std::chrono::seconds(60);

  // Records a deadline that has passed. `moving`: whether something moved, so that a new frame was
  // due; otherwise the frame shown was still valid. `met`: whether the frame was in time, or none
  // was due.
  void deadline(Timestamp at, bool moving, bool met);

  // Records a frame that was drawn while something moved. `work`: time from its begin to its
  // delivery. `cost`: cost of its detail.
  void frame(Timestamp finished, Duration work, Duration period, std::size_t cost);

  // Removes deadlines older than a minute and frames older than a second. To be called once a
  // period.
  void advance(Timestamp now);

  // Returns the share of the last second's deadlines that were met, times asked_hz [Hz]; 0 if there
  // were none.
  double heldRate(Timestamp now, double asked_hz) const;
  // Returns the share of late deadlines among those of the last `over` at which something moved; 0
  // if there were none. REQUIRES: over <= kMinute.
  double lateShare(Timestamp now, Duration over) const;
  double medianWorkSeconds() const;  // median of the last second's frames; 0: there were none
  double utilisation() const;        // mean of work / period of these frames; 0: none
  // Return, for the deadlines at which something moved since the start: their number, the number of
  // late ones, and the length of the longest run of late ones.
  std::uint64_t deadlines() const noexcept { return deadlines_; }
  std::uint64_t late() const noexcept { return late_; }
  std::uint32_t longestLate() const noexcept { return longest_late_; }

  // Returns the length of the last disturbance, as a number of deadlines: from the first late one
  // until five in a row were met, without these five. A single late deadline is no disturbance. 0
  // before the end of the first disturbance.
  std::uint32_t settleFrames() const noexcept { return settle_; }

  // Returns (95th - 5th percentile) / mean of the costs of the last 100 frames; 0 before there are
  // 100 frames.
  double oscillation() const;

  // Returns the histogram of work / period of all frames since the start. Each bucket is 1/16 wide;
  // the last one also counts all larger values.
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
