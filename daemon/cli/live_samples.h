// LiveSamples: reads one device's samples from the shared memory of a running merlind; each sample
// is delivered once.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {

// Thread-bound.
template <typename Sample>
class LiveSamples {
 public:
  using Segment = shm::DevicesSegment;
  using Pick = std::function<const shm::Channel<Sample>&(const Segment&)>;

  // `pick` returns the device's channel in the segment. Errors: kNotFound (there is no shared
  // memory of `instance`), kClosed (its merlind has ended), those of SegmentReader::open().
  static Result<LiveSamples> open(const std::string& instance, shm::DeviceIndex device, Pick pick) {
    auto segment = shm::SegmentReader<Segment>::open(shm::segmentName(instance, "devices"));
    if (!segment && segment.error().code == Errc::kNotFound)
      return Error{Errc::kNotFound,
                   fmt::format("no merlind with devices runs as \"{}\": start it first, or give "
                               "--instance",
                               instance)};
    if (!segment) return segment.error();
    LiveSamples samples(*std::move(segment), device, std::move(pick));
    if (const auto alive = samples.checkAlive(); !alive) return alive.error();
    return samples;
  }

  // Calls `take` for each sample that has arrived since the last call, but at most for the newest
  // 128; waits up to 0.1 s if there is none. Errors: kClosed (merlind has ended).
  template <typename Take>
  Result<Ok> listen(Take take) {
    if (auto alive = checkAlive(); !alive) return alive;
    const auto& channel = pick_(*segment_);
    channel.wait(next_, {0, 100'000'000});
    keepHealth();
    const std::uint64_t count = channel.count();
    next_ = std::max(next_, count - std::min<std::uint64_t>(count, shm::kHistory / 2));
    for (; next_ < count; ++next_) {
      if (const auto sample = channel.at(next_)) take(*sample);
    }
    return Ok{};
  }

  // Why the device does not deliver samples; empty if it does.
  std::string complaint() {
    keepHealth();
    if (!health_) return "its state is not known yet";
    if (health_->state == HealthState::kOk) return {};
    return health_->reason[0] ? health_->reason : "it is being opened";
  }

  const Segment& segment() const { return *segment_; }

 private:
  LiveSamples(shm::SegmentReader<Segment> segment, shm::DeviceIndex device, Pick pick)
      : segment_(std::move(segment)),
        device_(device),
        pick_(std::move(pick)),
        next_(pick_(*segment_).count()) {}

  Result<Ok> checkAlive() const {
    if (segment_.alive(clock_.now())) return Ok{};
    return Error{Errc::kClosed, "merlind has ended; nothing was changed"};
  }

  // Stores the device's health. read() fails if each attempt coincided with a write; the last known
  // health is kept then.
  void keepHealth() {
    if (const auto health = segment_->health[device_].read()) health_ = *health;
  }

  SystemClock clock_;
  shm::SegmentReader<Segment> segment_;
  shm::DeviceIndex device_;
  Pick pick_;
  std::optional<DeviceHealth> health_;  // the last known; none: not known yet
  std::uint64_t next_;                  // index of the next sample to deliver
};

}  // namespace merlin::cli
