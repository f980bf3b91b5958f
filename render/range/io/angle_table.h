// Tables of the angles of a spinning scanner's rows: text files with a line per row.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/range/io/image_header.h"

namespace merlin::render::range {

// Sets geometry, angles, columns and beams of `header`. A line has the number of the row, its
// altitude and the azimuth that is added to that of each column, or the altitude and the azimuth,
// or the altitude alone; degrees. Comments begin with #; that with "columns: 1024 over 360 deg"
// says how many columns there are and how far they turn (without it: the image's, and as far as the
// header says, else 360), and if it
// also has the word "destagger", then the rows of the image were shifted by whole columns against
// their azimuth already, and only what is left of it is added. Errors, with the line: kMalformed.
Result<Ok> parseAngleTable(std::string_view text, ImageHeader& header);

// The part of an azimuth that a shift by whole columns of `turn_rad` / `columns` leaves.
double leftOfShift(double azimuth_rad, double turn_rad, std::size_t columns);

}  // namespace merlin::render::range
