// Measures the error of a model's resolutions as a function of their number of triangles: the
// estimate that the model stores, and the measured distance from the finest resolution.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/compare/compare.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::compare {

// Comparison of one resolution with the finest one; lengths in model units.
struct ErrorPoint {
  std::size_t level, triangles;
  double estimate;
  Deviation error;  // the larger one of both directions: Comparison::symmetric()
};

struct ErrorCurve {
  double diagonal = 0;             // diagonal of the finest level's bounding box [model units]
  std::vector<ErrorPoint> points;  // finest first
};

// Compares `steps_an_octave` levels per halving of the number of triangles, and the coarsest level,
// with the finest one. `progress` is called on this thread with the share of the work (0..1) and
// the number of levels compared. Errors: those of compare(). Time: one comparison per level.
// REQUIRES: the model has more than one level; steps_an_octave > 0.
Result<ErrorCurve> errorCurve(const lod::Dendrogram& model, std::size_t steps_an_octave,
                              const CompareSettings& settings,
                              const std::function<void(double, std::size_t)>& progress);

}  // namespace merlin::render::compare
