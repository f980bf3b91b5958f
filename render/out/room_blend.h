// Computes the blend ramps of outputs whose pictures overlap on one screen from the screens'
// positions. Pure.
#pragma once

#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/out/settings.h"
#include "render/tiles/settings.h"

namespace merlin::render::out {

// Sets the ramps of each output whose blend is `automatic` to the strips of its picture that other
// tiles of the same screen and eye show as well, rounded to whole pixels. Returns faults with
// pointers like those of validate(outputs): an output that shows several tiles or a tile without a
// screen; a ramp that is configured and differs from the computed one. REQUIRES: validate() finds
// no fault in `tiles`. Outputs in which validate() finds other faults are left unchanged.
SettingFaults fillBlends(std::vector<OutputSettings>& outputs, const tiles::TilesSettings& tiles);

}  // namespace merlin::render::out
