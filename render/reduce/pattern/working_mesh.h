// WorkingMesh: a mesh that is being reduced: which triangles and edges each vertex has, and how
// they change when one edge is collapsed. Connectivity only. Thread-bound; private to
// render/reduce.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/mesh/mesh.h"
#include "render/reduce/pattern/list_pool.h"

namespace merlin::render {

class WorkingMesh {
 public:
  explicit WorkingMesh(const Mesh& mesh);

  using Corners = std::array<std::uint32_t, 3>;
  using Ends = std::array<std::uint32_t, 2>;

  std::size_t liveTriangles() const noexcept { return live_; }
  std::size_t edgeCount() const noexcept { return ends_.size(); }  // as it was at the start
  Ends ends(std::uint32_t edge) const noexcept { return ends_[edge]; }
  std::uint32_t otherEnd(std::uint32_t edge, std::uint32_t v) const noexcept {
    return ends_[edge][0] == v ? ends_[edge][1] : ends_[edge][0];
  }
  const Corners& corners(std::uint32_t triangle) const noexcept { return corners_[triangle]; }
  std::span<const std::uint32_t> trianglesOf(std::uint32_t v) const noexcept { return around_[v]; }
  std::span<const std::uint32_t> edgesOf(std::uint32_t v) const noexcept { return spokes_[v]; }

  bool contains(std::uint32_t triangle, std::uint32_t v) const noexcept {
    const Corners& c = corners_[triangle];
    return c[0] == v || c[1] == v || c[2] == v;
  }

  // How many triangles v has. What trianglesOf() and edgesOf() say of a vertex of many holds what
  // is gone as well, until tidy(): to take one out of a long list would take long.
  std::size_t triangleCount(std::uint32_t v) const noexcept {
    return around_[v].size() - stale_triangles_[v];
  }
  // Drops what is gone from v's lists; what is left keeps its order. O(1) where nothing is.
  void tidy(std::uint32_t v);

  // How many triangles have it; 1 is a boundary edge, 2 an inner one, more not manifold.
  std::size_t trianglesAt(std::uint32_t edge) const noexcept { return shared_[edge]; }
  bool isBoundary(std::uint32_t v) const noexcept;  // has a boundary edge

  // True where collapsing a-b keeps the topology: the link condition, T. K. Dey et al., "Topology
  // preserving edge contraction", 1999, with borders. REQUIRES: both ends are tidy.
  bool linkCondition(std::uint32_t edge) noexcept;

  // Merges b into a: triangles with both are gone, edges that became one are merged; returns
  // the edges that are no more, the collapsed one among them. Valid until the next call. REQUIRES:
  // a and b are tidy.
  std::span<const std::uint32_t> collapse(std::uint32_t a, std::uint32_t b);

 private:
  bool linksShareAnEdge(std::uint32_t a, std::uint32_t b) const noexcept;
  void loseTriangle(std::uint32_t v, std::uint32_t t);
  void loseEdge(std::uint32_t v, std::uint32_t e);
  void countTriangles(std::uint32_t a);
  void mergeTriangles(std::uint32_t a, std::uint32_t b);
  void mergeEdges(std::uint32_t a, std::uint32_t b);

  std::vector<Corners> corners_;
  std::vector<Ends> ends_;
  ListPool around_, spokes_;
  std::vector<std::uint32_t> shared_;                         // by edge
  std::vector<std::uint32_t> stale_triangles_, stale_edges_;  // by vertex: gone, but in its list
  std::vector<std::uint32_t> mark_;   // scratch, by vertex: stamp_ where seen
  std::vector<std::uint32_t> count_;  // scratch, by vertex
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> scratch_, gone_;
  std::size_t live_ = 0;
};

}  // namespace merlin::render
