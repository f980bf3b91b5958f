// QuadricReducer: reduces a mesh by the edge costs of quadric_evaluate.h, on several threads.
// Private to render/reduce.
//
// Large meshes are first reduced in parts, in parallel (PartsReduction), until at most about a
// sixth of the triangles is left, or three times the requested number if that is more. Then the
// mesh is reduced as a whole (WholeReduction), in stages, each of which drops a rule of the stage
// before. Both use a CollapseLoop, in which EdgeChoice decides which edge of a vertex may collapse,
// EdgeCollapser carries out the collapse, and Seams keeps the two sides of a seam together.
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

  // Sets the values of a channel: values[v * stride] is the value at vertex v of the input mesh. A
  // value difference of 1 costs as much as a distance of `scale` model units.
  void setChannel(std::size_t channel, const float* values, std::size_t stride, float scale);

  // Sets the labels: values[v] is the label of vertex v of the input mesh. Vertices with different
  // labels merge only when no other collapse is allowed.
  void setLabels(const float* values);

  // Locks each vertex v of the input mesh with locked[v]: it keeps its position as long as any
  // other collapse is allowed.
  void lock(const std::vector<bool>& locked);

  // Lets seams shrink: where exactly two vertices coincide, an edge along the seam may collapse
  // together with the coincident edge on the other side. next: rings of coincident vertices, the
  // result of coincidentVertices() for the input mesh. Call after lock() has locked the vertices on
  // seams.
  void pair(const std::vector<std::uint32_t>& next) { seams_.pair(next); }

  struct Limits {
    std::size_t triangles = 0;  // stop when at most this many are left; 0: no limit
    // maximum error of a collapse [model units]
    float error = std::numeric_limits<float>::infinity();
    bool preserve_topology = false, preserve_components = false;
    bool by_all_rules = false;  // stop when the rules allow no collapse, instead of dropping a rule
    bool fast = false;          // faster, less accurate: see CollapseRules::fast
    Threads threads = 1;
  };
  // Reduces the mesh and returns why it stopped: one of the values of ReduceReport::stopped.
  // `progress` is called on the caller's thread; false cancels.
  const char* run(const Limits& limits, const Progress& progress);

  // Writes the value of a channel at the node of each collapse k to values[k * stride], in the unit
  // in which setChannel() received it. `scale`: the same as for setChannel().
  void channelValues(std::size_t channel, float scale, float* values, std::size_t stride) const;

  // Returns the report and the log; only the log's feature "normal" is filled. Call once, after
  // run().
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
