#include "tests/bench/reduction/prepare.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "render/mesh/io/mesh_file.h"

namespace merlin::bench {
namespace {

using render::mesh::Mesh;

class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  bool join(std::size_t a, std::size_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::size_t> parent_;
};

// A half-edge: an edge as a side of one triangle.
struct Side {
  std::uint32_t low, high;  // indices of its vertices
  std::size_t from, to;     // indices of its corners: 3 * triangle + 0..2

  bool sameEdge(const Side& o) const { return low == o.low && high == o.high; }
};

std::vector<Side> sortedSides(const Mesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const auto [low, high] = std::minmax(mesh.triangles[i], mesh.triangles[next]);
    sides.push_back({low, high, i, next});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.from) < std::tie(b.low, b.high, b.from);
  });
  return sides;
}

// Calls f(first, last) with the half-edges of each edge.
template <typename F>
void forEachEdge(const std::vector<Side>& sides, F f) {
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first;
    while (last != sides.end() && last->sameEdge(*first)) ++last;
    f(first, last);
    first = last;
  }
}

}  // namespace

std::size_t contractZeroEdges(Mesh& mesh) {
  Groups same(mesh.vertexCount());
  std::size_t contracted = 0;
  for (const Side& side : sortedSides(mesh)) {
    const auto* low = &mesh.positions[3 * side.low];
    if (std::equal(low, low + 3, &mesh.positions[3 * side.high])) {
      contracted += same.join(side.low, side.high);
    }
  }
  for (std::uint32_t& v : mesh.triangles) v = static_cast<std::uint32_t>(same.of(v));
  render::mesh::tidy(mesh);
  return contracted;
}

std::size_t splitManifold(Mesh& mesh) {
  Groups fans(mesh.triangles.size());  // sets of corners, each identified by its smallest corner
  forEachEdge(sortedSides(mesh), [&](auto first, auto last) {
    if (last - first != 2) return;
    const Side &a = first[0], &b = first[1];
    // Both triangles traverse the edge in the same direction, so they belong to different fans.
    if (mesh.triangles[a.from] != mesh.triangles[b.to]) return;
    fans.join(a.from, b.to);
    fans.join(a.to, b.from);
  });
  constexpr auto kNobody = static_cast<std::size_t>(-1);
  std::vector<std::size_t> owner(mesh.vertexCount(), kNobody);
  std::vector<std::uint32_t> vertex(mesh.triangles.size());  // indexed by a fan's first corner
  const std::size_t before = mesh.vertexCount();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t v = mesh.triangles[i];
    const std::size_t fan = fans.of(i);  // identified by its first corner
    if (fan == i && owner[v] == kNobody) {
      owner[v] = fan;
      vertex[fan] = v;
    } else if (fan == i) {
      vertex[fan] = static_cast<std::uint32_t>(mesh.vertexCount());
      for (std::size_t k = 0; k < 3; ++k)
        mesh.positions.push_back(float{mesh.positions[3 * v + k]});
      for (auto& f : mesh.features) {
        for (std::size_t k = 0; k < f.dimension; ++k) {
          f.values.push_back(float{f.values[v * f.dimension + k]});
        }
      }
    }
    mesh.triangles[i] = vertex[fan];
  }
  return mesh.vertexCount() - before;
}

Kind kindOf(const Mesh& mesh) {
  Kind kind;
  forEachEdge(sortedSides(mesh), [&](auto first, auto last) {
    ++kind.edges;
    kind.borders += last - first == 1;
    kind.non_manifold += last - first > 2;
  });
  Groups parts(mesh.vertexCount());
  kind.components = mesh.vertexCount();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    kind.components -= parts.join(mesh.triangles[i], mesh.triangles[i - i % 3]);
  }
  return kind;
}

Result<std::string> prepare(const std::string& in, const std::string& out) {
  auto loaded = render::mesh::readMesh(in);
  if (!loaded) return loaded.error();
  Mesh& mesh = loaded->mesh;
  std::erase_if(mesh.features, [](const render::mesh::Feature& f) { return f.name != "colour"; });
  const std::size_t contracted = contractZeroEdges(mesh);
  const std::size_t split = splitManifold(mesh);
  if (const auto written = render::mesh::writeMesh(out, mesh); !written) return written.error();
  const Kind kind = kindOf(mesh);
  return fmt::format(R"({{"triangles": {}, "vertices": {}, "edges": {}, "border_edges": {}, )"
                     R"("non_manifold_edges": {}, "components": {}, "contracted_edges": {}, )"
                     R"("split_vertices": {}, "colour": {}}})",
                     mesh.triangleCount(), mesh.vertexCount(), kind.edges, kind.borders,
                     kind.non_manifold, kind.components, contracted, split,
                     mesh.find("colour") != nullptr);
}

}  // namespace merlin::bench
