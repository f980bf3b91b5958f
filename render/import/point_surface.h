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
  double spacing = 0;                // median distance to the fourth neighbour
  std::size_t trimmed = 0;           // triangles that were too far from all points
  std::string normals;               // origin of the normals, for the user
  std::vector<std::string> notes;    // for the user
};

// Called with the share of the work that is done, 0..1, and the number of points or triangles.
using OnSurfaceProgress = std::function<void(double share, std::int64_t items)>;

// Silences the library's messages. To be called once, before the sandbox closes.
Result<Ok> preparePoints(const char* program);

// Uses the cloud's own normals; if it has none, they are estimated from the nearest neighbours and
// oriented towards the viewpoint, upwards (kAbove), or consistently along the surface [HOPPE92].
// The features of a vertex are the means over the four nearest points, weighted by inverse
// distance; a label is that of the nearest point. The same cloud gives the same mesh. Errors:
// kMalformed (fewer than ten points, or points at only a few positions), kUnsupported (nothing is
// left after trimming; or the library's own reason), kNoMemory.
Result<PointSurface> surfaceOf(const points::PointCloud& cloud, points::SurfaceSettings said,
                               const OnSurfaceProgress& on_progress);

}  // namespace merlin::render::import
