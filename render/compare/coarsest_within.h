// The coarsest resolution of a model that certainly stays within a distance of the finest one.
#pragma once

#include <cstddef>
#include <functional>

#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

struct Within {
  std::size_t level = 0;
  double at_most = 0;  // upper bound of the level's distance from the finest one, model units
  double percent = 0;  // the same in percent of the diagonal of the finest level's box
};

// Bisects the logarithm of the number of triangles down to 2 %: a level whose distance is at most
// `percent` of the diagonal, and nearly the coarsest such. `progress`: share of the work, and how
// many levels have been compared; called on this thread. Errors: compare()'s. Cost: about ten
// comparisons. REQUIRES: percent > 0, more than one level.
Result<Within> coarsestWithin(const Dendrogram& model, double percent,
                              const std::function<void(double, std::size_t)>& progress);

}  // namespace merlin::render
