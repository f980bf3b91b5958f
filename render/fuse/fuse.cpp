#include "render/fuse/fuse.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "render/fuse/blend.h"
#include "render/fuse/volume.h"
#include "render/mesh/non_manifold.h"
#include "render/range/geometry.h"

namespace merlin::render::fuse {
namespace {

constexpr double kSteps = 10;              // longest edge of a scan, in steps between its pixels
constexpr std::size_t kPixelBytes = 15;    // bytes per pixel of a View
constexpr std::size_t kMeshedBytes = 120;  // bytes per pixel while a View is constructed

double medianOf(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ViewSettings viewSettings(const range::RangeImage& scan, const FuseSettings& settings) {
  ViewSettings view;
  view.truncation = settings.truncation * settings.voxel;
  view.background_is_empty = settings.close && settings.background_is_empty;
  if (settings.max_edge)
    view.max_edge.length = static_cast<float>(*settings.max_edge);
  else
    view.max_edge.per_range = static_cast<float>(kSteps * range::stepOf(scan));
  return view;
}

Result<std::vector<View>> viewsOf(std::span<const range::RangeImage> scans, FuseSettings& settings,
                                  const range::Work& work) {
  std::size_t pixels = 0, most = 0;
  for (const range::RangeImage& scan : scans) {
    pixels += scan.pixels();
    most = std::max(most, scan.pixels());
  }
  const std::size_t need = pixels * kPixelBytes + most * kMeshedBytes;
  if (need > settings.memory)
    return Error{Errc::kInvalidArgument,
                 fmt::format("{} scans of {} pixels take {} MB besides their files; the limit "
                             "(--memory, by default the free memory) leaves {} MB: fuse fewer "
                             "scans, or give more memory",
                             scans.size(), pixels, need >> 20, settings.memory >> 20)};
  settings.memory -= pixels * kPixelBytes;
  std::vector<View> views;
  views.reserve(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto share = [&](std::size_t n) {
      return static_cast<double>(n) / static_cast<double>(scans.size());
    };
    views.emplace_back(scans[i], viewSettings(scans[i], settings),
                       range::partOf(work, share(i), share(i + 1)));
  }
  return views;
}

// Returns a grid that encloses all surfaces, with a margin for the truncation distance. Errors:
// kMalformed (no scan has a surface), kInvalidArgument (too many voxels along an axis).
Result<Grid> gridOf(std::span<const View> views, const FuseSettings& settings) {
  Grid grid{{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}, settings.voxel};
  std::size_t points = 0;
  for (const View& view : views) {
    view.forSurfacePoints([&](const Point& p) {
      ++points;
      for (std::size_t k = 0; k < 3; ++k) {
        grid.low[k] = std::min(grid.low[k], p[k]);
        grid.high[k] = std::max(grid.high[k], p[k]);
      }
    });
  }
  if (points == 0)
    return Error{Errc::kMalformed,
                 "the scans have no surface: no three neighbouring returns are as near to one "
                 "another as --max-edge asks"};
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double margin = (settings.truncation + 2) * settings.voxel;
    // Aligns the lattice to multiples of the voxel size in world coordinates, whatever the scans
    // are.
    grid.low[k] = std::floor((grid.low[k] - margin) / settings.voxel) * settings.voxel;
    grid.high[k] += margin;
    longest = std::max(longest, grid.high[k] - grid.low[k]);
  }
  constexpr double kMost = kMostCorners - 4 * kCells;
  if (longest / settings.voxel <= kMost) return grid;
  return Error{
      Errc::kInvalidArgument,
      fmt::format("voxels of {:.4g} make {:.3g} along an axis; allowed are {}: --voxel "
                  "{:.3g} would fit",
                  settings.voxel, longest / settings.voxel, kMost, 1.01 * longest / kMost)};
}

// Returns the keys of all vertices in ascending order, each once.
std::vector<std::uint64_t> keysOf(const std::vector<Piece>& pieces) {
  std::size_t count = 0;
  for (const Piece& piece : pieces) count += piece.keys.size();
  std::vector<std::uint64_t> keys;
  keys.reserve(count);
  for (const Piece& piece : pieces) keys.insert(keys.end(), piece.keys.begin(), piece.keys.end());
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

// Joins the pieces to one mesh: vertices on common sides become one.
mesh::Mesh meshOf(const std::vector<Piece>& pieces, const Grid& grid) {
  mesh::Mesh mesh;
  const std::vector<std::uint64_t> keys = keysOf(pieces);
  mesh.positions.resize(3 * keys.size());
  std::vector<std::uint32_t> numbers;
  for (const Piece& piece : pieces) {
    numbers.clear();
    for (std::size_t i = 0; i < piece.keys.size(); ++i) {
      const auto found = std::lower_bound(keys.begin(), keys.end(), piece.keys[i]);
      numbers.push_back(static_cast<std::uint32_t>(found - keys.begin()));
      const Edge edge = edgeOf(piece.keys[i]);
      const Point from = grid.at(edge.corner);
      for (std::size_t k = 0; k < 3; ++k) {
        const double along = edge.step[k] ? double{piece.places[i]} * grid.voxel : 0;
        mesh.positions[3 * std::size_t{numbers.back()} + k] = static_cast<float>(from[k] + along);
      }
    }
    for (const std::uint32_t v : piece.triangles) mesh.triangles.push_back(numbers[v]);
  }
  return mesh;
}

// Adds the feature "normal", weighted by the triangles' areas, because marching tetrahedra makes
// thin triangles, whose normals are inaccurate.
void addNormals(mesh::Mesh& mesh) {
  std::vector<double> sums(mesh.positions.size(), 0);
  const auto at = [&](std::size_t v) {
    const float* p = &mesh.positions[3 * v];
    return Point{double{p[0]}, double{p[1]}, double{p[2]}};
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Point a = at(mesh.triangles[t]);
    const Point n = cross(minus(at(mesh.triangles[t + 1]), a), minus(at(mesh.triangles[t + 2]), a));
    for (std::size_t i = 0; i < 9; ++i)
      sums[3 * std::size_t{mesh.triangles[t + i / 3]} + i % 3] += n[i % 3];
  }
  mesh::Feature normals{"normal", 3, std::vector<float>(sums.size(), 0)};
  for (std::size_t i = 0; i < sums.size(); i += 3) {
    const double length = std::hypot(sums[i], sums[i + 1], sums[i + 2]);
    for (std::size_t k = i; k < i + 3 && length > 0; ++k)
      normals.values[k] = static_cast<float>(sums[k] / length);
  }
  mesh.features.insert(mesh.features.begin(), std::move(normals));
}

}  // namespace

std::string faultOf(const range::RangeImage& scan) {
  const std::string fault = inverseFaultOf(scan);
  return fault.empty() ? range::faultOf(scan) : fault;
}

double voxelFor(std::span<const range::RangeImage> scans) {
  std::vector<double> steps;
  for (const range::RangeImage& scan : scans) {
    std::vector<double> ranges;
    for (const float r : scan.range) {
      if (range::isReturn(r)) ranges.push_back(double{r});
    }
    if (!ranges.empty()) steps.push_back(range::stepOf(scan) * medianOf(ranges));
  }
  return medianOf(steps);
}

Result<Fused> fuse(std::span<const range::RangeImage> scans, const FuseSettings& wanted,
                   const range::Work& work) {
  FuseSettings settings = wanted;
  const auto views = viewsOf(scans, settings, range::partOf(work, 0, 0.1));
  if (!views) return views.error();
  const auto grid = gridOf(*views, settings);
  if (!grid) return grid.error();
  std::size_t values = settings.close ? 1 : 0;
  for (const Blended& plane : blendedOf(*views)) values += plane.dimension;
  Volume volume(*views, settings, *grid, values);
  if (const auto found = volume.run(range::partOf(work, 0.1, 0.9)); !found) return found.error();
  Fused fused;
  fused.looked_at = volume.lookedAt();
  fused.blocks = volume.pieces().size();
  if (fused.blocks == 0)
    return Error{Errc::kMalformed,
                 fmt::format("no surface is left at voxels of {:.4g}: give a smaller --voxel",
                             settings.voxel)};
  fused.mesh = meshOf(volume.pieces(), *grid);
  volume.clearPieces();
  if (!settings.close) fused.split = mesh::splitNonManifold(fused.mesh).added;
  addNormals(fused.mesh);
  const Blending blending =
      blend(*views, settings.truncation * settings.voxel, work.threads, fused.mesh);
  fused.not_numbers = blending.without;
  fused.measured =
      static_cast<std::size_t>(std::count(blending.measured.begin(), blending.measured.end(), 1));
  if (settings.close)
    fused.mesh.features.push_back(
        {"measured", 1, {blending.measured.begin(), blending.measured.end()}});
  if (work.progress) work.progress(1);
  return fused;
}

}  // namespace merlin::render::fuse
