// ReductionState: the data that the steps of a reduction share. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric/collapse_worker.h"
#include "render/reduce/quadric/quadric_evaluate.h"
#include "render/reduce/quadric/quadric_rules.h"

namespace merlin::render::reduce {

inline constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

// Maximum number of triangles in a star while the topology is kept. Useful surfaces stay below it;
// a collapse next to a larger star would take too long.
inline constexpr std::uint32_t kMostCorners = 128;
// Once the topology may change, stars are unordered and their maximum number of triangles is
// kMostUnordered at first. Of a star with more than kManyCorners triangles, only a few edges are
// tried.
inline constexpr std::uint32_t kManyCorners = 16, kMostUnordered = 32;

// The rules for collapses at the current stage of the reduction.
struct CollapseRules {
  QuadricStage stage = QuadricStage::kAll;
  // Maximum triangles of a star that takes part.
  std::uint32_t most_corners = kMostCorners;
  // Maximum error of a collapse [mean edge lengths].
  float max_error = std::numeric_limits<float>::infinity();
  bool keep_components = false;
  bool fast = false;  // larger tolerance() and no witnesses

  bool keepTopology() const noexcept { return keepsTopology(stage); }
  // Returns the factor by which an edge's cost may exceed the upper end of its bucket; the edge is
  // collapsed if the cost is lower.
  float tolerance() const noexcept { return fast ? 4.0F : 1.25F; }
};

struct ReductionState {
  // `input`: the mesh to reduce. `channel_count`: number of feature channels. `with`: threads to
  // use.
  ReductionState(const mesh::Mesh& input, std::size_t channel_count, Threads with)
      : mesh(input, with),
        channels(input.vertexCount(), channel_count),
        next(input.vertexCount()),
        log(input.vertexCount()),
        triangles(input.triangleCount()),
        threads(with) {}

  QuadricMesh mesh;
  QuadricChannels channels;
  std::vector<float> labels;  // by vertex; empty if labels are not locked
  std::vector<bool> locked;   // by vertex of the input; empty if none is locked
  CollapseRules rules;
  bool hubs = false;  // whether any vertex is a hub
  // by vertex: link of its queue list; a separate array caches better
  HugeArray<std::uint32_t> next;
  HugeArray<std::uint32_t> log;  // dead vertices, in the order of their collapses
  CollapseWorker whole;          // worker of the whole mesh; takes over the sums of the parts
  std::size_t triangles;         // number of triangles left
  Threads threads;
  bool cancelled = false;

  QuadricView view() const { return {&mesh[0], mesh.corners(0), &channels}; }

  auto nextOf() {
    return [this](std::uint32_t v) -> std::uint32_t& { return next[v]; };
  }

  // Adds v to the worker's queue. `cost`: cost of its cheapest edge; if that is kNoEdge, marks v as
  // idle instead.
  void enqueue(CollapseWorker& w, std::uint32_t v, float cost) {
    if (cost >= kNoEdge)
      mesh[v].flags |= kIdle;
    else
      w.queue.push(v, cost, nextOf());
  }
};

}  // namespace merlin::render::reduce
