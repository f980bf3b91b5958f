// Watchdog: decides whether systemd may be told that the service is alive, namely while every
// thread makes progress. Pure.
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
  // `interval`: time between two pings; zero: no watchdog, never ping.
  explicit Watchdog(Duration interval) : interval_(interval) {}

  // Returns whether systemd is to be pinged now: a ping is due, no thread has ended unexpectedly,
  // and each thread that existed at the last ping has made progress since or is paused.
  bool ping(Timestamp now, const std::vector<ThreadState>& threads);

 private:
  Duration interval_;
  Timestamp last_{};
  std::map<std::uint64_t, std::uint64_t> seen_;  // progress at the last ping, by thread id
};

}  // namespace merlin::status
