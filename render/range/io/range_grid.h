// PLY files whose points lie on a grid of rows and columns: those with an element range_grid, as
// the Stanford 3D Scanning Repository has them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Whether the header of a PLY file has an element range_grid. Reads its first 64 KiB at most.
bool isRangeGrid(std::string_view bytes) noexcept;

struct RangeGrid {
  RangeImage image;  // of kRays
  std::vector<std::string> notes;
};

// num_cols and num_rows of the header's obj_info are the size; each pixel has a list of one vertex,
// or of none where there is no return. x, y, z become ranges and rays, colours (0 to 255 of
// integers, else 0 to 1) the plane "colour", each other property of the vertices one of its name.
// The scanner's place is not in such a file: of the origin and a distant point in the direction of
// z, the one is taken from which the columns have the more even steps. Errors, with the line of the
// header or the number of the vertex or pixel: kMalformed, kUnsupported (too many pixels).
Result<RangeGrid> parseRangeGrid(std::string_view bytes);

}  // namespace merlin::render::range
