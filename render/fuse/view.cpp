#include "render/fuse/view.h"

#include <algorithm>
#include <cmath>

#include "render/range/colours.h"
#include "render/range/geometry.h"
#include "render/range/triangulate.h"

namespace merlin::render::fuse {
namespace {

constexpr double kLeastConfidence = 1e-3;
// Largest distance behind a surface along the ray, in truncation distances, at which an inclined
// surface still counts; farther away it need not be plane any more.
constexpr double kDeepest = 3;
// Weight of space that is known to be free only from neighbouring rays.
constexpr double kBesides = 0.25;

double length(const Point& p) { return std::sqrt(dot(p, p)); }

}  // namespace

View::View(const range::RangeImage& image, const ViewSettings& settings, const range::Work& work)
    : image_(image), settings_(settings), projection_(image) {
  findSurface(work);
  if (settings.background_is_empty) findBackground();
  const range::Plane* plane = image.find("confidence");
  if (!plane || plane->dimension != 1) return;
  const double most = double{range::endsOf(plane->values).high};
  if (most > 0) confidence_ = plane, most_confidence_ = most;
}

// Finds the triangles of the scan's surface. They are the same as in `merlin mesh import`, since
// triangulate() makes both.
void View::findSurface(const range::Work& work) {
  cells_.assign(image_.pixels(), 0);
  on_surface_.assign(image_.pixels(), 0);
  const range::RangeMesh surface =
      range::triangulate(image_, range::pointsOf(image_, range::partOf(work, 0, 0.2)),
                         settings_.max_edge, range::partOf(work, 0.2, 0.8));
  const std::vector<std::uint32_t>& triangles = surface.mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    std::array<std::size_t, 3> rows{}, columns{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t pixel = surface.pixels[triangles[t + k]];
      on_surface_[pixel] = 1;
      rows[k] = pixel / image_.width;
      columns[k] = pixel % image_.width;
    }
    const std::size_t row = std::min({rows[0], rows[1], rows[2]});
    const std::size_t low = std::min({columns[0], columns[1], columns[2]});
    const std::size_t high = std::max({columns[0], columns[1], columns[2]});
    // The cell connects both ends of a full turn.
    const std::size_t column = high - low > 1 ? high : low;
    unsigned has = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool below = rows[k] != row, right = columns[k] != column;
      has |= 1U << (below ? (right ? 2 : 3) : (right ? 1 : 0));
    }
    cells_[row * image_.width + column] |= static_cast<std::uint8_t>(~has & 15U);
  }
  range::RangeImage own;  // the same image without the pose
  own.width = image_.width, own.height = image_.height;
  own.range = image_.range;
  own.geometry = image_.geometry;
  own.geometry.T_world_scanner = range::kIdentity;
  points_ = range::pointsOf(own, range::partOf(work, 0.8, 1));
}

// Marks the rays that met nothing. A ray counts as such if it lies in a window of 3 x 3 pixels
// without any return, so that single lost returns do not open tunnels.
void View::findBackground() {
  const std::size_t width = image_.width, height = image_.height;
  background_.assign(image_.pixels(), 0);
  const auto forWindow = [&](std::size_t row, std::size_t column, const auto& each) {
    for (std::size_t i = 0; i < 9; ++i) each((row + i / 3) * width + (column + i % 3) % width);
  };
  const std::size_t columns = image_.wraps() ? width : width - std::min(width, std::size_t{2});
  for (std::size_t row = 0; row + 2 < height; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      bool empty = true;
      forWindow(row, column,
                [&](std::size_t p) { empty = empty && !range::isReturn(image_.range[p]); });
      if (empty) forWindow(row, column, [&](std::size_t p) { background_[p] = 1; });
    }
  }
}

Point View::toScanner(const Point& world) const {
  const range::Pose& m = image_.geometry.T_world_scanner;
  const Point p = {world[0] - m[3], world[1] - m[7], world[2] - m[11]};
  Point scanner;
  for (std::size_t k = 0; k < 3; ++k) scanner[k] = m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2];
  return scanner;
}

Point View::toWorld(const Point& p) const {
  const range::Pose& m = image_.geometry.T_world_scanner;
  Point world;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &m[4 * k];
    world[k] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
  }
  return world;
}

std::array<std::uint32_t, 4> View::cornersAt(std::size_t row, std::size_t column) const {
  const std::size_t right = column + 1 < image_.width ? column + 1 : 0;
  const std::size_t top = row * image_.width, bottom = top + image_.width;
  return {static_cast<std::uint32_t>(top + column), static_cast<std::uint32_t>(top + right),
          static_cast<std::uint32_t>(bottom + right), static_cast<std::uint32_t>(bottom + column)};
}

Sight View::at(const Point& point) const {
  const Point p = toScanner(point);
  const auto place = projection_.at(p);
  if (!place) return {};
  const std::size_t last = image_.width - (image_.wraps() ? 1 : 2);
  const std::size_t column = std::min(static_cast<std::size_t>(place->column), last);
  const std::size_t row = std::min(static_cast<std::size_t>(place->row), image_.height - 2);
  const auto corners = cornersAt(row, column);
  const Place in_cell = {place->column - static_cast<double>(column),
                         place->row - static_cast<double>(row)};
  const std::uint8_t lacking = cells_[corners[0]];
  if (lacking != 0) {
    Sight sight = onTriangles(corners, lacking, p);
    if (sight.weight < 0) return besides(corners, in_cell, p);  // the ray misses the triangles
    if (sight.kind == Sight::Kind::kNear) sight.weight *= confidenceAt(sight);
    return sight;
  }
  return besides(corners, in_cell, p);
}

// Returns the sight of `p` relative to the triangle that the ray through `p` meets; its weight is
// negative if the ray meets none. lacking: bit k: the triangle without corner k exists.
Sight View::onTriangles(const std::array<std::uint32_t, 4>& corners, std::uint8_t lacking,
                        const Point& p) const {
  // Cells of a spinning scanner have curved sides, but its triangles have straight ones. So a ray
  // slightly beside a triangle still counts as meeting it.
  constexpr double kOutside = -0.02;
  Sight sight;
  double best = kOutside;
  sight.weight = -1;
  std::array<Point, 3> corner{};
  for (unsigned lacks = 0; lacks < 4; ++lacks) {
    if (!(lacking & 1U << lacks)) continue;
    std::array<std::uint32_t, 3> pixels{};
    for (unsigned k = 0; k < 3; ++k) pixels[k] = corners[(lacks + 1 + k) & 3U];
    const Point a = pointAt(pixels[0]), b = pointAt(pixels[1]), c = pointAt(pixels[2]);
    const Point shares = {dot(p, cross(b, c)), dot(a, cross(p, c)), dot(a, cross(b, p))};
    const double sum = shares[0] + shares[1] + shares[2];
    const double least = std::min({shares[0] / sum, shares[1] / sum, shares[2] / sum});
    if (!(least >= best)) continue;
    best = least;
    corner = {a, b, c};
    sight.pixels = pixels;
    sight.shares = {shares[0] / sum, shares[1] / sum, shares[2] / sum};
    sight.weight = 1;
  }
  return sight.weight < 0 ? sight : fromPlane(corner, p, sight);
}

// Completes the sight of `p` with its distance from the plane of these corners, and its kind and
// weight.
Sight View::fromPlane(const std::array<Point, 3>& corner, const Point& p, Sight sight) const {
  Point normal = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
  const double area = length(normal), far = length(p);
  if (!(area > 0) || !(far > 0)) return {};
  const double towards = dot(normal, p) > 0 ? -1 / area : 1 / area;
  for (double& x : normal) x *= towards;
  const double cosine = std::min(-dot(normal, p) / far, 1.0);
  sight.distance = dot(normal, minus(p, corner[0]));
  if (sight.distance >= settings_.truncation) {
    sight.kind = Sight::Kind::kFree;
    return sight;
  }
  // Depth behind the surface, in truncation distances.
  const double depth = -sight.distance / settings_.truncation;
  if (depth >= 1 || depth >= kDeepest * cosine) return {};
  sight.kind = Sight::Kind::kNear;
  sight.weight = cosine * cosine * (depth > 0 ? 1 - depth : 1);
  return sight;
}

// Returns the sight of `p` if its ray meets no surface in its cell: `p` is free if it is nearer
// than all returns of the cell, or if the ray of the nearest pixel met nothing.
Sight View::besides(const std::array<std::uint32_t, 4>& corners, const Place& in_cell,
                    const Point& p) const {
  Sight free;
  free.kind = Sight::Kind::kFree;
  free.weight = kBesides;
  double nearest = range::kFarthest;
  std::size_t returns = 0;
  for (const std::uint32_t pixel : corners) {
    if (!range::isReturn(image_.range[pixel])) continue;
    ++returns;
    nearest = std::min(nearest, length(pointAt(pixel)));
  }
  if (returns > 0 && length(p) < nearest - settings_.truncation) return free;
  if (background_.empty()) return {};
  const bool right = in_cell.column >= 0.5, below = in_cell.row >= 0.5;
  const std::uint32_t pixel = corners[below ? (right ? 2 : 3) : (right ? 1 : 0)];
  return background_[pixel] ? free : Sight{};
}

double View::confidenceAt(const Sight& sight) const {
  if (!confidence_) return 1;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += sight.shares[k] * double{confidence_->values[sight.pixels[k]]};
  const double share = sum / most_confidence_;
  return share > kLeastConfidence ? std::min(share, 1.0) : kLeastConfidence;  // NaN gives the least
}

}  // namespace merlin::render::fuse
