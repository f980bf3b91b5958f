// Reads PLY files whose points lie on a grid of rows and columns: files with an element range_grid,
// such as those of the Stanford 3D Scanning Repository.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Returns whether the header of a PLY file has an element range_grid. Reads at most the first 64
// KiB.
bool isRangeGrid(std::string_view bytes) noexcept;

struct RangeGrid {
  RangeImage image;  // kRays
  std::vector<std::string> notes;
};

// Parses a PLY file with a range_grid; `bytes` is the whole file. num_cols and num_rows in the
// header's obj_info lines give the size. Each pixel has a list of one vertex, or an empty list if
// there is no return. x, y, z become ranges and rays; colours (integers of 0 to 255, else 0 to 1)
// become the plane "colour"; each other property of the vertices becomes a plane of its name. Such
// a file does not contain the scanner's position. It is assumed to be the origin or a distant point
// in the direction of z, whichever sees the columns at more even steps. Errors, with the line of
// the header or the number of the vertex or pixel: kMalformed, kUnsupported (too many pixels).
Result<RangeGrid> parseRangeGrid(std::string_view bytes);

}  // namespace merlin::render::range
