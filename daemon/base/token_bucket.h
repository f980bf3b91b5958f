// TokenBucket: a limit of so much a second, with a reserve for bursts. Pure: the caller says when.
#pragma once

#include <algorithm>

#include "daemon/base/clock.h"

namespace merlin {

// Thread-bound.
class TokenBucket {
 public:
  // `rate`: tokens a second; `burst`: the most that the bucket holds, and what it starts with.
  // REQUIRES: both are above 0.
  TokenBucket(double rate, double burst) noexcept : rate_(rate), burst_(burst), tokens_(burst) {}

  // How many whole tokens there are at `now`.
  double available(Timestamp now) noexcept {
    refill(now);
    return tokens_;
  }

  // Takes `amount` where the bucket holds it; else takes nothing and returns false.
  bool take(double amount, Timestamp now) noexcept {
    refill(now);
    if (tokens_ < amount) return false;
    tokens_ -= amount;
    return true;
  }

  // Takes `amount` whatever the bucket holds, for work that is already done: the debt is waited for
  // by whoever comes next.
  void charge(double amount, Timestamp now) noexcept {
    refill(now);
    tokens_ -= amount;
  }

  // How long from `now` until the bucket holds `amount`, at most its burst; zero where it does.
  Duration waitFor(double amount, Timestamp now) noexcept {
    refill(now);
    const double missing = std::min(amount, burst_) - tokens_;
    return missing <= 0 ? Duration::zero() : fromSeconds(missing / rate_) + Duration(1);
  }

 private:
  void refill(Timestamp now) noexcept {
    if (started_ && now > last_)
      tokens_ = std::min(burst_, tokens_ + rate_ * toSeconds(now - last_));
    if (!started_ || now > last_) last_ = now;
    started_ = true;
  }

  double rate_, burst_, tokens_;
  Timestamp last_{};
  bool started_ = false;
};

}  // namespace merlin
