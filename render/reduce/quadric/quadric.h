// Declares the steps of reduceByQuadric(); they are used for a whole mesh and for its blocks.
// Private to render/reduce.
#pragma once

#include <vector>

#include "daemon/base/thread_team.h"
#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render::reduce {

// Parameters computed once for the whole mesh, so that all of its blocks use the same values.
struct QuadricPlan {
  // A feature that contributes to the cost: mesh.features[feature]. Its values are the channels
  // first .. first + dimension - 1.
  struct ChannelFeature {
    std::size_t feature, first;
    float scale;  // a value difference of 1 costs as much as a distance of `scale` model units
  };
  Weights weights;
  std::vector<ChannelFeature> channels;
  // vertices with different labels merge only when nothing else may collapse
  bool labels_lock = false;
  float label_scale = 0;  // ChannelFeature::scale of the label channel, used if labels_lock
  // true: both sides of a seam collapse together; false: seams are locked
  bool seams_shrink = false;
  std::size_t by_percent = 0;  // settings.min_percent as a number of triangles
  QuadricReducer::Limits limits;
};

// Computes the plan for a mesh. Errors: kInvalidArgument for invalid weights, as in reduce().
// `team` provides the threads and must outlive the plan.
Result<QuadricPlan> planQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                ThreadTeam& team);

// Reduces `mesh`, which must have the features of the mesh that the plan was made for. locked: one
// entry per vertex, or empty; must include the vertices on seams. coincident: the result of
// coincidentVertices() for this mesh if seams may shrink, else empty. Leaves CollapseLog::about
// empty.
Reduction runQuadric(const mesh::Mesh& mesh, const QuadricPlan& plan,
                     const std::vector<bool>& locked, const Progress& progress,
                     std::vector<std::uint32_t> coincident = {});

// Does what runQuadric() does, but with less memory: reduces the mesh in `blocks` (more than one)
// blocks, one after another, then reduces what the blocks leave as one mesh. Only the quadrics of
// one block are in memory at a time. Defined in out_of_core/blocks.cpp.
Reduction reduceInBlocks(const mesh::Mesh& mesh, const QuadricPlan& plan,
                         const std::vector<bool>& locked, std::size_t blocks,
                         const Progress& progress);

}  // namespace merlin::render::reduce
