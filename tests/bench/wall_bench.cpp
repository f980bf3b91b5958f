// ./dev bench wall: late frames of the demo's wall, beside a bare loop that does the same median
// work at the same rate with the same devices running, in turns; and what a dead device does to the
// others.
//
// Absolute times differ from machine to machine and from second to second; what counts is the last
// column: how much later than the bare loop.
#include <algorithm>
#include <cstdio>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "tests/support/process.h"
#include "tests/support/statistics.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

using test::median;
using test::Process;

struct Options {
  std::string bin, config;
  double seconds = 20;
  int rounds = 3;
};

// The configuration with a name and a folder of this run's own, and another script.
std::string privateConfig(const Options& options, const test::TempDir& dir, const std::string& name,
                          const std::string& script) {
  auto config = nlohmann::json::parse(test::readText(options.config));
  const auto folder = std::filesystem::absolute(options.config).parent_path();
  const auto absolute = [&](nlohmann::json& path) {
    path = (folder / path.get<std::string>()).string();
  };
  absolute(config["devices"]["postures"]);
  absolute(config["wall"]["model"]);
  config["instance"] = name;
  config["run_directory"] = dir.path();
  config["devices"]["script"] = script;
  config.erase("$schema");
  const std::string path = dir / (script + ".json");
  test::writeText(path, config.dump());
  return path;
}

void sleepSeconds(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// The same amount of arithmetic each time it runs.
class FixedWork {
 public:
  void run() {
    for (std::uint64_t i = 0; i < count; ++i) state_ = state_ * 6364136223846793005ULL + 1;
  }
  std::uint64_t count = 1'000'000;

 private:
  volatile std::uint64_t state_ = 1;
};

struct BareRun {
  double late = 0, work_s = 0;
};

// A loop that does nothing but that work, on the same grid.
BareRun bareLoop(FixedWork& fixed, double rate_hz, double seconds) {
  SystemClock clock;
  const Duration period = fromSeconds(1 / rate_hz);
  const Timestamp start = clock.now();
  std::int64_t late = 0, deadlines = 0;
  std::vector<double> work;
  for (std::int64_t k = 0; toSeconds(clock.now() - start) < seconds;) {
    clock.sleepUntil(start + k * period, {});
    const Timestamp began = clock.now();
    fixed.run();
    work.push_back(toSeconds(clock.now() - began));
    const std::int64_t reached = (clock.now() - start) / period;
    late += std::max<std::int64_t>(reached - k, 0);
    deadlines += std::max<std::int64_t>(reached - k, 1);
    k = std::max(k + 1, reached);
  }
  return {static_cast<double>(late) / static_cast<double>(deadlines), median(work)};
}

// Chooses the amount of work so that its median, in such a loop, is `work_s`.
FixedWork workThatTakes(double work_s, double rate_hz) {
  FixedWork fixed;
  for (int i = 0; i < 6; ++i) {
    const double took = bareLoop(fixed, rate_hz, i < 3 ? 0.3 : 1.5).work_s;
    fixed.count = static_cast<std::uint64_t>(static_cast<double>(fixed.count) * work_s / took);
  }
  return fixed;
}

shm::WallStats statsOf(const std::string& name) {
  const auto segment = shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(name, "wall"));
  return segment ? (*segment)->stats.read().value_or(shm::WallStats{}) : shm::WallStats{};
}

struct WallRun {
  double late = 0, work_s = 0, held = 0, utilisation = 0;
  shm::WallStats end{};
};

WallRun runWall(const Options& options, const test::TempDir& dir, const std::string& script) {
  const std::string name = test::privateName("bench");
  Process wall({options.bin + "/merlind", "--config", privateConfig(options, dir, name, script),
                "--emulate"});
  if (!wall.saysEventually("ready")) {
    fmt::print("{}", wall.output());
    return {};
  }
  sleepSeconds(3);  // the first frames calibrate the governor
  const shm::WallStats from = statsOf(name);
  std::vector<double> work, held, use;
  for (int i = 0; i < static_cast<int>(options.seconds); ++i) {
    sleepSeconds(1);
    const auto s = statsOf(name);
    held.push_back(static_cast<double>(s.rate_held_hz));
    if (!s.moving) continue;
    work.push_back(static_cast<double>(s.work_median_ms) / 1000);
    use.push_back(static_cast<double>(s.utilisation));
  }
  WallRun run;
  run.end = statsOf(name);
  const auto deadlines =
      static_cast<double>(std::max<std::uint64_t>(run.end.deadlines - from.deadlines, 1));
  run.late = static_cast<double>(run.end.late - from.late) / deadlines;
  run.work_s = median(work);
  run.held = median(held);
  run.utilisation = median(use);
  wall.kill(SIGTERM);
  return run;
}

// The bare loop has the same devices beside it: read by a merlind without a wall.
BareRun runBare(const Options& options, const test::TempDir& dir, const std::string& script,
                double work_s, double rate_hz) {
  const std::string name = test::privateName("bare");
  Process devices({options.bin + "/merlind", "--config", privateConfig(options, dir, name, script),
                   "--emulate", "--role", "devices"});
  if (!devices.saysEventually("ready")) return {};
  FixedWork fixed = workThatTakes(work_s, rate_hz);
  const BareRun run = bareLoop(fixed, rate_hz, options.seconds);
  devices.kill(SIGTERM);
  return run;
}

void benchLate(const Options& options, const test::TempDir& dir) {
  fmt::print(
      "late frames while the model moves ({} s a run, {} rounds, wall and bare loop in turns)\n",
      options.seconds, options.rounds);
  fmt::print(
      "script   round   asked   held   work ms   used    late | bare: work ms   late | "
      "difference\n");
  for (const char* script : {"turning", "visit"}) {
    double wall_sum = 0, bare_sum = 0;
    for (int round = 1; round <= options.rounds; ++round) {
      const WallRun wall = runWall(options, dir, script);
      const double rate = static_cast<double>(wall.end.rate_asked_hz);
      const BareRun bare = runBare(options, dir, script, wall.work_s, rate);
      wall_sum += wall.late;
      bare_sum += bare.late;
      fmt::print(
          "{:8} {:5} {:7.0f} {:6.1f} {:9.1f} {:5.0f} % {:6.2f} % | {:12.1f} {:6.2f} % | {:+.2f} "
          "%\n",
          script, round, rate, wall.held, 1000 * wall.work_s, 100 * wall.utilisation,
          100 * wall.late, 1000 * bare.work_s, 100 * bare.late, 100 * (wall.late - bare.late));
      if (std::string(script) == "visit") {
        fmt::print(
            "         standstill to full detail {:.0f} ms; motion resumed {} times, first frame "
            "late {} times; longest late run {}\n",
            1000 * static_cast<double>(wall.end.still_to_full_s) + 150, wall.end.resumed,
            wall.end.resumed_late, wall.end.longest_late);
      }
      std::fflush(stdout);
    }
    fmt::print(
        "{:8}  mean: late {:.2f} %, bare loop {:.2f} % (asked: at most 2 %, or bare loop + 1 %)\n",
        script, 100 * wall_sum / options.rounds, 100 * bare_sum / options.rounds);
  }
}

template <typename T>
double medianInterval(const shm::Channel<T>& channel, std::uint64_t from, std::uint64_t to,
                      std::uint64_t* missing) {
  std::vector<double> intervals;
  std::optional<T> last;
  for (std::uint64_t n = from; n < to; ++n) {
    const auto sample = channel.at(n);
    if (!sample) continue;
    if (last) {
      intervals.push_back(static_cast<double>(sample->received_ns - last->received_ns) * 1e-6);
      *missing += sample->counter - last->counter - 1;
    }
    last = sample;
  }
  return median(std::move(intervals));
}

// Kills the emulator of one device for a second; prints what the other two lost by it.
void killOne(const Options& options, const test::TempDir& dir, const std::string& name,
             Process& wall, shm::DeviceIndex victim, const std::string& driver) {
  const auto segment =
      shm::SegmentReader<shm::DevicesSegment>::open(shm::segmentName(name, "devices"));
  if (!segment) return;
  const shm::DevicesSegment& d = **segment;
  std::uint64_t missing = 0, glove = d.glove.count(), tracker = d.tracker[0].count();
  sleepSeconds(1);
  const double glove_before = medianInterval(d.glove, glove, d.glove.count(), &missing);
  const double tracker_before =
      medianInterval(d.tracker[0], tracker, d.tracker[0].count(), &missing);
  const std::string pid = std::to_string(wall.pid());
  std::istringstream children(test::readText("/proc/" + pid + "/task/" + pid + "/children"));
  for (pid_t child = 0; children >> child;) {
    if (test::readText(fmt::format("/proc/{}/cmdline", child)).find(driver) != std::string::npos)
      ::kill(child, SIGKILL);
  }
  glove = d.glove.count();
  tracker = d.tracker[0].count();
  missing = 0;
  const shm::WallStats before = statsOf(name);
  sleepSeconds(1.5);
  static std::vector<std::unique_ptr<Process>> restarted;  // live to the end
  restarted.push_back(std::make_unique<Process>(std::vector<std::string>{
      options.bin + "/merlin", "emulate", driver, "--link", dir / (driver + ".pty")}));
  restarted.back()->saysEventually(" on pty:");
  const SystemClock clock;
  const Timestamp answered = clock.now();
  test::eventually([&] {
    return d.health[victim].read()->state == HealthState::kOk &&
           d.health[victim].read()->reconnects > 0;
  });
  const double back = toSeconds(clock.now() - answered);
  const double glove_during = medianInterval(d.glove, glove, d.glove.count(), &missing);
  const double tracker_during =
      medianInterval(d.tracker[0], tracker, d.tracker[0].count(), &missing);
  const shm::WallStats after = statsOf(name);
  const auto change = [](double during, double was) {
    return was > 0 ? 100 * (during / was - 1) : 0;
  };
  fmt::print("{:11} {:9.2f} s", driver, back);
  fmt::print("   {:>9}", victim == shm::kGlove
                             ? "-"
                             : fmt::format("{:+.1f} %", change(glove_during, glove_before)));
  fmt::print("   {:>9}", victim == shm::kTracker
                             ? "-"
                             : fmt::format("{:+.1f} %", change(tracker_during, tracker_before)));
  fmt::print("   {:9}   {:8}\n", missing,
             after.updated_ns > before.updated_ns ? "ran on" : "STOPPED");
}

void benchFaults(const Options& options, const test::TempDir& dir) {
  const std::string name = test::privateName("faults");
  Process wall({options.bin + "/merlind", "--config", privateConfig(options, dir, name, "visit"),
                "--emulate"});
  if (!wall.saysEventually("ready")) return;
  sleepSeconds(3);
  fmt::print("\na device killed and restarted (its emulator, kill -9)\n");
  fmt::print("killed      back after   glove's     tracker's   samples     wall\n");
  fmt::print("            1st answer   median      median      missing\n");
  killOne(options, dir, name, wall, shm::kGlove, "cyberglove");
  killOne(options, dir, name, wall, shm::kTracker, "fastrak");
  killOne(options, dir, name, wall, shm::kBall, "spaceball");
  wall.kill(SIGTERM);
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  CLI::App app("Late frames of the wall beside a bare loop.");
  app.add_option("--bin", options.bin, "Folder of merlind and merlin")->required();
  app.add_option("--config", options.config, "The wall's configuration")->required();
  app.add_option("--seconds", options.seconds, "Of a run")->capture_default_str();
  app.add_option("--rounds", options.rounds)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const merlin::test::TempDir dir;
  merlin::bench::benchLate(options, dir);
  merlin::bench::benchFaults(options, dir);
}
