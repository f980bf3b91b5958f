#include "tests/bench/demo_daemon.h"

#include <filesystem>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

constexpr const char* kWayOut = "'./dev bench wall' and 'latency' build it and make its model";

nlohmann::json demoConfig(const DemoOptions& options, const std::string& instance,
                          const test::TempDir& dir) {
  auto config = nlohmann::json::parse(test::readText(options.config), nullptr, false);
  if (!config.is_object()) {
    didNotRun("merlind", fmt::format("{} is not there or is not a configuration", options.config),
              "--config names the demo's, config/demo.json");
  }
  const auto folder = std::filesystem::absolute(options.config).parent_path();
  for (auto* path : {&config["postures"]["file"], &config["wall"]["model"]})
    *path = (folder / path->get<std::string>()).string();
  config["instance"] = instance;
  config["run_directory"] = dir.path();
  config.erase("$schema");
  return config;
}

// Returns the last part of a program's output, which has the message of a failure.
std::string endOf(const std::string& output) {
  constexpr std::size_t kMost = 400;
  const std::size_t end = output.find_last_not_of('\n');
  if (end == std::string::npos) return "it said nothing";
  const std::size_t begin = end + 1 > kMost ? end + 1 - kMost : 0;
  return "it said: " + output.substr(begin, end + 1 - begin);
}

// Returns the first line that contains `words`, or an empty text. The rest of the output differs
// from run to run.
std::string lineWith(const std::string& output, std::string_view words) {
  const std::size_t found = output.find(words);
  if (found == std::string::npos) return {};
  const std::size_t before = output.rfind('\n', found);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return output.substr(begin, output.find('\n', found) - begin);
}

// Opens a segment, which exists once merlind is ready. Returns the error, or an empty text.
template <typename Reader>
std::string open(std::optional<Reader>& reader, const std::string& instance, const char* role) {
  auto opened = Reader::open(shm::segmentName(instance, role));
  if (!opened) return opened.error().what;
  reader.emplace(*std::move(opened));
  return "";
}

}  // namespace

nlohmann::json& deviceOf(nlohmann::json& config, const std::string& name) {
  nlohmann::json& list = config["devices"];
  if (list.is_null()) {
    list = nlohmann::json::array({{{"name", "glove"}, {"driver", "cyberglove"}},
                                  {{"name", "tracker"}, {"driver", "fastrak"}},
                                  {{"name", "ball"}, {"driver", "spaceball"}}});
  }
  for (nlohmann::json& device : list) {
    if (device.value("name", "") == name) return device;
  }
  didNotRun(name, "the configuration has no device of this name", "--config names the demo's");
}

DemoDaemon::DemoDaemon(const DemoOptions& options, const test::TempDir& dir,
                       const std::string& role, const Change& change)
    : subject_(options.bin + "/merlind --role " + role) {
  // Each start has a new instance name, since a process that is ending may still hold its own.
  static int started = 0;
  instance_ = test::privateName(fmt::format("bench{}", ++started));
  if (::access((options.bin + "/merlind").c_str(), X_OK) != 0) fail("there is no such program");
  auto config = demoConfig(options, instance_, dir);
  change(config);
  const std::string path = dir / (instance_ + ".json");
  test::writeText(path, config.dump());
  process_.emplace(std::vector<std::string>{options.bin + "/merlind", "--config", path, "--role",
                                            role, "--emulate"});
  if (!process_->saysEventually("ready")) {
    fail((process_->ended() ? "it ended before it was ready; " : "it was not ready within 30 s; ") +
         endOf(process_->output()));
  }
  // merlind also runs without contents, but then there is nothing to measure.
  const std::string left_out = lineWith(process_->output(), "is left out until it can be read");
  if (!left_out.empty()) fail("it shows none of its contents; it said: " + left_out);
  std::string fault = open(devices_, instance_, "devices");
  if (fault.empty() && role == "all") fault = open(wall_, instance_, "wall");
  if (!fault.empty()) fail(fault);
}

void DemoDaemon::expectRunning() {
  if (process_->ended()) fail("it ended while it was measured; " + endOf(process_->output()));
}

std::optional<DeviceHealth> DemoDaemon::health(const std::string& device) const {
  for (const auto& health : devices().health) {
    if (health.device == device) return health.slot->read();
  }
  return std::nullopt;
}

shm::WallStats DemoDaemon::wall() {
  expectRunning();
  const auto stats = (*wall_)->stats.read();
  if (!stats || stats->updated_ns == 0) fail("its wall has published nothing");
  return *stats;
}

std::string DemoDaemon::renderer() const {
  constexpr std::string_view kBefore = "drawn by ";
  const std::string output = process_->output();
  const std::size_t at = output.find(kBefore);
  if (at == std::string::npos) fail("it did not say who draws its wall");
  const std::size_t begin = at + kBefore.size();
  return output.substr(begin, output.find(';', begin) - begin);
}

void DemoDaemon::fail(const std::string& found) const { didNotRun(subject_, found, kWayOut); }

}  // namespace merlin::bench
