// merlin wall mpcdi export | import.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addMpcdi(Command wall, Run& run);

}  // namespace merlin::cli
