// Reads PCD files (Point Cloud Library) with organised points, i.e. points in rows and columns as
// the scanner saw them; forms ascii, binary and binary_compressed. Format: "The PCD file format",
// documentation of PCL.
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

// Parses a PCD file; `bytes` is the whole file. The fields x, y, z become ranges and rays, rgb or
// rgba becomes the plane "colour", and each other field becomes a plane with the field's name;
// normals are left out, since they are computed from the surface. Points that are not finite count
// as no return. The viewpoint is ignored if its distance from the middle of the points' bounding
// box is 10^4 to 10^15 units along an axis and more than 100 diagonals of the box, as with the
// default 0 0 0 in a file with map coordinates: the ranges are then measured from a point above the
// others, and a note tells the user. Errors, with the line of the header or the number of the
// point: kMalformed, kUnsupported (not organised).
Result<PcdImage> parsePcd(std::string_view bytes);

}  // namespace merlin::render::range
