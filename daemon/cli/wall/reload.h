// Makes merlin reload available to other subcommands.
#pragma once

#include <string>

namespace merlin::cli {

// Has the daemon of this instance read its configuration again, prints the result, and returns the
// exit status, as merlin reload does.
int reloadNow(const std::string& instance);

}  // namespace merlin::cli
