// Finding the running roles of a daemon, for subcommands that read or ask them.
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

// Roles of this instance whose daemon lives. Errors: kIo, none does, saying what was looked for.
Result<std::vector<FoundRole>> findRoles(const std::string& instance);

// A command of daemon/base/commands.h.
struct Asked {
  std::string command, argument = {};
  Duration patience = std::chrono::seconds(2);
};

// The role's answer to a command, JSON. Errors: findRoles()'s; kIo, this daemon has no such role;
// status::ask()'s.
Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const Asked& asked);

}  // namespace merlin::cli
