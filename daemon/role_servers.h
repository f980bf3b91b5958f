// RoleServers: the servers of a role for other programs: its sockets for status, events and
// commands, and the servers for programs written for other daemons.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/event_logger.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/devices/devices_role.h"
#include "daemon/remote_devices.h"
#include "daemon/role_commands.h"
#include "daemon/servers.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/health_events.h"
#include "daemon/status/services.h"
#include "daemon/status/wall_events.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

// Returns the addresses of a role's status and command sockets. REQUIRES: settings.run_directory is
// the directory in use.
shm::Endpoints endpointsOf(const Settings& settings, const std::string& role);

// The threads of the servers call the parts; the destructor stops these threads. To be used by the
// main thread.
class RoleServers {
 public:
  // The parts of this process; null: this process lacks the part. They must outlive this object.
  struct Parts {
    const Settings& settings;
    const RoleCommands& commands;
    status::Services& services;
    devices::DevicesRole* devices;
    RemoteDevices* remote_devices;
    wall::WallRole* wall;
    state::StateKeeper* keeper;  // only in a process with a wall or projectors
  };
  // `watch` and `clock` must outlive this object.
  RoleServers(const Parts& parts, ThreadWatch& watch, const Clock& clock)
      : parts_(parts),
        watch_(watch),
        clock_(clock),
        servers_(parts.devices ? "devices" : "wall", watch, clock) {}

  // Each function starts the sockets of its role and, if the role has devices of this or another
  // machine, the servers for other programs (libspnav, VRPN). tend() restarts these servers if they
  // fail. Errors: those of Servers::startRole() and of reading keys. REQUIRES: the process has the
  // role.
  Result<Ok> startDevices();
  Result<Ok> startWall();
  // Restarts servers; to be called about ten times a second.
  void tend(Timestamp now) { servers_.tend(now); }

 private:
  // `commands`: the role whose commands its socket accepts. REQUIRES: settings.publications[0] is
  // the status.
  Result<Ok> startStatus(const std::string& role, CommandOf commands,
                         status::StatusServerSettings settings);
  void startServersForOthers(const shm::DeviceSlots& devices);
  // Collects one role's events. Used only by the thread of the role's server.
  struct RoleEvents {
    explicit RoleEvents(std::string_view role) : logger(role) {}
    EventLogger logger;
    std::vector<std::string> documents;
  };
  void add(RoleEvents& to, const EventKind& kind, const std::vector<Event>& events) const;
  std::vector<std::string> taken(RoleEvents& events) const;
  std::vector<std::string> deviceEvents(RoleEvents& events, status::HealthEvents& health);
  std::vector<std::string> wallEvents(RoleEvents& events, status::WallEvents& wall,
                                      status::HealthEvents* remote);

  Parts parts_;
  ThreadWatch& watch_;
  const Clock& clock_;
  Servers servers_;
};

}  // namespace merlin
