#include "render/correct/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace merlin::render::correct {
namespace {

constexpr int kFoldSteps = 8;    // samples per axis when a smooth cell is checked for folds
constexpr int kPatchSide = 64;   // minimum number of patches per axis
constexpr double kSlack = 1e-3;  // tolerance at the border of a patch, as a share of its size
constexpr Place kNowhere{std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::quiet_NaN()};

// Twice the signed area of the triangle a, b, c. Positive if the corners are in clockwise order (y
// points down), as the upper left, upper right and lower left corner of an unmirrored picture.
double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Returns whether the quadrilateral is convex and not mirrored: all four corner triangles have at
// least this double area. p: 00, 10, 01, 11.
bool isUpright(const std::array<Point, 4>& p, double least) {
  return turn(p[0], p[1], p[2]) > least && turn(p[1], p[3], p[0]) > least &&
         turn(p[3], p[2], p[1]) > least && turn(p[2], p[0], p[3]) > least;
}

}  // namespace

std::array<Point, 4> pinnedCorners(const CorrectionSettings& s, int width, int height) {
  const auto& c = s.corners;
  return {Point{c[0], c[1]}, Point{width + c[2], c[3]}, Point{c[4], height + c[5]},
          Point{width + c[6], height + c[7]}};
}

// A part of the uncorrected picture that is small enough to be nearly bilinear: its bounds in (u,
// v) and the positions of its corners on the output.
struct Warp::Patch {
  double u0, v0, u1, v1;
  std::array<Point, 4> corners;
  double left, top, right, bottom;  // bounds of the pixels that the patch may cover
};

Warp::Warp(const CorrectionSettings& settings, int width, int height, const MeasuredWarp* measured)
    : settings_(settings),
      measured_(measured),
      width_(width),
      height_(height),
      pin_(pinnedCorners(settings, width, height)),
      points_(meshPoints()) {}

std::vector<Point> Warp::meshPoints() const {
  std::vector<Point> points;
  for (const MeshPoint& p : settings_.mesh.points) points.push_back({p.x, p.y});
  return points;
}

std::optional<Point> Warp::land(Point meant) const noexcept {
  const MeshSettings& mesh = settings_.mesh;
  if (mesh.isOff()) return pin_.map(meant);
  const GridSurface surface(mesh.columns, mesh.rows, points_, mesh.interpolation);
  return pin_.map(surface.at(meant.x * (mesh.columns - 1), meant.y * (mesh.rows - 1)));
}

// The sign of a bilinear patch's Jacobian is determined by its corners, so the test of a bilinear
// cell is exact; a smooth cell is sampled at kFoldSteps x kFoldSteps places.
std::optional<Warp::Cell> Warp::fold() const {
  const MeshSettings& mesh = settings_.mesh;
  if (mesh.isOff()) return std::nullopt;
  const int steps = mesh.interpolation == MeshInterpolation::kBilinear ? 1 : kFoldSteps;
  const int columns = (mesh.columns - 1) * steps, rows = (mesh.rows - 1) * steps;
  const double least = 1e-6 * width_ * height_ / columns / rows;
  const auto at = [&](int i, int j) {
    return land({static_cast<double>(i) / columns, static_cast<double>(j) / rows});
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto a = at(i, j), b = at(i + 1, j), c = at(i, j + 1), d = at(i + 1, j + 1);
      if (!a || !b || !c || !d || !isUpright({*a, *b, *c, *d}, least))
        return Cell{i / steps, j / steps};
    }
  }
  return std::nullopt;
}

// Adds a border of patches, one pixel wide: pixels on the picture's border may show points up to a
// pixel outside it.
std::vector<Warp::Patch> Warp::patches() const {
  const auto bounds = [](int points, int pixels) {
    const int each = (kPatchSide + points - 2) / (points - 1), count = each * (points - 1);
    std::vector<double> all = {-1.0 / pixels};
    for (int i = 0; i <= count; ++i) all.push_back(static_cast<double>(i) / count);
    all.push_back(1 + 1.0 / pixels);
    return all;
  };
  const std::vector<double> u = bounds(settings_.mesh.columns, width_);
  const std::vector<double> v = bounds(settings_.mesh.rows, height_);
  std::vector<Patch> all;
  for (std::size_t j = 0; j + 1 < v.size(); ++j) {
    for (std::size_t i = 0; i + 1 < u.size(); ++i) {
      const auto a = land({u[i], v[j]}), b = land({u[i + 1], v[j]});
      const auto c = land({u[i], v[j + 1]}), d = land({u[i + 1], v[j + 1]});
      if (!a || !b || !c || !d) continue;
      const auto [left, right] = std::minmax({a->x, b->x, c->x, d->x});
      const auto [top, bottom] = std::minmax({a->y, b->y, c->y, d->y});
      const double bend = 1 + 0.1 * std::max(right - left, bottom - top);
      all.push_back({u[i],
                     v[j],
                     u[i + 1],
                     v[j + 1],
                     {*a, *b, *c, *d},
                     left - bend,
                     top - bend,
                     right + bend,
                     bottom + bend});
    }
  }
  return all;
}

// Simplified Newton's method: uses the mean derivatives of the whole patch, which is nearly
// bilinear; each step reduces the error to a few per cent.
std::optional<Point> Warp::solve(const Patch& p, Point pixel) const noexcept {
  constexpr int kMostSteps = 12;
  constexpr double kClose = 1e-4;  // [px]
  const auto& [p00, p10, p01, p11] = p.corners;
  const double ux = (p10.x - p00.x + p11.x - p01.x) / 2, uy = (p10.y - p00.y + p11.y - p01.y) / 2;
  const double vx = (p01.x - p00.x + p11.x - p10.x) / 2, vy = (p01.y - p00.y + p11.y - p10.y) / 2;
  const double det = ux * vy - uy * vx;
  double a = 0.5, b = 0.5;  // in shares of the patch
  for (int step = 0; step < kMostSteps; ++step) {
    const auto now = land({p.u0 + a * (p.u1 - p.u0), p.v0 + b * (p.v1 - p.v0)});
    if (!now) return std::nullopt;
    const double ex = pixel.x - now->x, ey = pixel.y - now->y;
    if (std::abs(ex) + std::abs(ey) < kClose) {
      const bool inside = a >= -kSlack && a <= 1 + kSlack && b >= -kSlack && b <= 1 + kSlack;
      if (!inside) return std::nullopt;
      return Point{p.u0 + a * (p.u1 - p.u0), p.v0 + b * (p.v1 - p.v0)};
    }
    a += (ex * vy - ey * vx) / det;
    b += (ey * ux - ex * uy) / det;
    if (!(std::abs(a - 0.5) < 2 && std::abs(b - 0.5) < 2)) return std::nullopt;
  }
  return std::nullopt;
}

void Warp::inverseRow(const std::vector<Patch>& patches, int y, Place* row) const {
  const double at = y + 0.5;
  for (const Patch& patch : patches) {
    if (at < patch.top || at > patch.bottom) continue;
    const int first = std::max(0, static_cast<int>(std::floor(patch.left)));
    const int last = std::min(width_ - 1, static_cast<int>(std::ceil(patch.right)));
    for (int x = first; x <= last; ++x) {
      if (!std::isnan(row[x].u)) continue;
      if (const auto found = solve(patch, {x + 0.5, at}))
        row[x] = {static_cast<float>(found->x), static_cast<float>(found->y)};
    }
  }
}

void Warp::placeRow(int y, Place* row) const {
  for (int x = 0; x < width_; ++x) {
    const auto square = pin_.unmap({x + 0.5, y + 0.5});
    if (!square) continue;
    Point place = *square;
    if (measured_) {
      const double reach = 1.0 / std::max(width_, height_);  // nothing was measured beyond
      if (!(place.x > -reach && place.x < 1 + reach && place.y > -reach && place.y < 1 + reach))
        continue;
      const GridSurface surface(measured_->columns, measured_->rows, measured_->places,
                                measured_->between);
      place = surface.at(place.x * measured_->columns - 0.5, place.y * measured_->rows - 0.5);
    }
    row[x] = {static_cast<float>(place.x), static_cast<float>(place.y)};
  }
}

std::vector<Place> Warp::places(Threads threads) const {
  const bool mesh = !measured_ && !settings_.mesh.isOff();
  const std::vector<Patch> all = mesh ? patches() : std::vector<Patch>{};
  std::vector<Place> places(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                            kNowhere);
  forBlocks(threads, static_cast<std::size_t>(height_), [&](std::size_t y) {
    Place* const row = &places[y * static_cast<std::size_t>(width_)];
    if (mesh)
      inverseRow(all, static_cast<int>(y), row);
    else
      placeRow(static_cast<int>(y), row);
  });
  return places;
}

}  // namespace merlin::render::correct
