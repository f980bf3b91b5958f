// ContinuedCounts: continues a device's counters when a changed configuration recreates the device.
// It is the first sink that the device's samples and health pass through.
#pragma once

#include <array>

#include "drivers/port/sample_sink.h"
#include "drivers/port/samples.h"

namespace merlin::devices {

// Thread-bound to the device's thread, except restart(). Takes no lock and allocates nothing.
class ContinuedCounts final : public SampleSink, public HealthSink {
 public:
  ContinuedCounts(SampleSink& samples, HealthSink& health) : samples_(samples), health_(health) {}

  void publish(const GloveSample& sample) noexcept override { pass(sample, glove_); }
  void publish(const BallSample& sample) noexcept override { pass(sample, ball_); }
  void publish(const TouchSample& sample) noexcept override { pass(sample, touch_); }
  void publish(const TrackerSample& sample) noexcept override {
    pass(sample, tracker_[(sample.station - 1) % kStations]);
  }
  void describe(const DeviceKeys& keys) noexcept override { samples_.describe(keys); }
  Timestamp due() const noexcept override { return samples_.due(); }
  void tick(Timestamp now) noexcept override { samples_.tick(now); }
  void publish(const DeviceHealth& health) noexcept override {
    DeviceHealth sum = health;
    sum.samples += before_.samples;
    sum.bad_bytes += before_.bad_bytes;
    sum.bad_packets += before_.bad_packets;
    sum.reconnects += before_.reconnects;
    last_ = sum;
    health_.publish(sum);
  }

  // Makes the counters continue from their last values, although those of the next device begin at
  // 0; this counts as a reconnection if the old device has sent samples. To be called after the old
  // device was closed and before the new one publishes anything. REQUIRES: the device's thread does
  // not run.
  void restart() noexcept {
    before_ = last_;
    if (last_.samples > 0) ++before_.reconnects;
    for (Count* const count : {&glove_, &ball_, &touch_}) count->before = count->last;
    for (Count& count : tracker_) count.before = count.last;
  }

 private:
  struct Count {
    std::uint32_t before = 0, last = 0;
  };
  template <typename Sample>
  void pass(Sample sample, Count& count) noexcept {
    sample.counter += count.before;
    count.last = sample.counter;
    samples_.publish(sample);
  }

  SampleSink& samples_;
  HealthSink& health_;
  Count glove_, ball_, touch_;
  std::array<Count, kStations> tracker_{};
  DeviceHealth before_{}, last_{};
};

}  // namespace merlin::devices
