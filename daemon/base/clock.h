// Time: the only clock that MERLIN reads. CLOCK_MONOTONIC in nanoseconds; replaced in tests.
#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>

namespace merlin {

using Duration = std::chrono::nanoseconds;
using Timestamp = std::chrono::time_point<std::chrono::steady_clock, Duration>;

// Samples and headers store times as nanoseconds of CLOCK_MONOTONIC.
inline std::int64_t toNanoseconds(Timestamp t) noexcept { return t.time_since_epoch().count(); }
inline Timestamp fromNanoseconds(std::int64_t ns) noexcept { return Timestamp(Duration(ns)); }
inline double toSeconds(Duration d) noexcept { return std::chrono::duration<double>(d).count(); }
inline Duration fromSeconds(double s) noexcept {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s));
}

// Port. Implemented by SystemClock below and by tests/support/fake_clock.h. Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;

  virtual Timestamp now() const noexcept = 0;

  // Sleeps until `when` and returns true, or returns false within 50 ms of a stop request.
  virtual bool sleepUntil(Timestamp when, const std::stop_token& stop) noexcept = 0;
};

class SystemClock final : public Clock {
 public:
  Timestamp now() const noexcept override;
  bool sleepUntil(Timestamp when, const std::stop_token& stop) noexcept override;
};

// CLOCK_REALTIME minus CLOCK_MONOTONIC: added to a Timestamp it gives the time of day. Measured to
// about a microsecond; changes when the system's clock is set. Thread-safe.
Duration realtimeOffset() noexcept;

}  // namespace merlin
