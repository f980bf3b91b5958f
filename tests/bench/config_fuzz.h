// Gives mutated configurations to the loader, and checks that accepted settings equal what the text
// says; a key that is ignored is a fault. A seed determines everything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/random.h"

namespace merlin::bench {

class ConfigFuzz {
 public:
  // `examples`: valid configurations, whose texts are mutated. REQUIRES: at least one example, and
  // each is valid JSON.
  explicit ConfigFuzz(std::vector<std::string> examples) : examples_(std::move(examples)) {}

  enum class Outcome { kNoJson, kInvalid, kAdjusted, kValid };

  struct Result {
    Outcome outcome = Outcome::kNoJson;
    std::string fault;  // empty: no fault
    std::string text;   // the mutated configuration
  };
  // Mutates an example as the seed determines, and loads it.
  Result run(std::uint64_t seed) const;

  // Loads the text and judges the loader's answer. These are faults: the loader accepts a text that
  // is not JSON, that has a key twice, or that has a key or value which the settings do not have as
  // written (unless a finding reports that the value was adjusted); or the settings, when written,
  // are refused or change when they are read again.
  static Result judge(std::string text);

 private:
  std::string mutated(Random& random) const;

  std::vector<std::string> examples_;
};

}  // namespace merlin::bench
