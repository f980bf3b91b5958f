// ActionSink: gives a device's samples and health to an ActionWriter, and passes them on. Runs on
// the device's thread.
#pragma once

#include <algorithm>

#include "daemon/actions/action_writer.h"
#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin::actions {

// One for each device. Takes no lock and allocates nothing. The actions are published before the
// sample, so that a reader that waits for the sample finds them.
class ActionSink final : public SampleSink, public HealthSink {
 public:
  // `postures`: where the current posture is published before each glove sample.
  // `stale_after`: a device that has not worked for this time counts as lost: its inputs end.
  struct Parts {
    const shm::SeqSlot<PostureState>& postures;
    SampleSink& samples;
    HealthSink& health;
    Duration stale_after;
  };
  ActionSink(ActionWriter writer, const Parts& parts) : writer_(std::move(writer)), parts_(parts) {}

  void publish(const GloveSample& sample) noexcept override {
    const auto posture = parts_.postures.read();
    writer_.update(sample, posture ? &*posture : nullptr);
    parts_.samples.publish(sample);
  }
  void publish(const TrackerSample& sample) noexcept override { parts_.samples.publish(sample); }
  void publish(const BallSample& sample) noexcept override {
    writer_.update(sample);
    parts_.samples.publish(sample);
  }
  void publish(const DeviceHealth& health) noexcept override {
    parts_.health.publish(health);
    const bool lost = health.state != HealthState::kOk &&
                      health.updated_ns - health.since_ns >= parts_.stale_after.count();
    if (lost) writer_.release(health.updated_ns);
  }

 private:
  ActionWriter writer_;
  Parts parts_;
};

}  // namespace merlin::actions
