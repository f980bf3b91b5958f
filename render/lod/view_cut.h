// ViewCut: which level each cluster is cut at, so that one budget over all tiles of the wall is
// spent where they look ([GOURLEY98] 5.4, 6.1).
//
// What one sees of a coarse surface is its shading: normals that are off by about T^-1/2 where the
// whole is cut to T triangles. A cluster of n triangles of which p pixels show one model unit has
// n p^2 g pixels, g the cosine at which it is seen. The squared error over all pixels is least, for
// a sum of triangles, where
//
//   T_c = kappa p_c g_c^(1/2)
//
// T_c is the count that the whole model would have at the cluster's level. What no tile sees wants
// nothing, but a neighbour has at least two fifths of a cluster's T: triangles between fine and
// very coarse fold over. kappa follows from the budget by bisection. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "render/lod/clusters.h"

namespace merlin::render {

// The view of one tile.
struct TileView {
  Eigen::Matrix4f clip_from_model;  // OpenGL's clip space; perspective
  int width_px = 0;
  float weight = 1;  // of its pixels' errors, as a root
};

// Thread-bound: keeps its tables and the last answer.
class ViewCut {
 public:
  // Borrows both. `back_faces`: they are drawn, so what faces away counts as well.
  ViewCut(const Dendrogram& dendrogram, const Clusters& clusters, bool back_faces);

  // Levels for these tiles, of at most `budget` triangles together where the coarsest are no more.
  // False where an even cut is as good: all is seen at much the same scale, or the budget is beyond
  // what clusters can do; levels() then stay as they were. Under a millisecond.
  bool choose(std::span<const TileView> tiles, std::size_t budget);

  std::span<const std::uint32_t> levels() const noexcept { return levels_; }

  // Whether `tile`, one of those last given to look(), may see any part of the cluster.
  bool sees(std::size_t tile, std::size_t cluster) const noexcept {
    return seen_[tile * clusters_.size() + cluster];
  }

  // Only finds out what is seen. O(tiles x clusters).
  void look(std::span<const TileView> tiles);

 private:
  void grade();
  std::size_t spend(double kappa);  // sets levels_; returns triangles
  std::size_t levelOf(double triangles) const noexcept;

  const Dendrogram& dendrogram_;
  const Clusters& clusters_;
  bool back_faces_;
  std::vector<std::uint32_t> level_table_;  // by log2 of triangles, 64 steps an octave
  std::vector<float> wanted_;               // by cluster: p g^(1/2); 0: not seen
  std::vector<std::uint8_t> seen_;          // tiles x clusters
  std::vector<std::uint32_t> levels_;
};

}  // namespace merlin::render
