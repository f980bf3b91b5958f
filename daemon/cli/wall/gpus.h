// Adds the subcommand gpus to `merlin wall`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addGpus(Command wall, Run& run);

}  // namespace merlin::cli
