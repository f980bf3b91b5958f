// Daemon: the composition root of merlind: creates its roles and servers, and runs the main loop.
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/actions/action_reader.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/configuration.h"
#include "daemon/devices/devices_role.h"
#include "daemon/emulator_children.h"
#include "daemon/role_commands.h"
#include "daemon/servers.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/ended_threads.h"
#include "daemon/status/sample_link.h"
#include "daemon/status/services.h"
#include "daemon/status/watchdog.h"
#include "daemon/wall/snapshot_writer.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

class Daemon {
 public:
  // Creates all parts. Afterwards only the emulators and the link to another machine are running;
  // run() starts the rest. REQUIRES: the configuration's verdict is not kInvalid; SIGTERM, SIGINT,
  // SIGHUP and SIGCHLD are blocked; no thread has been started. Errors: those of the parts.
  static Result<std::unique_ptr<Daemon>> make(Configuration configuration,
                                              const DaemonOptions& options, Clock& clock);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Runs until SIGTERM or SIGINT; notifies systemd when the first frame is shown, and of progress.
  // Errors: those of starting the servers; the first frame could not be drawn; kClosed (stopped
  // before the first frame); a thread has ended unexpectedly.
  Result<Ok> run();

 private:
  Daemon(Configuration configuration, const DaemonOptions& options, Clock& clock);
  Result<Ok> makeRoles();
  // Starts a role's sockets for status and commands. `commands`: the role whose commands they
  // accept. REQUIRES: settings.publications[0] is the status.
  Result<Ok> serveStatus(const std::string& role, CommandOf commands,
                         status::StatusServerSettings settings);
  Result<Ok> serveDevices();
  Result<Ok> serveWall();
  std::function<std::vector<std::string>()> wallEvents();
  Result<Ok> mirrorDevices(std::uint64_t generation);
  // Starts the servers for other programs (libspnav, VRPN), which are restarted if they fail.
  void serveOthers(const shm::DevicesSegment& segment);
  Result<status::CurveServer> network() const;
  void tellServices(std::vector<std::string>& documents);
  void makeSnapshots();
  void makeKeeper();
  void tendWall(Timestamp now);
  void executeActions();
  void serveWindows();
  shm::Endpoints endpoints(const std::string& role) const;
  Result<Ok> awaitFirstFrame(std::future<Result<std::string>> ready);
  bool stopAsked(Duration wait);  // waits for a signal
  void housekeeping();
  void mendSharedMemory();
  void pingWatchdog(Timestamp now);
  std::string summary(Timestamp now) const;

  // Members are destroyed from the last to the first: an object that calls others is declared after
  // them, so that it is destroyed first.
  Settings settings_;
  std::vector<wall::Model> models_;  // moved into wall_ when that is created
  DaemonOptions options_;
  Clock& clock_;
  ThreadWatch threads_;  // declared before all members that have threads
  std::string run_directory_;
  status::Services services_;
  status::EndedThreads ended_threads_{threads_, services_};
  status::Watchdog watchdog_;
  Timestamp summarised_{}, mended_{};
  std::atomic<bool> closed_{false};  // a person closed a window whose on_close is "stop"
  std::unique_ptr<EmulatorChildren> emulators_;
  // Shared memory with the samples of another machine's devices, if /wall/input names a machine.
  std::optional<shm::SegmentWriter<shm::DevicesSegment>> mirror_;
  actions::ActionReader device_actions_;
  std::unique_ptr<state::StateKeeper> keeper_;  // of a process with a wall; used by wall_
  std::optional<RoleCommands> commands_;
  std::unique_ptr<wall::SnapshotWriter> snapshots_;  // called by wall_
  std::unique_ptr<wall::WallRole> wall_;
  std::unique_ptr<devices::DevicesRole> devices_;
  std::unique_ptr<status::SampleLink> link_;  // writes into mirror_
  std::optional<Servers> servers_;            // clients' commands call all members above
};

}  // namespace merlin
