// Witnesses: input vertices that tell how far the reduced surface is from the input. Private to
// render/reduce.
//
// A quadric measures distance times area. Where there is little area, on a thin tip or a narrow
// ridge, it underestimates what is lost. So each vertex keeps the position of one input vertex that
// it replaces, its witness: at first itself; after a collapse, of the two ends' witnesses the one
// that is farther from the new surface. One witness is enough, since a distant one stays distant.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render::reduce {

// The witness of an edge: the farther one of its two ends' witnesses.
struct FartherWitness {
  float distance2;    // squared distance from the star of the new vertex
  std::uint32_t end;  // the end that has it: w (0) or the neighbour (1)
};

// Finds the farther witness of w and its neighbour in row `edge` of `costs`. Pure.
using FindFarther = FartherWitness (*)(const QuadricView& view, std::uint32_t w,
                                       const EdgeCosts& costs, std::uint32_t edge);

// Gives `a`, which moves to `to`, the witness of `of` (either `a` itself or the vertex that merges
// into it).
void keepWitness(QuadricVertex& a, const QuadricVertex& of, const float* to) noexcept;

// Returns the fastest implementation for this processor. All give the same bits.
FindFarther fartherWitness();

// For tests: the implementation that runs on any processor.
FindFarther portableFartherWitness();

}  // namespace merlin::render::reduce
