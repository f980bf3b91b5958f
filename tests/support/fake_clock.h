// FakeClock: a clock that moves only by advance() or sleepUntil(). Thread-bound.
#pragma once

#include "daemon/base/clock.h"

namespace merlin::test {

class FakeClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return now_; }

  // Does not block: it sets the clock to `when`. After a stop request it returns false and leaves
  // the clock as it is.
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
