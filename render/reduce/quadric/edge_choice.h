// EdgeChoice: which edges of a vertex may collapse, and at what cost. Private to render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_witness.h"
#include "render/reduce/quadric/seams.h"

namespace merlin::render::reduce {

// Keeps references to the state and the seams, which must outlive it. Changes nothing but the
// worker. Several threads may call it, each with a worker of its own.
class EdgeChoice {
 public:
  EdgeChoice(const ReductionState& state, const Seams& seams)
      : s_(state), seams_(seams), judge_(edgeJudge()), farther_(fartherWitness()) {}

  // Leaves out edges whose trial would take too long, by setting their cost to kNoEdge, then finds
  // the cheapest. Trying an edge looks at the stars of both ends. To avoid O(n^2) for n corners, a
  // vertex with a large star tries only a few of its edges, and no vertex tries an edge to a larger
  // star of more than kMostCorners triangles.
  void leaveOut(std::uint32_t v, EdgeCosts& costs) const;

  // Raises the cost of `edge`, once, where the quadric underestimates the loss: at borders, seams,
  // locked vertices, distant witnesses and vanishing components. Returns whether it has risen.
  bool raise(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // Whether the present rules allow the collapse of `edge` of v; counts it if they do not.
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
