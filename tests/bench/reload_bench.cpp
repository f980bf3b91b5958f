// ./dev bench reload: thousands of reloads, good and bad ones in turn, while the emulated hand
// moves and the demo's wall is drawn. Measures late frames compared with the same wall without
// reloads, descriptors, threads and memory, and whether samples were lost.
#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/status/client.h"
#include "tests/bench/command_line.h"
#include "tests/bench/demo_daemon.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

using nlohmann::json;

struct Options : DemoOptions {
  int reloads = 10'000;
  double seconds = 20, pause = 0;
};

// The resources that a process holds.
struct Held {
  std::size_t descriptors, threads;
  double memory_mb;  // resident memory [MB]
};

std::size_t entriesOf(pid_t pid, const char* folder) {
  const std::filesystem::directory_iterator all(fmt::format("/proc/{}/{}", pid, folder));
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

Held heldBy(pid_t pid) {
  const std::string status = test::readText(fmt::format("/proc/{}/status", pid));
  const std::size_t at = status.find("VmRSS:");
  const double kb = at == std::string::npos ? 0 : std::atof(status.c_str() + at + 6);
  return {entriesOf(pid, "fd"), entriesOf(pid, "task"), kb / 1024};
}

Measured lateShare(const shm::WallStats& from, const shm::WallStats& to) {
  return shareOf(to.late - from.late, to.deadlines - from.deadlines,
                 "deadlines of the wall, which did not move,");
}

// Returns the i-th configuration: changes of bindings, of postures, of a device's line and of the
// wall take turns; every fourth one is invalid.
json variantOf(const json& demo, int i) {
  json config = demo;
  switch (i % 8) {
    case 0:
    case 4:
      config["bindings"] = {{{"input", "posture.fist"}, {"action", i % 8 == 0 ? "fly" : "grab"}}};
      break;
    case 1: config["postures"]["hold_s"] = 0.2; break;
    case 2:
      config["wall"]["rate"]["late_share"] = 0.02;
      config["wall"]["scene"]["hand_gain"] = 2;
      break;
    case 5: deviceOf(config, "ball")["spaceball"]["dead_zone"] = i % 16 == 5 ? 5 : 6; break;
    case 6: config["hands"] = {{{"cutoff_hz", 4}}}; break;
    case 3: deviceOf(config, "glove")["baud"] = 7; break;
    default: config["wall"]["render"]["wireframe"] = "yes"; break;
  }
  return config;
}

// Writes the file, requests a reload, and waits for the answer; returns the outcome.
std::string reload(const DemoDaemon& daemon, const std::string& path, const json& config) {
  test::writeText(path, config.dump());
  const auto ask = [&](const std::string& argument) {
    const auto answer =
        status::ask(daemon.commandEndpoint(), "reload", std::chrono::seconds(10), argument);
    if (!answer) didNotRun("merlin reload", answer.error().what, "see merlin status");
    return json::parse(*answer);
  };
  const std::string number = std::to_string(ask("now").value("request", 0));
  SystemClock clock;
  for (;;) {
    const json answer = ask(number);
    if (!answer.value("pending", false)) return answer.value("outcome", "");
    clock.sleepUntil(clock.now() + std::chrono::milliseconds(5), {});
  }
}

bool bench(const Options& options, Report& report) {
  const test::TempDir dir;
  json demo;
  DemoDaemon daemon(options, dir, "all", [&](json& config) {
    config["script"] = "grabbing";
    config["wall"]["playlist"] = {{"after_s", 0}};
    demo = config;
  });
  const std::string path = dir / (daemon.instance() + ".json");
  std::this_thread::sleep_for(std::chrono::seconds(3));  // the first frames calibrate the governor
  const shm::WallStats first = daemon.wall();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  const shm::WallStats before = daemon.wall();
  for (int i = 0; i < 16; ++i) reload(daemon, path, variantOf(demo, i));  // until memory is steady
  const Held held = heldBy(daemon.pid());
  const shm::Channel<TrackerSample>& station = *daemon.devices().tracker()->stations[0];
  const std::uint64_t tracked = station.count();
  const shm::WallStats begun = daemon.wall();
  std::vector<double> took_ms;
  int wrong = 0;
  SystemClock clock;
  for (int i = 0; i < options.reloads; ++i) {
    if (i % 500 == 0) note(fmt::format("{} of {} reloads", i, options.reloads));
    const Timestamp from = clock.now();
    const std::string outcome = reload(daemon, path, variantOf(demo, i));
    took_ms.push_back(1000 * toSeconds(clock.now() - from));
    const char* const expected = i % 4 == 3 ? "invalid" : "done";
    if (outcome != expected && ++wrong < 5) note(fmt::format("reload {}: {}", i, outcome));
    daemon.expectRunning();
    std::this_thread::sleep_for(std::chrono::duration<double>(options.pause));
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));  // until the statistics are up to date
  const shm::WallStats end = daemon.wall();
  const Held after = heldBy(daemon.pid());
  const auto samples = station.count() - tracked;
  const auto tracker = daemon.health("tracker");
  const auto without = lateShare(first, before), with = lateShare(begun, end);
  const auto took = medianOf(took_ms, "reloads");
  const auto slowest = quantileOf(took_ms, 1, "reloads");
  const auto n = took.count();
  report.text("{} reloads, of which {} had another outcome than they should; drawn by {}\n", n,
              wrong, daemon.renderer());
  report.text("a reload takes {:.0f} ms (median), {:.0f} ms at most\n", took.value(),
              slowest.value());
  report.text("late frames {:.2f} % with reloads, {:.2f} % without\n", 100 * with, 100 * without);
  report.text("descriptors {} -> {}, threads {} -> {}, memory {:.1f} -> {:.1f} MB\n",
              held.descriptors, after.descriptors, held.threads, after.threads, held.memory_mb,
              after.memory_mb);
  report.text("samples of the tracker {}, which was lost {} times\n", samples,
              tracker ? tracker->reconnects : 0);
  report.figure("took", took, "ms");
  report.figure("slowest", slowest, "ms");
  report.figure("late_with", with, "1");
  report.figure("late_without", without, "1");
  report.figure("wrong_outcomes", Measured::of(wrong, n, "reloads"), "1");
  const auto grown = [&](double from, double to) { return Measured::of(to - from, n, "reloads"); };
  report.figure(
      "descriptors_grown",
      grown(static_cast<double>(held.descriptors), static_cast<double>(after.descriptors)), "1");
  report.figure("threads_grown",
                grown(static_cast<double>(held.threads), static_cast<double>(after.threads)), "1");
  report.figure("memory_grown", grown(held.memory_mb, after.memory_mb), "MB");
  return wrong == 0 && after.descriptors == held.descriptors && after.threads == held.threads;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app(
      "Late frames, descriptors, threads and memory during thousands of reloads.");
  app.option("--bin", options.bin, "Folder of merlind and merlin").required();
  app.option("--config", options.config, "The wall's configuration").required();
  app.option("--reloads", options.reloads, "Number of reloads").range(1, 10'000'000).showDefault();
  app.option("--seconds", options.seconds, "Length of the run without reloads, in seconds")
      .range(1, 86'400)
      .showDefault();
  app.option("--pause", options.pause, "Pause between two reloads, in seconds")
      .range(0.0, 3600.0)
      .showDefault();
  return app.run("reload", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::bench(options, report);
  });
}
