#include "render/compare/sampled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/base/random.h"

namespace merlin::render::compare {
namespace {

constexpr std::size_t kSampleBlock =
    4096;  // number of samples in a block; the sums of blocks are added later

// A point of a mesh, in the form in which features are interpolated.
struct SurfacePoint {
  const std::uint32_t* corners;  // the three vertices of its triangle
  std::array<double, 3> barycentric;
};

double valueAt(const mesh::Feature& feature, const SurfacePoint& at, std::size_t component) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t row = at.corners[k] * feature.dimension;
    sum += at.barycentric[k] * double{feature.values[row + component]};
  }
  return sum;
}

Vector vectorOf(const mesh::Feature& feature, const SurfacePoint& at) {
  return {valueAt(feature, at, 0), valueAt(feature, at, 1), valueAt(feature, at, 2)};
}

// Returns a normal whose length is twice the triangle's area.
Vector facetNormal(const std::array<Vector, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

struct Mean {
  double sum = 0;
  std::size_t count = 0;

  void add(double value) {
    sum += value;
    ++count;
  }
  void add(const Mean& other) {
    sum += other.sum;
    count += other.count;
  }
  double value() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
};

// Adds the square of the angle between a and b, unless one of them has length 0.
void addAngle(const Vector& a, const Vector& b, Mean& mean_deg2) {
  if (squared(a) == 0 || squared(b) == 0) return;
  const double angle_deg =
      std::atan2(std::sqrt(squared(cross(a, b))), dot(a, b)) * 180 / std::numbers::pi;
  mean_deg2.add(angle_deg * angle_deg);
}

struct Sums {
  Mean distance, distance2, facet_deg2, normal_deg2;
  std::vector<Mean> features2;

  void add(const Sums& other) {
    distance.add(other.distance);
    distance2.add(other.distance2);
    facet_deg2.add(other.facet_deg2);
    normal_deg2.add(other.normal_deg2);
    for (std::size_t i = 0; i < features2.size(); ++i) features2[i].add(other.features2[i]);
  }
};

struct Pair {
  const mesh::Feature* from = nullptr;
  const mesh::Feature* to = nullptr;
};

class Sampler {
 public:
  Sampler(const Surface& from, const Surface& to, const Sampling& sampling)
      : from_(from), to_(to), sampling_(sampling) {
    area_.reserve(from.tree.size() + 1);
    area_.push_back(0);
    for (std::uint32_t place = 0; place < from.tree.size(); ++place) {
      const double twice = std::sqrt(squared(facetNormal(from.tree.cornersAt(place))));
      area_.push_back(area_.back() + twice / 2);
    }
    for (const std::string& name : sampling.features)
      features_.push_back({from.mesh.find(name), to.mesh.find(name)});
    normals_ = {from.mesh.find("normal"), to.mesh.find("normal")};
    for (const mesh::Feature* normal : {normals_.from, normals_.to}) {
      if (!normal || normal->dimension != 3) normals_ = {};
    }
  }

  Sums none() const { return {{}, {}, {}, {}, std::vector<Mean>(features_.size())}; }

  // Adds samples kSampleBlock * block to kSampleBlock * (block + 1) - 1 to `sums`. REQUIRES: sums
  // equals none().
  void addBlock(std::size_t block, Sums& sums) const {
    // Each block has its own generator; next() makes neighbouring seeds independent.
    Random random(Random(sampling_.seed + block).next());
    const std::size_t first = block * kSampleBlock,
                      last = std::min(first + kSampleBlock, sampling_.samples);
    std::uint32_t place = 0, hint = TriangleTree::kNone;
    for (std::size_t i = first; i < last; ++i) {
      const double share =
          (static_cast<double>(i) + random.uniform()) / static_cast<double>(sampling_.samples);
      const double at = share * area_.back();
      if (i == first) place = placeAt(at);
      while (place + 1 < from_.tree.size() && !(at < area_[place + 1])) ++place;
      const double area = area_[place + 1] - area_[place];  // may be 0 for the last triangle
      const double within = area > 0 ? std::clamp((at - area_[place]) / area, 0.0, 1.0) : 0.0;
      hint = addSample(place, within, random.uniform(), hint, sums);
    }
  }

 private:
  std::uint32_t placeAt(double area) const {
    const auto after = std::upper_bound(area_.begin(), area_.end(), area) - area_.begin();
    return static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(after - 1, 0));
  }

  // Adds the sample at (u, v) of the unit square, which is mapped to the triangle at `place` with
  // uniform density. Returns the place of the nearest triangle of the other surface.
  std::uint32_t addSample(std::uint32_t place, double u, double v, std::uint32_t hint,
                          Sums& sums) const {
    const double root = std::sqrt(u);
    const std::array<double, 3> weights = {1 - root, root * (1 - v), root * v};
    const std::array<Vector, 3> corners = from_.tree.cornersAt(place);
    const Vector p = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    const TriangleTree::Nearest nearest = to_.tree.nearest(p, hint);
    sums.distance2.add(nearest.point.distance2);
    sums.distance.add(std::sqrt(nearest.point.distance2));
    addAngle(facetNormal(corners), facetNormal(to_.tree.cornersAt(nearest.place)), sums.facet_deg2);
    addFeatures({cornersOf(from_, place), weights},
                {cornersOf(to_, nearest.place), nearest.point.barycentric}, sums);
    return nearest.place;
  }

  void addFeatures(const SurfacePoint& a, const SurfacePoint& b, Sums& sums) const {
    if (normals_.from)
      addAngle(vectorOf(*normals_.from, a), vectorOf(*normals_.to, b), sums.normal_deg2);
    for (std::size_t f = 0; f < features_.size(); ++f) {
      for (std::size_t k = 0; k < features_[f].from->dimension; ++k) {
        const double difference =
            valueAt(*features_[f].from, a, k) - valueAt(*features_[f].to, b, k);
        sums.features2[f].add(difference * difference);
      }
    }
  }

  static const std::uint32_t* cornersOf(const Surface& surface, std::uint32_t place) {
    return &surface.mesh.triangles[3 * std::size_t{surface.tree.triangleAt(place)}];
  }

  const Surface& from_;
  const Surface& to_;
  const Sampling& sampling_;
  std::vector<double> area_;  // by place: total area of all triangles before it
  std::vector<Pair> features_;
  Pair normals_;
};

std::optional<double> rootOf(const Mean& squares) {
  if (squares.count == 0) return std::nullopt;
  return std::sqrt(squares.value());
}

SampledError errorOf(const Sums& sums) {
  SampledError error{std::sqrt(sums.distance2.value()),
                     sums.distance.value(),
                     rootOf(sums.facet_deg2),
                     rootOf(sums.normal_deg2),
                     {}};
  for (const Mean& squares : sums.features2) error.features.push_back(std::sqrt(squares.value()));
  return error;
}

}  // namespace

std::optional<SampledError> sampledError(const Surface& from, const Surface& to,
                                         const Sampling& sampling, const KeepGoing& keepGoing) {
  const Sampler sampler(from, to, sampling);
  const std::size_t blocks = (sampling.samples + kSampleBlock - 1) / kSampleBlock;
  std::vector<Sums> sums(blocks, sampler.none());
  const bool all = forBlocks(
      sampling.threads, blocks, [&](std::size_t block) { sampler.addBlock(block, sums[block]); },
      [&](std::size_t done) {
        return keepGoing(static_cast<double>(done) / static_cast<double>(blocks),
                         std::min(done * kSampleBlock, sampling.samples));
      });
  if (!all) return std::nullopt;
  Sums total = sampler.none();
  // Fixed order, so that the result does not depend on the threads.
  for (const Sums& s : sums) total.add(s);
  return errorOf(total);
}

double area(const mesh::Mesh& mesh) noexcept {
  double twice = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    std::array<Vector, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = vectorAt(&mesh.positions[3 * std::size_t{mesh.triangles[i + k]}]);
    twice += std::sqrt(squared(facetNormal(corners)));
  }
  return twice / 2;
}

}  // namespace merlin::render::compare
