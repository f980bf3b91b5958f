// merlin wall plan.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addPlan(Command wall, Run& run);

}  // namespace merlin::cli
