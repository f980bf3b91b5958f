// SampleSink: interface of a receiver of samples. Implemented by daemon/shm (ShmSink), by sinks
// that process samples and pass them on (daemon/devices, daemon/actions), and by fakes in tests.
//
// Called from device threads: an implementation takes no lock and allocates nothing. Each device
// has one thread; two devices never publish the same kind of sample.
#pragma once

#include "drivers/port/samples.h"

namespace merlin {

class SampleSink {
 public:
  virtual ~SampleSink() = default;

  virtual void publish(const GloveSample& sample) noexcept = 0;
  virtual void publish(const TrackerSample& sample) noexcept = 0;
  virtual void publish(const BallSample& sample) noexcept = 0;
  virtual void publish(const TouchSample& sample) noexcept = 0;
};

// Receives the health of one device.
class HealthSink {
 public:
  virtual ~HealthSink() = default;
  virtual void publish(const DeviceHealth& health) noexcept = 0;
};

}  // namespace merlin
