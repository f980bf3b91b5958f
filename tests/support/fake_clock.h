// FakeClock: time that moves when it is told to, or when somebody sleeps on it. Thread-bound.
#pragma once

#include "daemon/base/clock.h"

namespace merlin::test {

class FakeClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return now_; }

  // Sleeping takes no time of ours: the clock is simply later. A stop wakes before it moves.
  bool sleepUntil(Timestamp when, const std::stop_token& stop) noexcept override {
    if (stop.stop_requested()) return false;
    if (when > now_) now_ = when;
    return true;
  }

  void advance(Duration by) noexcept { now_ += by; }

 private:
  Timestamp now_{std::chrono::seconds(1000)};
};

}  // namespace merlin::test
