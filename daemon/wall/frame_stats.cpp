#include "daemon/wall/frame_stats.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace merlin::wall {

void FrameStats::deadline(Timestamp at, bool moving, bool met) {
  minute_.push_back({at, moving, met});
  if (!moving) return;
  ++deadlines_;
  late_run_ = met ? 0 : late_run_ + 1;
  late_ += met ? 0 : 1;
  longest_late_ = std::max(longest_late_, late_run_);
  settle(met);
}

// Updates the length of the last disturbance. `unsettled_` counts the deadlines since the first
// late one. A single late deadline is ignored as an outlier.
void FrameStats::settle(bool met) {
  met_run_ = met ? met_run_ + 1 : 0;
  if (met_run_ < 5) {
    ++unsettled_;
  } else if (unsettled_ > 0) {
    const std::uint32_t until = unsettled_ - 4;  // without the last four, which were met
    if (until >= 2) settle_ = until;
    unsettled_ = 0;
  }
}

void FrameStats::frame(Timestamp finished, Duration work, Duration period, std::size_t cost) {
  const double share = toSeconds(work) / toSeconds(period);
  second_.push_back({finished, toSeconds(work), share});
  const auto bucket = static_cast<std::size_t>(std::min(16 * share, kBuckets - 1.0));
  ++histogram_[bucket];
  costs_[frames_++ % costs_.size()] = static_cast<double>(cost);
}

double FrameStats::oscillation() const {
  if (frames_ < costs_.size()) return 0;
  std::array<double, 100> sorted = costs_;
  std::sort(sorted.begin(), sorted.end());
  const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / 100;
  return mean > 0 ? (sorted[94] - sorted[5]) / mean : 0;
}

void FrameStats::advance(Timestamp now) {
  while (!minute_.empty() && now - minute_.front().at > kMinute) minute_.pop_front();
  while (!second_.empty() && now - second_.front().at > kSecond) second_.pop_front();
}

double FrameStats::heldRate(Timestamp now, double asked_hz) const {
  // The rate is computed from the share of deadlines that were met, not from their number, since
  // the number of deadlines within a second varies by one.
  double met = 0, all = 0;
  for (auto d = minute_.rbegin(); d != minute_.rend() && now - d->at < kSecond; ++d) {
    met += d->met;
    ++all;
  }
  return all > 0 ? asked_hz * met / all : 0;
}

double FrameStats::lateShare(Timestamp now, Duration over) const {
  double late = 0, all = 0;
  for (auto d = minute_.rbegin(); d != minute_.rend() && now - d->at < over; ++d) {
    all += d->moving;
    late += d->moving && !d->met;
  }
  return all > 0 ? late / all : 0;
}

double FrameStats::medianWorkSeconds() const {
  if (second_.empty()) return 0;
  std::vector<double> work;
  for (const Frame& f : second_) work.push_back(f.work);
  const auto middle = work.begin() + static_cast<std::ptrdiff_t>(work.size() / 2);
  std::nth_element(work.begin(), middle, work.end());
  return *middle;
}

double FrameStats::utilisation() const {
  double sum = 0;
  for (const Frame& f : second_) sum += f.share;
  return second_.empty() ? 0 : sum / static_cast<double>(second_.size());
}

}  // namespace merlin::wall
