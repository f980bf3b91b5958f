// PLY files without faces, as a point cloud; they are parsed by render/mesh/io/ply.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

// Whether the bytes begin a PLY file with vertices, without faces, strips and range_grid.
bool isPlyCloud(std::string_view bytes);

// Each scalar vertex property becomes a feature, as of a mesh. Coordinates are read as doubles and
// kept relative to mesh::originNear() of the first point. Errors: those of ply::parse().
Result<PointCloud> parsePlyCloud(std::string_view bytes);

}  // namespace merlin::render::points
