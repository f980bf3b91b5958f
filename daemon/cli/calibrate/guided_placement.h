// Guided calibration of a tracker that measures in a frame of its own (drivers vrpn and osc):
// determines which of its axes are those of the samples, and where its origin is.
#pragma once

#include "daemon/base/result.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/guide.h"

namespace merlin::cli {

// Opens the tracker's own line, asks a person to hold the station at the origin and on two axes,
// and writes "axes" and "origin_m" into the configuration. Errors: those of openOwnLine(), guide(),
// placementOf() and saveChecked(); after an error the file is unchanged.
Result<Ok> guidePlacement(const CalibratedDevice& tracker, int station, const GuideTiming& timing);

}  // namespace merlin::cli
