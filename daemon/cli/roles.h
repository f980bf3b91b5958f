// Finds the running roles of a daemon (devices, wall), for subcommands that read the roles' state
// or send commands to them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/shm/segment.h"
#include "daemon/status/client.h"

namespace merlin::cli {

// The daemon that a subcommand communicates with: a daemon on this machine or, if an endpoint is
// given, a daemon on another machine, with encryption.
struct DaemonAddress {
  std::string instance = "merlin";     // name of the daemon on this machine
  std::vector<std::string> endpoints;  // "tcp://HOST:PORT", one for each role on the other machine
  std::string keys;                    // file with the client's key pair
  // Public key of the other daemon, or the name of a file with the key.
  std::string server_key;

  bool isRemote() const noexcept { return !endpoints.empty(); }
  // Returns the instance, or the endpoints of a remote daemon, as a text for messages.
  std::string name() const;
};

// A running role.
struct FoundRole {
  std::string role;  // "devices" or "wall"; empty: unknown, on another machine
  shm::Endpoints endpoints;
  std::uint32_t pid = 0;         // of its process, which may have both roles; 0: unknown
  std::uint64_t generation = 0;  // differs after each start
  std::optional<status::ClientKeys> keys = {};

  status::CommandAddress commands() const { return {endpoints.command, keys}; }
};

// Returns the running roles of an instance on this machine. Errors: kIo (no role runs, or the
// shared memory may not be read).
Result<std::vector<FoundRole>> findRoles(const std::string& instance);

// A role that was killed, has crashed or hangs: its process has ended without removing its shared
// memory, or its heartbeat has stopped. A process that ends normally removes its shared memory.
struct LostRole {
  std::string role;
  Duration silent{};      // time since its last heartbeat
  std::uint32_t pid = 0;  // of the process that hangs; 0: it has ended

  // Returns a clause for messages, such as "does not run; it ended 12 s ago".
  std::string what() const;
};

// Returns the lost roles of an instance on this machine; none if no merlind ever ran under this
// name.
std::vector<LostRole> lostRoles(const std::string& instance);

// Returns the running roles of a daemon on this or another machine. A daemon on another machine is
// not contacted: each of its endpoints becomes an entry with an empty `role`. Errors: those of
// findRoles() and of reading the keys; kInvalidArgument (a key is missing or invalid).
Result<std::vector<FoundRole>> findRoles(const DaemonAddress& daemon);

// Returns whether the process runs the program merlind, in whatever role, even while it is
// starting.
bool isMerlind(std::uint32_t pid);

// Returns the instance name of the merlind with this process id. Errors: kIo (the process is no
// merlind).
Result<std::string> instanceOf(std::uint32_t pid);

// A request to a role: a command of daemon/base/commands.h and its argument.
struct RoleRequest {
  std::string command, argument = {};
  Duration patience = std::chrono::seconds(5);  // maximum time to wait for the answer
};

// Checks that this user may write to the socket of an endpoint. Without this check, ZeroMQ would
// retry silently until the request times out. Endpoints on another machine are not checked. Errors:
// those of checkAllowed().
Result<Ok> checkMayAsk(std::string_view endpoint);

// Sends a command to the role and returns the answer as JSON. Errors: those of findRoles(),
// checkAllowed() and status::ask(); kIo if this daemon does not run the role.
Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const RoleRequest& request);
// Sends a command to a role of a daemon on this or another machine and returns the answer as JSON.
// With several endpoints, the command goes to the one at which the role answers.
Result<std::string> askRole(const DaemonAddress& daemon, const std::string& role,
                            const RoleRequest& request);

}  // namespace merlin::cli
