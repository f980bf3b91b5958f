#include "render/scan/scan.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "daemon/base/random.h"
#include "render/compare/triangle_tree.h"
#include "render/range/geometry.h"
#include "render/scan/modalities.h"

namespace merlin::render::scan {
namespace {

using compare::TriangleTree;
using compare::Vector;

// Counts of the rays of one row: met the mesh; too oblique; return lost.
struct Counts {
  std::size_t met = 0, oblique = 0, lost = 0;
};

// Returns the absolute cosine of the angle between a ray and the triangle's normal.
double cosineOfIncidence(const std::array<Vector, 3>& corners, const Vector& direction) {
  const Vector normal = compare::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double lengths = std::sqrt(compare::squared(normal) * compare::squared(direction));
  return lengths > 0 ? std::min(std::abs(compare::dot(normal, direction)) / lengths, 1.0) : 0;
}

class Scanner {
 public:
  Scanner(const Scene& scene, const ScanSettings& settings, Scan& scan, const range::Work& work)
      : settings_(settings), scan_(scan), tree_(scene.mesh), modalities_(scene, scan.image) {
    scan.left_out = modalities_.leftOut();
    range::RangeImage unit;
    unit.width = scan.image.width;
    unit.height = scan.image.height;
    unit.range.assign(unit.pixels(), 1.0F);
    unit.geometry = scan.image.geometry;
    unit.geometry.T_world_scanner = range::kIdentity;
    rays_ = range::pointsOf(unit, range::partOf(work, 0, 0.1));
    first_random_ = Random(settings.seed).next();
  }

  Counts scanRow(std::size_t row) {
    Counts counts;
    for (std::size_t column = 0; column < scan_.image.width; ++column)
      scanPixel(row * scan_.image.width + column, counts);
    return counts;
  }

 private:
  void scanPixel(std::size_t pixel, Counts& counts) {
    const Vector direction = directionOf(pixel);
    const TriangleTree::Crossing met = tree_.firstAlong(compare::Ray(origin(), direction));
    if (met.place == TriangleTree::kNone) return;
    ++counts.met;
    const double cosine = cosineOfIncidence(tree_.cornersAt(met.place), direction);
    if (cosine < least_cosine_) {
      ++counts.oblique;
      return;
    }
    Random random(first_random_ + pixel);
    const double range = met.hit.distance + settings_.noise * random.normal();
    const bool lost = random.uniform() < settings_.drop_outs;
    if (lost || !(range > 0) || !(range <= double{range::kFarthest})) {
      ++counts.lost;
      return;
    }
    scan_.image.range[pixel] = static_cast<float>(range);
    modalities_.set(pixel, {tree_.triangleAt(met.place), met.hit.barycentric, cosine});
  }

  const range::Pose& pose() const { return scan_.image.geometry.T_world_scanner; }
  Vector origin() const { return {pose()[3], pose()[7], pose()[11]}; }
  Vector directionOf(std::size_t pixel) const {
    const Vector ray = compare::vectorAt(&rays_[3 * pixel]);
    const auto row = [&](std::size_t k) {
      return pose()[k] * ray.x() + pose()[k + 1] * ray.y() + pose()[k + 2] * ray.z();
    };
    return {row(0), row(4), row(8)};
  }

  const ScanSettings& settings_;
  Scan& scan_;
  TriangleTree tree_;
  Modalities modalities_;
  std::vector<float> rays_;  // pixels x 3: points at range 1, in scanner coordinates
  std::uint64_t first_random_ = 0;
  double least_cosine_ = std::cos(settings_.most_incidence_rad) - 1e-12;
};

}  // namespace

Result<Scan> scan(const Scene& scene, const ScanSettings& settings, const range::Work& work) {
  assert(settings.geometry.scanner != range::Scanner::kElevation);
  assert(settings.geometry.scanner != range::Scanner::kRays);
  Scan result;
  range::RangeImage& image = result.image;
  image.width = settings.width;
  image.height = settings.height;
  image.geometry = settings.geometry;
  if (const std::string fault = range::faultOf(image); !fault.empty())
    return Error{Errc::kInvalidArgument, fault};
  image.range.assign(image.pixels(), range::kNoReturn);
  Scanner scanner(scene, settings, result, work);
  std::vector<Counts> rows(image.height);
  range::forRows(range::partOf(work, 0.1, 1), image.height,
                 [&](std::size_t row) { rows[row] = scanner.scanRow(row); });
  for (const Counts& row : rows) {
    result.met += row.met;
    result.oblique += row.oblique;
    result.lost += row.lost;
  }
  if (result.met == 0) return Error{Errc::kMalformed, "none of the rays meets the mesh"};
  return result;
}

}  // namespace merlin::render::scan
