// Clusters: a dendrogram divided into some hundred patches of surface. Each patch can be cut at its
// own level, from precomputed index buffers.
//
// The nodes alive at a coarse level L0 are the roots of the clusters; each cluster is the subtree
// below a root. A cut replaces each corner of a triangle by its nearest ancestor that is alive at
// the level of the corner's cluster. Each vertex is then represented by exactly one node, so
// clusters at any levels fit together without cracks (vertex clustering: J. Rossignac, P. Borrel,
// "Multi-resolution 3D approximations for rendering complex scenes", 1993, on the forest of
// [GOURLEY98]; levels that depend on the view: H. Hoppe, "View-dependent refinement of progressive
// meshes", 1997; proposed as future work in [GOURLEY98] 6.1).
//
// A triangle disappears when two of its corners become one node. That happens in one collapse in
// one cluster, so the triangle belongs to that cluster; the triangles of a cluster that are alive
// at a level are a prefix of its list. Detail steps hold these lists for levels whose triangle
// counts differ by a factor of sqrt(2) (of 2 above 300,000 triangles, which are too many to draw in
// motion), with corners already replaced for that level, so that a cut has few ancestors left to
// pass. The output is ordered by cluster: triangles near in space are near in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/alive_ancestors.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::lod {

struct ClusterSettings {
  // Approximate number; a small model gets fewer. 0: automatic, 512 to 2,048 (from about 1.4
  // million vertices on). Smaller clusters fit a close view better but cost more draw calls.
  std::size_t clusters = 0;
  std::size_t memory = 41'000'000;  // approximate limit [bytes] for all detail steps
};

// Bounding sphere of a cluster's triangles at all levels, in model units, and cone of the normals
// of its finest triangles.
struct ClusterBounds {
  std::array<float, 3> centre{};
  float radius = 0;
  std::array<float, 3> axis{};  // mean normal, unit
  float cone_cos = -1;          // least cosine between `axis` and a normal; -1: no limit
};

// Keeps a reference to the dendrogram, which must outlive it. Reentrant.
class Clusters {
 public:
  // O(finest triangles x log + nodes) time, on all cores.
  Clusters(const Dendrogram& dendrogram, const ClusterSettings& settings);

  std::size_t size() const noexcept { return bounds_.size(); }
  const ClusterBounds& bounds(std::size_t cluster) const noexcept { return bounds_[cluster]; }
  // Clusters in which triangles of this cluster have corners; may include itself. Not symmetric.
  std::span<const std::uint16_t> neighbours(std::size_t cluster) const noexcept {
    return neighbours_[cluster];
  }
  // Cluster of a node that is merged by a collapse from finestLevel() on and before
  // coarsestLevel().
  std::uint16_t clusterOf(std::uint32_t node) const noexcept { return cluster_of_[node]; }
  std::size_t finestLevel() const noexcept { return steps_.front().level; }
  std::size_t coarsestLevel() const noexcept { return coarsest_; }

  // Number of triangles of `cluster` at `level`, in O(log n). REQUIRES: finestLevel() <= level <=
  // coarsestLevel().
  std::size_t trianglesAt(std::size_t cluster, std::size_t level) const noexcept;
  // Number of triangles that belong to no cluster: they are alive at every level up to L0.
  std::size_t alwaysThere() const noexcept { return alive_[coarsest_]; }

  // Cuts cluster c at levels[c]: writes the triangles of each cluster in turn, then those of no
  // cluster. ends[c] receives the number of triangles up to the end of cluster c; it has size() + 1
  // entries. Returns the number of triangles. REQUIRES: size() levels from finestLevel() to
  // coarsestLevel(); `out` is large enough. Allocates nothing.
  std::size_t cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                  std::span<std::uint32_t> ends) const noexcept;

  // Whether cutEvenly(level) orders triangles by cluster: not if there are few, nor if `level` is
  // finer than finestLevel().
  bool isClustered(std::size_t level) const noexcept {
    return level >= finestLevel() && level < plain_.front().level;
  }

  // Cuts all clusters at one level: the same triangles as Dendrogram::cut(level), ordered by
  // cluster if isClustered(level), else in the dendrogram's order. Returns the number of triangles.
  std::size_t cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept;

  // All triangles of the mesh, ordered by cluster; `ends` as for cut(). Allocates both vectors.
  void everything(std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& ends) const;

  std::size_t memoryBytes() const noexcept;  // without the dendrogram

 private:
  // The triangles alive at a level, in groups, in each group by rank (their index in the
  // dendrogram). Group 2 c: triangles of cluster c with all corners in c; group 2 c + 1: its other
  // triangles; last group: triangles of no cluster.
  struct DetailStep {
    std::size_t level = 0;
    std::vector<std::uint32_t> begins;   // groups + 1; empty: one group, in the dendrogram's order
    std::vector<std::uint32_t> corners;  // 3 a triangle: nodes alive at the level
  };

  struct Builder;
  static std::size_t stepFor(std::span<const DetailStep> steps, std::size_t level) noexcept;
  std::size_t prefix(const DetailStep& step, std::size_t group, std::uint32_t alive) const noexcept;
  std::vector<std::uint16_t> clusterOfEach() const;  // entry n: cluster of node n
  // Write the alive ancestor of each corner to `out`, at `level`, or at the level of the cluster of
  // the corner; return the end of the output.
  std::uint32_t* replaceAt(std::size_t level, const std::uint32_t* from, std::size_t corners,
                           std::uint32_t* out) const noexcept;
  std::uint32_t* replaceEach(std::span<const std::uint32_t> levels, const std::uint32_t* from,
                             std::size_t corners, std::uint32_t* out) const noexcept;
  // Nodes with a smaller number are alive at the level.
  std::uint32_t aliveBelow(std::size_t level) const noexcept {
    return forest_.nodes - static_cast<std::uint32_t>(2 * level);
  }

  const Dendrogram& dendrogram_;
  std::span<const std::uint32_t> alive_;
  CollapseForest forest_;
  FindAliveAncestors find_alive_ancestors_;
  std::size_t coarsest_ = 0;
  std::vector<std::uint16_t> cluster_of_;  // by node; only nodes alive at the finest step's level
  std::vector<DetailStep> steps_;          // finest first
  std::vector<std::uint32_t> ranks_;  // of the finest step; groups of coarser steps are prefixes
  std::vector<DetailStep> plain_;     // steps without clusters, for cuts of few triangles
  std::vector<std::vector<std::uint16_t>> neighbours_;  // [c]: what neighbours(c) returns
  std::vector<ClusterBounds> bounds_;
};

}  // namespace merlin::render::lod
