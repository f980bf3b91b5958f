// Daemon: the roles of one merlind, put together, and its main loop.
#pragma once

#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/devices/devices_role.h"
#include "daemon/emulator_children.h"
#include "daemon/serve/spnav_server.h"
#include "daemon/serve/vrpn_server.h"
#include "daemon/status/sample_link.h"
#include "daemon/status/server.h"
#include "daemon/status/watchdog.h"
#include "daemon/wall/orders.h"
#include "daemon/wall/snapshot_writer.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

struct DaemonOptions {
  bool devices = true, wall = true;  // roles
  bool emulate = false;
};

class Daemon {
 public:
  // Everything is made and checked, nothing runs. REQUIRES: SIGTERM, SIGINT, SIGHUP and SIGCHLD are
  // blocked, no thread has been started. Errors: of its parts.
  static Result<std::unique_ptr<Daemon>> make(Settings settings, const DaemonOptions& options,
                                              Clock& clock);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Runs until a signal; tells systemd when the first frame is out, and that there is progress.
  // Errors: why there will be no first frame.
  Result<Ok> run();

 private:
  Daemon(Settings settings, const DaemonOptions& options, Clock& clock);
  Result<Ok> makeRoles();
  Result<Ok> serveStatus(const std::string& role, status::StatusServerSettings settings);
  Result<Ok> serveDevices();
  Result<Ok> serveWall();
  std::function<std::vector<std::string>()> wallEvents();
  Result<Ok> mirrorDevices(std::uint64_t generation);
  Result<Ok> serveOthers(const shm::DevicesSegment& segment);
  Result<status::CurveServer> network() const;
  Result<std::string> runCommand(const std::string& name);
  std::vector<status::Command> panelCommands();
  void takeOrders();
  shm::Endpoints endpoints(const std::string& role) const;
  Result<Ok> awaitFirstFrame(std::future<Result<std::string>> ready);
  bool stopAsked(Duration wait);  // waits for a signal
  void housekeeping();
  void pingWatchdog(Timestamp now);
  std::string summary(Timestamp now) const;

  Settings settings_;
  DaemonOptions options_;
  Clock& clock_;
  std::string run_directory_;
  std::unique_ptr<EmulatorChildren> emulators_;
  std::unique_ptr<devices::DevicesRole> devices_;
  // Another machine's devices, where the wall's input is one.
  std::optional<shm::SegmentWriter<shm::DevicesSegment>> mirror_;
  std::unique_ptr<status::SampleLink> link_;
  std::unique_ptr<wall::WallRole> wall_;
  std::unique_ptr<wall::SnapshotWriter> snapshots_;
  std::unique_ptr<wall::Orders> orders_;
  std::unique_ptr<serve::SpnavServer> spnav_;
  std::unique_ptr<serve::VrpnServer> vrpn_;
  std::vector<std::unique_ptr<status::StatusServer>> servers_;  // last made, first gone
  status::Watchdog watchdog_;
  Timestamp summarised_{};
};

}  // namespace merlin
