// Reads text files of points, one line per point: x y z, then nothing, an intensity, a colour
// (three integers of 0 to 255), a unit normal, or an intensity and a colour. Columns are separated
// by blanks, commas or semicolons. Lines that begin with # or // are comments; a first line with
// nothing but the number of points (PTS) is skipped.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

// Returns whether the first 4096 bytes contain at least three lines of points, all with 3, 4, 6 or
// 7 numbers, and otherwise only comments.
bool isXyz(std::string_view bytes);

// Parses a text file of points; `bytes` is the whole file. Errors, with the line: kMalformed
// (another number of columns, a word that is not a number, six columns whose last three are neither
// a colour nor a normal); kUnsupported (more than kMostPoints points).
Result<PointCloud> parseXyz(std::string_view bytes);

}  // namespace merlin::render::points
