// Whole drivers that ./dev bench fuzz sends bytes through: what their parsers make of bytes is
// carried on to samples.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "daemon/base/random.h"

namespace merlin::bench {

// Takes a piece of the stream; returns how many packets it completed.
using FuzzFeed = std::function<std::uint64_t(const std::string&)>;

struct FuzzTarget {
  const char* name;
  std::function<FuzzFeed()> make;
  std::function<std::string(Random&)> packet;  // a good one
};

// A packet of these counts if the driver has published a sample. Each sample has to be plausible
// (drivers/port/plausible.h); if one is not, the program aborts and names the driver.
std::span<const FuzzTarget> fuzzedDrivers();

}  // namespace merlin::bench
