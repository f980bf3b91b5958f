// Guided calibration of a tracker that measures in a frame of its own (drivers vrpn and osc):
// determines how the axes of that frame map to those of the samples, and where the origin of the
// samples lies.
#pragma once

#include "daemon/base/result.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/guide.h"

namespace merlin::cli {

// Opens the line of the tracker, asks a person to hold the station at the origin and on two axes,
// and writes the settings "axes" and "origin_m" of its driver into the configuration. Errors: those
// of openOwnLine(), Device::open(), guide(), placementOf() and saveChecked(); after an error the
// file is unchanged.
Result<Ok> guidePlacement(const CalibratedDevice& tracker, int station, const GuideTiming& timing);

}  // namespace merlin::cli
