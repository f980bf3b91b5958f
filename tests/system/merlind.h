// Merlind: a real merlind process with emulated devices, its own instance name and its own folder.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/shm/segment.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"
#include "tests/system/kept_models.h"

namespace merlin::test {

// Do not use these to initialise other global constants: clang initialises those of a precompiled
// header last.
inline const std::string kMerlin = MERLIN_BIN_DIR "/merlin";
inline const std::string kMerlind = MERLIN_BIN_DIR "/merlind";
inline const std::string kSource = MERLIN_SOURCE_DIR;

struct MerlindOptions {
  std::string script = "visit", role = "all";
  double rate_hz = 10;  // 30 Hz is too fast for a sanitizer's build
  bool emulate = true, last_good = false;
  std::map<std::string, std::string> environment = {};
  nlohmann::json also = nlohmann::json::object();  // merged into the configuration
};

// Returns an entry for the configuration's list of devices. `own`: the settings of its driver.
nlohmann::json deviceEntry(const std::string& name, const std::string& driver,
                           const std::string& port = {}, const nlohmann::json& own = nullptr);

// Returns a configuration whose list of devices has this entry only.
nlohmann::json onlyDevice(const nlohmann::json& entry);

class Merlind {
 public:
  Merlind(const TempDir& dir, const std::string& model, const std::string& name,
          MerlindOptions options = {});

  Process& process() { return *process_; }
  const std::string& instance() const { return instance_; }
  const std::string& config() const { return config_; }
  bool ready() { return process_->saysEventually("ready"); }

  // Null until the daemon's shared memory exists.
  const shm::DeviceSlots* devices();
  shm::WallStats wall();
  // Returns the latest health of the device with this name; nothing before the first report.
  std::optional<DeviceHealth> health(const std::string& device);
  // Forgets the shared memory that was opened; to be called after a restart of the daemon, which
  // then has new shared memory.
  void openAgain() { devices_.reset(); }
  bool healthIs(const std::string& device, HealthState state);
  // Returns the actions that inputs of this device have begun; nothing before the first report.
  std::optional<shm::ActionState> actions(const std::string& device);
  nlohmann::json status();

  // Returns the ids of the daemon's child processes whose command line contains `word`.
  std::vector<pid_t> children(const std::string& word) const;

  // Returns the paths of this instance's objects in /dev/shm.
  std::vector<std::string> leftInSharedMemory() const;

 private:
  std::string instance_, config_;
  std::unique_ptr<Process> process_;
  std::optional<shm::DevicesReader> devices_;
};

}  // namespace merlin::test
