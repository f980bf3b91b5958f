// ViewCut: chooses the level of each cluster such that one triangle budget for all tiles of the
// wall gives the least visible error ([GOURLEY98] 5.4, 6.1).
//
// The visible error of a coarse surface is its shading: if the whole model is cut to T triangles,
// normals are off by about T^-1/2. A cluster of n triangles, seen at p pixels per model unit and at
// an angle of cosine g, covers pixels in proportion to n p^2 g. The sum of squared errors over all
// pixels is least, for a given sum of triangles, if
//
//   T_c = kappa p_c g_c^(1/2)
//
// T_c is the triangle count that the whole model would have at the level of cluster c. A cluster
// that no tile sees needs no triangles, but gets at least two fifths of the T of its neighbours:
// triangles between fine and very coarse clusters fold over. kappa follows from the budget by
// bisection. Pure.
//
// Views may have different eye points, or no eye point (parallel projections): p and g are computed
// for each view separately, and the view that needs the most detail of a cluster decides. All views
// show the same cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "render/lod/clusters.h"

namespace merlin::render::lod {

// The view of one tile.
struct TileView {
  Eigen::Matrix4f clip_from_model;  // OpenGL's clip space; a perspective or parallel projection
  int width_px = 0;
  float weight = 1;  // square root of the weight of this tile's squared pixel errors
};

// Thread-bound, because it keeps its tables and its last result.
class ViewCut {
 public:
  // Keeps references to the dendrogram and the clusters, which must outlive it. `back_faces`:
  // whether back faces are drawn; if so, clusters that face away count as visible.
  ViewCut(const Dendrogram& dendrogram, const Clusters& clusters, bool back_faces);

  // Chooses levels() for these tiles and returns true. The cut has at most `budget` triangles in
  // total, unless even the coarsest levels have more. Returns false, and leaves levels() unchanged,
  // if one level for all clusters is as good: all clusters are seen at nearly the same scale, none
  // is seen, or the budget is too small for clusters. Takes less than a millisecond.
  bool choose(std::span<const TileView> tiles, std::size_t budget);

  std::span<const std::uint32_t> levels() const noexcept { return levels_; }

  // Returns whether any part of the cluster may be visible in `tile`, an index into the tiles of
  // the last look() or choose().
  bool sees(std::size_t tile, std::size_t cluster) const noexcept {
    return seen_[tile * clusters_.size() + cluster];
  }

  // Updates the result of sees(), but not levels(). O(tiles x clusters).
  void look(std::span<const TileView> tiles);

 private:
  void grade();
  std::size_t spend(double kappa);  // sets levels_; returns their number of triangles
  std::size_t levelOf(double triangles) const noexcept;

  const Dendrogram& dendrogram_;
  const Clusters& clusters_;
  bool back_faces_;
  std::vector<std::uint32_t> level_table_;  // level by log2(number of triangles), in steps of 1/64
  std::vector<float> wanted_;               // by cluster: largest p g^(1/2); 0: not seen
  std::vector<std::uint8_t> seen_;          // tiles x clusters
  std::vector<std::uint32_t> levels_;
};

}  // namespace merlin::render::lod
