// Makes a surface of a point cloud, by Open3D, whose Poisson reconstruction is the code of M.
// Kazhdan [KAZHDAN13]. Only the program merlin-import links this, behind its sandbox.
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
  points::SurfaceSettings settings;  // those used
  double spacing = 0;                // median distance to the fourth neighbour
  std::size_t trimmed = 0;           // triangles that were too far from all points
  std::string normals;               // where they come from, for a person
  std::vector<std::string> notes;    // for the user
};

// Called with the part of the work that is done, 0..1, and the number of points or triangles.
using OnSurfaceProgress = std::function<void(double share, std::int64_t items)>;

// Quiets the library. To be called once, before the sandbox closes.
Result<Ok> preparePoints(const char* program);

// Normals are the cloud's own; else they are estimated from the nearest neighbours and turned to
// the viewpoint, upwards (kAbove), or consistently along the surface [HOPPE92]. The features of a
// vertex are the mean of the four nearest points', by inverse distance; a label is the nearest
// one's. The same cloud gives the same mesh. Errors: kMalformed (fewer than ten points, points in
// a few places), kUnsupported (nothing is left within the trim; the library's own reason), kIo (the
// memory does not suffice).
Result<PointSurface> surfaceOf(const points::PointCloud& cloud, points::SurfaceSettings said,
                               const OnSurfaceProgress& on_progress);

}  // namespace merlin::render::import
