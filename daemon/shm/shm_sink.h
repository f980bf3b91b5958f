// ShmSink: writes samples and health from the device threads into the devices' segment.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"

namespace merlin::shm {

// Each overload is called from one device's thread only.
class ShmSink final : public SampleSink {
 public:
  explicit ShmSink(DevicesSegment& segment) : segment_(segment) {}

  void publish(const GloveSample& sample) noexcept override { segment_.glove.publish(sample); }
  void publish(const TrackerSample& sample) noexcept override {
    if (sample.station >= 1 && sample.station <= kStations) {
      segment_.tracker[sample.station - 1].publish(sample);
    }
  }
  void publish(const BallSample& sample) noexcept override { segment_.ball.publish(sample); }

 private:
  DevicesSegment& segment_;
};

class ShmHealthSink final : public HealthSink {
 public:
  explicit ShmHealthSink(SeqSlot<DeviceHealth>& slot) : slot_(slot) {}
  void publish(const DeviceHealth& health) noexcept override { slot_.publish(health); }

 private:
  SeqSlot<DeviceHealth>& slot_;
};

}  // namespace merlin::shm
