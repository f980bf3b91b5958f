// Seams: keeps the two sides of a seam together. A seam is where two vertices coincide because a
// feature differs between the two sides; edges on both sides collapse together, so that the seam
// does not open. Private to render/reduce.
#pragma once

#include <cstdint>
#include <vector>

#include "render/reduce/quadric/reduction_state.h"

namespace merlin::render::reduce {

// Keeps a reference to the state, which must outlive it. Several threads may call it at the same
// time for different parts of the mesh.
class Seams {
 public:
  explicit Seams(ReductionState& state) : s_(state), evaluate_(edgeEvaluator()) {}

  // Lets seams shrink: where exactly two vertices coincide, an edge along the seam may collapse
  // together with the coincident edge on the other side. next: rings of coincident vertices, the
  // result of coincidentVertices() for the input mesh.
  void pair(const std::vector<std::uint32_t>& next);

  // Returns the vertex that coincides with v across a seam that may shrink, or kNowhere.
  std::uint32_t twinOf(std::uint32_t v) const { return twins_.empty() ? kNowhere : twins_[v]; }

  // Returns true if `edge` of v is along a seam, whose two sides have to collapse together.
  bool isAlong(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge) const {
    return !twins_.empty() && s_.rules.keepTopology() && costs.shared[edge] == 1 &&
           twins_[v] != kNowhere && twins_[costs.neighbour[edge]] != kNowhere;
  }

  // Evaluates the edges of v's twin into w.twin and returns the row of the edge that coincides with
  // `edge` of v. Returns kNowhere if there is no such edge, or if the two sides are so close that
  // one collapse would change the other side's edge. REQUIRES: isAlong(w.costs, v, edge).
  std::uint32_t findTwinEdge(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // Sets the cost of `edge` to the cost of collapsing it together with its twin edge; kNoEdge if
  // there is no twin edge. REQUIRES: isAlong(w.costs, v, edge).
  void setCost(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const;

  // Records that x merges into v: the twin of x, if any, becomes the twin of v. No effect if v is
  // locked.
  void merge(std::uint32_t v, std::uint32_t x);

  // Adds the sum of the face normals of the current star of v's twin to `normal` (3 floats), if
  // both sides form one smooth surface.
  void addTwinNormal(std::uint32_t v, float* normal) const;

  // Copies the normal in the node record of dead vertex `from` to that of dead vertex `to`, if both
  // sides form one smooth surface.
  void shareNormal(std::uint32_t from, std::uint32_t to) const;

 private:
  ReductionState& s_;
  EvaluateEdges evaluate_;
  std::vector<std::uint32_t> twins_;  // by vertex: its twin, or kNowhere; empty: no seam shrinks
};

}  // namespace merlin::render::reduce
