// Finds the running roles of a daemon (devices, wall), for subcommands that read the roles' state
// or send commands to them.
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
  std::uint32_t pid = 0;  // of its process; one may have both roles
};

// The running roles of this instance. Errors: kIo if no role runs, or if its shared memory may not
// be read.
Result<std::vector<FoundRole>> findRoles(const std::string& instance);

// The instance of the merlind that is this process. Errors: kIo if it is none.
Result<std::string> instanceOf(std::uint32_t pid);

// A request to a role: a command of daemon/base/commands.h and its argument.
struct RoleRequest {
  std::string command, argument = {};
  Duration patience = std::chrono::seconds(5);  // maximum time to wait for the answer
};

// Sends a command to the role and returns the answer as JSON. Errors: those of findRoles(),
// checkAllowed() and status::ask(); kIo if this daemon does not run the role.
Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const RoleRequest& request);

}  // namespace merlin::cli
