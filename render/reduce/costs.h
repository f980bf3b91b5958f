// The cost functions of reduce(), one folder each. Private to render/reduce.
#pragma once

#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

// The cost `pattern`, the method of [GOURLEY98]: the length of the edge in pattern space. Defined
// in pattern/pattern.cpp.
Result<Reduction> reduceByPattern(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);

// The cost `quadric`: quadrics over position and all weighted features. Defined in
// quadric/quadric.cpp.
Result<Reduction> reduceByQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress);
Weights quadricWeights(const mesh::Mesh& mesh);

// Returns the weights of the settings, or the cost's default weights if those are empty.
Weights weightsFor(const mesh::Mesh& mesh, const ReduceSettings& settings);

// Returns "key=value" lines that describe the reduction, for CollapseLog::about.
std::string aboutText(const ReduceSettings& settings, const Weights& weights,
                      const ReduceReport& report);

}  // namespace merlin::render::reduce
