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

// The daemon that a subcommand communicates with: one of this machine or, if an endpoint is given,
// one of another machine, encrypted.
struct DaemonAddress {
  std::string instance = "merlin";     // of this machine
  std::vector<std::string> endpoints;  // "tcp://HOST:PORT", one for each role of another machine
  std::string keys;                    // file with our key pair
  std::string server_key;              // the other daemon's public key, or a file with it

  bool isRemote() const noexcept { return !endpoints.empty(); }
  // For messages: the instance, or the endpoints.
  std::string name() const;
};

struct FoundRole {
  std::string role;  // "devices" or "wall"; empty: whichever the other machine's endpoint has
  shm::Endpoints endpoints;
  std::uint32_t pid = 0;         // of its process; one may have both roles
  std::uint64_t generation = 0;  // differs after each start
  std::optional<status::ClientKeys> keys = {};

  status::CommandAddress commands() const { return {endpoints.command, keys}; }
};

// The running roles of this instance. Errors: kIo if no role runs, or if its shared memory may not
// be read.
Result<std::vector<FoundRole>> findRoles(const std::string& instance);

// A role whose process has left its shared memory behind, or gives no sign of life: it was killed,
// has crashed or hangs. A process that ends normally removes its shared memory.
struct LostRole {
  std::string role;
  Duration silent{};      // since its last heartbeat
  std::uint32_t pid = 0;  // of the process that hangs; 0: it has ended

  // "does not run; it ended 12 s ago"
  std::string what() const;
};

// The lost roles of this instance; none if no merlind ever ran under this name.
std::vector<LostRole> lostRoles(const std::string& instance);

// The same for any daemon. A daemon of another machine is not contacted, so its roles are unknown.
// Errors: those of findRoles() and of reading the keys; kInvalidArgument (a key is missing or
// invalid).
Result<std::vector<FoundRole>> findRoles(const DaemonAddress& daemon);

// Whether this process runs the program merlind, whatever its role, and also while it starts.
bool isMerlind(std::uint32_t pid);

// The instance of the merlind that is this process. Errors: kIo if it is none.
Result<std::string> instanceOf(std::uint32_t pid);

// A request to a role: a command of daemon/base/commands.h and its argument.
struct RoleRequest {
  std::string command, argument = {};
  Duration patience = std::chrono::seconds(5);  // maximum time to wait for the answer
};

// Checks that this user may write to the socket of an endpoint, because ZeroMQ would only retry
// until the patience is over. Endpoints of another machine are not checked. Errors: those of
// checkAllowed().
Result<Ok> checkMayAsk(std::string_view endpoint);

// Sends a command to the role and returns the answer as JSON. Errors: those of findRoles(),
// checkAllowed() and status::ask(); kIo if this daemon does not run the role.
Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const RoleRequest& request);
// The same for any daemon. If there are several endpoints, the command goes to the one with the
// role.
Result<std::string> askRole(const DaemonAddress& daemon, const std::string& role,
                            const RoleRequest& request);

}  // namespace merlin::cli
