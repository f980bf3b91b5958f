// The demo's merlind as a benchmark's subject: it runs and delivers, or the benchmark ends.
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

// Thread-bound. Every function throws DidNotRun where merlind is not what it is asked for.
class DemoDaemon {
 public:
  using Change = std::function<void(nlohmann::json& config)>;

  // Starts merlind on the configuration with a name and a folder of its own, as `change` has it,
  // on emulated devices, waits until it is ready, and opens its segments. `role`: "all" or
  // "devices".
  DemoDaemon(const DemoOptions& options, const test::TempDir& dir, const std::string& role,
             const Change& change);

  pid_t pid() const { return process_->pid(); }

  // That it has not ended since; to be called when the measurement is over.
  void expectRunning();

  // Statistics that its wall has published last. Not if `role` is "devices".
  shm::WallStats wall();
  const shm::DevicesSegment& devices() const { return **devices_; }

  // Ends it, and waits for its end.
  void stop() { process_->kill(SIGTERM); }

 private:
  [[noreturn]] void fail(const std::string& found) const;

  std::string instance_, subject_;
  std::optional<test::Process> process_;
  std::optional<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<shm::SegmentReader<shm::DevicesSegment>> devices_;
};

}  // namespace merlin::bench
