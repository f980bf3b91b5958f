// Clusters: a dendrogram divided into some hundred patches of surface (clusters). Each cluster can
// be cut at its own level, from precomputed index buffers.
//
// The nodes alive at a coarse level L0 are the roots of the clusters; each cluster is the subtree
// below a root. A cut replaces each corner of a triangle by its nearest ancestor that is alive at
// the level of the corner's cluster. Each vertex is then represented by exactly one node, so
// clusters at any levels fit together without cracks (vertex clustering: J. Rossignac, P. Borrel,
// "Multi-resolution 3D approximations for rendering complex scenes", 1993, on the forest of
// [GOURLEY98]; levels that depend on the view: H. Hoppe, "View-dependent refinement of progressive
// meshes", 1997; proposed as future work in [GOURLEY98] 6.1).
//
// A triangle disappears when two of its corners become one node. This happens in one collapse in
// one cluster, and the triangle belongs to this cluster; the triangles of a cluster that are alive
// at a level are a prefix of its list. Detail steps hold these lists for levels whose triangle
// counts differ by a factor of sqrt(2) (of 2 above 300,000 triangles, which are too many to draw in
// motion), with corners already replaced for that level, so that a cut only has to go up by few
// ancestors. The output is ordered by cluster: triangles near in space are near in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/alive_ancestors.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::lod {

struct ClusterSettings {
  // Approximate number of clusters; a small model gets fewer. 0: automatic, 512 to 2,048 (from
  // about 1.4 million vertices on). Smaller clusters fit a close view better but cost more draw
  // calls.
  std::size_t clusters = 0;
  std::size_t memory = 41'000'000;  // approximate limit [bytes] for all detail steps
};

// Bounding sphere of a cluster's triangles at all levels, in model units, and the cone that
// contains the normals of its finest triangles.
struct ClusterBounds {
  std::array<float, 3> centre{};
  float radius = 0;
  std::array<float, 3> axis{};  // mean normal, unit length
  float cone_cos = -1;          // smallest cosine between `axis` and a normal; -1: no limit
};

// Keeps a reference to the dendrogram, which must outlive it. Reentrant.
class Clusters {
 public:
  // Builds the clusters, in O(n log n + nodes) time for n triangles at the finest level, on all
  // cores.
  Clusters(const Dendrogram& dendrogram, const ClusterSettings& settings);

  std::size_t size() const noexcept { return bounds_.size(); }
  const ClusterBounds& bounds(std::size_t cluster) const noexcept { return bounds_[cluster]; }
  // Returns the clusters in which triangles of this cluster have corners; may include the cluster
  // itself. The relation is not symmetric.
  std::span<const std::uint16_t> neighbours(std::size_t cluster) const noexcept {
    return neighbours_[cluster];
  }
  // Returns the cluster of a node. REQUIRES: a collapse from finestLevel() on and before
  // coarsestLevel() merges the node.
  std::uint16_t clusterOf(std::uint32_t node) const noexcept { return cluster_of_[node]; }
  std::size_t finestLevel() const noexcept { return steps_.front().level; }
  std::size_t coarsestLevel() const noexcept { return coarsest_; }

  // Returns the number of triangles of `cluster` at `level`, in O(log n). REQUIRES: finestLevel()
  // <= level <= coarsestLevel().
  std::size_t trianglesAt(std::size_t cluster, std::size_t level) const noexcept;
  // Returns the number of triangles that belong to no cluster: those that are alive at every level
  // up to L0.
  std::size_t alwaysThere() const noexcept { return alive_[coarsest_]; }

  // Cuts cluster c at levels[c]: writes the triangles of each cluster in turn, then those of no
  // cluster. ends[c] receives the number of triangles written up to the end of cluster c;
  // ends[size()] receives the total. Returns the number of triangles. Allocates nothing. REQUIRES:
  // size() levels from finestLevel() to coarsestLevel(); `ends` has size() + 1 entries; `out` has
  // room for 3 indices per triangle.
  std::size_t cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                  std::span<std::uint32_t> ends) const noexcept;

  // Returns whether cutEvenly(level) orders triangles by cluster. It does not if there are few
  // triangles or if `level` is finer than finestLevel().
  bool isClustered(std::size_t level) const noexcept {
    return level >= finestLevel() && level < plain_.front().level;
  }

  // Cuts all clusters at one level: writes the same triangles as Dendrogram::cut(level), ordered by
  // cluster if isClustered(level), else in the dendrogram's order. Returns the number of triangles.
  // REQUIRES: `out` has room for 3 indices per triangle.
  std::size_t cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept;

  // Returns all triangles of the mesh in `corners`, ordered by cluster; `ends` as for cut().
  // Allocates both vectors.
  void everything(std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& ends) const;

  std::size_t memoryBytes() const noexcept;  // memory of all members, without the dendrogram

 private:
  // The triangles alive at a level, divided into groups; each group is sorted by rank (a triangle's
  // index in the dendrogram). Group 2 c: triangles of cluster c with all corners in c; group 2 c +
  // 1: its other triangles; last group: triangles of no cluster.
  struct DetailStep {
    std::size_t level = 0;
    // First triangle of each group, and the end; empty: one group.
    std::vector<std::uint32_t> begins;
    std::vector<std::uint32_t> corners;  // 3 per triangle: nodes alive at the level
  };

  struct Builder;
  static std::size_t stepFor(std::span<const DetailStep> steps, std::size_t level) noexcept;
  std::size_t prefix(const DetailStep& step, std::size_t group, std::uint32_t alive) const noexcept;
  std::vector<std::uint16_t> clusterOfEach() const;  // entry n: cluster of node n
  // Both write the alive ancestor of each corner to `out` and return the end of the output:
  // replaceAt() at `level`, replaceEach() at the level of the corner's cluster.
  std::uint32_t* replaceAt(std::size_t level, const std::uint32_t* from, std::size_t corners,
                           std::uint32_t* out) const noexcept;
  std::uint32_t* replaceEach(std::span<const std::uint32_t> levels, const std::uint32_t* from,
                             std::size_t corners, std::uint32_t* out) const noexcept;
  // Returns the number below which node numbers are alive at the level.
  std::uint32_t aliveBelow(std::size_t level) const noexcept {
    return forest_.nodes - static_cast<std::uint32_t>(2 * level);
  }

  const Dendrogram& dendrogram_;
  std::span<const std::uint32_t> alive_;
  CollapseForest forest_;
  FindAliveAncestors find_alive_ancestors_;
  std::size_t coarsest_ = 0;
  std::vector<std::uint16_t> cluster_of_;  // by node, only for nodes alive at finestLevel()
  std::vector<DetailStep> steps_;          // finest first
  // Ranks in the finest step; groups of coarser steps are prefixes.
  std::vector<std::uint32_t> ranks_;
  std::vector<DetailStep> plain_;  // steps without clusters, for cuts of few triangles
  std::vector<std::vector<std::uint16_t>> neighbours_;  // [c]: the result of neighbours(c)
  std::vector<ClusterBounds> bounds_;
};

}  // namespace merlin::render::lod
