// CollapseWorker: the data that one thread needs to collapse edges. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/bucket_queue.h"
#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render::reduce {

// A worker belongs to one part of the mesh, or to the whole mesh.
struct CollapseWorker {
  BucketQueue queue;
  StarRoom room;
  EdgeCosts costs;
  EdgeCosts twin;              // edge costs of the coincident vertex across a seam
  EdgeCosts hub;               // scratch for reviving hubs
  std::vector<Corner> merged;  // scratch for merging two stars
  // output: vertices merged into another, in the order of their collapses
  std::uint32_t* log = nullptr;
  std::size_t collapses = 0;
  std::size_t removed = 0;  // number of triangles removed
  std::size_t flips = 0, links = 0;
  std::size_t visited = 0;             // measure of work: triangles in all stars visited
  bool too_coarse = false;             // an edge was refused because of the error limit
  std::uint32_t refused_star = ~0U;    // triangles of the smallest star refused for its size
  std::vector<std::uint32_t> revived;  // hubs that now have few triangles
  bool inside_only = false;            // collapse only vertices whose whole ring is inside the part
  // Only for a part: its range of vertices along the curve (`end` exclusive), the approximate
  // number of its triangles, and its number of collapses at the end of each step.
  std::uint32_t begin = 0, end = 0;
  std::size_t triangles = 0;
  std::vector<std::size_t> steps;

  // Adds the counts of another worker to this one and takes over its returned room, but not its
  // queue.
  void takeOver(CollapseWorker&& other) {
    room.join(std::move(other.room));
    flips += other.flips;
    links += other.links;
    visited += other.visited;
    too_coarse |= other.too_coarse;
  }
};

}  // namespace merlin::render::reduce
