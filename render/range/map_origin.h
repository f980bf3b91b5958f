// Where an elevation map lies, in the coordinates of the mesh that is made of it. Pure.
#pragma once

#include <string_view>

#include "render/mesh/origin.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Whether a projection's coordinates are metres: WKT with a length of 1 m, or ArcInfo's words
// "Units METERS". False for degrees, feet, and names alone ("EPSG:32633").
bool isInMetres(std::string_view projection);

// The map's origin as that of the mesh, at height 0, where both are in one unit: the projection is
// in metres, or there is none and the coordinates are too large for degrees. Otherwise 0 0 0, also
// for whatever is no elevation map.
mesh::Origin mapOrigin(const Geometry& geometry);

}  // namespace merlin::render::range
