// PostureHold: filters the postures of single records. A posture begins once it has lasted for a
// minimum time, and ends once it has been absent for a while. Pure, allocation-free.
#pragma once

#include <cstdint>

#include "nn/postures.h"
#include "nn/settings.h"

namespace merlin::nn {

// The held posture; there is none if `any` is false.
struct Held {
  std::uint32_t code = 0;
  bool any = false;
  std::int64_t since_ns = 0;  // time of the first record of the run that began or ended it
  std::uint32_t entered = 0;  // number of postures that have begun so far
};

// Thread-bound.
class PostureHold {
 public:
  explicit PostureHold(const HoldSettings& settings) : settings_(settings) {}

  // REQUIRES: `now_ns` never decreases.
  const Held& update(const Recognition& seen, std::int64_t now_ns) noexcept;

 private:
  HoldSettings settings_;
  Held held_;
  bool running_ = false;  // in a run of records that all show `run_code_` (kNone: no posture)
  std::uint32_t run_code_ = kNone;
  std::int64_t run_since_ns_ = 0;
  std::int64_t gone_since_ns_ = 0;  // first record of a run without the held posture
  bool gone_ = false;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

}  // namespace merlin::nn
