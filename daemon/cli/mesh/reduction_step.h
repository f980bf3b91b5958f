// The step from a mesh to a model that `merlin mesh reduce` and `merlin mesh import` share.
#pragma once

#include "daemon/base/result.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// reduce(), with its progress on stderr. `seconds`: receives the time it took. Errors: those of
// reduce().
Result<render::reduce::Reduction> reduceWithProgress(const render::mesh::Mesh& mesh,
                                                     const render::reduce::ReduceSettings& settings,
                                                     double& seconds);

}  // namespace merlin::cli
