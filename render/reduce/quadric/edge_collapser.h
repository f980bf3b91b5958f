// EdgeCollapser: carries out a collapse on the mesh. Private to render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/seams.h"

namespace merlin::render::reduce {

// Keeps references to the state and the seams, which must outlive it. Several threads may call it
// for different parts of the mesh, each with a worker of its own.
class EdgeCollapser {
 public:
  EdgeCollapser(ReductionState& state, Seams& seams)
      : s_(state), seams_(seams), evaluate_(edgeEvaluator()) {}

  // Merges the neighbour in row `edge` of w.costs, which are the edges of v, into v. Appends it to
  // the worker's log, queues neighbours that had no edge to collapse, and evaluates the edges of v
  // into w.costs, unless v has lost its last triangle.
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
