// ./dev bench wall: late frames of the demo's wall, in turns with a bare loop that does the same
// median work at the same rate while the same devices run. Also the effect of a dead device on the
// others.
//
// Absolute times differ from machine to machine and from second to second. The last column is what
// matters: how much later the wall is than the bare loop.
#include <algorithm>
#include <map>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "tests/bench/command_line.h"
#include "tests/bench/demo_daemon.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

using test::Process;

struct Options : DemoOptions {
  double seconds = 20;
  int rounds = 3;
};

DemoDaemon::Change withScript(const std::string& script) {
  return [script](nlohmann::json& config) { config["script"] = script; };
}

void sleepSeconds(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Does the same amount of arithmetic at each call.
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
  Measured late, work_s;
};

// Runs a loop that does only this work, on the same grid of periods.
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
    deadlines += std::max<std::int64_t>(reached - k, 1);  // at least the turn's own deadline
    k = std::max(k + 1, reached);
  }
  constexpr const char* kWhat = "turns of the bare loop";
  return {shareOf(static_cast<std::uint64_t>(late), static_cast<std::uint64_t>(deadlines), kWhat),
          medianOf(work, kWhat)};
}

// Chooses the amount of work with which a turn of such a loop has the median time `work_s`.
FixedWork workThatTakes(double work_s, double rate_hz) {
  FixedWork fixed;
  for (int i = 0; i < 6; ++i) {
    const double took = bareLoop(fixed, rate_hz, i < 3 ? 0.3 : 1.5).work_s;
    fixed.count = static_cast<std::uint64_t>(static_cast<double>(fixed.count) * work_s / took);
  }
  return fixed;
}

struct WallRun {
  Measured late, work_s, held, utilisation;
  shm::WallStats end;
  std::string renderer;
};

WallRun runWall(const Options& options, const test::TempDir& dir, const std::string& script) {
  DemoDaemon daemon(options, dir, "all", withScript(script));
  sleepSeconds(3);  // the first frames calibrate the governor
  const shm::WallStats from = daemon.wall();
  std::vector<double> work, held, use;
  for (int i = 0; i < static_cast<int>(options.seconds); ++i) {
    sleepSeconds(1);
    const auto s = daemon.wall();
    held.push_back(static_cast<double>(s.rate_held_hz));
    if (!s.moving) continue;
    work.push_back(static_cast<double>(s.work_median_ms) / 1000);
    use.push_back(static_cast<double>(s.utilisation));
  }
  const shm::WallStats end = daemon.wall();
  const std::string renderer = daemon.renderer();
  daemon.stop();
  constexpr const char* kMoving = "seconds in which the wall moved";
  return {shareOf(end.late - from.late, end.deadlines - from.deadlines,
                  "deadlines of the wall, which did not move,"),
          medianOf(work, kMoving),
          medianOf(held, "seconds of the wall"),
          medianOf(use, kMoving),
          end,
          renderer};
}

// Runs the bare loop beside the same devices, which a merlind without a wall reads.
BareRun runBare(const Options& options, const test::TempDir& dir, const std::string& script,
                double work_s, double rate_hz) {
  DemoDaemon devices(options, dir, "devices", withScript(script));
  FixedWork fixed = workThatTakes(work_s, rate_hz);
  const std::uint64_t before = devices.devices().glove()->samples->count();
  const BareRun run = bareLoop(fixed, rate_hz, options.seconds);
  devices.expectRunning();
  if (devices.devices().glove()->samples->count() == before)
    didNotRun("the glove beside the bare loop", "it sent no sample", "see merlin status");
  devices.stop();
  return run;
}

// Results of all rounds of one script.
struct Rounds {
  std::vector<double> wall, bare;
  std::uint64_t wall_deadlines = 0, bare_deadlines = 0;

  void add(const WallRun& w, const BareRun& b) {
    wall.push_back(w.late);
    bare.push_back(b.late);
    wall_deadlines += w.late.count();
    bare_deadlines += b.late.count();
  }
};

void printRow(Report& report, const std::string& script, int round, const WallRun& wall,
              const BareRun& bare) {
  const auto percent = [](double share) { return 100 * share; };
  report.text(
      "{:8} {:5} {:7.0f} {:6.1f} {:9.1f} {:5.0f} % {:6.2f} % | {:12.1f} {:6.2f} % | {:+.2f} %\n",
      script, round, wall.end.rate_asked_hz, wall.held.value(), 1000 * wall.work_s,
      percent(wall.utilisation), percent(wall.late), 1000 * bare.work_s, percent(bare.late),
      percent(wall.late - bare.late));
  if (script == "visit") {
    report.text(
        "         standstill to full detail {:.0f} ms; motion resumed {} times, first frame late "
        "{} "
        "times; longest late run {}\n",
        1000 * static_cast<double>(wall.end.still_to_full_s) + 150, wall.end.resumed,
        wall.end.resumed_late, wall.end.longest_late);
  }
  const std::string name = fmt::format("{}.round{}", script, round);
  report.figure(name + ".wall_late", wall.late, "1");
  report.figure(name + ".bare_late", bare.late, "1");
  report.figure(name + ".wall_work", wall.work_s, "s");
  report.figure(name + ".bare_work", bare.work_s, "s");
  report.figure(name + ".rate_held", wall.held, "Hz");
  report.figure(name + ".utilisation", wall.utilisation, "1");
}

void benchLate(const Options& options, const test::TempDir& dir, Report& report) {
  report.text(
      "late frames while the model moves ({} s a run, {} rounds, wall and bare loop in turns)\n",
      options.seconds, options.rounds);
  report.text(
      "script   round   asked   held   work ms   used    late | bare: work ms   late | "
      "difference\n");
  bool named = false;
  for (const char* script : {"turning", "visit"}) {
    Rounds all;
    for (int round = 1; round <= options.rounds; ++round) {
      note(fmt::format("{}: round {} of {}", script, round, options.rounds));
      const WallRun wall = runWall(options, dir, script);
      const auto rate = static_cast<double>(wall.end.rate_asked_hz);
      const BareRun bare = runBare(options, dir, script, wall.work_s, rate);
      all.add(wall, bare);
      if (!std::exchange(named, true)) {
        report.text("drawn by {}\n", wall.renderer);
        report.figure("renderer", wall.renderer, 1);
      }
      printRow(report, script, round, wall, bare);
    }
    const auto wall = Measured::of(meanOf(all.wall, "rounds"), all.wall_deadlines, "deadlines");
    const auto bare = Measured::of(meanOf(all.bare, "rounds"), all.bare_deadlines, "deadlines");
    report.text("{:8}  mean: late {:.2f} %, bare loop {:.2f} % (limit: 2 %, or bare loop + 1 %)\n",
                script, 100 * wall, 100 * bare);
    report.figure(std::string(script) + ".wall_late", wall, "1");
    report.figure(std::string(script) + ".bare_late", bare, "1");
  }
}

// The intervals between the samples of a device that was not killed.
struct Intervals {
  Measured median_ms;
  std::uint64_t missing;
};

template <typename T>
Intervals intervalsOf(const shm::Channel<T>& channel, std::uint64_t from, const char* device) {
  std::vector<double> intervals;
  std::optional<T> last;
  std::uint64_t missing = 0;
  for (std::uint64_t n = from, to = channel.count(); n < to; ++n) {
    const auto sample = channel.at(n);
    if (!sample) continue;
    if (last) {
      intervals.push_back(static_cast<double>(sample->received_ns - last->received_ns) * 1e-6);
      missing += sample->counter - last->counter - 1;
    }
    last = sample;
  }
  return {medianOf(intervals, fmt::format("intervals of the {}'s samples", device)), missing};
}

struct Victim {
  std::string name, driver;  // of the device that is killed
};

void killEmulator(const DemoDaemon& wall, const std::string& driver) {
  const std::string pid = std::to_string(wall.pid());
  std::istringstream children(test::readText("/proc/" + pid + "/task/" + pid + "/children"));
  bool found = false;
  for (pid_t child = 0; children >> child;) {
    if (test::readText(fmt::format("/proc/{}/cmdline", child)).find(driver) == std::string::npos)
      continue;
    found = ::kill(child, SIGKILL) == 0 || found;
  }
  if (!found)
    didNotRun("the fault of " + driver, "merlind has no emulator of it to kill", "see --emulate");
}

// Returns the time until merlind reads the emulator that replaces the killed one.
Measured secondsUntilBack(const DemoDaemon& wall, const Victim& victim, Process& emulator) {
  if (!emulator.saysEventually(" on pty:"))
    didNotRun(fmt::format("merlin emulate {}", victim.driver), emulator.output(), "see --bin");
  const SystemClock clock;
  const Timestamp answered = clock.now();
  const bool back = test::eventually([&] {
    const auto health = wall.health(victim.name);
    return health && health->state == HealthState::kOk && health->reconnects > 0;
  });
  if (!back)
    didNotRun(victim.name, "merlind did not read it again within 30 s", "see merlin status");
  return Measured::of(toSeconds(clock.now() - answered), 1, "reconnections");
}

// Samples of glove and tracker since the last call of begin(), except for those of the killed
// device.
class Others {
 public:
  Others(const shm::DeviceSlots& devices, std::string victim)
      : glove_slots_(*devices.glove()->samples),
        tracker_slots_(*devices.tracker()->stations[0]),
        victim_(std::move(victim)) {
    begin();
  }
  void begin() {
    glove_ = glove_slots_.count();
    tracker_ = tracker_slots_.count();
  }
  std::map<std::string, Intervals> end() const {
    std::map<std::string, Intervals> all;
    if (victim_ != "glove") all.emplace("glove", intervalsOf(glove_slots_, glove_, "glove"));
    if (victim_ != "tracker")
      all.emplace("tracker", intervalsOf(tracker_slots_, tracker_, "tracker"));
    return all;
  }

 private:
  const shm::Channel<GloveSample>& glove_slots_;
  const shm::Channel<TrackerSample>& tracker_slots_;
  std::string victim_;
  std::uint64_t glove_ = 0, tracker_ = 0;
};

using Emulators = std::vector<std::unique_ptr<Process>>;

// Kills the emulator of one device for a second; reports the effect on the other two devices, and
// whether the wall went on.
bool killOne(const Victim& victim, const std::function<Process&()>& restart, DemoDaemon& wall,
             Report& report) {
  const std::string driver = victim.driver;
  note(driver + ": killed and restarted");
  Others others(wall.devices(), victim.name);
  sleepSeconds(1);
  const auto before = others.end();
  killEmulator(wall, driver);
  others.begin();
  const std::int64_t drawn = wall.wall().updated_ns;
  sleepSeconds(1.5);
  const Measured back = secondsUntilBack(wall, victim, restart());
  const auto during = others.end();
  report.text("{:11} {:9.2f} s", driver, back.value());
  report.figure(driver + ".back", back, "s");
  std::uint64_t missing = 0;
  for (const char* other : {"glove", "tracker"}) {
    const auto now = during.find(other);
    if (now == during.end()) {
      report.text("   {:>9}", "-");
      continue;
    }
    const auto ratio = ratioOf(now->second.median_ms, before.at(other).median_ms, "intervals");
    report.text("   {:>9}", fmt::format("{:+.1f} %", 100 * (ratio - 1)));
    report.figure(fmt::format("{}.interval_of_{}", driver, other), ratio, "1");
    missing += now->second.missing;
  }
  const bool ran_on = wall.wall().updated_ns > drawn;
  report.text("   {:9}   {:8}\n", missing, ran_on ? "ran on" : "STOPPED");
  return ran_on;
}

bool benchFaults(const Options& options, const test::TempDir& dir, Report& report) {
  DemoDaemon wall(options, dir, "all", withScript("visit"));
  Emulators emulators;  // the restarted emulators run until the end
  bool ran_on = true;
  sleepSeconds(3);
  report.text("\na device killed and restarted (its emulator, kill -9)\n");
  report.text("killed      back after   glove's     tracker's   samples     wall\n");
  report.text("            1st answer   median      median      missing\n");
  for (const Victim& victim :
       {Victim{"glove", "cyberglove"}, Victim{"tracker", "fastrak"}, Victim{"ball", "spaceball"}}) {
    const auto restart = [&]() -> Process& {
      return *emulators.emplace_back(std::make_unique<Process>(
          std::vector<std::string>{options.bin + "/merlin", "emulate", victim.driver, "--link",
                                   dir / fmt::format("{}-{}.pty", wall.instance(), victim.name)}));
    };
    ran_on = killOne(victim, restart, wall, report) && ran_on;
  }
  wall.stop();
  return ran_on;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app("Late frames of the wall compared with those of a bare loop.");
  app.option("--bin", options.bin, "Folder of merlind and merlin").required();
  app.option("--config", options.config, "The wall's configuration").required();
  app.option("--seconds", options.seconds, "Length of each run, in seconds")
      .range(1, 86'400)
      .showDefault();
  app.option("--rounds", options.rounds, "Number of rounds").range(1, 1000).showDefault();
  return app.run("wall", argc, argv, [&](merlin::bench::Report& report) {
    const merlin::test::TempDir dir;
    benchLate(options, dir, report);
    return benchFaults(options, dir, report);
  });
}
