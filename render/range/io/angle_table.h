// Reads tables of the angles of a spinning scanner's rows: text files with one line per row.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/range/io/image_header.h"

namespace merlin::render::range {

// Sets geometry, angles, columns and beams of `header`. A line has one to three numbers, in
// degrees: the row's number, its altitude and the azimuth that is added to that of each column; or
// altitude and azimuth; or the altitude alone. Comments begin with #. A comment "columns: 1024 over
// 360 deg" gives the number of columns and the angle over which they are spread; without it these
// are the image's number and the header's angle, or else 360. If a comment also has the word
// "destagger", the rows of the image have already been shifted by whole columns to correct their
// azimuth, and only the remainder (leftOfShift()) is added. Errors, with the line: kMalformed.
Result<Ok> parseAngleTable(std::string_view text, ImageHeader& header);

// The part of an azimuth that remains after a shift by whole columns of `turn_rad` / `columns`
// each.
double leftOfShift(double azimuth_rad, double turn_rad, std::size_t columns);

}  // namespace merlin::render::range
