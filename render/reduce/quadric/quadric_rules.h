// Rules that decide which collapses are allowed, and the additional costs of borders, seams and
// locked vertices. Private to render/reduce.
#pragma once

#include <cmath>
#include <cstdint>

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render::reduce {

// Stages of a reduction. When a stage allows no more collapses, the next one drops a rule.
enum class QuadricStage : std::uint8_t {
  kAll,      // all rules: topology stays (link condition), labels do not mix, no face flips
  kNoLock,   // labels may mix; locked vertices still stay
  kNoLink,   // parts may join or separate, holes close, components vanish, locked vertices move
  kNoFlips,  // faces may flip
};

// Returns true if this stage respects locked vertices, the link condition and seams.
inline bool keepsTopology(QuadricStage stage) noexcept { return stage <= QuadricStage::kNoLock; }

enum class Verdict : std::uint8_t { kLegal, kLink, kFlip };

// Returns true if the collapse of `edge` of w removes the last triangles of a component, or folds a
// tetrahedron flat.
bool vanishes(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs, std::uint32_t edge);

// Returns the squared length of w's longest edge, which is used as the size of a component that
// vanishes when w collapses.
float reachOf(const EdgeCosts& costs);

// Function type: judges whether w may collapse with its neighbour in row `edge` of `costs`. Pure.
using JudgeEdge = Verdict (*)(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                              std::uint32_t edge, QuadricStage stage);

// Returns the fastest implementation for this processor. All implementations return the same
// verdicts.
JudgeEdge edgeJudge();

// For tests: returns the implementation that runs on any processor.
JudgeEdge portableEdgeJudge();

// Moves the new vertex of an edge to the end that is locked. The cost becomes the quadric error of
// moving the other end there, for geometry alone (without the feature channels), but at least the
// cost at the optimal position. If both ends are locked, the cost becomes kNoEdge: the edge cannot
// collapse.
void stayAtLocked(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge);

// Computes the cost of an edge along a seam together with the coincident edge at `twin`, the vertex
// across the seam. Both new vertices are placed at that end of the edge where the sum of the two
// quadric errors is smaller; the cost of each edge becomes at least that sum.
void goAlongSeam(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge,
                 std::uint32_t twin, EdgeCosts& twin_costs, std::uint32_t twin_edge);

// For each end of the edge that lies on a border, takes the squared distance from that end to the
// border after the collapse plus the deviation that the end already has; returns the larger value
// (unit of length: mean edge length). Quadrics alone do not protect a border: a narrow flap has
// little area, so removing it costs little.
float borderDeviation(const QuadricView& view, std::uint32_t w, EdgeCosts& costs,
                      std::uint32_t edge);

// Returns r' H r: the area-weighted squared distance from the point r to the planes of the quadric
// h.
inline float costAt(const float* h, const float (&r)[3]) {
  return r[0] * (h[0] * r[0] + 2 * (h[1] * r[1] + h[2] * r[2])) +
         r[1] * (h[3] * r[1] + 2 * (h[4] * r[2])) + h[5] * r[2] * r[2];
}

inline float trace(const float* h) { return h[0] + h[3] + h[5]; }

// Returns the root mean square distance to the planes of both ends' stars that corresponds to a
// collapse of this cost, in mean edge lengths; 0 if the stars have no area.
inline float errorOf(const QuadricVertex& a, const QuadricVertex& x, float cost) {
  const float area = trace(a.h) + trace(x.h);
  return area > 0 ? std::sqrt(cost / area) : 0;
}

// Returns the minimum cost of an edge whose collapse has this squared deviation.
inline float deviationCost(float deviation) { return 100 * deviation * deviation; }

}  // namespace merlin::render::reduce
