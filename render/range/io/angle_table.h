// Reads tables of the angles of a spinning scanner's rows. A table is a text file with one line per
// row.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/range/io/image_header.h"

namespace merlin::render::range {

// Parses a table and sets geometry, angles, columns and beams of `header`. A line has one to three
// numbers, in degrees where they are angles: the altitude alone; altitude and azimuth; or the row's
// number, altitude and azimuth. The azimuth is added to that of each column. Comments begin with #.
// A comment "columns: 1024 over 360 deg" gives the number of columns and the angle over which they
// are spread; without it, they are the image's number of columns and the header's angle, or 360
// degrees if the header has none. If a comment contains the word "destagger", the rows of the image
// have already been shifted by whole columns to correct their azimuth, and only the remainder
// (leftOfShift()) is added. Errors, with the line: kMalformed.
Result<Ok> parseAngleTable(std::string_view text, ImageHeader& header);

// Returns the part of an azimuth that remains after a shift by whole columns of `turn_rad` /
// `columns` each [rad].
double leftOfShift(double azimuth_rad, double turn_rad, std::size_t columns);

}  // namespace merlin::render::range
