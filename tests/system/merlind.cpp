#include "tests/system/merlind.h"

#include <filesystem>
#include <sstream>

#include <fmt/format.h>

namespace merlin::test {

nlohmann::json deviceEntry(const std::string& name, const std::string& driver,
                           const std::string& port, const nlohmann::json& own) {
  nlohmann::json entry = {{"name", name}, {"driver", driver}};
  if (!port.empty()) entry["port"] = port;
  if (!own.is_null()) entry[driver] = own;
  return entry;
}

nlohmann::json onlyDevice(const nlohmann::json& entry) {
  return {{"devices", nlohmann::json::array({entry})}};
}

Merlind::Merlind(const TempDir& dir, const std::string& model, const std::string& name,
                 MerlindOptions options)
    : instance_(privateName(name)), config_(dir / (name + ".json")) {
  nlohmann::json config = {{"instance", instance_},
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

const shm::DeviceSlots* Merlind::devices() {
  if (!devices_) {
    auto opened = shm::DevicesReader::open(shm::segmentName(instance_, "devices"));
    if (!opened) return nullptr;
    devices_.emplace(*std::move(opened));
  }
  return &**devices_;
}

shm::WallStats Merlind::wall() {
  const auto opened =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(instance_, "wall"));
  return opened ? (*opened)->stats.read().value_or(shm::WallStats{}) : shm::WallStats{};
}

std::optional<DeviceHealth> Merlind::health(const std::string& device) {
  const auto* const slots = devices();
  for (std::size_t i = 0; slots && i < slots->health.size(); ++i) {
    if (slots->health[i].device == device) return slots->health[i].slot->read();
  }
  return std::nullopt;
}

bool Merlind::healthIs(const std::string& device, HealthState state) {
  return eventually([&] {
    const auto now = health(device);
    return now && now->state == state;
  });
}

std::optional<shm::ActionState> Merlind::actions(const std::string& device) {
  const auto* const slots = devices();
  for (std::size_t i = 0; slots && i < slots->actions.size(); ++i) {
    if (slots->actions[i].source == device) return slots->actions[i].slot->read();
  }
  return std::nullopt;
}

nlohmann::json Merlind::status() {
  const Outcome asked = run({kMerlin, "status", "--json", "--instance", instance_});
  return nlohmann::json::parse(asked.output, nullptr, false);
}

std::vector<pid_t> Merlind::children(const std::string& word) const {
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

std::vector<std::string> Merlind::leftInSharedMemory() const {
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    if (entry.path().filename().string().starts_with(instance_)) left.push_back(entry.path());
  }
  return left;
}

}  // namespace merlin::test
