// Mutated configurations through the loader, and whether what it accepts is what was written: a key
// that is ignored is a fault. Deterministic: a seed says everything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/random.h"

namespace merlin::bench {

class ConfigFuzz {
 public:
  // `examples`: good configurations, the texts that are mutated. REQUIRES: at least one, each JSON.
  explicit ConfigFuzz(std::vector<std::string> examples) : examples_(std::move(examples)) {}

  enum class Outcome { kNoJson, kInvalid, kAdjusted, kValid };

  struct Result {
    Outcome outcome = Outcome::kNoJson;
    std::string fault;  // empty: none
    std::string text;   // the mutated configuration
  };
  // Mutates an example by the seed and loads it.
  Result run(std::uint64_t seed) const;

  // What is wrong with the loader's answer to this text; empty: nothing. Faults: it is accepted and
  // is no JSON, has a key twice, has a key or value that the settings do not have as it was written
  // (unless a finding says that it was adjusted), or its settings, written, are refused or change
  // when they are read again.
  static Result judge(std::string text);

 private:
  std::string mutated(Random& random) const;

  std::vector<std::string> examples_;
};

}  // namespace merlin::bench
