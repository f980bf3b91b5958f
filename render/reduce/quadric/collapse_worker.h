// CollapseWorker: what one thread needs to collapse edges. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/bucket_queue.h"
#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render::reduce {

// Works on a part of the mesh, or on the whole mesh.
struct CollapseWorker {
  BucketQueue queue;
  StarRoom room;
  EdgeCosts costs;
  EdgeCosts twin;                // of the coincident vertex across a seam
  EdgeCosts hub;                 // scratch
  std::vector<Corner> merged;    // scratch
  std::uint32_t* log = nullptr;  // dead vertices, in order
  std::size_t collapses = 0;
  std::size_t removed = 0;  // triangles
  std::size_t flips = 0, links = 0;
  std::size_t visited = 0;             // triangles in all stars that were looked at
  bool too_coarse = false;             // an edge was refused because of the error limit
  std::uint32_t refused_star = ~0U;    // triangles of the smallest star refused for its size
  std::vector<std::uint32_t> revived;  // hubs that now have few triangles
  bool inside_only = false;            // for a part: only vertices whose ring is inside it
  // For a part: the range of its vertices on the curve, its number of triangles (about), and the
  // number of collapses at the end of each step.
  std::uint32_t begin = 0, end = 0;
  std::size_t triangles = 0;
  std::vector<std::size_t> steps;

  // Takes over the counts of another worker and the room that it returned, but not its queue.
  void takeOver(CollapseWorker&& other) {
    room.join(std::move(other.room));
    flips += other.flips;
    links += other.links;
    visited += other.visited;
    too_coarse |= other.too_coarse;
  }
};

}  // namespace merlin::render::reduce
