// Clusters: a dendrogram in some hundred patches of surface, each of which may be cut at a level of
// its own, from index buffers made ready.
//
// The nodes alive at a coarse level L0 are the roots of the clusters; each cluster is the subtree
// below one. A corner is chased up its parents to the first node that is alive at its own
// cluster's level. Since every vertex then stands for exactly one node, levels of different
// clusters fit together: no cracks, whatever they are (vertex clustering: J. Rossignac, P. Borrel,
// "Multi-resolution 3D approximations for rendering complex scenes", 1993, on the forest of
// [GOURLEY98]; levels that depend on the view: H. Hoppe, "View-dependent refinement of progressive
// meshes", 1997; wished for in [GOURLEY98] 6.1).
//
// A triangle goes when two of its corners become one; that happens in one cluster, at one collapse,
// so it belongs to that cluster, and those alive of a cluster are a prefix of its list. Rungs hold
// the lists of levels at steps of sqrt(2) in triangles (of 2 above 300,000, which nobody draws
// while it moves), corners chased up to there, so that a cut starts near where it ends. Triangles
// come out cluster by cluster: near in space, near in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/chase.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

struct ClusterSettings {
  // About so many; fewer for a small model. 0: 512, and up to 2,048 of a million vertices and more:
  // smaller clusters follow a close look better, and cost more draw calls.
  std::size_t clusters = 0;
  std::size_t memory = 41'000'000;  // bytes at most, about: bounds the finest rung
};

// Where a cluster's triangles lie: at all levels, in model units.
struct ClusterBounds {
  std::array<float, 3> centre{};
  float radius = 0;
  std::array<float, 3> axis{};  // mean normal, unit
  float cone_cos = -1;          // least cosine of a finest triangle's normal to it; -1: any
};

// Borrows the dendrogram. Reentrant.
class Clusters {
 public:
  // O(finest triangles x log + nodes) time, on all cores.
  Clusters(const Dendrogram& dendrogram, const ClusterSettings& settings);

  std::size_t size() const noexcept { return bounds_.size(); }
  const ClusterBounds& bounds(std::size_t cluster) const noexcept { return bounds_[cluster]; }
  // Clusters that share triangles with this one; it may be among them. Not both ways.
  std::span<const std::uint16_t> neighbours(std::size_t cluster) const noexcept {
    return neighbours_[cluster];
  }
  // Cluster of a node that dies at or after finestLevel() and before coarsestLevel().
  std::uint16_t clusterOf(std::uint32_t node) const noexcept { return cluster_of_[node]; }
  std::size_t finestLevel() const noexcept { return rungs_.front().level; }
  std::size_t coarsestLevel() const noexcept { return coarsest_; }

  // Triangles of `cluster` at `level`. REQUIRES: finestLevel() <= level <= coarsestLevel().
  // O(log n).
  std::size_t trianglesAt(std::size_t cluster, std::size_t level) const noexcept;
  // Those of no cluster, which are there at every level.
  std::size_t alwaysThere() const noexcept { return alive_[coarsest_]; }

  // Writes the triangles of each cluster at its level, in the order of the clusters, then those of
  // none; `ends` gets where each cluster's end in triangles, size() + 1 entries. Returns how many.
  // REQUIRES: size() levels as above; out large enough. Allocates nothing.
  std::size_t cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                  std::span<std::uint32_t> ends) const noexcept;

  // Whether an even cut at `level` is worth its clusters: not of few triangles.
  bool isClustered(std::size_t level) const noexcept {
    return level >= finestLevel() && level < plain_.front().level;
  }

  // All at one level, the same triangles as Dendrogram::cut(level): cluster by cluster; few
  // triangles, and those of levels finer than the finest rung, in the dendrogram's own order.
  // Returns how many.
  std::size_t cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept;

  // All triangles of the mesh, cluster by cluster; `ends` as of cut(). Allocates both.
  void everything(std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& ends) const;

  std::size_t memoryBytes() const noexcept;  // beyond the dendrogram

 private:
  // The triangles that are alive at a level, each group's by rank (their places in the dendrogram's
  // order). Groups: of cluster c, 2 c: those with all corners in it, 2 c + 1: the others; then
  // those of none.
  struct Rung {
    std::size_t level = 0;
    std::vector<std::uint32_t> begins;   // groups + 1; empty: one, in the dendrogram's own order
    std::vector<std::uint32_t> corners;  // 3 a triangle: nodes alive at the level
  };

  struct Builder;
  static std::size_t rungFor(std::span<const Rung> rungs, std::size_t level) noexcept;
  std::size_t prefix(const Rung& rung, std::size_t group, std::uint32_t alive) const noexcept;
  std::vector<std::uint16_t> clusterOfEach() const;  // of all nodes
  // Append corners, chased up to `level`, or each to its cluster's level; return the end.
  std::uint32_t* chaseTo(std::size_t level, const std::uint32_t* from, std::size_t corners,
                         std::uint32_t* out) const noexcept;
  std::uint32_t* chaseEach(std::span<const std::uint32_t> levels, const std::uint32_t* from,
                           std::size_t corners, std::uint32_t* out) const noexcept;
  // Nodes with a smaller number are alive at the level.
  std::uint32_t aliveBelow(std::size_t level) const noexcept {
    return forest_.nodes - static_cast<std::uint32_t>(2 * level);
  }

  const Dendrogram& dendrogram_;
  std::span<const std::uint32_t> alive_;
  Forest forest_;
  ChaseAll chase_all_;
  std::size_t coarsest_ = 0;
  std::vector<std::uint16_t> cluster_of_;  // of nodes that are alive at the finest level or later
  std::vector<Rung> rungs_;                // finest first
  std::vector<std::uint32_t> ranks_;  // of the finest; a coarser one's groups are prefixes of its
  std::vector<Rung> plain_;           // the same without clusters, of few triangles
  std::vector<std::vector<std::uint16_t>> neighbours_;  // clusters that a cluster's group 2 c + 1
                                                        // has corners in
  std::vector<ClusterBounds> bounds_;
};

}  // namespace merlin::render
