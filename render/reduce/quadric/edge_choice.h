// EdgeChoice: decides which edges of a vertex may collapse, and at what cost. Private to
// render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_witness.h"
#include "render/reduce/quadric/seams.h"

namespace merlin::render::reduce {

// Keeps references to the state and the seams, which must outlive it. Writes only to the worker and
// to edge costs, so several threads may call it if each has a worker of its own.
class EdgeChoice {
 public:
  EdgeChoice(const ReductionState& state, const Seams& seams)
      : s_(state), seams_(seams), judge_(edgeJudge()), farther_(fartherWitness()) {}

  // Excludes edges that would take too long to try, by setting their cost to kNoEdge; then finds
  // the cheapest of the others. Trying an edge visits the stars of both ends. To avoid O(n^2) time
  // for n corners, a vertex with a large star tries only a few of its edges, and no vertex tries an
  // edge to a vertex whose star is larger than its own and has more than kMostCorners triangles.
  void leaveOut(std::uint32_t v, EdgeCosts& costs) const;

  // Raises the cost of `edge` where the quadric underestimates the loss: at borders, seams, locked
  // vertices, distant witnesses and vanishing components. Returns true if the cost has risen. A
  // second call for the same edge has no effect and returns false.
  bool raise(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // Returns whether the current rules allow the collapse of `edge` of v. A refusal is counted in
  // the worker.
  bool mayCollapse(CollapseWorker& w, const EdgeCosts& costs, std::uint32_t v,
                   std::uint32_t edge) const;

 private:
  float witnessDeviation(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  const ReductionState& s_;
  const Seams& seams_;
  JudgeEdge judge_;
  FindFarther farther_;
};

}  // namespace merlin::render::reduce
