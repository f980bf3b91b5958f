// Port: where samples go. Implemented by daemon/shm (ShmSink) and by fakes in tests.
//
// Called from device threads: an implementation takes no lock and allocates nothing. One thread a
// device; two devices never write the same kind of sample.
#pragma once

#include "drivers/port/samples.h"

namespace merlin {

class SampleSink {
 public:
  virtual ~SampleSink() = default;

  virtual void publish(const GloveSample& sample) noexcept = 0;
  virtual void publish(const TrackerSample& sample) noexcept = 0;
  virtual void publish(const BallSample& sample) noexcept = 0;
};

// Where a device's health goes; one for each device.
class HealthSink {
 public:
  virtual ~HealthSink() = default;
  virtual void publish(const DeviceHealth& health) noexcept = 0;
};

}  // namespace merlin
