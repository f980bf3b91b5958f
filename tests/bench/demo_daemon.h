// The demo's merlind as the subject of a benchmark. If it does not run and deliver, the benchmark
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

// The entry with this name in the configuration's list of devices. If the configuration has no
// list, it is the default one, whose names are "glove", "tracker" and "ball".
nlohmann::json& deviceOf(nlohmann::json& config, const std::string& name);

// Thread-bound. Every function throws DidNotRun if merlind does not run or deliver as expected.
class DemoDaemon {
 public:
  using Change = std::function<void(nlohmann::json& config)>;

  // Starts merlind on emulated devices, waits until it is ready, and opens its segments. The
  // configuration is the demo's with a name and a folder of its own, after `change`. `role`: "all"
  // or "devices".
  DemoDaemon(const DemoOptions& options, const test::TempDir& dir, const std::string& role,
             const Change& change);

  pid_t pid() const { return process_->pid(); }
  const std::string& instance() const { return instance_; }
  // The address at which its wall takes commands. Not for the role "devices".
  std::string commandEndpoint() const { return (*wall_)->header.command_endpoint; }

  // Throws if merlind has ended; to be called after the measurement.
  void expectRunning();

  // The latest statistics of its wall. Not for the role "devices".
  shm::WallStats wall();
  const shm::DeviceSlots& devices() const { return **devices_; }
  // The latest health of the device with this name; nothing before the first report.
  std::optional<DeviceHealth> health(const std::string& device) const;

  // How its wall draws, as merlind reports it: "EGL, llvmpipe (...), two contexts". Not for the
  // role "devices".
  std::string renderer() const;

  // Kills it and waits for its end.
  void stop() { process_->kill(SIGTERM); }

 private:
  [[noreturn]] void fail(const std::string& found) const;

  std::string instance_, subject_;
  std::optional<test::Process> process_;
  std::optional<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<shm::DevicesReader> devices_;
};

}  // namespace merlin::bench
