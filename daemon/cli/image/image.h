// The subcommands of `merlin image`: functions that add them, one source file each.
#pragma once

#include "daemon/cli/command.h"

namespace merlin::cli {

void addImageImport(Command image, Run& run);
void addImageInfo(Command image, Run& run);

}  // namespace merlin::cli
