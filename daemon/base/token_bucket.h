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

  // Returns the number of tokens in the bucket at `now`; it may be negative after charge().
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

  // Takes `amount` even if the bucket holds less, for work that is already done. The number of
  // tokens may become negative; later calls must wait until it has recovered.
  void charge(double amount, Timestamp now) noexcept {
    refill(now);
    tokens_ -= amount;
  }

  // Returns the time from `now` until the bucket holds `amount`, or `burst` if that is less; zero
  // if it does already.
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
