// Declares the cost functions of reduce(); each is implemented in a folder of its own. Private to
// render/reduce.
#pragma once

#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

// Reduces a mesh with the cost `pattern` ([GOURLEY98]): the cost of an edge is its length in
// pattern space. Errors, REQUIRES: as reduce(). Defined in pattern/pattern.cpp.
Result<Reduction> reduceByPattern(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);

// Reduces a mesh with the cost `quadric`: the cost of an edge is a quadric error over position and
// all weighted features. Errors, REQUIRES: as reduce(). Defined in quadric/quadric.cpp.
Result<Reduction> reduceByQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);
Weights quadricWeights(const mesh::Mesh& mesh);

// Returns settings.weights, or the default weights of settings.cost if those are empty. REQUIRES:
// findCost(settings.cost).
Weights weightsFor(const mesh::Mesh& mesh, const ReduceSettings& settings);

// Returns "key=value" lines that describe the reduction, for CollapseLog::about.
std::string aboutText(const ReduceSettings& settings, const Weights& weights,
                      const ReduceReport& report);

}  // namespace merlin::render::reduce
