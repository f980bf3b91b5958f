// PostureHold: filters the postures that are recognised in single records of a glove. A posture
// begins once it has lasted for a minimum time, and ends once it has been absent for a while. Pure,
// allocation-free.
#pragma once

#include <cstdint>

#include "nn/postures.h"
#include "nn/settings.h"

namespace merlin::nn {

// The held posture; there is none if `any` is false.
struct Held {
  std::uint32_t code = 0;
  bool any = false;
  std::int64_t since_ns = 0;  // time of the first record of the run with which it began or ended
  std::uint32_t entered = 0;  // number of postures that have begun so far
};

// Thread-bound.
class PostureHold {
 public:
  explicit PostureHold(const HoldSettings& settings) : settings_(settings) {}

  // Takes the recognition of the record at time `now_ns` and returns the posture that is now held,
  // valid until the next call. REQUIRES: `now_ns` never decreases.
  const Held& update(const Recognition& seen, std::int64_t now_ns) noexcept;

 private:
  HoldSettings settings_;
  Held held_;
  // False until the first record. Since run_since_ns_, all records show run_code_ (kNone: no
  // posture).
  bool running_ = false;
  std::uint32_t run_code_ = kNone;
  std::int64_t run_since_ns_ = 0;
  std::int64_t gone_since_ns_ = 0;  // time of the first record without the held posture, if gone_
  bool gone_ = false;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

}  // namespace merlin::nn
