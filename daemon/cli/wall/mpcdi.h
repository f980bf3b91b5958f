// Adds the subcommands mpcdi export and mpcdi import to `merlin wall`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addMpcdi(Command wall, Run& run);

}  // namespace merlin::cli
