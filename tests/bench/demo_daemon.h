// The demo's merlind as the subject of a benchmark. If it does not run or deliver, the benchmark
// ends.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/shm/segment.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {

struct DemoOptions {
  std::string bin;     // the folder of merlind and merlin
  std::string config;  // the demo's configuration
};

// Returns the entry with this name in the configuration's list of devices. If the configuration has
// no list, the default list is added, whose names are "glove", "tracker" and "ball".
nlohmann::json& deviceOf(nlohmann::json& config, const std::string& name);

// Thread-bound. Every function throws DidNotRun if merlind does not run or deliver as expected.
class DemoDaemon {
 public:
  using Change = std::function<void(nlohmann::json& config)>;

  // Starts merlind on emulated devices, waits until it is ready, and opens its segments. The
  // configuration is the demo's, with its own instance name and folder, after `change`. `role`:
  // "all" or "devices".
  DemoDaemon(const DemoOptions& options, const test::TempDir& dir, const std::string& role,
             const Change& change);

  pid_t pid() const { return process_->pid(); }
  const std::string& instance() const { return instance_; }
  // Returns the address at which the wall accepts commands. REQUIRES: the role is not "devices".
  std::string commandEndpoint() const { return (*wall_)->header.command_endpoint; }

  // Throws DidNotRun if merlind has ended; to be called after the measurement.
  void expectRunning();

  // Returns the wall's latest statistics. REQUIRES: the role is not "devices".
  shm::WallStats wall();
  const shm::DeviceSlots& devices() const { return **devices_; }
  // Returns the latest health of the device with this name; nothing before the first report.
  std::optional<DeviceHealth> health(const std::string& device) const;

  // Returns how the wall draws, as merlind reports it: "EGL, llvmpipe (...), two contexts".
  // REQUIRES: the role is not "devices".
  std::string renderer() const;

  // Sends merlind SIGTERM and waits until it has ended.
  void stop() { process_->kill(SIGTERM); }

 private:
  [[noreturn]] void fail(const std::string& found) const;

  std::string instance_, subject_;
  std::optional<test::Process> process_;
  std::optional<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<shm::DevicesReader> devices_;
};

}  // namespace merlin::bench
