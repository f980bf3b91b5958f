// ./dev bench soak: a day of the wall on a virtual clock, with scripted people, faults and reloads,
// in minutes. Measures memory, descriptors and late frames, and checks whether every event is
// explained. The same seed gives the same day. The same in real time with the real programs is
// ./dev soak.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>

#include "config/loader.h"
#include "daemon/base/clock.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/soak/virtual_day.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

using nlohmann::json;

struct Options {
  double hours = 24, warm_up_h = 2;
  std::uint64_t seed = 1;
};

json configurationOf(const test::TempDir& dir) {
  const auto device = [](const char* name, const char* driver, const char* person) {
    return json{{"name", name},
                {"driver", driver},
                {"port", fmt::format("pty:/virtual/{}", name)},
                {"person", person}};
  };
  return {{"instance", test::privateName("soak")},
          {"run_directory", dir.path()},
          {"devices",
           {device("glove", "cyberglove", "ann"), device("tracker", "fastrak", "ann"),
            device("ball", "spaceball", "ann"), device("guest", "spaceball", "ben")}},
          {"hands", {{{"person", "ann"}}}},
          {"postures", {{"file", MERLIN_SOURCE_DIR "/config/postures.json"}}},
          {"wall",
           {{"model", "stand-in.mrm"},
            {"rate", {{"rate_hz", 30}}},
            {"playlist", {{"after_s", 300}, {"hold_s", 30}, {"dim_after_s", 3600}}}}}};
}

Settings settingsOf(const json& configuration, const std::string& folder) {
  LoadedSettings loaded = loadSettings(configuration.dump(), folder);
  if (loaded.verdict() != LoadedSettings::Verdict::kValid)
    didNotRun("the configuration", toText("soak.json", loaded.findings.at(0)), "fix the benchmark");
  return loaded.settings;
}

std::vector<VirtualDevices::Line> linesOf(const Settings& settings, const Persons& persons,
                                          std::uint64_t seed, Fibers& fibers) {
  std::vector<VirtualDevices::Line> lines;
  for (const DeviceSettings& device : settings.devices.list) {
    const std::size_t& held = device.person == "ben" ? persons.guest : persons.first;
    const auto make = [&held, device, seed, number = lines.size()](Timestamp start) {
      emulate::EmulatorSettings emulated;
      emulated.baud = device.line.baud;
      emulated.seed = seed + number;
      return emulate::findEmulator(device.line.driver)->make(emulated, scriptOf(held), start);
    };
    lines.push_back({device.name, std::make_unique<VirtualLine>(fibers, make)});
  }
  return lines;
}

struct Sample {
  double at_h, memory_mb;
  std::size_t descriptors;
  std::uint64_t deadlines, late, slow_deadlines, slow_late;
};

std::size_t descriptorsNow() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

double memoryNow_mb() {
  std::size_t all = 0, resident = 0;
  std::istringstream(test::readText("/proc/self/statm")) >> all >> resident;
  return static_cast<double>(resident) * 4096 / (1 << 20);
}

// One simulated lab, from its start to its end.
class Lab {
 public:
  Lab(const Options& options, const test::TempDir& dir)
      : options_(options),
        configuration_(configurationOf(dir)),
        settings_(settingsOf(configuration_, dir.path())),
        devices_(settings_, linesOf(settings_, persons_, options.seed, fibers_), fibers_, clock_),
        wall_(settings_, options.seed + 100, fibers_, clock_),
        day_({configuration_, dir.path(), settings_, fibers_, clock_, devices_, wall_, persons_},
             options.seed + 200) {}

  void run() {
    const Timestamp begin = clock_.now(), end = begin + fromSeconds(3600 * options_.hours);
    devices_.start(stop_.get_token());
    wall_.start(stop_.get_token());
    day_.start(stop_.get_token(), end);
    SystemClock system;
    const Timestamp began = system.now();
    for (int minute = 1; clock_.now() < end; ++minute) {
      fibers_.runUntil(std::min(end, begin + std::chrono::minutes(minute)));
      sample(toSeconds(clock_.now() - begin) / 3600);
      if (minute % 60 != 0) continue;
      const double took = toSeconds(system.now() - began);
      const double share = toSeconds(clock_.now() - begin) / toSeconds(end - begin);
      note(
          fmt::format("{:4.0f} h of {:.0f}, {:.0f} s left: {:.1f} MiB, {} descriptors, {} visits, "
                      "{} faults, {} reloads, {} wrong",
                      minute / 60.0, options_.hours, took / share - took, samples_.back().memory_mb,
                      samples_.back().descriptors, day_.counts().visits, day_.counts().faults,
                      day_.counts().reloads, day_.counts().wrong.size()));
    }
    took_s_ = toSeconds(system.now() - began);
    frames_ = wall_.stats().frames;
    measured_ = devices_.samples();
    stop_.request_stop();
    while (!fibers_.finished()) fibers_.runUntil(clock_.now() + std::chrono::seconds(1));
  }

  const std::vector<Sample>& samples() const { return samples_; }
  const VirtualDay& day() const { return day_; }
  double took_s() const { return took_s_; }
  std::uint64_t frames() const { return frames_; }
  std::uint64_t measured() const { return measured_; }

 private:
  // Takes a sample. A minute in which the renderer was slow on purpose is counted separately.
  void sample(double at_h) {
    const shm::WallStats now = wall_.stats();
    const std::uint64_t deadlines = now.deadlines - last_.deadlines, late = now.late - last_.late;
    last_ = now;
    const bool slow = day_.isSlow() || std::exchange(was_slow_, day_.isSlow());
    samples_.push_back({at_h, memoryNow_mb(), descriptorsNow(), slow ? 0 : deadlines,
                        slow ? 0 : late, slow ? deadlines : 0, slow ? late : 0});
  }

  const Options& options_;
  json configuration_;
  Settings settings_;
  Persons persons_;
  Fibers fibers_;
  VirtualClock clock_{fibers_};
  VirtualDevices devices_;
  VirtualWall wall_;
  VirtualDay day_;
  std::stop_source stop_;
  std::vector<Sample> samples_;
  shm::WallStats last_{};
  bool was_slow_ = false;
  double took_s_ = 0;
  std::uint64_t frames_ = 0, measured_ = 0;
};

void reportFrames(const std::vector<Sample>& samples, Report& report) {
  std::uint64_t first[2] = {}, rest[2] = {}, slow[2] = {};
  for (const Sample& s : samples) {
    auto& part = s.at_h <= 1 ? first : rest;
    part[0] += s.deadlines;
    part[1] += s.late;
    slow[0] += s.slow_deadlines;
    slow[1] += s.slow_late;
  }
  const auto say = [&](const char* name, const char* key, const std::uint64_t(&part)[2]) {
    if (part[0] == 0) return report.text("late frames, {}: nothing moved\n", name);
    const Measured share = shareOf(part[1], part[0], "deadlines");
    report.text("late frames, {}: {:.3f} % of {}\n", name, 100 * share.value(), share.count());
    report.figure(key, share, "1");
  };
  say("first hour", "late_first_hour", first);
  say("the rest", "late_rest", rest);
  say("minutes with a renderer that is slow on purpose, apart", "late_slow", slow);
}

void reportEvents(const DayCounts& counts, Report& report) {
  std::uint64_t all = 0;
  for (const auto& [kind, row] : counts.events) {
    std::string explained;
    std::uint64_t sum = 0;
    for (const auto& [fault, count] : row) {
      explained += fmt::format("{}{} {}", explained.empty() ? "" : ", ", fault, count);
      sum += count;
    }
    report.text("  {:<10} {:6}  {}\n", kind, sum, explained);
    all += sum;
  }
  report.text(
      "{} visits, {} faults, {} reloads, {} status documents; an alarm's program would have "
      "been started {} times\n",
      counts.visits, counts.faults, counts.reloads, counts.documents, counts.alarms);
  report.figure("events", Measured::of(static_cast<double>(all), all, "events"), "1");
  report.figure("wrong", Measured::of(static_cast<double>(counts.wrong.size()), all, "events"),
                "1");
  report.figure("digest", fmt::format("{:016x}", counts.digest), all);
}

// Reports memory and descriptors; returns whether they have not grown.
bool reportHeld(const Options& options, const std::vector<Sample>& samples, Report& report) {
  std::vector<std::pair<double, double>> memory;
  std::vector<double> descriptors;
  for (const Sample& s : samples) {
    if (s.at_h < options.warm_up_h) continue;
    memory.emplace_back(s.at_h, s.memory_mb);
    descriptors.push_back(static_cast<double>(s.descriptors));
  }
  const Slope slope = slopeOf(memory, "minutes after the warm-up");
  const auto quarter = static_cast<std::ptrdiff_t>(descriptors.size() / 4);
  const Measured before = medianOf({descriptors.begin(), descriptors.begin() + quarter}, "minutes");
  const Measured after = medianOf({descriptors.end() - quarter, descriptors.end()}, "minutes");
  report.text(
      "memory {:.1f} -> {:.1f} MiB, {:+.4f} MiB/h [95 %: {:+.4f}, {:+.4f}]; descriptors {} "
      "-> {}\n",
      memory.front().second, memory.back().second, slope.value.value(),
      slope.value - slope.half_width, slope.value + slope.half_width, before.value(),
      after.value());
  report.figure("memory_slope", slope.value, "MiB/h");
  report.figure("memory_slope_half_width", slope.half_width, "MiB/h");
  report.figure("descriptors_first", before, "1");
  report.figure("descriptors_last", after, "1");
  return slope.value - slope.half_width <= 0 && after <= before;
}

// Ends the benchmark if on a whole day nobody came or nothing happened, since it then shows
// nothing. Runs of less than a day are not checked.
void expectLived(const Options& options, const DayCounts& counts,
                 const std::vector<Sample>& samples) {
  if (options.hours < 24) return;
  const bool moved =
      std::ranges::any_of(samples, [](const Sample& sample) { return sample.deadlines > 0; });
  if (moved && counts.visits > 0 && counts.faults > 0 && counts.reloads > 0) return;
  didNotRun("the day",
            fmt::format("{} visits, {} faults, {} reloads, and the wall {}", counts.visits,
                        counts.faults, counts.reloads, moved ? "moved" : "did not move"),
            "see tests/bench/soak/virtual_day.cpp");
}

bool bench(const Options& options, Report& report) {
  // With a single heap for the one thread, the memory sizes of samples can be compared.
  ::mallopt(M_ARENA_MAX, 1);
  const test::TempDir dir;
  Lab lab(options, dir);
  lab.run();
  const DayCounts& counts = lab.day().counts();
  expectLived(options, counts, lab.samples());
  const Measured speed = Measured::of(3600 * options.hours / lab.took_s(), 1, "days");
  report.text(
      "{:.4g} h of the wall in {:.0f} s, {:.0f} times as fast, seed {}: {} frames, {} samples\n",
      options.hours, lab.took_s(), speed.value(), options.seed, lab.frames(), lab.measured());
  report.text(
      "real: drivers and their loops, postures, hand, actions, flight recorder, shared "
      "memory, input, turns, scene, governor and its ladder, playlist, attendance, delivery, "
      "output in shared memory, picture checks, loader and plan of reloads, state, events, "
      "status documents, alarm queue\n"
      "stand-ins: the clock; the devices (emulators); who draws (its cost by a model); the "
      "state's disk; merlind's threads are fibers of one. Not in it: sockets, page, models' "
      "files, start and end of processes: ./dev soak\n");
  report.figure("speed", speed, "1");
  const bool held = reportHeld(options, lab.samples(), report);
  reportFrames(lab.samples(), report);
  report.text("events by kind, and what explains them\n");
  reportEvents(counts, report);
  std::vector<std::string> wrong = counts.wrong;
  for (const std::string& missing : lab.day().untold())
    wrong.push_back("a fault was not reported: " + missing);
  for (const std::string& what : wrong) {
    report.text("WRONG: {}\n", what);
    note("soak: " + what);
  }
  return held && wrong.empty();
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  double warm_up_h = -1;
  merlin::bench::CommandLine app(
      "A day of the wall on a virtual clock, with people, faults and reloads.");
  app.option("--hours", options.hours, "Hours of virtual time").range(0.2, 10'000.0).showDefault();
  app.option("--seed", options.seed, "Seed of people, faults and devices").showDefault();
  app.option("--warm-up", warm_up_h,
             "Hours at the beginning whose memory does not count; the default is a quarter, at "
             "most two")
      .range(0.0, 1000.0);
  return app.run("soak", argc, argv, [&](merlin::bench::Report& report) {
    options.warm_up_h = warm_up_h >= 0 ? warm_up_h : std::min(2.0, options.hours / 4);
    return merlin::bench::bench(options, report);
  });
}
