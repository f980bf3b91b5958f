// Witnesses: how far the surface gets from what it stands for. Private to render/reduce.
//
// A quadric sees distance times area: where there is little area, on a thin tip or a narrow ridge,
// it sees little of what is lost. So each vertex knows one of the mesh's vertices that it stands
// for, its witness: at first itself, and of the two witnesses of an edge the one that is farther
// from the surface once the edge is gone. One is enough, since what is far off stays so.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render {

// The witness of an edge: the farther one of its two ends' witnesses.
struct FartherWitness {
  float distance2;    // from the new vertex' star, squared
  std::uint32_t end;  // whose it is: w's (0) or the neighbour's (1)
};

// Finds the farther witness of w and its neighbour number `edge` of `costs`. Pure.
using FindFarther = FartherWitness (*)(const QuadricView& view, std::uint32_t w,
                                       const EdgeCosts& costs, std::uint32_t edge);

// a, which goes to `to`, stands for what `of` (itself, or what it is merged with) stood for.
void keepWitness(QuadricVertex& a, const QuadricVertex& of, const float* to) noexcept;

// The fastest for this processor. All give the same bits.
FindFarther fartherWitness();

// For tests: that of any processor.
FindFarther portableFartherWitness();

}  // namespace merlin::render
