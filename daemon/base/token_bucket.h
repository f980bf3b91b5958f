// TokenBucket: limits a rate, with a reserve for bursts. Pure: the caller passes the time.
#pragma once

#include <algorithm>

#include "daemon/base/clock.h"

namespace merlin {

// Thread-bound.
class TokenBucket {
 public:
  // `rate`: tokens per second; `burst`: capacity of the bucket, which is full at first.
  // REQUIRES: both are above 0.
  TokenBucket(double rate, double burst) noexcept : rate_(rate), burst_(burst), tokens_(burst) {}

  // Number of tokens in the bucket at `now`; negative after charge().
  double available(Timestamp now) noexcept {
    refill(now);
    return tokens_;
  }

  // Takes `amount` if the bucket holds it; otherwise takes nothing and returns false.
  bool take(double amount, Timestamp now) noexcept {
    refill(now);
    if (tokens_ < amount) return false;
    tokens_ -= amount;
    return true;
  }

  // Takes `amount` even if the bucket holds less, for work that is already done; the next caller
  // waits for the debt.
  void charge(double amount, Timestamp now) noexcept {
    refill(now);
    tokens_ -= amount;
  }

  // Time from `now` until the bucket holds `amount` (at most `burst`); zero if it does.
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
