// SampleSink: interface of a receiver of samples. Implemented by daemon/shm (ShmSink), by sinks
// that process samples and pass them on (daemon/devices, daemon/actions), and by fakes in tests.
//
// Called from device threads: an implementation takes no lock and allocates nothing. Each device
// has one thread; two devices never publish the same kind of sample.
#pragma once

#include <algorithm>
#include <bitset>

#include "daemon/base/clock.h"
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

  // Called each time that an input device of the kernel has been opened, before its first sample;
  // drivers of other devices do not call it.
  virtual void describe(const DeviceKeys&) noexcept {}

  // Returns when this sink has to act even if no sample arrives, for example because a held button
  // takes effect after a delay; Timestamp::max() if never. The driver of a device that sends
  // nothing while an input is held must then call tick() with the present time.
  virtual Timestamp due() const noexcept { return Timestamp::max(); }
  virtual void tick(Timestamp) noexcept {}
};

// Returns how long the driver may wait for bytes before it has to call tick(), at most `most`.
inline Duration untilDue(const SampleSink& sink, Timestamp now, Duration most) noexcept {
  const Timestamp due = sink.due();
  return due < now + most ? std::max<Duration>(due - now, Duration::zero()) : most;
}
// Calls sink.tick() if sink.due() has been reached.
inline void tickIfDue(SampleSink& sink, Timestamp now) noexcept {
  if (sink.due() <= now) sink.tick(now);
}

// Receives the health of one device.
class HealthSink {
 public:
  virtual ~HealthSink() = default;
  virtual void publish(const DeviceHealth& health) noexcept = 0;
};

}  // namespace merlin
