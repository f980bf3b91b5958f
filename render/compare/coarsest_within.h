// Finds the coarsest resolution of a model that is certain to be within a given distance of the
// finest one.
#pragma once

#include <cstddef>
#include <functional>

#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::compare {

struct LevelWithError {
  std::size_t level = 0;
  double at_most = 0;  // upper bound of the distance from the finest level [model units]
  double percent = 0;  // at_most in percent of the diagonal of the finest level's bounding box
};

// Returns a level whose distance from the finest one is at most `percent` of the diagonal of the
// bounding box, and whose number of triangles is nearly the lowest possible: bisects the logarithm
// of that number until the interval is 2 % wide. `progress` is called on this thread with the share
// of the work (0..1) and the number of levels compared. Errors: those of compare(). Time: about ten
// comparisons. REQUIRES: percent > 0; the model has more than one level.
Result<LevelWithError> coarsestWithin(const lod::Dendrogram& model, double percent,
                                      const std::function<void(double, std::size_t)>& progress);

}  // namespace merlin::render::compare
