// PostureHold: from what a hand shows, record by record, to postures that a person means: a posture
// counts once it has lasted, and ends once it has been gone for a while. Pure, allocation-free.
#pragma once

#include <cstdint>

#include "nn/postures.h"
#include "nn/settings.h"

namespace merlin::nn {

// The posture that is held; none if `any` is false.
struct Held {
  std::uint32_t code = 0;
  bool any = false;
  std::int64_t since_ns = 0;  // of the first record of the run that made it count, or ended it
  std::uint32_t entered = 0;  // postures that have begun to count so far
};

// Thread-bound.
class PostureHold {
 public:
  explicit PostureHold(const HoldSettings& settings) : settings_(settings) {}

  // `now_ns` never falls.
  const Held& update(const Recognition& seen, std::int64_t now_ns) noexcept;

 private:
  HoldSettings settings_;
  Held held_;
  bool running_ = false;  // a run of records that all show `run_code_`, or none for kNone
  std::uint32_t run_code_ = kNone;
  std::int64_t run_since_ns_ = 0;
  std::int64_t gone_since_ns_ = 0;  // first record in a row that does not show what is held
  bool gone_ = false;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

}  // namespace merlin::nn
