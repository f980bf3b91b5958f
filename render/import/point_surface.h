// Reconstructs a surface from a point cloud, through Open3D, whose Poisson reconstruction is the
// code of M. Kazhdan [KAZHDAN13]. Linked only into the program merlin-import, which runs it in its
// sandbox.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/points/point_cloud.h"
#include "render/points/surface_guess.h"

namespace merlin::render::import {

struct PointSurface {
  mesh::Mesh mesh;
  points::SurfaceSettings settings;  // the values that were used
  double spacing = 0;                // median distance of points to their fourth neighbour
  std::size_t trimmed = 0;           // number of triangles removed, as too far from all points
  std::string normals;               // text for the user: how the normals were obtained
  std::vector<std::string> notes;    // notes for the user
};

// Progress callback: receives the share of the work that is done, 0..1, and the number of points or
// triangles.
using OnSurfaceProgress = std::function<void(double share, std::int64_t items)>;

// Silences Open3D's messages. Call once, before the sandbox closes. Always succeeds.
Result<Ok> preparePoints(const char* program);

// Reconstructs a surface. Uses the cloud's own normals; if it has none, normals are estimated from
// the nearest neighbours and oriented towards the viewpoint, upwards (kAbove), or consistently
// along the surface [HOPPE92]. The features of a vertex are the means over the four nearest points,
// weighted by inverse distance; a label is that of the nearest point. `said`: settings of the user,
// which may contain values to guess. The same cloud gives the same mesh. Errors: kMalformed (fewer
// than ten points, or points at only a few positions), kUnsupported (nothing is left after
// trimming; or an error of the library, with its message), kNoMemory.
Result<PointSurface> surfaceOf(const points::PointCloud& cloud, points::SurfaceSettings said,
                               const OnSurfaceProgress& on_progress);

}  // namespace merlin::render::import
