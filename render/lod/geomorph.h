// Geomorphs: vertices that merge next are already on their way to where they will, so that nothing
// pops when they do ([GOURLEY98] 6.1).
//
// At level L, of the collapses L .. E-1 that come next, the two nodes that collapse k merges stand
//
//   (k - L + 1) / (E - L + 1)
//
// of the way from their parent's place to their own, E being the level with a given share of the
// triangles less. So what is seen is a function of the level alone, and changes little with it: no
// state, no clock, and levels may jump. (H. Hoppe, "Progressive Meshes", 1996, section 3.3: there
// between two meshes, by time.) What stands elsewhere is what costs least to lose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/clusters.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

struct Morph {
  std::uint32_t node = 0;
  float own = 1;  // 0: at its parent's place; 1: at its own
};

// The nodes that are on their way at `level`, by rising number: a parent comes before its children,
// and where it is itself on its way, it is there that they go. `share`: of the triangles, 0 to 1;
// 0: none are. REQUIRES: level < levels(). O(log levels + what is returned).
void morphsAt(const Dendrogram& dendrogram, std::size_t level, double share,
              std::vector<Morph>& morphs);

// The same where each cluster has a level of its own, as Clusters::cut() wants them. O(nodes that
// are alive at the finest of them and not at the coarsest).
void morphsAt(const Dendrogram& dendrogram, const Clusters& clusters,
              std::span<const std::uint32_t> levels, double share, std::vector<Morph>& morphs);

}  // namespace merlin::render
