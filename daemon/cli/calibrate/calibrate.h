// The subcommands of `merlin calibrate`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addCalibrateGlove(Command calibrate, Run& run);
void addCalibrateImport(Command calibrate, Run& run);
void addCalibrateTracker(Command calibrate, Run& run);
void addCalibrateBall(Command calibrate, Run& run);
void addCalibratePad(Command calibrate, Run& run);
void addCalibrateTouch(Command calibrate, Run& run);

}  // namespace merlin::cli
