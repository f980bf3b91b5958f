// Geomorphs: vertices that merge soon move gradually towards the position of the merged vertex, so
// that a change of level is not visible as a jump ("popping") ([GOURLEY98] 6.1).
//
// At level L the next collapses are L .. E-1, where E is the first level whose triangle count is
// lower by a given share. A node that collapse k of these merges is drawn at
//
//   (k - L + 1) / (E - L + 1)
//
// of the way from its parent's position to its own. The positions thus depend on the level alone,
// and change little with it: no state, no clock, and the level may jump. (H. Hoppe, "Progressive
// Meshes", 1996, section 3.3, instead interpolates between two meshes over time.) The displaced
// vertices are those that cost least to remove.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/clusters.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::lod {

struct Morph {
  std::uint32_t node = 0;
  float own = 1;  // weight of its own position: 0 at its parent's position, 1 at its own
};

// Sets `morphs` to the nodes that are displaced at `level`, by ascending number; so a parent comes
// before its children, which move towards the displaced position of a displaced parent. `share`:
// fraction of the triangles whose removal is prepared, 0 to 1; 0: no node is displaced. REQUIRES:
// level < levels(). O(log levels + size of the result).
void morphsAt(const Dendrogram& dendrogram, std::size_t level, double share,
              std::vector<Morph>& morphs);

// Does the same for cuts with one level per cluster, as for Clusters::cut(). O(collapses from the
// finest of these levels to the last one that displaces a node).
void morphsAt(const Dendrogram& dendrogram, const Clusters& clusters,
              std::span<const std::uint32_t> levels, double share, std::vector<Morph>& morphs);

}  // namespace merlin::render::lod
