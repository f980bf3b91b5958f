// The steps of reduceByQuadric(), used for a whole mesh and for blocks of one. Private to
// render/reduce.
#pragma once

#include <vector>

#include "daemon/base/thread_team.h"
#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render::reduce {

// Parameters that are computed once for the whole mesh, so that all of its blocks use the same.
struct QuadricPlan {
  // A feature that contributes to the cost: mesh.features[feature], whose values are the channels
  // first .. first + dimension - 1.
  struct ChannelFeature {
    std::size_t feature, first;
    float scale;  // a difference of 1 costs like a distance of `scale` model units
  };
  Weights weights;
  std::vector<ChannelFeature> channels;
  bool labels_lock = false;    // vertices of different labels merge last
  float label_scale = 0;       // as ChannelFeature::scale, for the channel of locked labels
  bool seams_shrink = false;   // edges on both sides collapse together; if false, seams are locked
  std::size_t by_percent = 0;  // number of triangles for settings.min_percent
  QuadricReducer::Limits limits;
};

// Computes the plan. Errors: kInvalidArgument for weights, as reduce(). `team` provides the threads
// and must outlive the plan.
Result<QuadricPlan> planQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                ThreadTeam& team);

// Reduces `mesh`, which must have the features of the mesh that the plan was made for. locked: one
// entry per vertex, or empty; must include the vertices on seams. coincident: coincidentVertices()
// of the mesh if seams may shrink, else empty. Leaves CollapseLog::about empty.
Reduction runQuadric(const mesh::Mesh& mesh, const QuadricPlan& plan,
                     const std::vector<bool>& locked, const Progress& progress,
                     std::vector<std::uint32_t> coincident = {});

// As runQuadric(), but reduces `blocks` (more than one) blocks one after another, then what they
// leave as one mesh. Only the quadrics of one block are in memory at a time. Defined in
// out_of_core/blocks.cpp.
Reduction reduceInBlocks(const mesh::Mesh& mesh, const QuadricPlan& plan,
                         const std::vector<bool>& locked, std::size_t blocks,
                         const Progress& progress);

}  // namespace merlin::render::reduce
