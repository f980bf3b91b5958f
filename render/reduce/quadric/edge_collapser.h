// EdgeCollapser: carries out a collapse on the mesh. Private to render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/seams.h"

namespace merlin::render::reduce {

// Keeps references to the state and the seams, which must outlive it. Several threads may call
// collapse() at the same time if each has a worker of its own and works on a different part of the
// mesh.
class EdgeCollapser {
 public:
  EdgeCollapser(ReductionState& state, Seams& seams)
      : s_(state), seams_(seams), evaluate_(edgeEvaluator()) {}

  // Collapses an edge of v: merges the neighbour in row `edge` of w.costs into v, and appends that
  // neighbour to the worker's log. Puts adjacent vertices that had no edge to collapse back into
  // the queue. Then evaluates the new edges of v into w.costs, unless v has lost its last triangle.
  // REQUIRES: w.costs holds the edges of v.
  void collapse(CollapseWorker& w, std::uint32_t v, std::uint32_t edge);

 private:
  NodeRecord mergeVertices(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge);
  void mergeStars(CollapseWorker& w, std::uint32_t v, std::uint32_t x);
  void storeStar(CollapseWorker& w, std::uint32_t v, std::uint32_t x, std::uint32_t corners);
  void renameInRing(CollapseWorker& w, std::uint32_t o, std::uint32_t v, std::uint32_t x,
                    bool beside);
  void wakeRing(CollapseWorker& w, std::uint32_t v, float cost);
  void loseTriangle(CollapseWorker& w, std::uint32_t o);
  void reviveHubs(CollapseWorker& w, float cost);

  ReductionState& s_;
  Seams& seams_;
  EvaluateEdges evaluate_;
};

}  // namespace merlin::render::reduce
