// merlin reload, for other subcommands.
#pragma once

#include <string>

namespace merlin::cli {

// Has the daemon of this instance read its configuration, prints what became of it, and returns
// the exit status of merlin reload.
int reloadNow(const std::string& instance);

}  // namespace merlin::cli
