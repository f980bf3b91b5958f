// Witnesses: input vertices that show how far the reduced surface is from the input. Private to
// render/reduce.
//
// A quadric measures squared distance times area. Where there is little area, on a thin tip or a
// narrow ridge, it underestimates the loss. So each vertex keeps the position of one input vertex
// that it replaces, its witness. At first this is the vertex itself; after a collapse it is the one
// of the two ends' witnesses that is farther from the new surface. One witness is enough, since a
// distant one stays distant.
#pragma once

#include <cstdint>

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::render::reduce {

// The witness of an edge: the one of its two ends' witnesses that is farther from the new surface.
struct FartherWitness {
  float distance2;    // squared distance to the star of the new vertex
  std::uint32_t end;  // the end whose witness it is: w (0) or the neighbour (1)
};

// Function type: returns the farther witness for the collapse of w with its neighbour in row `edge`
// of `costs`. Pure.
using FindFarther = FartherWitness (*)(const QuadricView& view, std::uint32_t w,
                                       const EdgeCosts& costs, std::uint32_t edge);

// Makes the witness of `of` the witness of `a`, which moves to position `to`. `of` is `a` itself or
// the vertex that merges into `a`. REQUIRES: the positions of `a` and `of` are still the old ones.
void keepWitness(QuadricVertex& a, const QuadricVertex& of, const float* to) noexcept;

// Returns the fastest implementation for this processor. All implementations return bit-identical
// results.
FindFarther fartherWitness();

// For tests: returns the implementation that runs on any processor.
FindFarther portableFartherWitness();

}  // namespace merlin::render::reduce
