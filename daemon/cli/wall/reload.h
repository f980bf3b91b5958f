// merlin reload, for other subcommands.
#pragma once

#include <string>

namespace merlin::cli {

// Lets the daemon of this instance read its configuration again, prints the result, and returns the
// exit status of merlin reload.
int reloadNow(const std::string& instance);

}  // namespace merlin::cli
