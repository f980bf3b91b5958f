#include "render/compare/triangle_tree.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace merlin::render::compare {
namespace {

constexpr std::uint32_t kLeaf = 4;  // maximum number of triangles in a leaf
constexpr std::size_t kBins = 16;
// From this depth on, triangles are split into equal halves, so that no tree is deeper than
// kDeepest.
constexpr int kUneven = 60;
constexpr std::size_t kDeepest = kUneven + 32;

struct Bounds {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<float, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void add(const Bounds& b) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], b.low[k]);
      high[k] = std::max(high[k], b.high[k]);
    }
  }
  float centre(std::size_t axis) const noexcept { return low[axis] / 2 + high[axis] / 2; }
  // Returns half the surface area of the box; 0 if the box is empty.
  double area() const noexcept {
    if (low[0] > high[0]) return 0;
    const double x = double{high[0]} - low[0], y = double{high[1]} - low[1],
                 z = double{high[2]} - low[2];
    return x * y + y * z + z * x;
  }
};

struct Reference {
  Bounds bounds;
  std::uint32_t triangle = 0;
};
using References = std::vector<Reference>;

Bounds boundsOf(const mesh::Mesh& mesh, std::size_t triangle) {
  Bounds bounds;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const float* p = &mesh.positions[3 * std::size_t{mesh.triangles[3 * triangle + corner]}];
    bounds.add({{p[0], p[1], p[2]}, {p[0], p[1], p[2]}});
  }
  return bounds;
}

struct Bin {
  Bounds bounds;
  std::size_t count = 0;
};
using Bins = std::array<Bin, kBins>;

// Returns the index of the bin before which a cut has the lowest cost; 0 if one bin holds all
// triangles.
std::size_t cheapestCut(const Bins& bins) {
  std::array<double, kBins> above{};  // cost of the triangles in this bin and all later ones
  Bin sum;
  for (std::size_t i = kBins; i-- > 1;) {
    sum.bounds.add(bins[i].bounds);
    sum.count += bins[i].count;
    above[i] = sum.bounds.area() * static_cast<double>(sum.count);
  }
  const std::size_t all = sum.count + bins[0].count;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  sum = {};
  for (std::size_t i = 1; i < kBins; ++i) {
    sum.bounds.add(bins[i - 1].bounds);
    sum.count += bins[i - 1].count;
    const double cost = sum.bounds.area() * static_cast<double>(sum.count) + above[i];
    if (sum.count == 0 || sum.count == all || !(cost < least)) continue;
    least = cost;
    best = i;
  }
  return best;
}

// Returns the squared distances from p to the boxes of both children; infinite for an empty box.
template <typename Node>
std::array<double, 2> boxDistances(const Node& node, const Vector& p) noexcept {
  const double at[3] = {p.x(), p.y(), p.z()};
  std::array<double, 2> sum{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double below = double{node.low[axis][side]} - at[axis];
      const double above = at[axis] - double{node.high[axis][side]};
      const double out = std::max(std::max(below, above), 0.0);
      sum[side] += out * out;
    }
  }
  return sum;
}

// Returns the distances at which the ray enters the boxes of both children; infinite if the ray
// misses the box or the box is empty.
template <typename Node>
std::array<double, 2> boxEntries(const Node& node, const Ray& ray) noexcept {
  std::array<double, 2> entries{};
  for (std::size_t side = 0; side < 2; ++side) {
    const std::array<float, 3> low = {node.low[0][side], node.low[1][side], node.low[2][side]};
    const std::array<float, 3> high = {node.high[0][side], node.high[1][side], node.high[2][side]};
    entries[side] =
        low[0] > high[0] ? std::numeric_limits<double>::infinity() : ray.entry(low, high);
  }
  return entries;
}

}  // namespace

class TriangleTree::Builder {
 public:
  Builder(const mesh::Mesh& mesh, TriangleTree& tree)
      : nodes_(tree.nodes_), all_(mesh.triangleCount()) {
    for (std::size_t t = 0; t < all_.size(); ++t)
      all_[t] = {boundsOf(mesh, t), static_cast<std::uint32_t>(t)};
    nodes_.reserve(all_.size() / 2 + 1);
    const auto count = static_cast<std::uint32_t>(all_.size());
    build(0, count, 0);
  }

  const References& references() const noexcept { return all_; }

 private:
  // Builds a node over the triangles [first, last); returns the index of the node.
  std::uint32_t build(std::uint32_t first, std::uint32_t last, int depth) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    const std::uint32_t middle = last - first <= kLeaf ? last : split(first, last, depth);
    const std::uint32_t range[] = {first, middle, last};
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t from = range[side], to = range[side + 1], count = to - from;
      setBox(nodes_[number], side, from, to);
      nodes_[number].count[side] = count <= kLeaf ? count : 0;
      // An empty side is a leaf without triangles, whose box is infinitely far away.
      const std::uint32_t child = count <= kLeaf ? from : build(from, to, depth + 1);
      nodes_[number].child[side] = child;
    }
    return number;
  }

  void setBox(Node& node, int side, std::uint32_t from, std::uint32_t to) const {
    Bounds bounds;
    for (std::uint32_t i = from; i < to; ++i) bounds.add(all_[i].bounds);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis][side] = bounds.low[axis];
      node.high[axis][side] = bounds.high[axis];
    }
  }

  // Divides [first, last) into two non-empty parts; returns the index where the second part begins.
  std::uint32_t split(std::uint32_t first, std::uint32_t last, int depth) {
    Bounds centres;
    for (std::uint32_t i = first; i < last; ++i) {
      const Bounds& b = all_[i].bounds;
      const std::array<float, 3> c = {b.centre(0), b.centre(1), b.centre(2)};
      centres.add({c, c});
    }
    std::size_t axis = 0;
    const auto extent = [&](std::size_t k) { return double{centres.high[k]} - centres.low[k]; };
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
      if (extent(k) > extent(axis)) axis = k;
    }
    const std::uint32_t half = first + (last - first) / 2;
    if (depth < kUneven && extent(axis) > 0) {
      const std::uint32_t at = splitByArea(first, last, axis, centres.low[axis], extent(axis));
      if (at != first) return at;
    }
    std::nth_element(at(first), at(half), at(last), [axis](const auto& a, const auto& b) {
      return a.bounds.centre(axis) < b.bounds.centre(axis);
    });
    return half;
  }

  // Divides the triangles at the cheapest cut. Returns `first` if no cut leaves triangles on both
  // sides.
  std::uint32_t splitByArea(std::uint32_t first, std::uint32_t last, std::size_t axis, double low,
                            double extent) {
    const auto binOf = [&](const Reference& r) {
      const double share = (double{r.bounds.centre(axis)} - low) / extent;
      return std::min(static_cast<std::size_t>(share * kBins), kBins - 1);
    };
    Bins bins;
    for (std::uint32_t i = first; i < last; ++i) {
      Bin& bin = bins[binOf(all_[i])];
      bin.bounds.add(all_[i].bounds);
      ++bin.count;
    }
    const std::size_t cut = cheapestCut(bins);
    if (cut == 0) return first;
    const auto second =
        std::partition(at(first), at(last), [&](const Reference& r) { return binOf(r) < cut; });
    return static_cast<std::uint32_t>(second - all_.begin());
  }

  References::iterator at(std::uint32_t i) { return all_.begin() + static_cast<std::ptrdiff_t>(i); }

  std::vector<Node>& nodes_;
  References all_;
};

TriangleTree::TriangleTree(const mesh::Mesh& mesh) {
  assert(mesh.triangleCount() > 0);
  const Builder builder(mesh, *this);
  order_.reserve(mesh.triangleCount());
  corners_.reserve(9 * mesh.triangleCount());
  for (const Reference& r : builder.references()) {
    order_.push_back(r.triangle);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const float* p =
          &mesh.positions[3 * std::size_t{mesh.triangles[3 * std::size_t{r.triangle} + corner]}];
      corners_.insert(corners_.end(), p, p + 3);
    }
  }
}

std::array<Vector, 3> TriangleTree::cornersAt(std::uint32_t place) const noexcept {
  const float* p = &corners_[9 * std::size_t{place}];
  return {vectorAt(p), vectorAt(p + 3), vectorAt(p + 6)};
}

void TriangleTree::nearestOfLeaf(const Node& node, int side, const Vector& p,
                                 Nearest& best) const noexcept {
  const std::uint32_t first = node.child[side];
  for (std::uint32_t place = first; place < first + node.count[side]; ++place) {
    const NearestPoint candidate = nearestAt(place, p);
    if (candidate.distance2 < best.point.distance2) best = {candidate, place};
  }
}

void TriangleTree::firstOfLeaf(const Node& node, int side, const Ray& ray,
                               Crossing& best) const noexcept {
  const std::uint32_t first = node.child[side];
  for (std::uint32_t place = first; place < first + node.count[side]; ++place) {
    const auto hit = ray.hit(cornersAt(place));
    if (hit && hit->distance < best.hit.distance) best = {*hit, place};
  }
}

template <typename DistancesOf, typename VisitLeaf>
void TriangleTree::walk(const DistancesOf& distancesOf, const double& limit,
                        const VisitLeaf& visitLeaf) const noexcept {
  struct Pending {
    std::uint32_t node;
    double distance;
  };
  std::array<Pending, kDeepest> stack;  // NOLINT: filled before it is read
  std::size_t pending = 0;
  stack[pending++] = {0, 0.0};
  while (pending > 0) {
    const Pending next = stack[--pending];
    if (!(next.distance < limit)) continue;
    const Node& node = nodes_[next.node];
    const std::array<double, 2> distances = distancesOf(node);
    const int nearer = distances[1] < distances[0] ? 1 : 0;
    const auto isInner = [&](int side) { return node.count[side] == 0; };
    const auto isNear = [&](int side) { return distances[static_cast<std::size_t>(side)] < limit; };
    for (const int side : {nearer, 1 - nearer}) {
      if (!isInner(side) && isNear(side)) visitLeaf(node, side);
    }
    // The nearer child is pushed last, so it is visited next.
    for (const int side : {1 - nearer, nearer}) {
      if (isInner(side) && isNear(side))
        stack[pending++] = {node.child[side], distances[static_cast<std::size_t>(side)]};
    }
  }
}

TriangleTree::Nearest TriangleTree::nearest(const Vector& p, std::uint32_t hint) const noexcept {
  Nearest best{{std::numeric_limits<double>::infinity(), {}}, kNone};
  if (hint != kNone) best = {nearestAt(hint, p), hint};
  walk([&](const Node& node) { return boxDistances(node, p); }, best.point.distance2,
       [&](const Node& node, int side) { nearestOfLeaf(node, side, p, best); });
  return best;
}

TriangleTree::Crossing TriangleTree::firstAlong(const Ray& ray) const noexcept {
  Crossing best{{std::numeric_limits<double>::infinity(), {}}, kNone};
  walk([&](const Node& node) { return boxEntries(node, ray); }, best.hit.distance,
       [&](const Node& node, int side) { firstOfLeaf(node, side, ray, best); });
  return best;
}

}  // namespace merlin::render::compare
