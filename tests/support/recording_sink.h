// RecordingSink and RecordingHealth: keep every sample and every health report published to them.
#pragma once

#include <vector>

#include "drivers/port/sample_sink.h"

namespace merlin::test {

struct RecordingSink final : SampleSink {
  void publish(const GloveSample& s) noexcept override { glove.push_back(s); }
  void publish(const TrackerSample& s) noexcept override { tracker.push_back(s); }
  void publish(const BallSample& s) noexcept override { ball.push_back(s); }
  void publish(const TouchSample& s) noexcept override { touch.push_back(s); }
  void describe(const DeviceKeys& k) noexcept override { keys = k; }
  Timestamp due() const noexcept override { return due_at; }
  void tick(Timestamp now) noexcept override {
    ticks.push_back(now);
    due_at = Timestamp::max();
  }

  std::vector<GloveSample> glove;
  std::vector<TrackerSample> tracker;
  std::vector<BallSample> ball;
  std::vector<TouchSample> touch;
  DeviceKeys keys;                      // keys of the device that was opened last
  Timestamp due_at = Timestamp::max();  // set by the test
  std::vector<Timestamp> ticks;
};

struct RecordingHealth final : HealthSink {
  void publish(const DeviceHealth& h) noexcept override { all.push_back(h); }
  const DeviceHealth& last() const { return all.back(); }

  std::vector<DeviceHealth> all;
};

}  // namespace merlin::test
