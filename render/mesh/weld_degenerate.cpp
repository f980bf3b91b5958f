#include "render/mesh/weld_degenerate.h"

#include <algorithm>
#include <numeric>

namespace merlin::render::mesh {
namespace {

bool haveSameRow(const std::vector<float>& values, std::size_t dimension, std::uint32_t a,
                 std::uint32_t b) {
  const auto row = [&](std::uint32_t v) {
    return values.begin() + static_cast<std::ptrdiff_t>(v * dimension);
  };
  return std::equal(row(a), row(a) + static_cast<std::ptrdiff_t>(dimension), row(b));
}

bool areTwins(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  return haveSameRow(mesh.positions, 3, a, b) &&
         std::all_of(mesh.features.begin(), mesh.features.end(),
                     [&](const Feature& f) { return haveSameRow(f.values, f.dimension, a, b); });
}

// Disjoint sets of vertices; a set is identified by its first vertex. Memory is allocated only when
// two sets are joined.
class TwinSets {
 public:
  explicit TwinSets(std::size_t vertices) : vertices_(vertices) {}

  bool empty() const noexcept { return parents_.empty(); }

  std::uint32_t firstOf(std::uint32_t v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }

  // Joins the sets of a and b. Returns whether they were different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    if (parents_.empty()) {
      parents_.resize(vertices_);
      std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
    }
    a = firstOf(a);
    b = firstOf(b);
    parents_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::size_t vertices_;
  std::vector<std::uint32_t> parents_;
};

}  // namespace

std::size_t weldDegenerate(Mesh& mesh) {
  TwinSets sets(mesh.vertexCount());
  std::size_t merged = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i + k], b = mesh.triangles[i + (k + 1) % 3];
      if (a != b && areTwins(mesh, a, b)) merged += sets.join(a, b);
    }
  }
  if (sets.empty()) return 0;
  for (std::uint32_t& v : mesh.triangles) v = sets.firstOf(v);
  return merged;
}

}  // namespace merlin::render::mesh
