// Adds the subcommands align and testcard to `merlin wall`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addAlign(Command wall, Run& run);
void addTestcard(Command wall, Run& run);

}  // namespace merlin::cli
