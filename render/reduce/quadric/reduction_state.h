// ReductionState: what the steps of a reduction share. Private to render/reduce.
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
// Once the topology may change, stars are unordered; the maximum is then kMostUnordered at first.
// If a star has more than kManyCorners triangles, only a few of its edges are tried.
inline constexpr std::uint32_t kManyCorners = 16, kMostUnordered = 32;

// Which collapses are allowed at present.
struct CollapseRules {
  QuadricStage stage = QuadricStage::kAll;
  std::uint32_t most_corners = kMostCorners;                 // of the stars that take part
  float max_error = std::numeric_limits<float>::infinity();  // unit: mean edge length
  bool keep_components = false;
  bool fast = false;  // accept costs up to 4 times that of the queue; use no witnesses

  bool keepTopology() const noexcept { return keepsTopology(stage); }
  // An edge is collapsed if its cost is below the upper end of its bucket times this factor.
  float tolerance() const noexcept { return fast ? 4.0F : 1.25F; }
};

struct ReductionState {
  // The mesh must outlive the state. `channels`: their number.
  ReductionState(const mesh::Mesh& input, std::size_t channel_count, Threads with)
      : mesh(input, with),
        channels(input.vertexCount(), channel_count),
        next(input.vertexCount()),
        log(input.vertexCount()),
        triangles(input.triangleCount()),
        threads(with) {}

  QuadricMesh mesh;
  QuadricChannels channels;
  std::vector<float> labels;  // by vertex; empty if there are none
  std::vector<bool> locked;   // by vertex of the input; empty if none is locked
  CollapseRules rules;
  bool hubs = false;              // some vertex is a hub
  HugeArray<std::uint32_t> next;  // links of the queues' lists; not in the records, to stay cached
  HugeArray<std::uint32_t> log;   // dead vertices, in the order of their collapses
  CollapseWorker whole;           // worker of the whole mesh; with parts: their sums
  std::size_t triangles;          // left
  Threads threads;
  bool cancelled = false;

  QuadricView view() const { return {&mesh[0], mesh.corners(0), &channels}; }

  auto nextOf() {
    return [this](std::uint32_t v) -> std::uint32_t& { return next[v]; };
  }

  // Queues v by the cost of its cheapest edge, if it has one that may collapse.
  void enqueue(CollapseWorker& w, std::uint32_t v, float cost) {
    if (cost >= kNoEdge)
      mesh[v].flags |= kIdle;
    else
      w.queue.push(v, cost, nextOf());
  }
};

}  // namespace merlin::render::reduce
