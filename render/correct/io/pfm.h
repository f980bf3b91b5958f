// Portable float map (PFM): a raster of three floats per cell, as bytes. Pure.
//
// Header: "PF", columns, rows and a scale as ASCII text, separated by white space, and one white
// space character after the scale. Then 32-bit floats, little-endian if the scale is negative,
// starting with the lowest row (netpbm.sourceforge.net/doc/pfm.html).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::correct {

struct FloatMap {
  int columns = 0, rows = 0;
  std::vector<std::array<float, 3>> cells{};  // row by row from the top; any floats, NaN included
};

// Parses a PFM. Errors: kMalformed (no valid header, or not as many bytes as it declares),
// kUnsupported (one float per cell, or more than `most_cells` cells).
Result<FloatMap> parsePfm(std::span<const std::byte> bytes, std::size_t most_cells);

// Returns a little-endian PFM.
std::string pfmBytes(const FloatMap& map);

}  // namespace merlin::render::correct
