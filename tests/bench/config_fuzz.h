// Gives mutated configurations to the loader, and checks that what it accepts equals what is
// written there: a key that is ignored is a fault. A seed determines everything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/random.h"

namespace merlin::bench {

class ConfigFuzz {
 public:
  // `examples`: good configurations, whose texts are mutated. REQUIRES: at least one, and each is
  // valid JSON.
  explicit ConfigFuzz(std::vector<std::string> examples) : examples_(std::move(examples)) {}

  enum class Outcome { kNoJson, kInvalid, kAdjusted, kValid };

  struct Result {
    Outcome outcome = Outcome::kNoJson;
    std::string fault;  // empty: none
    std::string text;   // the mutated configuration
  };
  // Mutates an example as the seed says, and loads it.
  Result run(std::uint64_t seed) const;

  // Describes the fault in the loader's answer to this text; empty if there is none. Faults: the
  // loader accepts a text that is no JSON, that has a key twice, or that has a key or value which
  // the settings do not have as written (unless a finding says that it was adjusted); or the
  // settings, when written, are refused or change when they are read again.
  static Result judge(std::string text);

 private:
  std::string mutated(Random& random) const;

  std::vector<std::string> examples_;
};

}  // namespace merlin::bench
