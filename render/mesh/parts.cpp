#include "render/mesh/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/mesh/coincident.h"
#include "render/mesh/disjoint_sets.h"

namespace merlin::render::mesh {
namespace {

// Minimum thickness of a closed part, in diagonals of its box.
constexpr double kThinnest = 1e-7;
constexpr double kSameVolume = 1 + 1e-6;  // tolerated ratio of the volumes of a surface's two sides
constexpr std::size_t kMostComparisons = 1'000'000'000;  // limit of box comparisons: a few seconds

using Vector = std::array<double, 3>;

Vector difference(const float* to, const float* from) {
  return {double{to[0]} - from[0], double{to[1]} - from[1], double{to[2]} - from[2]};
}

double product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Returns the normal of the triangle with these corners; its length is twice the triangle's area.
Vector areaNormal(const float* a, const float* b, const float* c) {
  const Vector u = difference(b, a), v = difference(c, a);
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

bool holds(const Box& outer, const Box& inner) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (inner.low[k] < outer.low[k] || inner.high[k] > outer.high[k]) return false;
  }
  return true;
}

class PartFinder {
 public:
  // Allocates kByVertex bytes for each vertex.
  PartFinder(const Mesh& mesh, std::size_t most_bytes)
      : mesh_(mesh),
        most_bytes_(most_bytes),
        sets_(mesh.vertexCount()),
        ends_(mesh.vertexCount()) {}

  // Bytes per vertex: sets_, ends_, and hashes or part_of.
  static constexpr std::size_t kByVertex = 12;
  // Bytes per part: parts, first_, the area, boxes_, and the order and the list of the search for
  // inner walls.
  static constexpr std::size_t kByPart = sizeof(Part) + 4 + 8 + sizeof(Box) + 8 + 8;

  // Finds the parts; returns nothing if that would take more memory than allowed.
  std::optional<Parts> run() {
    connect();
    if (!joinEnds() || !numberParts()) return std::nullopt;
    findClosed();
    const bool any = std::any_of(result_.parts.begin(), result_.parts.end(),
                                 [](const Part& part) { return part.closed; });
    if (any) {
      measure();
      findInwards();
    }
    return std::move(result_);
  }

 private:
  const float* at(std::uint32_t vertex) const { return &mesh_.positions[3 * std::size_t{vertex}]; }

  bool hasCornersAtOnePlace(const std::uint32_t* triangle) const;
  void connect();
  bool joinEnds();
  bool numberParts();
  void findClosed();
  void measure();
  void findBoxes();
  void dropThin(const std::vector<double>& area);
  std::size_t sweepAxis(const std::vector<std::size_t>& closed) const;
  void findInwards();

  const Mesh& mesh_;
  std::size_t most_bytes_;  // limit of memory [bytes]
  Parts result_;
  DisjointSets sets_;  // sets of connected vertices
  // By vertex: the sum of the hashes of the vertices to which edges lead from it, minus the hashes
  // of the vertices from which edges lead to it. The value is 0 where the triangles around a vertex
  // close up.
  std::vector<std::uint32_t> ends_;
  std::vector<std::uint32_t> first_;  // by part: one of its vertices
  std::vector<Box> boxes_;            // by part: bounding box of a closed part
};

bool PartFinder::hasCornersAtOnePlace(const std::uint32_t* triangle) const {
  const auto same = [&](std::uint32_t v, std::uint32_t w) {
    return std::equal(at(v), at(v) + 3, at(w));
  };
  return same(triangle[0], triangle[1]) || same(triangle[1], triangle[2]) ||
         same(triangle[2], triangle[0]);
}

void PartFinder::connect() {
  std::vector<std::uint32_t> hash(mesh_.vertexCount());
  for (std::uint32_t v = 0; v < hash.size(); ++v)
    hash[v] = static_cast<std::uint32_t>(hashOfPlace(at(v)));
  for (std::size_t i = 0; i + 2 < mesh_.triangles.size(); i += 3) {
    const std::uint32_t* t = &mesh_.triangles[i];
    const std::uint32_t a = hash[t[0]], b = hash[t[1]], c = hash[t[2]];
    if ((a == b || b == c || c == a) && hasCornersAtOnePlace(t)) continue;
    sets_.unite(sets_.unite(t[0], t[1]), t[2]);
    ends_[t[0]] += b - c;
    ends_[t[1]] += c - a;
    ends_[t[2]] += a - b;
  }
}

// Connects coincident vertices where the surface ends, and accumulates the sums in ends_ at the
// last of them. Returns false if that takes too much memory.
bool PartFinder::joinEnds() {
  std::vector<std::uint32_t> vertices;
  std::vector<float> positions;
  const std::size_t ends =
      ends_.size() - static_cast<std::size_t>(std::count(ends_.begin(), ends_.end(), 0U));
  constexpr std::size_t kByEnd = 4 + 12;  // bytes per entry of `vertices` and `positions`
  if (8 * ends_.size() + kByEnd * ends + bytesForCoincident(ends) > most_bytes_) return false;
  vertices.reserve(ends);
  positions.reserve(3 * ends);
  for (std::uint32_t v = 0; v < ends_.size(); ++v) {
    if (ends_[v] == 0) continue;
    vertices.push_back(v);
    positions.insert(positions.end(), at(v), at(v) + 3);
  }
  if (!std::all_of(positions.begin(), positions.end(), [](float x) { return std::isfinite(x); }))
    return true;
  const std::vector<std::uint32_t> next = coincidentVertices(positions);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (next[i] <= i) continue;
    sets_.unite(vertices[i], vertices[next[i]]);
    ends_[vertices[next[i]]] += std::exchange(ends_[vertices[i]], 0);
  }
  return true;
}

// Numbers the parts. Returns false if there are so many that they take too much memory.
bool PartFinder::numberParts() {
  std::vector<std::uint32_t>& part_of = result_.part_of;
  part_of.assign(mesh_.vertexCount(), Parts::kNone);
  std::uint32_t parts = 0;
  for (std::uint32_t v = 0; v < part_of.size(); ++v) {
    const std::uint32_t root = sets_.rootOf(v);
    if (root == v) continue;  // the next vertex of its set gives it a number
    if (part_of[root] == Parts::kNone) part_of[root] = parts++;
    part_of[v] = part_of[root];
  }
  if (kByVertex * part_of.size() + kByPart * parts > most_bytes_) return false;
  result_.parts.resize(parts);
  first_.resize(parts);
  for (std::uint32_t v = 0; v < part_of.size(); ++v) {
    if (part_of[v] != Parts::kNone && sets_.rootOf(v) == v) first_[part_of[v]] = v;
  }
  return true;
}

void PartFinder::findClosed() {
  for (Part& part : result_.parts) part.closed = true;
  for (std::uint32_t v = 0; v < ends_.size(); ++v) {
    if (ends_[v] != 0) result_.parts[result_.part_of[v]].closed = false;
  }
}

// Computes the volume and the area of each closed part. Consecutive triangles mostly belong to the
// same part, so a part's totals are updated only once per such run. The area is up to 1.7 times too
// large, since a sum of coordinates is cheaper than a length.
void PartFinder::measure() {
  std::vector<double> area(result_.parts.size());
  const std::vector<std::uint32_t>& t = mesh_.triangles;
  for (std::size_t i = 0; i + 2 < t.size();) {
    const std::uint32_t p = result_.part_of[t[i]];
    const bool counts = p != Parts::kNone && result_.parts[p].closed;
    const float* const origin = counts ? at(first_[p]) : nullptr;
    double volume = 0, twice = 0;
    const std::size_t begin = i;
    for (; i + 2 < t.size() && result_.part_of[t[i]] == p; i += 3) {
      if (!counts) continue;
      const Vector normal = areaNormal(at(t[i]), at(t[i + 1]), at(t[i + 2]));
      twice += std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
      volume += product(difference(at(t[i]), origin), normal);
    }
    if (!counts) continue;
    area[p] += twice / 2;
    result_.parts[p].volume += volume / 6;
    result_.parts[p].triangles += (i - begin) / 3;
  }
  findBoxes();
  dropThin(area);
}

void PartFinder::findBoxes() {
  constexpr float kFar = std::numeric_limits<float>::max();
  boxes_.assign(result_.parts.size(), {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}});
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v) {
    const std::uint32_t p = result_.part_of[v];
    if (p == Parts::kNone || !result_.parts[p].closed) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      boxes_[p].low[k] = std::min(boxes_[p].low[k], at(v)[k]);
      boxes_[p].high[k] = std::max(boxes_[p].high[k], at(v)[k]);
    }
  }
}

// Marks closed parts without thickness as not closed.
void PartFinder::dropThin(const std::vector<double>& area) {
  for (std::size_t p = 0; p < result_.parts.size(); ++p) {
    Part& part = result_.parts[p];
    if (!part.closed) continue;
    part.closed = std::abs(part.volume) > kThinnest * area[p] * double{boxes_[p].diagonal()};
    if (!part.closed) part = {};
  }
}

// Returns the axis along which the boxes of the closed parts overlap least.
std::size_t PartFinder::sweepAxis(const std::vector<std::size_t>& closed) const {
  std::array<double, 3> overlap{};
  for (std::size_t k = 0; k < 3; ++k) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const std::size_t p : closed) {
      low = std::min(low, double{boxes_[p].low[k]});
      high = std::max(high, double{boxes_[p].high[k]});
      overlap[k] += double{boxes_[p].high[k]} - boxes_[p].low[k];
    }
    overlap[k] = high > low ? overlap[k] / (high - low) : std::numeric_limits<double>::max();
  }
  return static_cast<std::size_t>(std::min_element(overlap.begin(), overlap.end()) -
                                  overlap.begin());
}

// Sweeps over the closed parts along one axis. The list `outer` holds the parts that face outwards
// and whose boxes may still contain later parts.
void PartFinder::findInwards() {
  std::vector<Part>& parts = result_.parts;
  std::vector<std::size_t> order, outer;
  std::size_t left = kMostComparisons;
  order.reserve(static_cast<std::size_t>(
      std::count_if(parts.begin(), parts.end(), [](const Part& part) { return part.closed; })));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].closed) order.push_back(p);
  }
  outer.reserve(order.size());
  const std::size_t axis = sweepAxis(order);
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    return std::pair(boxes_[p].low[axis], -parts[p].volume) <
           std::pair(boxes_[q].low[axis], -parts[q].volume);
  });
  for (const std::size_t p : order) {
    if (parts[p].volume > 0) {
      outer.push_back(p);
      continue;
    }
    if (outer.size() > left) return;  // the remaining parts count as inner walls
    left -= outer.size();
    std::erase_if(outer, [&](std::size_t o) { return boxes_[o].high[axis] < boxes_[p].low[axis]; });
    parts[p].inwards = std::none_of(outer.begin(), outer.end(), [&](std::size_t o) {
      return parts[o].volume * kSameVolume >= -parts[p].volume && holds(boxes_[o], boxes_[p]);
    });
  }
}

bool facesInwards(const Parts& parts, std::uint32_t vertex) {
  const std::uint32_t part = parts.part_of[vertex];
  return part != Parts::kNone && parts.parts[part].inwards;
}

// For each part that faces inwards, negates the "normal" values if most of them point to the side
// to which its triangles face.
void turnNormals(const Parts& parts, const std::vector<float>& positions,
                 const std::vector<std::uint32_t>& triangles, std::vector<float>& normals) {
  std::vector<double> agree(parts.parts.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::uint32_t* t = &triangles[i];
    if (!facesInwards(parts, t[0])) continue;
    const auto at = [&](int corner) { return &positions[3 * std::size_t{t[corner]}]; };
    const Vector facing = areaNormal(at(0), at(1), at(2));
    for (int corner = 0; corner < 3; ++corner) {
      const float* n = &normals[3 * std::size_t{t[corner]}];
      agree[parts.part_of[t[0]]] += product(facing, {double{n[0]}, double{n[1]}, double{n[2]}});
    }
  }
  for (std::uint32_t v = 0; v < parts.part_of.size(); ++v) {
    if (!facesInwards(parts, v) || !(agree[parts.part_of[v]] > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      normals[3 * std::size_t{v} + k] = -normals[3 * std::size_t{v} + k];
  }
}

}  // namespace

std::optional<Parts> partsWithin(std::size_t most_bytes, const Mesh& mesh) {
  if (PartFinder::kByVertex * mesh.vertexCount() > most_bytes) return std::nullopt;
  return PartFinder(mesh, most_bytes).run();
}

Parts partsOf(const Mesh& mesh) {
  return *partsWithin(std::numeric_limits<std::size_t>::max(), mesh);
}

Facing facingOf(const Parts& parts) {
  Facing facing;
  for (const Part& part : parts.parts) {
    facing.closed += part.closed;
    facing.inwards += part.inwards;
    if (part.inwards) facing.triangles += part.triangles;
  }
  return facing;
}

void turnOutwards(const Parts& parts, Mesh& mesh) {
  if (Feature* normal = mesh.find("normal"); normal && normal->dimension == 3)
    turnNormals(parts, mesh.positions, mesh.triangles, normal->values);
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    std::uint32_t* t = &mesh.triangles[i];
    if (facesInwards(parts, t[0])) std::swap(t[1], t[2]);
  }
}

}  // namespace merlin::render::mesh
