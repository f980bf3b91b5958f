// The blend ramps of outputs whose pictures overlap on one screen, from where the screens are.
// Pure.
#pragma once

#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/out/settings.h"
#include "render/tiles/settings.h"

namespace merlin::render::out {

// Sets the ramps of each output whose blend is `automatic` to the strips of its picture that other
// tiles of the same screen and eye show as well, rounded to whole pixels. Pointers: those of
// validate(outputs): an output that shows several tiles or one without a screen; a ramp that is
// given and differs. REQUIRES: tiles in which validate() finds nothing. Outputs of which validate()
// finds other faults are left as they are.
SettingFaults fillBlends(std::vector<OutputSettings>& outputs, const tiles::TilesSettings& tiles);

}  // namespace merlin::render::out
