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
#include "daemon/devices/wall_fault.h"
#include "daemon/devices_beside.h"
#include "daemon/emulator_children.h"
#include "daemon/kept_by_systemd.h"
#include "daemon/last_good.h"
#include "daemon/reloader.h"
#include "daemon/remote_devices.h"
#include "daemon/role_commands.h"
#include "daemon/role_servers.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/ended_threads.h"
#include "daemon/status/services.h"
#include "daemon/status/watchdog.h"
#include "daemon/wall/crash_frame.h"
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

  // Runs until SIGTERM or SIGINT; on SIGHUP it reads the configuration again. If a change takes
  // effect only at a start, run() returns, and startsAgain() is true. Tells systemd when the first
  // frame is shown, and from then on that every thread still makes progress (its watchdog). Errors:
  // those of starting the servers; the first frame could not be drawn; kClosed (stopped before the
  // first frame); a thread has ended unexpectedly.
  Result<Ok> run();
  bool startsAgain() const noexcept { return starts_again_; }
  // Whether run() has told systemd READY=1.
  bool wasReady() const noexcept { return was_ready_; }
  // Returns the open files that the restarted program takes over, for ProgramRestart::now().
  std::vector<std::pair<std::string, UniqueFd>> handOver() { return kept_files_.handOver(); }

 private:
  Daemon(Configuration configuration, const DaemonOptions& options, Clock& clock);
  Result<Ok> makeRoles();
  void connectRoles();
  void makeKeeper();
  void keepCrashFrame();
  void tendState();
  void executeActions();
  void tendLamp(Timestamp now);
  void tendPanel();
  void serveWindows();
  Result<Ok> awaitFirstFrame(std::future<Result<std::string>> ready);
  bool stopAsked(Duration wait);  // waits for a signal
  void tendReload();
  void tellEnd() const;
  void keepLastGood();
  void housekeeping();
  void mendSharedMemory();
  std::string summary(Timestamp now) const;

  // Members are destroyed from the last to the first: an object that calls others is declared after
  // them, so that it is destroyed first.
  Settings settings_;
  Reloader::Configured configured_;          // as configured in the files; moved into reloader_
  const std::string file_, instead_of_;      // as in Configuration
  std::vector<wall::WallContent> contents_;  // moved into wall_ when that is created
  DaemonOptions options_;
  Clock& clock_;
  KeptBySystemd kept_files_;  // made before the emulators are forked
  ThreadWatch threads_;       // declared before all members that have threads
  status::Services services_;
  status::EndedThreads ended_threads_{threads_, services_};
  status::Watchdog watchdog_;
  Timestamp summarised_{}, mended_{};
  bool starts_again_ = false, was_ready_ = false;
  std::atomic<bool> closed_{false};  // a person closed a window whose on_close is "stop"
  std::unique_ptr<EmulatorChildren> emulators_;
  std::unique_ptr<RemoteDevices> remote_devices_;  // if /wall/input names another machine
  // Only in a process with a wall whose devices are read by another process of this machine.
  std::unique_ptr<DevicesBeside> devices_beside_;
  actions::ActionReader device_actions_;
  std::unique_ptr<devices::WallFault> wall_fault_;  // if the panel's lamp warns
  std::string warned_of_;                           // what the lamp warns of; empty: nothing
  // Only in a process with a wall or projectors; used by wall_ and devices_.
  std::unique_ptr<state::StateKeeper> keeper_;
  std::optional<Reloader> reloader_;
  std::unique_ptr<LastGoodKeeper> last_good_;  // if DaemonOptions::last_good names a file
  std::optional<RoleCommands> commands_;
  std::unique_ptr<wall::SnapshotWriter> snapshots_;  // called by wall_
  std::unique_ptr<wall::CrashFrame> crash_frame_;    // only if the wall's previous process crashed
  std::unique_ptr<wall::WallRole> wall_;
  std::unique_ptr<devices::DevicesRole> devices_;
  std::optional<RoleServers> servers_;  // clients' commands call all members above
};

}  // namespace merlin
