// Merlind: a real merlind process on emulated devices, with an instance name and a folder of its
// own.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/shm/segment.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"
#include "tests/system/kept_models.h"

namespace merlin::test {

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

// An entry of the configuration's list of devices. `own`: the settings of its driver.
inline nlohmann::json deviceEntry(const std::string& name, const std::string& driver,
                                  const std::string& port = {},
                                  const nlohmann::json& own = nullptr) {
  nlohmann::json entry = {{"name", name}, {"driver", driver}};
  if (!port.empty()) entry["port"] = port;
  if (!own.is_null()) entry[driver] = own;
  return entry;
}

// A configuration's list with this one device.
inline nlohmann::json onlyDevice(const nlohmann::json& entry) {
  return {{"devices", nlohmann::json::array({entry})}};
}

class Merlind {
 public:
  Merlind(const TempDir& dir, const std::string& model, const std::string& name,
          MerlindOptions options = {})
      : instance_(privateName(name)), config_(dir / (name + ".json")) {
    nlohmann::json config = {
        {"instance", instance_},
        {"run_directory", dir.path()},
        {"state_file", dir / (name + ".state.json")},
        {"postures", {{"file", kSource + "/config/postures.json"}}},
        {"script", options.script},
        {"wall", {{"model", model}, {"rate", {{"rate_hz", options.rate_hz}}}}}};
    config.merge_patch(options.also);
    writeText(config_, config.dump(2));
    std::vector<std::string> arguments = {kMerlind, "--config", config_, "--role", options.role};
    if (options.emulate) arguments.emplace_back("--emulate");
    if (options.last_good) arguments.emplace_back("--last-good");
    process_ = std::make_unique<Process>(std::move(arguments), options.environment);
  }

  Process& process() { return *process_; }
  const std::string& instance() const { return instance_; }
  const std::string& config() const { return config_; }
  bool ready() { return process_->saysEventually("ready"); }

  const shm::DeviceSlots* devices() {
    if (!devices_) {
      auto opened = shm::DevicesReader::open(shm::segmentName(instance_, "devices"));
      if (!opened) return nullptr;
      devices_.emplace(*std::move(opened));
    }
    return &**devices_;
  }
  shm::WallStats wall() {
    const auto opened =
        shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(instance_, "wall"));
    return opened ? (*opened)->stats.read().value_or(shm::WallStats{}) : shm::WallStats{};
  }
  // The last health of the device with this name; nothing before the first.
  std::optional<DeviceHealth> health(const std::string& device) {
    const auto* const slots = devices();
    for (std::size_t i = 0; slots && i < slots->health.size(); ++i) {
      if (slots->health[i].device == device) return slots->health[i].slot->read();
    }
    return std::nullopt;
  }
  // After a start of its own the daemon has other shared memory.
  void openAgain() { devices_.reset(); }
  bool healthIs(const std::string& device, HealthState state) {
    return eventually([&] {
      const auto now = health(device);
      return now && now->state == state;
    });
  }
  // The actions that the inputs of the device with this name have begun; nothing before the first.
  std::optional<shm::ActionState> actions(const std::string& device) {
    const auto* const slots = devices();
    for (std::size_t i = 0; slots && i < slots->actions.size(); ++i) {
      if (slots->actions[i].source == device) return slots->actions[i].slot->read();
    }
    return std::nullopt;
  }
  nlohmann::json status() {
    const Outcome asked = run({kMerlin, "status", "--json", "--instance", instance_});
    return nlohmann::json::parse(asked.output, nullptr, false);
  }

  // Ids of its child processes whose command line contains `word`.
  std::vector<pid_t> children(const std::string& word) const {
    std::vector<pid_t> found;
    for (const auto& thread :
         std::filesystem::directory_iterator(fmt::format("/proc/{}/task", process_->pid()))) {
      std::istringstream pids(readText(thread.path() / "children"));
      for (pid_t child = 0; pids >> child;) {
        if (readText(fmt::format("/proc/{}/cmdline", child)).find(word) != std::string::npos)
          found.push_back(child);
      }
    }
    return found;
  }

  // Paths of this instance's objects in /dev/shm.
  std::vector<std::string> leftInSharedMemory() const {
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
      if (entry.path().filename().string().starts_with(instance_)) left.push_back(entry.path());
    }
    return left;
  }

 private:
  std::string instance_, config_;
  std::unique_ptr<Process> process_;
  std::optional<shm::DevicesReader> devices_;
};

}  // namespace merlin::test
