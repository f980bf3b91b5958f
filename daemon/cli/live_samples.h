// LiveSamples: reads one device's samples from the shared memory of a running merlind; each sample
// is delivered once.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {

// Thread-bound.
template <typename Sample>
class LiveSamples {
 public:
  // `slot`: name of the samples' slot in shared memory, "tracker1"; `device`: name of the device
  // from which the samples come, "tracker". Errors: kNotFound (there is no shared memory of
  // `instance`), kClosed (its merlind has ended), kInvalidArgument (that merlind has no such
  // device), those of DevicesReader::open() and SlotTable::channel().
  static Result<LiveSamples> open(const std::string& instance, const std::string& slot,
                                  const std::string& device) {
    const std::string segment = shm::segmentName(instance, "devices");
    auto reader = shm::DevicesReader::open(segment);
    if (!reader && reader.error().code == Errc::kNotFound)
      return Error{Errc::kNotFound,
                   fmt::format("no merlind with devices runs as \"{}\": start it first, or give "
                               "--instance",
                               instance)};
    if (!reader) return reader.error();
    if (const auto known = checkName(**reader, instance, device); !known) return known.error();
    const auto channel = reader->table().template channel<Sample>(slot);
    if (!channel) return channel.error();
    const auto health = reader->table().template slot<DeviceHealth>(device + ".health");
    if (!health) return health.error();
    LiveSamples samples(segment, *std::move(reader), **channel, **health);
    if (const auto alive = samples.checkAlive(); !alive) return alive.error();
    return samples;
  }

  // Calls `take` for each sample that has arrived since the last call of listen() or since open(),
  // but only for the newest 128 if there are more; waits up to 0.1 s for the first. Errors: kClosed
  // (merlind has ended).
  template <typename Take>
  Result<Ok> listen(Take take) {
    if (auto alive = checkAlive(); !alive) return alive;
    channel_.wait(next_, {0, 100'000'000});
    keepHealth();
    const std::uint64_t count = channel_.count();
    next_ = std::max(next_, count - std::min<std::uint64_t>(count, shm::kHistory / 2));
    for (; next_ < count; ++next_) {
      if (const auto sample = channel_.at(next_)) take(*sample);
    }
    return Ok{};
  }

  // Returns why the device does not deliver samples; an empty text if it works.
  std::string complaint() {
    keepHealth();
    if (!health_) return "its state is not known yet";
    if (health_->state == HealthState::kOk) return {};
    return health_->reason[0] ? health_->reason : "it is being opened";
  }

  const shm::DeviceSlots& devices() const { return *reader_; }

 private:
  LiveSamples(std::string segment, shm::DevicesReader reader, const shm::Channel<Sample>& channel,
              const shm::SeqSlot<DeviceHealth>& health_slot)
      : segment_(std::move(segment)),
        reader_(std::move(reader)),
        channel_(channel),
        health_slot_(health_slot),
        next_(channel.count()) {}

  static Result<Ok> checkName(const shm::DeviceSlots& devices, const std::string& instance,
                              const std::string& device) {
    std::string names;
    for (const auto& health : devices.health) {
      if (health.device == device) return Ok{};
      names += (names.empty() ? "" : ", ") + health.device;
    }
    return Error{Errc::kInvalidArgument,
                 fmt::format("the merlind that runs as \"{}\" has no device named \"{}\": its "
                             "devices are {}; start it with the same configuration, or give "
                             "--instance",
                             instance, device, names)};
  }

  Result<Ok> checkAlive() const {
    if (shm::isRunning(segment_, *(*reader_).header, clock_.now())) return Ok{};
    return Error{Errc::kClosed, "merlind has ended; nothing was changed"};
  }

  // Stores the device's health. If it cannot be read, because each attempt coincided with a write,
  // keeps the last known health.
  void keepHealth() {
    if (const auto health = health_slot_.read()) health_ = *health;
  }

  SystemClock clock_;
  std::string segment_;
  shm::DevicesReader reader_;
  const shm::Channel<Sample>& channel_;
  const shm::SeqSlot<DeviceHealth>& health_slot_;
  std::optional<DeviceHealth> health_;  // the last known health; nothing: not known yet
  std::uint64_t next_;                  // index of the next sample to deliver
};

}  // namespace merlin::cli
