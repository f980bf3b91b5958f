// Adds the subcommand plan to `merlin wall`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addPlan(Command wall, Run& run);

}  // namespace merlin::cli
