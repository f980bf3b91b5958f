// Which collapses may be, and what more a border costs. Private to render/reduce.
#pragma once

#include <cstdint>

#include "render/reduce/quadric_evaluate.h"

namespace merlin::render {

// Rules fall one after another once nothing is left that they allow.
enum class QuadricStage : std::uint8_t {
  kAll,      // topology stays (link condition), every component keeps a triangle, no face flips
  kNoLink,   // parts may join or pinch off, holes close
  kNoFlips,  // faces may flip
};

enum class Verdict : std::uint8_t { kLegal, kLink, kFlip };

// Whether w may collapse with its neighbour number `edge` of `costs`. Pure.
Verdict judge(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs, std::uint32_t edge,
              QuadricStage stage);

// Squared distance of the two ends that lie on a border, and of what they stand for, to the border
// as it would be. A border loses little area where a flap is worn off; so it is watched by length.
float borderDeviation(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                      std::uint32_t edge);

// What an edge costs at least whose border deviation (squared) is this.
inline float borderCost(float deviation) { return 30 * deviation * deviation; }

}  // namespace merlin::render
