// merlin wall align, merlin wall testcard: adds the subcommands to `merlin wall`.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addAlign(Command wall, Run& run);
void addTestcard(Command wall, Run& run);

}  // namespace merlin::cli
