// Converts PLY files without faces to point clouds; render/mesh/io/ply parses them.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

// Returns whether the bytes are the beginning of a PLY file with vertices, but without faces,
// strips and range_grid.
bool isPlyCloud(std::string_view bytes);

// Parses a PLY file; `bytes` is the whole file. Each scalar vertex property becomes a feature, as
// in a mesh. Coordinates are read as doubles and kept relative to mesh::originNear() of the first
// point. Errors: those of mesh::ply::parse(); kUnsupported (more than kMostPoints points).
Result<PointCloud> parsePlyCloud(std::string_view bytes);

}  // namespace merlin::render::points
