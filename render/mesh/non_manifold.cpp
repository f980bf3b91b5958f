#include "render/mesh/non_manifold.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

namespace merlin::render::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// Maximum compared at an edge; with more, pairs follow mesh order.
constexpr std::size_t kMostPairs = 64;
constexpr int kMostRounds = 3;  // after so many rounds, all non-manifold edges are cut

// Half-edge h = 3 t + k runs from corner k of triangle t to the next one.
std::uint32_t nextOf(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
std::uint32_t previousOf(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

class Splitter {
 public:
  explicit Splitter(Mesh& mesh)
      : mesh_(mesh), twins_(mesh.triangles.size(), kNone), fans_(mesh.triangles.size(), kNone) {}

  SplitReport run() {
    pairAll();
    SplitReport report;
    report.edges = singular_.size();
    for (int round = 0;; ++round) {
      numberFans();
      if (!cutWhatIsLeft(round + 1 >= kMostRounds)) break;
    }
    report.vertices = split_;
    report.added = sources_.size();
    apply();
    return report;
  }

 private:
  struct Edge {
    std::vector<std::uint32_t> half_edges;
    bool cut = false;
  };

  std::uint32_t from(std::uint32_t h) const { return mesh_.triangles[h]; }
  std::uint32_t to(std::uint32_t h) const { return mesh_.triangles[nextOf(h)]; }

  // Sorts half-edges by their smaller vertex index, then by the larger one, so that the half-edges
  // of one edge are adjacent; then pairs the half-edges of each edge.
  void pairAll() {
    const std::size_t n = mesh_.vertexCount();
    std::vector<std::uint32_t> begin(n + 1, 0);
    std::vector<std::uint64_t> list(twins_.size());  // larger vertex << 32 | half-edge
    const auto count = static_cast<std::uint32_t>(list.size());
    for (std::uint32_t h = 0; h < count; ++h) ++begin[std::min(from(h), to(h)) + 1];
    for (std::size_t v = 0; v < n; ++v) begin[v + 1] += begin[v];
    for (std::uint32_t h = 0; h < count; ++h) {
      const auto [smaller, larger] = std::minmax({from(h), to(h)});
      list[begin[smaller]++] = std::uint64_t{larger} << 32 | h;
    }
    std::vector<std::uint32_t> edge;
    std::uint32_t first = 0;
    for (std::size_t v = 0; v < n; ++v) {
      const std::uint32_t end = begin[v];  // advanced to the begin of v + 1
      std::sort(list.begin() + first, list.begin() + end);
      while (first < end) {
        const std::uint64_t larger = list[first] >> 32;
        edge.clear();
        for (; first < end && list[first] >> 32 == larger; ++first)
          edge.push_back(static_cast<std::uint32_t>(list[first]));
        pairEdge(edge);
      }
    }
  }

  void pairEdge(std::span<const std::uint32_t> half_edges) {
    if (half_edges.size() == 1) return;
    if (half_edges.size() == 2 && from(half_edges[0]) == to(half_edges[1])) {
      glue(half_edges[0], half_edges[1]);
      return;
    }
    singular_.push_back({{half_edges.begin(), half_edges.end()}, false});
    pairSmoothest(half_edges);
  }

  void glue(std::uint32_t a, std::uint32_t b) {
    twins_[a] = b;
    twins_[b] = a;
  }

  std::array<float, 3> normalOf(std::uint32_t h) const {
    const std::uint32_t* t = &mesh_.triangles[h - h % 3];
    const auto at = [&](std::size_t k) { return &mesh_.positions[3 * std::size_t{t[k]}]; };
    return faceNormal(at(0), at(1), at(2));
  }

  void pairSmoothest(std::span<const std::uint32_t> half_edges) {
    std::vector<std::uint32_t> ways[2];
    for (const std::uint32_t h : half_edges) ways[from(h) < to(h)].push_back(h);
    if (ways[0].size() * ways[1].size() > kMostPairs) {
      for (std::size_t i = 0; i < std::min(ways[0].size(), ways[1].size()); ++i)
        glue(ways[0][i], ways[1][i]);
      return;
    }
    std::vector<std::tuple<float, std::uint32_t, std::uint32_t>> pairs;
    for (const std::uint32_t a : ways[0]) {
      for (const std::uint32_t b : ways[1]) {
        const auto m = normalOf(a), n = normalOf(b);
        pairs.emplace_back(-(m[0] * n[0] + m[1] * n[1] + m[2] * n[2]), a, b);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [bend, a, b] : pairs) {
      if (twins_[a] == kNone && twins_[b] == kNone) glue(a, b);
    }
  }

  // Gives all corners of a fan (triangles connected around a vertex) the same vertex index: the
  // index of the vertex for its first fan, a new index for each other fan. Corner h is where
  // half-edge h starts.
  void numberFans() {
    std::fill(fans_.begin(), fans_.end(), kNone);
    sources_.clear();
    split_ = 0;
    // Fans found so far; 2 means two or more.
    std::vector<std::uint8_t> fans_of(mesh_.vertexCount(), 0);
    for (std::uint32_t corner = 0; corner < fans_.size(); ++corner) {
      if (fans_[corner] != kNone) continue;
      const std::uint32_t v = from(corner);
      std::uint32_t number = v;
      if (fans_of[v] > 0) {
        number = static_cast<std::uint32_t>(mesh_.vertexCount() + sources_.size());
        sources_.push_back(v);
        split_ += fans_of[v] == 1;
        fans_of[v] = 2;
      } else {
        fans_of[v] = 1;
      }
      numberFan(corner, number);
    }
  }

  void numberFan(std::uint32_t corner, std::uint32_t number) {
    fans_[corner] = number;
    for (std::uint32_t c = corner;;) {  // across the incoming edge
      c = twins_[previousOf(c)];
      if (c == kNone || fans_[c] != kNone) break;
      fans_[c] = number;
    }
    for (std::uint32_t c = corner;;) {  // across the outgoing edge
      if (twins_[c] == kNone) break;
      c = nextOf(twins_[c]);
      if (fans_[c] != kNone) break;
      fans_[c] = number;
    }
  }

  // Cuts edges that are still not manifold, since a fan may contain such an edge twice. Cutting
  // them completely (if `every`, all non-manifold edges) means that a fan meets the edge only with
  // its two ends, which have opposite directions. Returns false if every edge is manifold.
  bool cutWhatIsLeft(bool every) {
    bool again = false;
    for (Edge& edge : singular_) {
      if (edge.cut || isManifold(edge)) continue;
      again = true;
      edge.cut = true;
    }
    if (!again) return false;
    for (Edge& edge : singular_) {
      edge.cut |= every;
      if (!edge.cut) continue;
      for (const std::uint32_t h : edge.half_edges) twins_[h] = kNone;
    }
    return true;
  }

  bool isManifold(const Edge& edge) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
    for (const std::uint32_t h : edge.half_edges) ends.emplace_back(fans_[h], fans_[nextOf(h)]);
    std::sort(ends.begin(), ends.end());
    // Each direction occurs once.
    return std::adjacent_find(ends.begin(), ends.end()) == ends.end();
  }

  void apply() {
    for (std::size_t h = 0; h < fans_.size(); ++h) mesh_.triangles[h] = fans_[h];
    append(mesh_.positions, 3);
    for (Feature& f : mesh_.features) append(f.values, f.dimension);
  }

  void append(std::vector<float>& values, std::size_t dimension) const {
    values.reserve(values.size() + sources_.size() * dimension);
    for (const std::uint32_t v : sources_) {
      for (std::size_t k = 0; k < dimension; ++k) values.push_back(values[v * dimension + k]);
    }
  }

  Mesh& mesh_;
  std::vector<std::uint32_t> twins_;    // by half-edge: the half-edge across; kNone at borders
  std::vector<std::uint32_t> fans_;     // by corner: vertex index of its fan
  std::vector<Edge> singular_;          // edges that are not manifold
  std::vector<std::uint32_t> sources_;  // by new vertex: the vertex of which it is a copy
  std::size_t split_ = 0;
};

}  // namespace

SplitReport splitNonManifold(Mesh& mesh) {
  assert(mesh.triangles.size() < kNone);
  return Splitter(mesh).run();
}

}  // namespace merlin::render::mesh
