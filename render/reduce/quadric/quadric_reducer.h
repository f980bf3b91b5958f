// QuadricReducer: collapses edges by the costs of quadric_evaluate, on several threads. Private to
// render/reduce.
//
// Large meshes are first reduced in parts, side by side (PartsReduction). When a sixth of the
// triangles is left, the mesh is reduced as a whole (WholeReduction), in stages, each of which
// drops a rule of the one before. Both run a CollapseLoop: EdgeChoice says which edge of a vertex
// may collapse, EdgeCollapser carries that out, Seams keeps the two sides of a seam together.
// LogBuilder makes the log.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "render/reduce/quadric/collapse_loop.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

class QuadricReducer {
 public:
  // `channels`: number of feature values per vertex that contribute to the cost. The mesh must
  // outlive the reducer.
  QuadricReducer(const mesh::Mesh& mesh, std::size_t channels, Threads threads);

  // Sets a channel: values[v * stride] is its value at vertex v of the mesh. A difference of 1
  // costs like a distance of `scale` model units.
  void setChannel(std::size_t channel, const float* values, std::size_t stride, float scale);

  // values: one label per vertex of the mesh. Vertices with different labels merge only when no
  // other collapse is allowed.
  void setLabels(const float* values);

  // Keeps each vertex v of the mesh with locked[v] where it is as long as any other collapse is
  // allowed.
  void lock(const std::vector<bool>& locked);

  // Lets seams shrink; to be called after lock() has locked their vertices. next: rings of
  // coincident vertices of the mesh (coincidentVertices()). Where a ring has two vertices, an edge
  // along the seam may collapse together with the coincident edge on the other side.
  void pair(const std::vector<std::uint32_t>& next) { seams_.pair(next); }

  struct Limits {
    std::size_t triangles = 0;  // stop when no more than these are left; 0: no limit
    float error = std::numeric_limits<float>::infinity();  // maximum of a collapse, model units
    bool preserve_topology = false, preserve_components = false;
    bool by_all_rules = false;  // stop when the rules allow no more, instead of dropping one
    bool fast = false;          // accept costs up to 4 times that of the queue; use no witnesses
    Threads threads = 1;
  };
  // Returns why it stopped: a value of ReduceReport::stopped.
  const char* run(const Limits& limits, const Progress& progress);

  // Writes a channel's value at the node of collapse k to values[k * stride], in the unit in which
  // setChannel() was given them. `scale`: as in setChannel().
  void channelValues(std::size_t channel, float scale, float* values, std::size_t stride) const;

  // Returns the log; of its features only "normal" is filled.
  Reduction finish();

 private:
  void runStages(std::size_t keep, const Limits& limits, const Progress& progress);

  const mesh::Mesh& input_;
  ReductionState state_;
  Seams seams_{state_};
  CollapseLoop loop_{state_, seams_};
  std::size_t by_all_rules_ = 0;  // triangles left when the first rule was dropped
};

}  // namespace merlin::render::reduce
