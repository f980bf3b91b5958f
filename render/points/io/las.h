// Reads LAS files of laser scanners: versions 1.2, 1.3 and 1.4, point formats 0 to 10,
// uncompressed.
// Format: ASPRS, "LAS Specification 1.4 - R15", 2019, tables 1 to 17; also the
// specifications of versions 1.2 and 1.3.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

bool isLas(std::string_view bytes) noexcept;

// Returns the points with the features "intensity" (raw counts), "label" (the class) and, if the
// points have one, "colour", and the projection. The following is left out, and a note says so:
// withheld points, points of the noise classes 7 and 18, GPS times, return numbers, scan angles,
// near infrared, waveforms and extra bytes. Errors, with the field of the header: kMalformed;
// kUnsupported (LAZ, any other version, more than kMostPoints points), with a command that converts
// the file.
Result<PointCloud> parseLas(std::string_view bytes);

}  // namespace merlin::render::points
