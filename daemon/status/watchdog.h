// Watchdog: whether the service may be told alive: only while all that should move on does. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"

namespace merlin::status {

// Thread-bound.
class Watchdog {
 public:
  // `interval`: between two pings; zero: nobody watches, never ping.
  explicit Watchdog(Duration interval) : interval_(interval) {}

  // True where a ping is due and each thread that was there at the last one has made progress
  // since, or has stopped as it was asked to.
  bool ping(Timestamp now, const std::vector<ThreadState>& threads);

 private:
  Duration interval_;
  Timestamp last_{};
  std::map<std::uint64_t, std::uint64_t> seen_;  // progress by thread
};

}  // namespace merlin::status
