// Watchdog: whether the service may be told alive: only while all that should move on does. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::status {

// Thread-bound.
class Watchdog {
 public:
  // `interval`: between two pings; zero: nobody watches, never ping.
  explicit Watchdog(Duration interval) : interval_(interval) {}

  // True where a ping is due and each counter has grown since the last one; `counters` are the same
  // ones, in the same order, each time.
  bool ping(Timestamp now, std::span<const std::uint64_t> counters);

 private:
  Duration interval_;
  Timestamp last_{};
  std::vector<std::uint64_t> seen_;
};

}  // namespace merlin::status
