// LAS files of laser scanners: versions 1.2, 1.3 and 1.4, point formats 0 to 10, not compressed.
// Format: ASPRS, "LAS Specification 1.4 - R15", 2019, tables 1 to 17; versions 1.2 and 1.3
// likewise.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

bool isLas(std::string_view bytes) noexcept;

// The points with the features "intensity" (raw counts), "label" (the class) and "colour", where a
// point has one, and the projection. Left out, as a note says: withheld points, points of the noise
// classes 7 and 18, the GPS time, return numbers, scan angles, near infrared, waveforms and extra
// bytes where there are any. Errors, with the field of the header: kMalformed; kUnsupported (LAZ,
// any other version), each with the command that converts.
Result<PointCloud> parseLas(std::string_view bytes);

}  // namespace merlin::render::points
