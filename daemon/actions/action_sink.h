// ActionSink: gives a device's samples and health to an ActionWriter, and passes them on. Runs on
// the device's thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <optional>

#include "daemon/actions/action_writer.h"
#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin::actions {

// One for each device. Takes no lock and allocates nothing, except in reload(). The actions are
// published before the sample, so that a reader that waits for the sample finds them. If a device
// works but lacks a key that a binding names, its health gets a text about it, unless the health
// has another text.
class ActionSink final : public SampleSink, public HealthSink {
 public:
  // `postures`: where the current posture is published before each glove sample; null: not a glove.
  // `stale_after`: a device that has not worked for this time counts as lost, and its inputs end.
  struct Parts {
    const shm::SeqSlot<PostureState>* postures;
    SampleSink& samples;
    HealthSink& health;
    Duration stale_after;
  };
  ActionSink(ActionWriter writer, const Parts& parts)
      : writer_(std::move(writer)), parts_(parts), stale_after_(parts.stale_after) {}

  // For one other thread: see ActionWriter::rebind(). A device that sends nothing uses the new
  // bindings from its next health record on, within 250 ms.
  void reload(const std::vector<Binding>& bindings, Duration stale_after) {
    stale_after_ = stale_after;
    writer_.rebind(bindings);
  }

  // To be called when the device was closed: ends all its inputs. REQUIRES: no thread of the device
  // runs.
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
  std::optional<DeviceKeys> keys_;  // of the device that was opened last
};

}  // namespace merlin::actions
