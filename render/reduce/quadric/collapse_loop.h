// CollapseLoop: takes vertices from a worker's queue, cheapest first, and collapses one edge of
// each. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/reduce/quadric/edge_choice.h"
#include "render/reduce/quadric/edge_collapser.h"

namespace merlin::render::reduce {

// Keeps references to the state and the seams, which must outlive the loop. Several threads may
// call reduceTo() at the same time if each has a worker of its own and works on a different part of
// the mesh.
class CollapseLoop {
 public:
  CollapseLoop(ReductionState& state, Seams& seams)
      : s_(state),
        seams_(seams),
        choice_(state, seams),
        collapser_(state, seams),
        evaluate_(edgeEvaluator()) {}

  // Collapses edges until the worker has removed `removed` triangles or its queue has no vertex
  // left in a bucket whose index is below `bucket_limit`.
  void reduceTo(CollapseWorker& w, std::size_t removed, std::size_t bucket_limit);

 private:
  void prefetch(CollapseWorker& w);
  void tryVertex(CollapseWorker& w, std::uint32_t v);
  bool collapse(CollapseWorker& w, std::uint32_t v, std::uint32_t edge);
  bool collapseSeam(CollapseWorker& w, std::uint32_t v, std::uint32_t edge);

  ReductionState& s_;
  Seams& seams_;
  EdgeChoice choice_;
  EdgeCollapser collapser_;
  EvaluateEdges evaluate_;
};

}  // namespace merlin::render::reduce
