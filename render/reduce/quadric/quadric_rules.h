// Which collapses may be, and what more a border costs. Private to render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render {

// Rules fall one after another once nothing is left that they allow.
enum class QuadricStage : std::uint8_t {
  kAll,      // topology stays (link condition), labels do not mix, no face flips
  kNoLock,   // labels may mix, what is locked stays
  kNoLink,   // parts may join or pinch off, holes close, components vanish
  kNoFlips,  // faces may flip
};

// While locks, links and seams hold: nothing may go that the mesh's topology needs.
inline bool keepsTopology(QuadricStage stage) noexcept { return stage <= QuadricStage::kNoLock; }

enum class Verdict : std::uint8_t { kLegal, kLink, kFlip };

// Whether a collapse leaves no surface of a component, or only a tetrahedron folded flat.
bool vanishes(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs, std::uint32_t edge);

// Squared length of the longest edge at w's neighbour and at w itself: how far what vanishes
// reaches.
float reachOf(const EdgeCosts& costs);

// Whether w may collapse with its neighbour number `edge` of `costs`. Pure.
using JudgeEdge = Verdict (*)(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                              std::uint32_t edge, QuadricStage stage);

// The fastest for this processor. All give the same verdicts.
JudgeEdge edgeJudge();

// For tests: that of any processor.
JudgeEdge portableEdgeJudge();

// Puts the new vertex where the locked end is, and says what that costs (of the channels what they
// cost at their best place). kNoEdge where both ends are locked.
void stayAtLocked(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge);

// Prices an edge along a seam, whose vertices exist on both sides, w's and `twin`'s: both new
// vertices go to the end of the edge where the two together cost less, and that sum becomes the
// cost of w's edge.
void goAlongSeam(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge,
                 std::uint32_t twin, EdgeCosts& twin_costs, std::uint32_t twin_edge);

// Squared distance of the two ends that lie on a border, and of what they stand for, to the border
// as it would be. A border loses little area where a flap is worn off; so it is watched by length.
float borderDeviation(const QuadricView& view, std::uint32_t w, EdgeCosts& costs,
                      std::uint32_t edge);

// r' H r: area times squared distance to the planes of a quadric.
inline float costAt(const float* h, const float (&r)[3]) {
  return r[0] * (h[0] * r[0] + 2 * (h[1] * r[1] + h[2] * r[2])) +
         r[1] * (h[3] * r[1] + 2 * (h[4] * r[2])) + h[5] * r[2] * r[2];
}

// Least cost of an edge with this squared deviation.
inline float deviationCost(float deviation) { return 100 * deviation * deviation; }

}  // namespace merlin::render
