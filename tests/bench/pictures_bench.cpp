// ./dev bench pictures: a picture of 20000 x 10000 pixels that is panned and zoomed without a
// pause, and a panorama that is turned: late frames, rate and memory. Also the time from `merlin
// show` to the first picture of a file that the wall has not shown before, including a file of
// 10^11 pixels. Also the late frames while contents change, by commands on the socket and by
// programs that start on the same processors, compared with the same wall while it gets no
// commands.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "daemon/base/clock.h"
#include "daemon/status/client.h"
#include "tests/bench/command_line.h"
#include "tests/bench/demo_daemon.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

namespace fs = std::filesystem;

struct Options : DemoOptions {
  std::string work = "build/bench/pictures";
  double seconds = 60;
  int shows = 10;
};

// Writes a picture that has structures of every size, so that no tile compresses to almost nothing.
void writePpm(const std::string& path, int width, int height) {
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << width << " " << height << "\n255\n";
  std::string row(3 * static_cast<std::size_t>(width), '\0');
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned noise = static_cast<unsigned>(x * 7919 ^ y * 104729) * 2654435761U >> 28;
      const int wave = static_cast<int>(60 * std::sin(x / 97.0) * std::cos(y / 61.0));
      char* const pixel = &row[3 * static_cast<std::size_t>(x)];
      pixel[0] = static_cast<char>(120 + wave + static_cast<int>(noise));
      pixel[1] = static_cast<char>(255 * x / width);
      pixel[2] = static_cast<char>(255 * y / height);
    }
    out << row;
  }
}

std::string pyramid(const Options& options, int width, int height, bool panorama) {
  fs::create_directories(options.work);
  const std::string name =
      fmt::format("{}/{}x{}{}", options.work, width, height, panorama ? "-360" : "");
  if (!fs::exists(name + ".tif")) {
    note(fmt::format("making a picture of {} x {} pixels", width, height));
    writePpm(name + ".ppm", width, height);
    std::vector<std::string> command = {options.bin + "/merlin", "image", "import",
                                        name + ".ppm",           "-o",    name + ".tif"};
    if (panorama) command.emplace_back("--panorama");
    const test::Outcome made = test::run(command);
    fs::remove(name + ".ppm");
    if (made.status != 0) didNotRun("merlin image import", made.output, "./dev build");
  }
  return fs::absolute(name + ".tif").string();
}

// Makes a picture of 10^11 pixels in a sparse file; returns its path.
std::string gigapixels(const Options& options) {
  fs::create_directories(options.work);
  const std::string name = options.work + "/400000x250000.tif";
  const test::Outcome made =
      test::run({"python3", "-B", MERLIN_SOURCE_DIR "/tests/support/sparse_pyramid.py", "400000",
                 "250000", name});
  if (made.status != 0) didNotRun("sparse_pyramid.py", made.output, "is python3 there?");
  return fs::absolute(name).string();
}

// Returns the disk space that a file occupies [kB].
double diskOf(const std::string& file) {
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0) didNotRun(file, "it is not there", "make it again");
  return static_cast<double>(s.st_blocks) * 512 / 1000;
}

// Returns the resident memory of a process [MB]; `field` selects its maximum or its present value.
double memoryOf(pid_t pid, const std::string& field) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(field + ":")) return std::stod(line.substr(field.size() + 1)) / 1024;
  }
  didNotRun("merlind", "/proc has no " + field + " of it", "is /proc there?");
}

// Returns the times of copying a frame of the demo's wall, which the wall does three times for each
// frame. While memory is slow, because another machine on the same hardware uses it, frames take
// longer.
std::string frameCopies() {
  std::vector<char> from(std::size_t{4} * 640 * 480 * 4, 1), to(from.size());
  SystemClock clock;
  std::vector<double> ms;
  for (int i = 0; i < 100; ++i) {
    const Timestamp began = clock.now();
    std::copy(from.begin(), from.end(), to.begin());
    ms.push_back(1000 * toSeconds(clock.now() - began));
    from[static_cast<std::size_t>(i)] = to.back();
    clock.sleepUntil(clock.now() + std::chrono::milliseconds(5), {});
  }
  return fmt::format("median {:.1f} ms, 95 % {:.1f} ms", medianOf(ms, "copies").value(),
                     quantileOf(ms, 0.95, "copies").value());
}

// The priority that merlin-wall.service gives the wall (`Nice`).
constexpr int kUnitsNice = -10;

// While it exists, this thread and the programs that it starts have the priority of the wall's
// unit, if this process may raise it.
class UnitsPriority {
 public:
  UnitsPriority() : is_set_(::setpriority(PRIO_PROCESS, 0, kUnitsNice) == 0) {}
  ~UnitsPriority() { ::setpriority(PRIO_PROCESS, 0, before_); }
  UnitsPriority(const UnitsPriority&) = delete;
  UnitsPriority& operator=(const UnitsPriority&) = delete;
  bool isSet() const { return is_set_; }

 private:
  int before_ = ::getpriority(PRIO_PROCESS, 0);
  bool is_set_;
};

struct Motion {
  Measured late, held, work_ms;
  double memory_mb = 0;
  std::string renderer;
};

// Returns the motion of a person at the wall at time `t`, for 30 steps a second: circles and zooms.
std::string stepAt(double t, bool panorama) {
  if (panorama) return fmt::format("0 0 0 {:.4f} {:.4f} 0", 0.6 * std::sin(t), -1.5);
  const double zoom = 0.06 * std::sin(2 * std::numbers::pi * t / 12);
  return fmt::format("{:.5f} {:.5f} {:.5f} 0 0 0", 0.02 * std::sin(t / 1.3),
                     0.012 * std::cos(t / 0.9), zoom);
}

Motion move(const Options& options, const test::TempDir& dir, const std::string& file,
            bool panorama) {
  std::optional<UnitsPriority> priority(std::in_place);
  DemoDaemon daemon(options, dir, "all", [&](nlohmann::json& config) {
    config["script"] = "still";
    config["wall"]["model"] = "";
    config["wall"]["contents"] = {{{"picture", file}}};
  });
  priority.reset();
  SystemClock clock;
  // until the picture has full detail and is at rest
  clock.sleepUntil(clock.now() + std::chrono::seconds(3), {});
  status::CommandSender sender;
  const std::string endpoint = daemon.commandEndpoint();
  const shm::WallStats from = daemon.wall();
  std::vector<double> held, work;
  const Timestamp start = clock.now();
  for (int i = 0; toSeconds(clock.now() - start) < options.seconds; ++i) {
    clock.sleepUntil(start + fromSeconds(i / 30.0), {});
    static_cast<void>(sender.answer(clock.now()));
    if (sender.isReady()) {
      const auto sent = sender.send(endpoint, "move", stepAt(i / 30.0, panorama), clock.now());
      if (!sent) didNotRun("the wall", sent.error().what, "see its log");
    }
    if (i % 30 != 29) continue;
    const auto s = daemon.wall();
    held.push_back(static_cast<double>(s.rate_held_hz));
    work.push_back(static_cast<double>(s.work_median_ms));
  }
  const shm::WallStats end = daemon.wall();
  daemon.expectRunning();
  const double memory_mb = memoryOf(daemon.pid(), "VmHWM");
  const std::string renderer = daemon.renderer();
  daemon.stop();
  constexpr const char* kSeconds = "seconds in which the wall moved";
  return {shareOf(end.late - from.late, end.deadlines - from.deadlines,
                  "deadlines of the wall, which did not move,"),
          medianOf(held, kSeconds), medianOf(work, kSeconds), memory_mb, renderer};
}

struct Shown {
  Measured first_s;
  Measured undisturbed, changed, started;  // shares of late frames
  double model_memory_mb = 0, most_memory_mb = 0;
  bool first = false;  // whether the wall had the priority of its unit
};

// Late frames of a wall, added up over the times between begin() and end().
class LateFrames {
 public:
  explicit LateFrames(DemoDaemon& daemon) : daemon_(daemon) {}

  void begin() { from_ = daemon_.wall(); }
  void end() {
    const shm::WallStats to = daemon_.wall();
    late_ += to.late - from_.late;
    deadlines_ += to.deadlines - from_.deadlines;
  }
  Measured share(const char* when) const {
    return shareOf(late_, deadlines_, fmt::format("deadlines of the wall {}", when).c_str());
  }

 private:
  DemoDaemon& daemon_;
  shm::WallStats from_;
  std::uint64_t late_ = 0, deadlines_ = 0;
};

// Sends a command on the socket and waits for the answer, without starting a program.
void command(const DemoDaemon& daemon, status::CommandSender& sender, const std::string& name,
             const std::string& argument = "") {
  SystemClock clock;
  if (!sender.send(daemon.commandEndpoint(), name, argument, clock.now()))
    didNotRun(name, "it was not sent", "see the wall's log");
  while (!sender.isReady()) {
    clock.sleepUntil(clock.now() + std::chrono::milliseconds(10), {});
    const auto answer = sender.answer(clock.now());
    if (answer && !*answer) didNotRun(name, answer->error().what, "see the wall's log");
  }
}

// On a wall that the demo's script moves, shows a picture and the model in turns: in each round by
// `merlin show` and `merlin next_content`, then by the same commands on the socket, with a second
// in between in which the wall gets no commands.
Shown show(const Options& options, const test::TempDir& dir, const std::string& file) {
  std::optional<UnitsPriority> priority(std::in_place);
  const bool first = priority->isSet();
  DemoDaemon daemon(options, dir, "all",
                    [&](nlohmann::json& config) { config["script"] = "turning"; });
  priority.reset();
  SystemClock clock;
  clock.sleepUntil(clock.now() + std::chrono::seconds(3), {});
  const double memory_mb = memoryOf(daemon.pid(), "VmRSS");
  LateFrames undisturbed(daemon), changed(daemon), started(daemon);
  status::CommandSender sender;
  const auto forASecond = [&](LateFrames& frames, const std::function<void()>& act) {
    frames.begin();
    if (act) act();
    clock.sleepUntil(clock.now() + std::chrono::seconds(1), {});
    frames.end();
  };
  const std::string name = fs::path(file).stem().string();
  std::vector<double> times;
  const auto showFile = [&] {
    const Timestamp began = clock.now();
    const test::Outcome shown =
        test::run({options.bin + "/merlin", "show", file, "--instance", daemon.instance()});
    if (shown.status != 0) didNotRun("merlin show", shown.output, "see the wall's log");
    times.push_back(toSeconds(clock.now() - began));
  };
  for (int i = 0; i < options.shows; ++i) {
    forASecond(started, showFile);
    forASecond(started, [&] {
      test::run({options.bin + "/merlin", "next_content", "--instance", daemon.instance()});
    });
    forASecond(undisturbed, {});
    forASecond(changed, [&] { command(daemon, sender, "show", name); });
    forASecond(undisturbed, {});
    forASecond(changed, [&] { command(daemon, sender, "next_content"); });
  }
  const double most_mb = memoryOf(daemon.pid(), "VmHWM");
  daemon.stop();
  return {quantileOf(times, 1, "pictures shown"),
          undisturbed.share("while nothing was asked of it"),
          changed.share("while contents changed"),
          started.share("while programs started"),
          memory_mb,
          most_mb,
          first};
}

void print(Report& report, const std::string& name, const Motion& m, bool panorama) {
  report.text(
      "{:24} {:6.1f} Hz held, {:5.2f} % of {} frames late, {:5.1f} ms a frame, {:5.0f} MB\n", name,
      m.held.value(), 100 * m.late, m.late.count(), m.work_ms.value(), m.memory_mb);
  const std::string key = panorama ? "panorama" : "picture";
  report.figure(key + ".late", m.late, "1");
  report.figure(key + ".rate_held", m.held, "Hz");
  report.figure(key + ".work", m.work_ms, "ms");
}

// Returns 1 if a figure is within the limit that MERLIN states; otherwise prints a line and returns
// 0.
int keeps(Report& report, const char* what, double value, double most, const char* unit) {
  if (value <= most) return 1;
  report.text("beyond its limit: {} {:.2f} {}, the limit is {} {}\n", what, value, unit, most,
              unit);
  return 0;
}

// Returns whether all limits were kept.
bool benchPictures(const Options& options, Report& report) {
  const std::string large = pyramid(options, 20'000, 10'000, false);
  const std::string of_1998 = pyramid(options, 7000, 4000, false);
  const std::string panorama = pyramid(options, 8192, 4096, true);
  const std::string huge = gigapixels(options);
  const test::TempDir dir;
  const std::string copies = frameCopies();
  const Motion moved = move(options, dir, large, false);
  const Motion turned = move(options, dir, panorama, true);
  const Shown shown = show(options, dir, of_1998);
  const Shown opened = show(options, dir, huge);
  report.text("{}; to copy the 4.9 MB of a frame takes {} before, {} after all this\n",
              moved.renderer, copies, frameCopies());
  print(report, "picture 20000 x 10000", moved, false);
  print(report, "panorama 8192 x 4096", turned, true);
  report.text(
      "merlin show, 7000 x 4000: at most {:.0f} ms from the command to the first picture; the wall "
      "with the model alone takes {:.0f} MB\n"
      "{} changes between model and picture while the wall moves: {:.2f} % of {} frames late by "
      "commands on the socket, {:.2f} % by programs that start on these processors; {:.2f} % of {} "
      "in as many seconds without a change; {}\n",
      1000 * shown.first_s, shown.model_memory_mb, 2 * options.shows, 100 * shown.changed,
      shown.changed.count(), 100 * shown.started, 100 * shown.undisturbed,
      shown.undisturbed.count(),
      shown.first ? "nice -10, as in its unit"
                  : "without the priority of its unit, which this user may not set");
  report.text(
      "merlin show, 10^11 pixels ({:.0f} kB of {:.0f} MB on the disk): at most {:.0f} ms; {:.2f} % "
      "late by commands, {:.2f} % without a change; {:.0f} MB before, {:.0f} MB at most\n",
      diskOf(huge), static_cast<double>(fs::file_size(huge)) / 1e6, 1000 * opened.first_s,
      100 * opened.changed, 100 * opened.undisturbed, opened.model_memory_mb,
      opened.most_memory_mb);
  report.figure("show.first", shown.first_s, "s");
  report.figure("show.late", shown.changed, "1");
  report.figure("show.late_as_programs_start", shown.started, "1");
  report.figure("show.late_without", shown.undisturbed, "1");
  report.figure("show.first_of_1e11_pixels", opened.first_s, "s");
  const double more_mb = moved.memory_mb - shown.model_memory_mb;
  return keeps(report, "late frames of a picture that moves", 100 * moved.late, 1, "%") +
             keeps(report, "late frames of a panorama that turns", 100 * turned.late, 1, "%") +
             keeps(report, "late frames while contents change, beyond those without",
                   100 * (shown.changed - shown.undisturbed), 0, "%") +
             keeps(report, "the first picture", 1000 * shown.first_s, 300, "ms") +
             keeps(report, "memory beyond that of the wall with a model", more_mb, 256, "MB") ==
         5;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app(
      "Late frames and memory with large pictures, and the time to the first picture.");
  app.option("--bin", options.bin, "Folder of merlind and merlin").required();
  app.option("--config", options.config, "The demo's configuration").required();
  app.option("--work", options.work, "Folder for the pictures");
  app.option("--seconds", options.seconds, "Seconds of motion of each kind");
  app.option("--shows", options.shows, "Number of calls of merlin show");
  return app.run("pictures", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::benchPictures(options, report);
  });
}
