#include "render/mesh/weld_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "render/mesh/coincident.h"

namespace merlin::render::mesh {
namespace {

// Limit of the vertices that are welded into one; it bounds the work on meshes that are crafted to
// be slow.
constexpr std::size_t kMostInOne = 64;
constexpr float kCosineOfCrease = 0.5F;  // 60 degrees

// An edge of one triangle, in the direction of the triangle.
struct Edge {
  std::uint32_t triangle = 0, from = 0, to = 0;
};

// Returns for each vertex the first vertex at its position.
std::vector<std::uint32_t> placesOf(const Mesh& mesh) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  const auto next = coincidentVertices(mesh.positions);
  std::vector<std::uint32_t> place(next.size(), kNone);
  for (std::uint32_t v = 0; v < next.size(); ++v) {
    for (std::uint32_t w = v; place[w] == kNone; w = next[w]) place[w] = v;
  }
  return place;
}

// Returns the edges that belong to only one triangle, sorted by the indices of their vertices.
std::vector<Edge> borderEdges(const Mesh& mesh) {
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::uint32_t* const c = &mesh.triangles[3 * std::size_t{t}];
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t, c[k], c[(k + 1) % 3]});
  }
  const auto ends = [](const Edge& e) { return std::minmax(e.from, e.to); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
    return std::tuple(ends(a), a.triangle) < std::tuple(ends(b), b.triangle);
  });
  std::vector<Edge> border;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i + 1; end < edges.size() && ends(edges[end]) == ends(edges[i]);) ++end;
    if (end == i + 1) border.push_back(edges[i]);
  }
  return border;
}

class Welder {
 public:
  Welder(Mesh& mesh, const std::vector<float>& labels)
      : mesh_(mesh), label_(labels), place_(placesOf(mesh)), size_(mesh.vertexCount(), 1) {
    root_.resize(mesh.vertexCount());
    std::iota(root_.begin(), root_.end(), 0U);
    next_ = root_;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
      part_.push_back(labels[mesh.triangles[3 * t]]);
    listTriangles();
  }

  WeldReport weld() {
    for (const auto& [a, b] : pairs()) report_.edges += weld(a, b);
    for (std::uint32_t& v : mesh_.triangles) v = root_[v];
    return report_;
  }

  // Returns for each vertex the vertex that it became.
  const std::vector<std::uint32_t>& roots() const noexcept { return root_; }

 private:
  void listTriangles() {
    first_.assign(mesh_.vertexCount() + 1, 0);
    for (const std::uint32_t v : mesh_.triangles) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    list_.resize(mesh_.triangles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      list_[next[mesh_.triangles[i]]++] = static_cast<std::uint32_t>(i / 3);
  }

  // Returns pairs of border edges that may be welded: they are at the same place, belong to
  // different parts, have opposite directions, equal features and smooth normals.
  std::vector<std::pair<Edge, Edge>> pairs() const {
    std::vector<Edge> border = borderEdges(mesh_);
    const auto ends = [&](const Edge& e) { return std::minmax(place_[e.from], place_[e.to]); };
    std::sort(border.begin(), border.end(), [&](const Edge& a, const Edge& b) {
      return std::tuple(ends(a), a.triangle) < std::tuple(ends(b), b.triangle);
    });
    std::vector<std::pair<Edge, Edge>> found;
    for (std::size_t i = 0, end = 0; i < border.size(); i = end) {
      for (end = i + 1; end < border.size() && ends(border[end]) == ends(border[i]);) ++end;
      if (end == i + 2 && areOne(border[i], border[i + 1]))
        found.emplace_back(border[i], border[i + 1]);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.first.triangle, a.second.triangle, a.first.from) <
             std::tuple(b.first.triangle, b.second.triangle, b.first.from);
    });
    return found;
  }

  bool areOne(const Edge& a, const Edge& b) const {
    return part_[a.triangle] != part_[b.triangle] && place_[a.from] == place_[b.to] &&
           place_[a.to] == place_[b.from] && lookAlike(a.from, b.to) && lookAlike(a.to, b.from) &&
           isSmooth(a.triangle, b.triangle);
  }

  bool lookAlike(std::uint32_t a, std::uint32_t b) const {
    return std::all_of(mesh_.features.begin(), mesh_.features.end(), [&](const Feature& f) {
      if (f.name == "label" || f.name == "normal") return true;
      const float* const values = f.values.data();
      return std::equal(values + a * f.dimension, values + (a + 1) * f.dimension,
                        values + b * f.dimension);
    });
  }

  bool isSmooth(std::uint32_t s, std::uint32_t t) const {
    const auto normal = [&](std::uint32_t triangle) {
      const std::uint32_t* const c = &mesh_.triangles[3 * std::size_t{triangle}];
      const auto at = [&](std::uint32_t v) { return &mesh_.positions[3 * std::size_t{v}]; };
      return faceNormal(at(c[0]), at(c[1]), at(c[2]));
    };
    return dot(normal(s).data(), normal(t).data()) > kCosineOfCrease;
  }

  // Joins the four vertices of two border edges to two. Does nothing if too many vertices would
  // become one, or if a triangle would have no corner with its part's label. Returns whether the
  // vertices were joined.
  bool weld(const Edge& a, const Edge& b) {
    const std::array<std::array<std::uint32_t, 2>, 2> ends = {
        {{root_[a.from], root_[b.to]}, {root_[a.to], root_[b.from]}}};
    for (const auto& [v, w] : ends) {
      if (v != w && size_[v] + size_[w] > kMostInOne) return false;
    }
    const auto labelThen = [&](std::uint32_t corner) {
      const std::uint32_t root = root_[corner];
      float label = label_[root];
      for (const auto& [v, w] : ends) {
        if (root == v || root == w) label = std::min(label_[v], label_[w]);
      }
      return label;
    };
    for (const auto& end : ends) {
      for (const std::uint32_t root : end) {
        if (!staysKnown(root, labelThen)) return false;
      }
    }
    for (const auto& [v, w] : ends) join(v, w);
    return true;
  }

  // Returns whether each triangle at the vertex would keep a corner with the label of its part.
  // `labelThen` returns the label that a corner would have after the weld.
  template <typename LabelThen>
  bool staysKnown(std::uint32_t root, const LabelThen& labelThen) const {
    std::uint32_t v = root;
    do {
      for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
        const std::uint32_t* const c = &mesh_.triangles[3 * std::size_t{list_[i]}];
        const float part = part_[list_[i]];
        if (std::none_of(c, c + 3, [&](std::uint32_t u) { return labelThen(u) == part; }))
          return false;
      }
      v = next_[v];
    } while (v != root);
    return true;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    if (std::pair(label_[b], b) < std::pair(label_[a], a)) std::swap(a, b);
    std::uint32_t v = b;
    do {
      root_[v] = a;
      v = next_[v];
    } while (v != b);
    std::swap(next_[a], next_[b]);
    size_[a] += size_[b];
    ++report_.vertices;
  }

  Mesh& mesh_;
  const std::vector<float>& label_;  // by vertex; a root has the lowest label of its members
  std::vector<std::uint32_t> place_, root_;
  std::vector<std::uint32_t> next_;  // by vertex: next member of the same root, in a ring
  std::vector<std::size_t> size_;    // by root: number of its members
  std::vector<float> part_;          // by triangle: label of its part
  // Triangles at each vertex v: list_[first_[v]] .. list_[first_[v + 1] - 1].
  std::vector<std::uint32_t> first_, list_;
  WeldReport report_;
};

}  // namespace

WeldReport weldParts(Mesh& mesh) {
  const Feature* const label = mesh.find("label");
  if (!label || label->dimension != 1) return {};
  Welder welder(mesh, label->values);
  const WeldReport report = welder.weld();
  if (report.vertices == 0) return report;
  std::vector<bool> kept;
  for (std::uint32_t v = 0; v < welder.roots().size(); ++v) kept.push_back(welder.roots()[v] == v);
  keepVertices(mesh, kept);
  return report;
}

}  // namespace merlin::render::mesh
