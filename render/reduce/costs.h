// The costs that reduce() knows, one file each. Private to render/reduce.
#pragma once

#include "render/reduce/reduce.h"

namespace merlin::render {

// 1998's: the length of the edge in pattern space. pattern.cpp
Result<Reduction> reduceByPattern(const Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);

// Quadrics in the space of position and all weighted features. quadric.cpp
Result<Reduction> reduceByQuadric(const Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);
Weights quadricWeights(const Mesh& mesh);

// The settings' weights, or those of the cost.
Weights weightsFor(const Mesh& mesh, const ReduceSettings& settings);

// "key=value" lines for the model's file.
std::string aboutText(const ReduceSettings& settings, const Weights& weights,
                      const ReduceReport& report);

}  // namespace merlin::render
