// Converts the origin of an elevation map to the origin of the mesh that is made from the map.
// Pure.
#pragma once

#include <string_view>

#include "render/mesh/origin.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Returns whether the coordinates of a projection are in metres: WKT whose unit of length is 1 m,
// or ArcInfo's text "Units METERS". Returns false for degrees, feet, and mere names ("EPSG:32633").
bool isInMetres(std::string_view projection);

// Returns the map's origin as the origin of the mesh, with height 0, if map and mesh have the same
// unit: the projection is in metres, or it is unknown and the coordinates are too large for
// degrees. Otherwise returns 0 0 0, also for a geometry that is not an elevation map.
mesh::Origin mapOrigin(const Geometry& geometry);

}  // namespace merlin::render::range
