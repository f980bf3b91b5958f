// The error of a model's resolutions over their number of triangles: the estimate that the model
// stores, and the measured distance from the finest resolution.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/compare/compare.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::compare {

// Comparison of one resolution with the finest; lengths in model units.
struct ErrorPoint {
  std::size_t level, triangles;
  double estimate;
  Deviation error;  // of both directions, Comparison::symmetric()
};

struct ErrorCurve {
  double diagonal = 0;             // of the finest level's bounding box, model units
  std::vector<ErrorPoint> points;  // finest first
};

// Compares `steps_an_octave` levels per halving of the number of triangles, and the coarsest level,
// with the finest one. `progress`: called on this thread with the share of the work (0..1) and the
// number of levels compared. Errors: those of compare(). Cost: one comparison a level. REQUIRES:
// more than one level, steps_an_octave > 0.
Result<ErrorCurve> errorCurve(const lod::Dendrogram& model, std::size_t steps_an_octave,
                              const CompareSettings& settings,
                              const std::function<void(double, std::size_t)>& progress);

}  // namespace merlin::render::compare
