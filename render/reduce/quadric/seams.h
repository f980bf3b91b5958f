// Seams: at a seam two vertices coincide, because a feature differs on either side. Edges on both
// sides collapse together, so that the seam does not open. Private to render/reduce.
#pragma once

#include <cstdint>
#include <vector>

#include "render/reduce/quadric/reduction_state.h"

namespace merlin::render::reduce {

// Keeps a reference to the state, which must outlive it. Several threads may call it for different
// parts of the mesh.
class Seams {
 public:
  explicit Seams(ReductionState& state) : s_(state), evaluate_(edgeEvaluator()) {}

  // Lets seams shrink. next: rings of coincident vertices of the input mesh. Where a ring has two
  // vertices, an edge along the seam may collapse together with the coincident edge on the other
  // side.
  void pair(const std::vector<std::uint32_t>& next);

  // The vertex that coincides with v across a seam that may shrink, or kNowhere.
  std::uint32_t twinOf(std::uint32_t v) const { return twins_.empty() ? kNowhere : twins_[v]; }

  // True if `edge` of v is along a seam, whose two sides have to collapse together.
  bool isAlong(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge) const {
    return !twins_.empty() && s_.rules.keepTopology() && costs.shared[edge] == 1 &&
           twins_[v] != kNowhere && twins_[costs.neighbour[edge]] != kNowhere;
  }

  // Evaluates the edges of v's twin into w.twin and returns the row of the one that coincides with
  // `edge` of v. kNowhere if there is none, or if the two sides are so close that one collapse
  // would change the other side's edge. REQUIRES: isAlong(w.costs, v, edge).
  std::uint32_t findTwinEdge(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // Sets the cost of `edge` to that of both sides together; kNoEdge if there is no twin edge.
  // REQUIRES: isAlong(w.costs, v, edge).
  void setCost(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // x merges into v: the twin of x becomes that of v.
  void merge(std::uint32_t v, std::uint32_t x);

  // Adds the normal of the present star of v's twin to `normal`, if both sides are one surface.
  void addTwinNormal(std::uint32_t v, float* normal) const;

  // Copies the normal of the node of `from` to that of `to`, if both sides are one surface.
  void shareNormal(std::uint32_t from, std::uint32_t to) const;

 private:
  ReductionState& s_;
  EvaluateEdges evaluate_;
  std::vector<std::uint32_t> twins_;  // by vertex: its twin, or kNowhere; empty: no seam shrinks
};

}  // namespace merlin::render::reduce
