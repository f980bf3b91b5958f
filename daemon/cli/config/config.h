// The subcommands of `merlin config`: functions that add them, and shared helpers.
#pragma once

#include <string>

#include "config/loader.h"
#include "config/usual_file.h"
#include "daemon/cli/command.h"

namespace merlin::cli {

void addConfigShow(Command config, Run& run);
void addConfigDiff(Command config, Run& run);
void addConfigEdit(Command config, Run& run);
void addConfigMigrate(Command config, Run& run);

// Reads a configuration and prints its findings to stderr. Errors: kInvalidArgument (it is
// invalid).
Result<LoadedSettings> loadPrinted(const std::string& file);

}  // namespace merlin::cli
