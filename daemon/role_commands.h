// RoleCommands: carries out the commands of daemon/base/commands.h, whoever asks: a client of a
// socket, or the panel's button.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/commands.h"
#include "daemon/devices/devices_role.h"
#include "daemon/status/server.h"
#include "daemon/wall/snapshot_writer.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

// Thread-safe, as its parts are.
class RoleCommands {
 public:
  // What there is of them in this process; they outlive this.
  struct Parts {
    devices::DevicesRole* devices = nullptr;
    wall::WallRole* wall = nullptr;
    wall::SnapshotWriter* snapshots = nullptr;
  };
  explicit RoleCommands(const Parts& parts) : parts_(parts) {}

  // Returns the answer as JSON. Errors: kInvalidArgument (no such command, its argument is wrong,
  // this process lacks what it needs); of what carries it out.
  Result<std::string> run(std::string_view name, const std::string& argument = {}) const;

  // Those of the list that a role's socket takes and this process can carry out, but for `status`.
  std::vector<status::Command> of(CommandOf role) const;

 private:
  Parts parts_;
};

}  // namespace merlin
