// PCD files (Point Cloud Library) with organised points: rows and columns as the scanner saw them.
// Forms ascii, binary and binary_compressed. Format: "The PCD file format", documentation of PCL.
#pragma once

#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

bool isPcd(std::string_view bytes) noexcept;

struct PcdImage {
  RangeImage image;  // kRays, seen from the file's viewpoint or from above
  std::vector<std::string> notes;
};

// The fields x, y, z become ranges and rays, rgb or rgba becomes the plane "colour", and each other
// field a plane of its name; normals are left out, since they are computed anew. Points that are
// not finite count as no return. A viewpoint whose distance from the points is 10^4 units and 100
// diagonals of their box, such as the default 0 0 0 in a file with map coordinates, is ignored: the
// points are then seen from above, which a note says. Errors, with the line of the header or the
// number of the point: kMalformed, kUnsupported (not organised).
Result<PcdImage> parsePcd(std::string_view bytes);

}  // namespace merlin::render::range
