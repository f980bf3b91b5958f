// Converts a float map of an MPCDI file to a warp, and rejects invalid maps. Pure.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/correct/io/pfm.h"
#include "render/correct/warp.h"

namespace merlin::render::correct {

// Converts a map. Its v, which points upwards as in OpenGL, points downwards in the result. A cell
// of two NaN means that nothing was measured there. `region`: the region's id, for messages.
// Errors: kMalformed (less than 2 x 2 cells; a cell that has an infinite number or only one NaN; a
// warp that shows nothing, or at most a line of the picture).
Result<MeasuredWarp> measuredWarp(const FloatMap& map, MeshInterpolation between,
                                  const std::string& region);

}  // namespace merlin::render::correct
