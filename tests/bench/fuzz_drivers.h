// Whole drivers for ./dev bench fuzz: the benchmark sends bytes through them, from their parsers to
// the samples that they publish.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "daemon/base/random.h"

namespace merlin::bench {

// Processes a piece of the stream; returns how many packets the piece completed.
using FuzzFeed = std::function<std::uint64_t(const std::string&)>;

struct FuzzTarget {
  const char* name;
  std::function<FuzzFeed()> make;
  std::function<std::string(Random&)> packet;  // makes a valid packet
};

// Returns the fuzzed drivers. A packet counts if the driver publishes a sample. Each sample has to
// be plausible (drivers/port/plausible.h); otherwise the program aborts and names the driver.
std::span<const FuzzTarget> fuzzedDrivers();

}  // namespace merlin::bench
