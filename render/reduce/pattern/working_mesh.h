// WorkingMesh: the connectivity of a mesh during its reduction: lists of the triangles and edges of
// each vertex, updated by each collapse. Thread-bound; private to render/reduce.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/mesh/mesh.h"
#include "render/reduce/pattern/list_pool.h"

namespace merlin::render::reduce {

class WorkingMesh {
 public:
  explicit WorkingMesh(const mesh::Mesh& mesh);

  using Corners = std::array<std::uint32_t, 3>;
  using Ends = std::array<std::uint32_t, 2>;

  std::size_t liveTriangles() const noexcept { return live_; }
  std::size_t edgeCount() const noexcept { return ends_.size(); }  // edges of the input mesh
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

  // Returns the number of triangles of v that still exist. Use this instead of
  // trianglesOf(v).size(): since removing from a long list is slow, the lists trianglesOf() and
  // edgesOf() of a vertex with many triangles contain removed entries until tidy().
  std::size_t triangleCount(std::uint32_t v) const noexcept {
    return around_[v].size() - stale_triangles_[v];
  }
  // Drops removed triangles and edges from v's lists; the remaining entries keep their order. O(1)
  // if there is nothing to drop.
  void tidy(std::uint32_t v);

  // Returns the number of triangles at an edge: 1 at a boundary, 2 inside, more if non-manifold.
  std::size_t trianglesAt(std::uint32_t edge) const noexcept { return shared_[edge]; }
  bool isBoundary(std::uint32_t v) const noexcept;  // true if v has a boundary edge

  // Returns true if collapsing the edge keeps the topology. This is the link condition of T. K. Dey
  // et al., "Topology preserving edge contraction", 1999, extended to meshes with borders.
  // REQUIRES: tidy() was called for both ends.
  bool linkCondition(std::uint32_t edge) noexcept;

  // Merges vertex b into vertex a: removes the triangles that contain both, and merges edges that
  // then coincide. Returns the removed edges, including the collapsed one; the span is valid until
  // the next call. REQUIRES: tidy() was called for a and b.
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
  std::vector<std::uint32_t> shared_;  // by edge: number of its triangles
  // By vertex: number of removed entries that are still in its list.
  std::vector<std::uint32_t> stale_triangles_, stale_edges_;
  // scratch, by vertex: equals stamp_ if the current search has visited it
  std::vector<std::uint32_t> mark_;
  std::vector<std::uint32_t> count_;  // scratch, by vertex
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> scratch_, gone_;
  std::size_t live_ = 0;
};

}  // namespace merlin::render::reduce
