#include "render/import/point_surface.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/utility/Logging.h>

#include "render/points/orient_normals.h"

namespace merlin::render::import {
namespace {

namespace o3d = open3d::geometry;
using points::PointCloud;

constexpr std::size_t kLeastPoints = 10;
constexpr std::size_t kSpacingSamples = 10'000;
// Neighbours per point, including itself; at most kLeastPoints.
constexpr int kGraphNeighbours = 10;
constexpr int kSources = 4;  // number of points from which a vertex gets its features

// Maps the points to a cube of side 1, because Open3D computes with floats; so the file's unit does
// not matter.
struct UnitCube {
  explicit UnitCube(const PointCloud& cloud) {
    const mesh::Box box = mesh::boundingBox(cloud.positions);
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double low = double{box.low[axis]}, high = double{box.high[axis]};
      middle[k] = (low + high) / 2;
      side = std::max(side, high - low);
    }
  }
  Eigen::Vector3d into(const float* p) const {
    return (Eigen::Vector3d(p[0], p[1], p[2]) - middle) / side;
  }

  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double side = 0;
};

o3d::PointCloud cloudOf(const PointCloud& cloud, const UnitCube& cube) {
  o3d::PointCloud made;
  made.points_.reserve(cloud.size());
  for (std::size_t p = 0; p < cloud.size(); ++p)
    made.points_.push_back(cube.into(&cloud.positions[3 * p]));
  return made;
}

// Returns the median distance to the fourth neighbour. On a square grid this is the spacing; for
// the same number of points at random positions it is about the same, while the nearest neighbour
// is at half that distance.
double spacingOf(const o3d::PointCloud& cloud, const o3d::KDTreeFlann& tree) {
  // Index 0 is the point; others may be at the same position.
  constexpr int kFourth = 4, kLooked = 16;
  const std::size_t step = std::max<std::size_t>(1, cloud.points_.size() / kSpacingSamples);
  std::vector<double> distances, squared;
  std::vector<int> indices;
  for (std::size_t p = 0; p < cloud.points_.size(); p += step) {
    tree.SearchKNN(cloud.points_[p], kLooked, indices, squared);
    const auto other =
        std::find_if(squared.begin() + std::min<std::ptrdiff_t>(kFourth, std::ssize(squared)),
                     squared.end(), [](double d) { return d > 0; });
    if (other != squared.end()) distances.push_back(std::sqrt(*other));
  }
  return points::medianSpacing(std::move(distances));
}

// Returns kGraphNeighbours indices of neighbours per point, including the point itself.
std::vector<std::uint32_t> neighboursOf(const o3d::PointCloud& cloud,
                                        const o3d::KDTreeFlann& tree) {
  std::vector<std::uint32_t> neighbours;
  neighbours.reserve(kGraphNeighbours * cloud.points_.size());
  std::vector<int> indices;
  std::vector<double> squared;
  for (const Eigen::Vector3d& point : cloud.points_) {
    tree.SearchKNN(point, kGraphNeighbours, indices, squared);
    for (const int index : indices) neighbours.push_back(static_cast<std::uint32_t>(index));
  }
  return neighbours;
}

bool takeNormals(const PointCloud& cloud, o3d::PointCloud& to) {
  const mesh::Feature* normal = cloud.find("normal");
  if (!normal || normal->dimension != 3) return false;
  to.normals_.reserve(cloud.size());
  for (std::size_t p = 0; p < cloud.size(); ++p) {
    const float* n = &normal->values[3 * p];
    const Eigen::Vector3d v(n[0], n[1], n[2]);
    if (!(v.norm() > 0.5)) {  // an unknown normal
      to.normals_.clear();
      return false;
    }
    to.normals_.push_back(v.normalized());
  }
  return true;
}

// Adds normals to the cloud; returns a text for the user about their origin.
std::string addNormals(const PointCloud& cloud, const UnitCube& cube, const o3d::KDTreeFlann& tree,
                       int neighbours, o3d::PointCloud& to) {
  if (takeNormals(cloud, to)) return "of the file";
  to.EstimateNormals(o3d::KDTreeSearchParamKNN(neighbours));
  switch (cloud.side) {
    case points::Side::kViewpoint:
      to.OrientNormalsTowardsCameraLocation(cube.into(cloud.viewpoint.data()));
      return fmt::format("of {} neighbours, turned to the file's viewpoint", neighbours);
    case points::Side::kAbove:
      to.OrientNormalsToAlignWithDirection(Eigen::Vector3d(0, 0, 1));
      return fmt::format("of {} neighbours, turned upwards", neighbours);
    case points::Side::kUnknown: break;
  }
  const auto k = static_cast<std::size_t>(kGraphNeighbours);
  points::orientAlike(cloud.positions, neighboursOf(to, tree), k,
                      {to.normals_.front().data(), 3 * to.normals_.size()});
  return fmt::format("of {} neighbours, turned alike along the surface", neighbours);
}

// The points nearest to a vertex, nearest first, with their squared distances.
struct Sources {
  std::vector<int> points;
  std::vector<double> squared;
};

void mixFeature(const mesh::Feature& from, const Sources& sources, std::vector<float>& to) {
  const bool whole = from.name == "label";
  const auto nearest = static_cast<std::size_t>(sources.points.front()) * from.dimension;
  // Avoids a division by 0 if a vertex lies on a point.
  const double least = 1e-30 + 1e-6 * sources.squared.back();
  for (std::size_t k = 0; k < from.dimension; ++k) {
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < sources.points.size(); ++i) {
      const double weight = 1 / std::sqrt(sources.squared[i] + least);
      const auto p = static_cast<std::size_t>(sources.points[i]);
      sum += weight * double{from.values[p * from.dimension + k]};
      weights += weight;
    }
    to.push_back(whole ? from.values[nearest + k] : static_cast<float>(sum / weights));
  }
}

// Adds the vertices' positions and features; returns which vertices are within `trim` of a point.
std::vector<bool> addVertices(const o3d::TriangleMesh& made, const PointCloud& cloud,
                              const UnitCube& cube, const o3d::KDTreeFlann& tree,
                              PointSurface& surface) {
  mesh::Mesh& to = surface.mesh;
  const double trim = surface.settings.trim / cube.side;
  std::vector<const mesh::Feature*> from;
  for (const mesh::Feature& f : cloud.features) {
    if (f.name == "normal") continue;  // the surface gets its own normals
    from.push_back(&f);
    to.features.push_back({f.name, f.dimension, {}});
    to.features.back().values.reserve(made.vertices_.size() * f.dimension);
  }
  std::vector<bool> near(made.vertices_.size());
  Sources sources;
  for (std::size_t v = 0; v < made.vertices_.size(); ++v) {
    const Eigen::Vector3d& x = made.vertices_[v];
    for (int k = 0; k < 3; ++k)
      to.positions.push_back(static_cast<float>(x[k] * cube.side + cube.middle[k]));
    tree.SearchKNN(x, kSources, sources.points, sources.squared);
    near[v] = !(trim > 0) || sources.squared.front() <= trim * trim;
    for (std::size_t f = 0; f < from.size(); ++f)
      mixFeature(*from[f], sources, to.features[f].values);
  }
  return near;
}

void addTriangles(const o3d::TriangleMesh& made, const std::vector<bool>& near,
                  PointSurface& surface) {
  for (const Eigen::Vector3i& t : made.triangles_) {
    const bool kept = near[static_cast<std::size_t>(t[0])] &&
                      near[static_cast<std::size_t>(t[1])] && near[static_cast<std::size_t>(t[2])];
    surface.trimmed += !kept;
    for (int k = 0; kept && k < 3; ++k)
      surface.mesh.triangles.push_back(static_cast<std::uint32_t>(t[k]));
  }
}

// Adds a note if the cells of the octree are coarse. Points far away from the others make the cube
// large, and with it the cells.
void noteCoarseCells(double side, PointSurface& surface) {
  constexpr double kCoarse = 4;  // spacings
  const double cell = points::cellOf(surface.settings.depth, side);
  if (cell <= kCoarse * surface.spacing) return;
  surface.notes.push_back(
      fmt::format("the surface's cells are {:.6g} wide, but the points {:.6g} apart: give a larger "
                  "--depth (now {}), or a file without points that are far away from the others",
                  cell, surface.spacing, surface.settings.depth));
}

Result<PointSurface> reconstruct(const PointCloud& cloud, const points::SurfaceSettings& said,
                                 const OnSurfaceProgress& on_progress) {
  constexpr float kScale = 1.1F;  // side of the reconstruction's cube / side of the points' box
  constexpr int kOneThread = 1;   // several threads would add up in a different order each time
  const UnitCube cube(cloud);
  if (!(cube.side > 0))
    return Error{Errc::kMalformed, fmt::format("its {} points lie in one place", cloud.size())};
  o3d::PointCloud points = cloudOf(cloud, cube);
  const o3d::KDTreeFlann tree(points);
  PointSurface surface;
  surface.spacing = spacingOf(points, tree) * cube.side;
  if (!(surface.spacing > 0))
    return Error{Errc::kMalformed, fmt::format("its {} points lie in a few places", cloud.size())};
  surface.settings = points::guessed(said, cube.side, surface.spacing);
  noteCoarseCells(cube.side, surface);
  const auto items = static_cast<std::int64_t>(cloud.size());
  on_progress(0.1, items);
  surface.normals = addNormals(cloud, cube, tree, surface.settings.neighbours, points);
  on_progress(0.4, items);
  const auto [made, densities] = o3d::TriangleMesh::CreateFromPointCloudPoisson(
      points, static_cast<std::size_t>(surface.settings.depth), 0, kScale, false, kOneThread);
  on_progress(0.9, static_cast<std::int64_t>(made->triangles_.size()));
  const auto near = addVertices(*made, cloud, cube, tree, surface);
  addTriangles(*made, near, surface);
  if (!surface.mesh.triangles.empty()) return surface;
  return Error{Errc::kUnsupported,
               fmt::format("no surface lies within {:.6g} of its points (--trim), of octree depth "
                           "{}; give a larger --trim or --depth",
                           surface.settings.trim, surface.settings.depth)};
}

}  // namespace

Result<Ok> preparePoints(const char* /*program*/) {
  // Keeps stdout free for our output.
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  return Ok{};
}

Result<PointSurface> surfaceOf(const PointCloud& cloud, points::SurfaceSettings said,
                               const OnSurfaceProgress& on_progress) {
  if (cloud.size() < kLeastPoints)
    return Error{Errc::kMalformed, fmt::format("has {} points; a surface takes {} at least",
                                               cloud.size(), kLeastPoints)};
  try {
    return reconstruct(cloud, said, on_progress);
  } catch (const std::bad_alloc&) {
    return Error{Errc::kNoMemory,
                 fmt::format("a surface of its {} points does not fit into the memory; give more "
                             "by --memory, or a smaller --depth",
                             cloud.size())};
  } catch (const std::exception& thrown) {
    return Error{Errc::kUnsupported, fmt::format("no surface of its points: {}", thrown.what())};
  }
}

}  // namespace merlin::render::import
