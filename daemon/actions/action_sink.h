// ActionSink: passes a device's samples and health to an ActionWriter and then to the next sinks.
// Runs on the device's thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <optional>

#include "daemon/actions/action_writer.h"
#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin::actions {

// Each device that has inputs has one ActionSink. It takes no lock and allocates nothing, except in
// reload(). The actions are published before the sample, so that a reader that waits for the sample
// finds them. If a device works but lacks a key that a binding names, a sentence about this is
// written into the reason of its health, unless the health already has a reason.
class ActionSink final : public SampleSink, public HealthSink {
 public:
  // `postures`: slot in which the current posture is published before each glove sample; null if
  // the device is not a glove. `samples`, `health`: the next sinks. `stale_after`: if a device has
  // not worked for this time, it counts as lost, and all its inputs count as released.
  struct Parts {
    const shm::SeqSlot<PostureState>* postures;
    SampleSink& samples;
    HealthSink& health;
    Duration stale_after;
  };
  ActionSink(ActionWriter writer, const Parts& parts)
      : writer_(std::move(writer)), parts_(parts), stale_after_(parts.stale_after) {}

  // Replaces bindings and `stale_after`: see ActionWriter::rebind(). May be called by one other
  // thread while the device's thread runs. If the device sends no samples, the new bindings are
  // used from its next health record on, i.e. within 250 ms.
  void reload(const std::vector<Binding>& bindings, Duration stale_after) {
    stale_after_ = stale_after;
    writer_.rebind(bindings);
  }

  // Ends all inputs of the device, and thus the actions that they hold. To be called after the
  // device was closed. REQUIRES: the device's thread does not run.
  void release(std::int64_t now_ns) noexcept { writer_.release(now_ns); }

  void publish(const GloveSample& sample) noexcept override {
    const auto posture = parts_.postures ? parts_.postures->read() : std::nullopt;
    writer_.update(sample, posture ? &*posture : nullptr);
    parts_.samples.publish(sample);
  }
  void publish(const TrackerSample& sample) noexcept override { parts_.samples.publish(sample); }
  void publish(const TouchSample& sample) noexcept override {
    writer_.update(sample);
    parts_.samples.publish(sample);
  }
  void publish(const BallSample& sample) noexcept override {
    writer_.update(sample);
    parts_.samples.publish(sample);
  }
  void describe(const DeviceKeys& keys) noexcept override { keys_ = keys; }
  Timestamp due() const noexcept override { return writer_.due(); }
  void tick(Timestamp now) noexcept override { writer_.adopt(toNanoseconds(now)); }
  void publish(const DeviceHealth& health) noexcept override {
    DeviceHealth told = health;
    if (keys_ && health.state == HealthState::kOk && health.reason[0] == '\0')
      writer_.sayLackingKey(*keys_, told.reason);
    parts_.health.publish(told);
    writer_.adopt(health.updated_ns);
    const bool lost = health.state != HealthState::kOk &&
                      health.updated_ns - health.since_ns >= stale_after_.load().count();
    if (lost) writer_.release(health.updated_ns);
  }

 private:
  ActionWriter writer_;
  Parts parts_;
  std::atomic<Duration> stale_after_;
  std::optional<DeviceKeys> keys_;  // keys of the device that was opened last; empty: not known
};

}  // namespace merlin::actions
