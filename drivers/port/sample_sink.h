// SampleSink: interface of a receiver of samples. Implemented by daemon/shm (ShmSink), by sinks
// that process samples and pass them on (daemon/devices, daemon/actions), and by fakes in tests.
//
// Called from device threads: an implementation takes no lock and allocates nothing. Each device
// has one thread; two devices never publish the same kind of sample.
#pragma once

#include <bitset>

#include "drivers/port/samples.h"

namespace merlin {

// The keys and buttons that an input device has, by the kernel's numbers.
using DeviceKeys = std::bitset<kKeyNumbers>;

class SampleSink {
 public:
  virtual ~SampleSink() = default;

  virtual void publish(const GloveSample& sample) noexcept = 0;
  virtual void publish(const TrackerSample& sample) noexcept = 0;
  virtual void publish(const BallSample& sample) noexcept = 0;
  virtual void publish(const TouchSample& sample) noexcept = 0;

  // Told each time that a device of the kernel has been opened, before its first sample; other
  // devices tell nothing.
  virtual void describe(const DeviceKeys&) noexcept {}
};

// Receives the health of one device.
class HealthSink {
 public:
  virtual ~HealthSink() = default;
  virtual void publish(const DeviceHealth& health) noexcept = 0;
};

}  // namespace merlin
