// ./dev bench latency: time from a byte on a line to a client of the shared memory. The readers
// that take turns in one run are MERLIN's; the same with idle cores kept awake (cpu_latency_us =
// 0); the same on a line that is polled once a millisecond; the same on a line that is polled
// without a pause; and a bare blocking loop without a driver. They read over a pseudo-terminal and
// over a socket pair, idle and with all cores loaded. The device is a glove. Each other kind of
// device is compared with a bare loop of its own: devices of 1998 with their dialogue, present-day
// ones in the form in which their ports deliver data (records of an input device, a VRPN server's
// messages, datagrams).
//
// Absolute times are valid only for this machine and this minute; only ratios can be compared. The
// bytes of a pseudo-terminal pass through a kernel worker, those of a socket pair do not.
#include <functional>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>

#include "drivers/io/cpu_latency.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/latency_daemon.h"
#include "tests/bench/latency_round.h"

namespace merlin::bench {
namespace {

struct Options : DemoOptions {
  RoundSize round;
  int rounds = 4;
};

struct Row {
  Measured median, p99, p999;
};
using Rows = std::map<Reader, Row>;

void printRow(Report& report, const std::string& line, const std::string& load, Reader kind,
              const Round& all, const Row& row) {
  report.text("{:11} {:6} {:13} {:5} {:9.1f} {:9.1f} {:10.1f} {:7.1f} %  {}\n", line, load,
              kReaderNames[kind], row.median.count(), row.median.value(), row.p99.value(),
              row.p999.value(), 100 * all.cpu_share, all.real_time ? "real-time" : "");
  const std::string name = fmt::format("{}.{}.{}", line, load, kReaderNames[kind]);
  report.figure(name + ".median", row.median, "us");
  report.figure(name + ".p99", row.p99, "us");
  report.figure(name + ".p99.9", row.p999, "us");
  report.figure(name + ".core_share", Measured::of(all.cpu_share, all.latency_us.size(), "samples"),
                "1");
}

// Processes that load all cores as long as this object exists.
class Hogs {
 public:
  explicit Hogs(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      all_.push_back(child([] {
        for (volatile std::uint64_t n = 0;;) n = n + 1;
      }));
    }
  }
  ~Hogs() {
    for (const pid_t hog : all_) ::kill(hog, SIGKILL);
    for (const pid_t hog : all_) ::waitpid(hog, nullptr, 0);
  }
  Hogs(const Hogs&) = delete;
  Hogs& operator=(const Hogs&) = delete;

 private:
  std::vector<pid_t> all_;
};

struct Setting {
  const Options& options;
  std::vector<Reader> readers;
  Times& times;
  Report& report;
};

Rows benchLine(const Setting& s, Line line, bool loaded) {
  const std::string load = loaded ? "loaded" : "idle";
  std::map<Reader, Round> all;
  const Hogs hogs(loaded ? std::thread::hardware_concurrency() : 0);
  for (int r = 0; r < s.options.rounds; ++r) {
    note(fmt::format("{}, {}: round {} of {}", kLineNames[line], load, r + 1, s.options.rounds));
    for (const Reader kind : s.readers) {
      const Round round = runRound(s.options.round, kind, line, s.times);
      Round& to = all[kind];
      to.latency_us.insert(to.latency_us.end(), round.latency_us.begin(), round.latency_us.end());
      to.cpu_share += round.cpu_share / s.options.rounds;
      to.real_time = round.real_time;
    }
  }
  Rows rows;
  for (const auto& [kind, round] : all) {
    const std::string what =
        fmt::format("samples of {} on a {}", kReaderNames[kind], kLineNames[line]);
    const auto& v = round.latency_us;
    const Row row{quantileOf(v, 0.5, what), quantileOf(v, 0.99, what), quantileOf(v, 0.999, what)};
    printRow(s.report, kLineNames[line], load, kind, round, row);
    rows.emplace(kind, row);
  }
  return rows;
}

const char* verdict(bool good) { return good ? "yes" : "NO"; }

// Compares the measurements with the limits that MERLIN states for its readers.
void judge(Reader kind, const Rows& pair_idle, const Rows& pty_idle, const Rows& pair_loaded,
           Report& report) {
  const std::string name = kReaderNames[kind];
  const Row &idle = pair_idle.at(kind), &loaded = pair_loaded.at(kind);
  const auto pair = ratioOf(pair_idle.at(kSleeping).median, idle.median, "samples");
  const auto pty = ratioOf(pty_idle.at(kSleeping).median, pty_idle.at(kind).median, "samples");
  report.text(
      "{}: median of the sleeping loop's, idle: 1/{:.1f} (socket pair), 1/{:.1f} (pty); limit "
      "1/20: {}\n",
      name, pair.value(), pty.value(), verdict(pair >= 20 && pty >= 20));
  report.text(
      "{}: socket pair p99: idle {:.0f} us (limit 200): {}; loaded {:.0f} us (limit 2000): {}\n",
      name, idle.p99.value(), verdict(idle.p99 <= 200), loaded.p99.value(),
      verdict(loaded.p99 <= 2000));
  report.figure(name + ".sleeping_by_it_on_socket_pair", pair, "1");
  report.figure(name + ".sleeping_by_it_on_pty", pty, "1");
}

// Returns all readers. The reader with awake cores is left out, with a note, if this machine does
// not allow it.
std::vector<Reader> readersHere(Report& report) {
  std::vector<Reader> readers;
  for (int kind = 0; kind < kReaders; ++kind) readers.push_back(static_cast<Reader>(kind));
  if (const auto awake = io::limitCpuLatency(0); !awake) {
    std::erase(readers, kAwake);
    report.text("{}: not measured: {}\n", kReaderNames[kAwake], awake.error().what);
  }
  return readers;
}

void benchReaders(const Options& options, Report& report) {
  double load = 0;
  ::getloadavg(&load, 1);
  report.text(
      "\nfrom the line's byte to a client of the shared memory, microseconds (the machine's load "
      "before: {:.2f}; \"idle\" is idle where that is small)\n",
      load);
  const Setting setting{options, readersHere(report), makeTimes(), report};
  report.text("line        load   reader            n    median       p99      p99.9      CPU\n");
  const Rows pair_idle = benchLine(setting, kSocketPair, false);
  const Rows pty_idle = benchLine(setting, kPty, false);
  const Rows pair_loaded = benchLine(setting, kSocketPair, true);
  benchLine(setting, kPty, true);
  for (const Reader kind : {kMerlin, kAwake}) {
    if (pair_idle.contains(kind)) judge(kind, pair_idle, pty_idle, pair_loaded, report);
  }
  const auto bare = ratioOf(pty_idle.at(kMerlin).median, pty_idle.at(kBare).median, "samples");
  const auto bare99 = ratioOf(pty_idle.at(kMerlin).p99, pty_idle.at(kBare).p99, "samples");
  report.text("pty: {:.2f} times the bare loop's median, {:.2f} times its p99 (limit 1.2): {}\n",
              bare.value(), bare99.value(), verdict(bare <= 1.2 && bare99 <= 1.2));
  report.figure("pty.by_bare_median", bare, "1");
  report.figure("pty.by_bare_p99", bare99, "1");
}

// Measures the other kinds of devices, compared with a bare loop that publishes a sample for the
// bytes of each record without parsing them. The rounds of both are interleaved.
void benchKinds(const Options& options, Report& report) {
  report.text("\nkind      line  MERLIN [us]  bare [us]   median by bare (limit 1.2)\n");
  Times& times = makeTimes();
  for (const Kind* kind : {&kTrackerKind, &kBallKind, &kGamepadKind, &kTouchKind, &kVrpnTrackerKind,
                           &kVrpnPadKind, &kOscKind, &kTuioKind}) {
    std::map<Reader, std::vector<double>> all;
    for (int r = 0; r < options.rounds; ++r) {
      note(fmt::format("{}: round {} of {}", kind->name, r + 1, options.rounds));
      for (const Reader reader : {kMerlin, kBare}) {
        const Round round = runRound(options.round, reader, kPty, times, *kind);
        all[reader].insert(all[reader].end(), round.latency_us.begin(), round.latency_us.end());
      }
    }
    const auto what = [&](Reader r) {
      return fmt::format("{} of {}", kind->name, kReaderNames[r]);
    };
    const auto merlin = quantileOf(all[kMerlin], 0.5, what(kMerlin));
    const auto bare = quantileOf(all[kBare], 0.5, what(kBare));
    const auto ratio = ratioOf(merlin, bare, "samples");
    report.text("{:9} pty {:12.1f} {:10.1f}   {:.2f}: {}\n", kind->name, merlin.value(),
                bare.value(), ratio.value(), verdict(ratio <= 1.2));
    report.figure(fmt::format("pty.{}.median", kind->name), merlin, "us");
    report.figure(fmt::format("pty.{}.by_bare_median", kind->name), ratio, "1");
  }
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app("Latency from a line's byte to a client of the shared memory.");
  app.option("--bin", options.bin, "Folder of merlind and merlin").required();
  app.option("--config", options.config, "The demo's configuration").required();
  app.option("--samples", options.round.samples, "Number of samples in a round")
      .range(1, 60'000)
      .showDefault();
  app.option("--rounds", options.rounds, "Number of rounds").range(1, 1000).showDefault();
  return app.run("latency", argc, argv, [&](merlin::bench::Report& report) {
    const merlin::test::TempDir dir;
    benchCpu(options, dir, report);
    benchEquation(options, dir, report);
    benchReaders(options, report);
    benchKinds(options, report);
    return true;
  });
}
