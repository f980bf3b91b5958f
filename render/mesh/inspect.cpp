#include "render/mesh/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "render/mesh/coincident.h"
#include "render/mesh/disjoint_sets.h"
#include "render/mesh/parts.h"

namespace merlin::render::mesh {
namespace {

using Index = std::uint32_t;

constexpr double kUnitTolerance = 1e-3;

// The numbers 0 .. count - 1 grouped by a key below `keys`, ascending within a group. The numbers
// with key k are items[begin[k]] .. items[begin[k + 1] - 1].
struct Buckets {
  std::vector<Index> begin, items;

  template <typename KeyOf>
  Buckets(std::size_t keys, std::size_t count, const KeyOf& keyOf) : begin(keys + 1), items(count) {
    for (Index i = 0; i < count; ++i) ++begin[keyOf(i) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Index> at(begin.begin(), begin.end() - 1);
    for (Index i = 0; i < count; ++i) items[at[keyOf(i)]++] = i;
  }
};

bool isFinite(const float* p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

class Inspector {
 public:
  explicit Inspector(const Mesh& mesh) : mesh_(mesh) {}

  Inspection run() {
    lookAtVertices();
    joinPlaces();
    keepTriangles();
    dropDuplicates();
    DisjointSets corners(
        corners_.size());  // sets of corners at one vertex whose triangles are joined by edges
    lookAtEdges(corners);
    countFans(corners);
    joinBorders(corners);
    countParts();
    return std::move(result_);
  }

 private:
  const float* at(Index vertex) const { return &mesh_.positions[3 * std::size_t{vertex}]; }
  // Returns the next corner of the same triangle.
  static Index behind(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  std::size_t triangles() const { return corners_.size() / 3; }

  void lookAtVertices();
  void joinPlaces();
  void keepTriangles();
  void dropDuplicates();
  void lookAtEdges(DisjointSets& corners);
  void lookAtEdge(const Index* begin, const Index* end, DisjointSets& corners);
  void countFans(DisjointSets& corners);
  void joinBorders(DisjointSets& corners);
  void countParts();
  std::array<Index, 3> sortedCorners(Index triangle) const;

  const Mesh& mesh_;
  Inspection result_;
  std::vector<Index> place_;    // by vertex: the first vertex at its position
  std::vector<Index> corners_;  // corners of the triangles that count, as indices of places
  std::vector<Index> borders_;  // corners at which a border edge begins
};

void Inspector::lookAtVertices() {
  constexpr float kFar = std::numeric_limits<float>::max();
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  std::vector<bool> used(mesh_.vertexCount());
  for (const Index v : mesh_.triangles) used[v] = true;
  result_.isolated = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  for (Index v = 0; v < mesh_.vertexCount(); ++v) {
    if (!isFinite(at(v))) {
      ++result_.not_finite;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], at(v)[k]);
      box.high[k] = std::max(box.high[k], at(v)[k]);
    }
  }
  if (result_.not_finite < mesh_.vertexCount()) result_.box = box;
  const Feature* normal = mesh_.find("normal");
  if (!normal || normal->dimension != 3) return;
  for (std::size_t i = 0; i < normal->values.size(); i += 3) {
    const double length = std::sqrt(dot(&normal->values[i], &normal->values[i]));
    if (!(std::abs(length - 1) <= kUnitTolerance)) ++result_.not_unit;
  }
}

void Inspector::joinPlaces() {
  place_.resize(mesh_.vertexCount());
  std::iota(place_.begin(), place_.end(), 0U);
  if (result_.not_finite > 0) return;
  const std::vector<Index> next = coincidentVertices(mesh_.positions);
  for (Index v = 0; v < place_.size(); ++v) {
    if (place_[v] != v) continue;  // v belongs to a ring that was found before
    for (Index other = next[v]; other != v; other = next[other]) place_[other] = v;
  }
}

void Inspector::keepTriangles() {
  corners_.reserve(mesh_.triangles.size());
  for (std::size_t i = 0; i + 2 < mesh_.triangles.size(); i += 3) {
    const Index* t = &mesh_.triangles[i];
    const Index a = place_[t[0]], b = place_[t[1]], c = place_[t[2]];
    if (a == b || b == c || c == a) {
      ++result_.degenerate;
      continue;
    }
    const auto normal = faceNormal(at(a), at(b), at(c));
    if (normal == std::array<float, 3>{}) ++result_.no_area;
    corners_.insert(corners_.end(), {a, b, c});
  }
}

std::array<Index, 3> Inspector::sortedCorners(Index triangle) const {
  std::array<Index, 3> t{};
  std::copy_n(&corners_[3 * std::size_t{triangle}], 3, t.begin());
  std::sort(t.begin(), t.end());
  return t;
}

void Inspector::dropDuplicates() {
  Buckets by_least(place_.size(), triangles(), [&](Index t) { return sortedCorners(t)[0]; });
  std::vector<bool> drop(triangles());
  for (std::size_t v = 0; v < place_.size(); ++v) {
    Index* const begin = by_least.items.data() + by_least.begin[v];
    Index* const end = by_least.items.data() + by_least.begin[v + 1];
    if (end - begin < 2) continue;
    std::sort(begin, end, [&](Index s, Index t) {
      return std::pair(sortedCorners(s), s) < std::pair(sortedCorners(t), t);
    });
    for (Index* t = begin; t + 1 < end; ++t) {
      if (sortedCorners(t[0]) == sortedCorners(t[1])) drop[t[1]] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < drop.size(); ++t) {
    if (!drop[t]) std::copy_n(&corners_[3 * t], 3, &corners_[3 * kept++]);
  }
  result_.duplicate = drop.size() - kept;
  corners_.resize(3 * kept);
}

// Examines all edges. An edge is identified by the corner at which it begins. Edges are sorted by
// the smaller and then by the larger of their two places, so that edges between the same places are
// adjacent.
void Inspector::lookAtEdges(DisjointSets& corners) {
  const auto other = [&](Index c) { return std::max(corners_[c], corners_[behind(c)]); };
  Buckets edges(place_.size(), corners_.size(),
                [&](Index c) { return std::min(corners_[c], corners_[behind(c)]); });
  for (std::size_t v = 0; v < place_.size(); ++v) {
    Index* begin = edges.items.data() + edges.begin[v];
    Index* const end = edges.items.data() + edges.begin[v + 1];
    std::sort(begin, end,
              [&](Index a, Index b) { return std::pair(other(a), a) < std::pair(other(b), b); });
    while (begin != end) {
      const Index* const next =
          std::find_if(begin, end, [&, to = other(*begin)](Index c) { return other(c) != to; });
      lookAtEdge(begin, next, corners);
      begin += next - begin;
    }
  }
}

// Examines one edge between two places. [begin, end): for each of its triangles, the corner at
// which the edge begins.
void Inspector::lookAtEdge(const Index* begin, const Index* end, DisjointSets& corners) {
  const auto count = end - begin;
  if (count == 1) borders_.push_back(*begin);
  if (count > 2) ++result_.non_manifold_edges;
  const bool turned = count == 2 && corners_[begin[0]] == corners_[begin[1]];
  if (turned) ++result_.turned_edges;
  for (const Index* c = begin; c != end; ++c) {
    const bool same = corners_[*c] == corners_[*begin];
    corners.unite(*begin, same ? *c : behind(*c));
    corners.unite(behind(*begin), same ? behind(*c) : *c);
  }
}

void Inspector::countFans(DisjointSets& corners) {
  std::vector<std::uint8_t> fans(place_.size());
  for (Index c = 0; c < corners_.size(); ++c) {
    std::uint8_t& count = fans[corners_[c]];
    if (corners.rootOf(c) == c && count < 2) ++count;
  }
  result_.non_manifold_vertices = static_cast<std::size_t>(
      std::count_if(fans.begin(), fans.end(), [](std::uint8_t f) { return f > 1; }));
}

// Joins border edges to holes: the two border edges at the end of a fan of triangles follow each
// other.
void Inspector::joinBorders(DisjointSets& corners) {
  for (const Index c : borders_) corners.unite(c, behind(c));
  // 0: no hole yet; else its index in result_.holes + 1.
  std::vector<Index> hole_of(corners_.size());
  for (const Index c : borders_) {
    Index& hole = hole_of[corners.rootOf(c)];
    if (hole == 0) {
      result_.holes.emplace_back();
      hole = static_cast<Index>(result_.holes.size());
    }
    const float *a = at(corners_[c]), *b = at(corners_[behind(c)]);
    Hole& h = result_.holes[hole - 1];
    h.length += std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
    ++h.edges;
  }
  std::stable_sort(result_.holes.begin(), result_.holes.end(),
                   [](const Hole& a, const Hole& b) { return a.length > b.length; });
}

void Inspector::countParts() {
  if (triangles() == 0) return;
  const Parts parts = partsOf(mesh_);
  const Facing facing = facingOf(parts);
  result_.components = parts.parts.size();
  result_.closed = facing.closed;
  result_.inside_out = facing.inwards;
  for (const Part& part : parts.parts) result_.volume += part.volume;
}

}  // namespace

Inspection inspect(const Mesh& mesh) { return Inspector(mesh).run(); }

ValueRange rangeOf(const Feature& feature) {
  ValueRange range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
  for (const float value : feature.values) {
    if (!std::isfinite(value)) {
      ++range.not_numbers;
      continue;
    }
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  if (range.not_numbers == feature.values.size()) range.low = range.high = 0;
  return range;
}

}  // namespace merlin::render::mesh
