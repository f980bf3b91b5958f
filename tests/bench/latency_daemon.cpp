#include "tests/bench/latency_daemon.h"

#include <algorithm>
#include <sstream>
#include <thread>
#include <tuple>

#include <fmt/format.h>
#include <unistd.h>

namespace merlin::bench {
namespace {

double cpuSeconds(pid_t pid) {
  std::istringstream words(test::readText(fmt::format("/proc/{}/stat", pid)));
  std::string word;
  double ticks = 0;
  for (int i = 1; words >> word && i <= 15; ++i) {
    if (i >= 14) ticks += std::stod(word);
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

void atHighestRates(nlohmann::json& config) {
  deviceOf(config, "glove")["cyberglove"] = {{"rate_hz", 150}};
  config["script"] = "turning";
}

// Returns the smallest number of samples among the three devices.
std::uint64_t fewestSamples(const shm::DeviceSlots& devices) {
  return std::min({devices.glove()->samples->count(), devices.tracker()->stations[0]->count(),
                   devices.ball()->samples->count()});
}

struct Terms {
  Measured age_ms, work_ms;
};

Terms termsOf(DemoDaemon& daemon) {
  std::vector<double> age, work;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  for (int i = 0; i < 300; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(23));
    const auto s = daemon.wall();
    if (!s.moving) continue;
    age.push_back(static_cast<double>(s.input_age_ms));
    work.push_back(static_cast<double>(s.work_ms));
  }
  constexpr const char* kWhat = "moving frames of the wall";
  return {medianOf(age, kWhat), medianOf(work, kWhat)};
}

}  // namespace

void benchCpu(const DemoOptions& options, const test::TempDir& dir, Report& report) {
  note("the processor time of three devices");
  DemoDaemon daemon(options, dir, "devices", atHighestRates);
  std::this_thread::sleep_for(std::chrono::seconds(3));
  const double before = cpuSeconds(daemon.pid());
  const std::uint64_t samples = fewestSamples(daemon.devices());
  std::this_thread::sleep_for(std::chrono::seconds(10));
  const double took = cpuSeconds(daemon.pid()) - before;
  daemon.expectRunning();
  const auto share = Measured::of(took / 10, fewestSamples(daemon.devices()) - samples,
                                  "samples of each of the three devices");
  daemon.stop();
  report.text(
      "three devices at full rate, with postures, status and shared memory: {:.1f} % of a "
      "core (limit 5): {}\n",
      100 * share, share <= 0.05 ? "yes" : "NO");
  report.figure("devices.core_share", share, "1");
}

void benchEquation(const DemoOptions& options, const test::TempDir& dir, Report& report) {
  note("the terms of a wall's latency");
  double rate_hz = 0;
  DemoDaemon daemon(options, dir, "all", [&](nlohmann::json& config) {
    atHighestRates(config);
    rate_hz = config["wall"]["rate"]["rate_hz"].get<double>();
  });
  const Terms terms = termsOf(daemon);
  daemon.stop();
  const double frame_ms = 1000 / rate_hz;
  report.text(
      "\nL = wire + parse and publish + age at pick-up + wait for the frame + draw + present "
      "[ms]\n");
  for (const auto& [device, bytes, baud] : {std::tuple{"glove 25 B, 38400 baud", 25, 38400},
                                            {"Fastrak 32 B, 38400 baud", 32, 38400},
                                            {"ball 16 B, 9600 baud", 16, 9600}}) {
    report.text("  wire: {:25} {:5.1f}   (10 bits a byte, computed)\n", device,
                10'000.0 * bytes / baud);
  }
  report.text(
      "  parse and publish               see the table below: the median of MERLIN's rows\n");
  report.text(
      "  age at pick-up            {:11.1f}   (median; newest sample when a frame begins)\n",
      terms.age_ms.value());
  report.text("  wait for the frame        {:11.1f}   (mean of 0 to {:.1f}, computed)\n",
              frame_ms / 2, frame_ms);
  report.text(
      "  draw, to the last pixel   {:11.1f}   (median; this includes presenting: the frame "
      "buffer is where pixels are written)\n",
      terms.work_ms.value());
  report.figure("wall.age_at_pick_up", terms.age_ms, "ms");
  report.figure("wall.draw", terms.work_ms, "ms");
}

}  // namespace merlin::bench
