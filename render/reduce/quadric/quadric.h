// The parts of reduceByQuadric(), for a mesh as a whole and for blocks of it. Private to
// render/reduce.
#pragma once

#include <vector>

#include "daemon/base/thread_team.h"
#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render {

// Decisions that are made once for the whole mesh, so that all of its blocks are measured alike.
struct QuadricPlan {
  // Feature f of the mesh as channels first .. first + dimension - 1.
  struct ChannelFeature {
    std::size_t feature, first;
    float scale;  // model units a difference of 1 weighs
  };
  Weights weights;
  std::vector<ChannelFeature> channels;
  bool labels_lock = false;
  float label_scale = 0;       // of the step between locked labels: model units
  bool seams_shrink = false;   // both sides at once; else their vertices stay
  std::size_t by_percent = 0;  // triangles that settings.min_percent leaves
  QuadricReducer::Limits limits;
};

// Errors: of weights and criteria, as reduce(). `team`: its threads do the work; outlives the plan.
Result<QuadricPlan> planQuadric(const Mesh& mesh, const ReduceSettings& settings, ThreadTeam& team);

// Reduces `mesh`, which has the features that the plan was made with. locked: one a vertex, or
// empty; seams' vertices are. places: samePlace(), where seams are to shrink. The log lacks its
// `about`.
Reduction runQuadric(const Mesh& mesh, const QuadricPlan& plan, const std::vector<bool>& locked,
                     const Progress& progress, std::vector<std::uint32_t> places = {});

// The same in so many blocks, more than one: blocks.cpp. Of their quadrics those of one block are
// in memory, then those of what all have left.
Reduction reduceInBlocks(const Mesh& mesh, const QuadricPlan& plan, const std::vector<bool>& locked,
                         std::size_t blocks, const Progress& progress);

}  // namespace merlin::render
