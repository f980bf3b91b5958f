// Finds the running roles of a daemon, for subcommands that read their state or send commands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {

struct FoundRole {
  std::string role;  // "devices" or "wall"
  shm::Endpoints endpoints;
};

// The running roles of this instance. Errors: kIo, with what was looked for, if there is none.
Result<std::vector<FoundRole>> findRoles(const std::string& instance);

// A command of daemon/base/commands.h, its argument, and how long to wait for the answer.
struct Asked {
  std::string command, argument = {};
  Duration patience = std::chrono::seconds(2);
};

// Sends a command to the role and returns its answer, JSON. Errors: those of findRoles() and
// status::ask(); kIo if this daemon does not run the role.
Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const Asked& asked);

}  // namespace merlin::cli
