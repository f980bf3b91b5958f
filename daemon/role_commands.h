// RoleCommands: executes the commands of daemon/base/commands.h for clients of the sockets and for
// the panel's button.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/commands.h"
#include "daemon/devices/devices_role.h"
#include "daemon/devices_beside.h"
#include "daemon/reloader.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/server.h"
#include "daemon/wall/snapshot_writer.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

// Thread-safe, because its parts are.
class RoleCommands {
 public:
  // The parts of this process that execute commands; null: this process lacks the part. They must
  // outlive this object.
  struct Parts {
    devices::DevicesRole* devices = nullptr;
    wall::WallRole* wall = nullptr;
    wall::SnapshotWriter* snapshots = nullptr;
    state::StateKeeper* keeper = nullptr;  // only in a process with a wall or projectors
    Reloader* reloader = nullptr;
    DevicesBeside* beside = nullptr;  // only in a process with a wall and without devices
  };
  // `clock` must outlive this object.
  RoleCommands(const Parts& parts, const Clock& clock) : parts_(parts), clock_(clock) {}

  // Executes a command and returns the answer as JSON. Errors: kInvalidArgument (unknown command,
  // invalid argument, or this process lacks the part that executes the command); those of the part.
  Result<std::string> run(std::string_view name, const std::string& argument = {}) const;

  // Executes the commands requested at the operator's panel, or passes them to the process with the
  // devices; the panel shows why one was refused. Returns at once if there are none.
  void runPanel() const;

  // Returns the commands that a role's socket accepts, without `status` and `events`, which the
  // servers add.
  std::vector<status::Command> of(CommandOf role) const;

 private:
  Parts parts_;
  const Clock& clock_;
};

}  // namespace merlin
