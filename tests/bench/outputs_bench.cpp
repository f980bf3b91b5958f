// ./dev bench outputs: the cost of an output of each kind for a frame of the demo's wall, compared
// with a memcpy of the frame. Also measures whether frames of the other outputs are late while one
// output is slow or stuck.
//
// All frames are the same picture of the demo's wall, 1920 x 480 pixels. Each is presented after a
// wait that is as long as the demo's drawing; a frame is therefore late if an output blocks the
// wall's thread, and not because the machine has other work. The window is that of merlin-window at
// an Xvfb. Disturbed and undisturbed runs take turns in one process with the same outputs.
#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "render/image/image_file.h"
#include "render/image/png_writer.h"
#include "render/out/output_set.h"
#include "render/out/png_output.h"
#include "render/out/shared_frame.h"
#include "render/out/window_output.h"
#include "tests/bench/command_line.h"
#include "tests/bench/demo_picture.h"
#include "tests/bench/figures.h"
#include "tests/support/temp_dir.h"
#include "tests/support/x_server.h"

namespace merlin::bench {
namespace {

namespace out = render::out;

constexpr double kPngInterval_s = 0.2;

struct Options {
  double seconds = 3;
  int rounds = 5;
};

// Simulates a file system that writes at once, half a second late, or not before it is released.
class Disk {
 public:
  enum class State { kFast, kSlow, kStuck };
  std::atomic<State> state{State::kFast};

  Result<Ok> write(const std::string& path, int width, int height,
                   std::span<const std::uint8_t> pixels) const {
    if (state == State::kSlow) std::this_thread::sleep_for(std::chrono::milliseconds(500));
    while (state == State::kStuck) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return render::image::writePng(path, width, height, pixels);
  }
};

// A process that has mapped the frames and was stopped while it read them.
class StoppedReader {
 public:
  explicit StoppedReader(const std::string& name) : pid_(::fork()) {
    if (pid_ == 0) {
      const auto memory = SharedMemory::open(name);
      volatile std::byte last = memory ? memory->data()[memory->size() - 1] : std::byte{};
      static_cast<void>(last);
      ::raise(SIGSTOP);
      ::_exit(0);
    }
    ::waitpid(pid_, nullptr, WUNTRACED);
  }
  ~StoppedReader() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  StoppedReader(const StoppedReader&) = delete;
  StoppedReader& operator=(const StoppedReader&) = delete;

 private:
  pid_t pid_;
};

enum Kind : std::size_t { kShared, kPng, kWindow, kKinds };
constexpr const char* kNames[] = {"shared_memory", "png", "window"};

// The outputs of a wall, and the disturbance of each.
class Wall {
 public:
  explicit Wall(const test::TempDir& dir) : picture_(demoPicture()), plan_(planOf(picture_)) {
    ::setenv("DISPLAY", x.display().c_str(), 1);
    ::unsetenv("WAYLAND_DISPLAY");
    std::vector<out::NamedOutput> outputs;
    auto shared = out::SharedFrameOutput::make(shared_name, plan_, 1, clock_);
    if (!shared) didNotRun("shared memory", shared.error().what, "see /dev/shm");
    outputs.push_back({kNames[kShared], "shared_memory", *std::move(shared)});
    const auto write = [this](const std::string& path, int width, int height,
                              std::span<const std::uint8_t> pixels) {
      return disk.write(path, width, height, pixels);
    };
    outputs.push_back(
        {kNames[kPng], "png",
         std::make_unique<out::PngOutput>(dir / "frame.png", kPngInterval_s, watch_, write)});
    const auto program = out::windowProgram();
    if (!program) didNotRun("merlin-window", program.error().what, "build it");
    outputs.push_back(
        {kNames[kWindow], "window",
         std::make_unique<out::WindowOutput>(out::WindowSettings{.title = "bench", .x = 0, .y = 0},
                                             out::WindowActs{}, *program, watch_, clock_)});
    outputs_.emplace(std::move(outputs));
  }

  const Picture& picture() const { return picture_; }
  const out::OutputSet& outputs() const { return *outputs_; }

  Duration present(std::size_t i, std::optional<Timestamp> deadline) {
    const Timestamp began = clock_.now();
    outputs_->present(i, {picture_.width, picture_.height, picture_.pixels},
                      {.sequence = ++sequence_, .finished = began}, deadline);
    return clock_.now() - began;
  }

  // Presents frames until each output shows them.
  void awaitAll() {
    std::array<std::uint64_t, kKinds> before{};
    for (std::size_t i = 0; i < kKinds; ++i) before[i] = outputs_->state(i).frames;
    const bool all = test::eventually([&] {
      bool each = true;
      for (std::size_t i = 0; i < kKinds; ++i) {
        present(i, std::nullopt);
        each = each && outputs_->state(i).frames > before[i] + (i == kPng ? 0 : 3) &&
               outputs_->faultNow(i).empty();
      }
      return each;
    });
    if (all) return;
    for (std::size_t i = 0; i < kKinds; ++i) {
      if (!outputs_->faultNow(i).empty())
        didNotRun(fmt::format("output {}", kNames[i]), outputs_->faultNow(i), "mend that");
    }
    didNotRun("the outputs", "not all outputs show frames", "see whether the machine is busy");
  }

  test::XServer x;
  Disk disk;
  const std::string shared_name = "/" + test::privateName("bench-outputs");

 private:
  Picture picture_;
  render::tiles::TilePlan plan_;
  SystemClock clock_;
  ThreadWatch watch_;
  std::uint64_t sequence_ = 0;
  std::optional<out::OutputSet> outputs_;
};

// Returns the processor time that a process has used [ms].
double cpuMs(pid_t pid) {
  double ns = 0;
  for (const auto& thread :
       std::filesystem::directory_iterator(fmt::format("/proc/{}/task", pid))) {
    std::ifstream schedstat(thread.path() / "schedstat");
    double one = 0;
    if (schedstat >> one) ns += one;
  }
  return ns / 1e6;
}

pid_t windowProcess() {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream pids(thread.path() / "children");
    for (pid_t child = 0; pids >> child;) {
      std::string name;
      std::getline(std::ifstream(fmt::format("/proc/{}/comm", child)) >> std::ws, name);
      if (name == "merlin-window") return child;
    }
  }
  didNotRun("merlin-window", "it does not run", "see whether SDL2 is installed");
}

void sayCost(Report& report, const std::string& name, const std::vector<double>& ms,
             const Measured& memcpy_ms) {
  const Measured median = medianOf(ms, "frames of " + name);
  const Measured slow = quantileOf(ms, 0.99, "frames of " + name);
  const Measured share = scaled(median, kRate_hz / 1000);
  const Measured ratio = ratioOf(median, memcpy_ms, name + " beside memcpy");
  report.text("  {:<22} {:7.3f} {:9.3f} {:9.2f} % {:9.2f}\n", name, median.value(), slow.value(),
              100 * share.value(), ratio.value());
  report.figure(name + "_ms", median, "ms");
  report.figure(name + "_p99_ms", slow, "ms");
  report.figure(name + "_frame_share", share, "1");
  report.figure(name + "_per_memcpy", ratio, "1");
}

void measureCosts(Wall& wall, int frames, const test::TempDir& dir, Report& report) {
  wall.awaitAll();
  const Picture& picture = wall.picture();
  std::vector<std::uint8_t> copy(picture.pixels.size());
  SystemClock clock;
  std::vector<double> copies, taken, left_out;
  std::array<std::vector<double>, kKinds> costs;
  const pid_t window = windowProcess(), x = wall.x.process().pid();
  const double before_window = cpuMs(window), before_x = cpuMs(x);
  const Timestamp start = clock.now();
  for (int k = 0; k < frames; ++k) {
    clock.sleepUntil(start + k * fromSeconds(1 / kRate_hz), {});
    const Timestamp began = clock.now();
    std::memcpy(copy.data(), picture.pixels.data(), copy.size());
    asm volatile("" : : "r"(copy.data()) : "memory");
    copies.push_back(msOf(clock.now() - began));
    for (const Kind i : {kShared, kPng, kWindow}) {
      const auto shown = wall.outputs().state(i).frames;
      const double ms = msOf(wall.present(i, std::nullopt));
      if (i != kPng)
        costs[i].push_back(ms);
      else
        (wall.outputs().state(i).frames > shown ? taken : left_out).push_back(ms);
    }
  }
  const auto each = [&](double ms) {
    return Measured::of(ms / frames, static_cast<std::uint64_t>(frames), "frames of the window");
  };
  const Measured of_program = each(cpuMs(window) - before_window), of_x = each(cpuMs(x) - before_x);
  std::vector<double> encoded;
  for (int i = 0; i < 5; ++i) {
    const Timestamp began = clock.now();
    if (!render::image::writePng(dir / "one.png", picture.width, picture.height, picture.pixels))
      didNotRun("the PNG", "cannot be written", "see the disk");
    encoded.push_back(msOf(clock.now() - began));
  }
  const Measured memcpy_ms = medianOf(copies, "copies of the frame");
  report.text(
      "cost on the wall's thread, {} frames of {} x {} at {} Hz\n"
      "  {:<22} {:>7} {:>9} {:>11} {:>9}\n  {:<22} {:7.3f}\n",
      frames, picture.width, picture.height, kRate_hz, "", "ms", "ms (p99)", "of a frame",
      "memcpys", "memcpy", memcpy_ms.value());
  report.figure("memcpy_ms", memcpy_ms, "ms");
  sayCost(report, "shared_memory", costs[kShared], memcpy_ms);
  sayCost(report, "png_taken", taken, memcpy_ms);
  sayCost(report, "png_left_out", left_out, memcpy_ms);
  sayCost(report, "window", costs[kWindow], memcpy_ms);
  const Measured encode_ms = medianOf(encoded, "PNG files");
  report.text(
      "cost elsewhere, of a processor's time\n  png: {:.1f} ms a file on its thread; window: "
      "{:.2f} ms a frame in "
      "merlin-window, {:.2f} ms in the X server\n",
      encode_ms.value(), of_program.value(), of_x.value());
  report.figure("png_encode_ms", encode_ms, "ms");
  report.figure("window_program_ms", of_program, "ms");
  report.figure("window_x_server_ms", of_x, "ms");
}

struct Counts {
  std::array<std::uint64_t, kKinds> due{}, late{};
  std::vector<double> outputs_ms;  // time that all outputs together take for each frame

  void add(const Counts& o) {
    for (std::size_t i = 0; i < kKinds; ++i) {
      due[i] += o.due[i];
      late[i] += o.late[i];
    }
    outputs_ms.insert(outputs_ms.end(), o.outputs_ms.begin(), o.outputs_ms.end());
  }
};

// Presents frames on a grid; a frame is due when the next one begins.
Counts run(Wall& wall, double seconds) {
  SystemClock clock;
  const Duration period = fromSeconds(1 / kRate_hz);
  std::array<out::OutputState, kKinds> before;
  for (std::size_t i = 0; i < kKinds; ++i) before[i] = wall.outputs().state(i);
  Counts counts;
  const Timestamp start = clock.now();
  for (std::int64_t k = 0; toSeconds(clock.now() - start) < seconds;) {
    clock.sleepUntil(start + k * period + fromSeconds(kDrawingShare / kRate_hz), {});
    const Timestamp began = clock.now();
    for (std::size_t i = 0; i < kKinds; ++i) wall.present(i, start + (k + 1) * period);
    counts.outputs_ms.push_back(msOf(clock.now() - began));
    k = std::max(k + 1, static_cast<std::int64_t>((clock.now() - start) / period));
  }
  for (std::size_t i = 0; i < kKinds; ++i) {
    counts.due[i] = wall.outputs().state(i).due - before[i].due;
    counts.late[i] = wall.outputs().state(i).late - before[i].late;
  }
  return counts;
}

struct Disturbance {
  const char* name;
  Kind of;  // the disturbed output; the other outputs are judged
  std::function<void()> begin, end;
};

std::vector<Disturbance> disturbances(Wall& wall, std::optional<StoppedReader>& reader) {
  const auto disk = [&wall](Disk::State state) {
    return [&wall, state] { wall.disk.state = state; };
  };
  const auto x = [&wall](int signal) {
    return [&wall, signal] { ::kill(wall.x.process().pid(), signal); };
  };
  return {{"png_slow", kPng, disk(Disk::State::kSlow), disk(Disk::State::kFast)},
          {"png_stuck", kPng, disk(Disk::State::kStuck), disk(Disk::State::kFast)},
          {"window_x_stopped", kWindow, x(SIGSTOP), x(SIGCONT)},
          {"window_x_gone", kWindow, [&wall] { wall.x.process().kill(SIGKILL); },
           [&wall] { wall.x.start(); }},
          {"reader_stopped", kShared, [&] { reader.emplace(wall.shared_name); },
           [&] { reader.reset(); }}};
}

// Judges an output that was not disturbed, by its late frames in disturbed runs beyond those in
// undisturbed runs.
bool judge(Report& report, const std::string& name, std::size_t i, const Counts& disturbed,
           const Counts& undisturbed) {
  // limit of further late frames, as a share of the output's frames
  constexpr double kMostMoreLate = 0.02;
  constexpr double kChance = 3;  // number of frames that may be late for other reasons
  const std::string what = fmt::format("frames of {} in {}", kNames[i], name);
  const Measured late = shareOf(disturbed.late[i], disturbed.due[i], what);
  const Measured before = shareOf(undisturbed.late[i], undisturbed.due[i], what);
  const Measured ratio =
      ratioOf(shareOf(disturbed.due[i] - disturbed.late[i], disturbed.due[i], what),
              shareOf(undisturbed.due[i] - undisturbed.late[i], undisturbed.due[i], what), what);
  const auto due = static_cast<double>(disturbed.due[i]);
  const bool good = (late - before) * due <= std::max(kChance, kMostMoreLate * due);
  report.text("    {:<14} {:6.2f} % late, undisturbed {:6.2f} %; in time {:.4f} of undisturbed{}\n",
              kNames[i], 100 * late.value(), 100 * before.value(), ratio.value(),
              good ? "" : "  MORE LATE");
  report.figure(fmt::format("{}.{}_late", name, kNames[i]), late, "1");
  report.figure(fmt::format("{}.{}_in_time_ratio", name, kNames[i]), ratio, "1");
  return good;
}

bool measureDisturbances(Wall& wall, const Options& options, Report& report) {
  std::optional<StoppedReader> reader;
  bool good = true;
  report.text(
      "the others while one is slow or stuck, {} rounds of {} s each, in turns with undisturbed "
      "ones\n",
      options.rounds, options.seconds);
  for (const Disturbance& d : disturbances(wall, reader)) {
    Counts disturbed, undisturbed;
    for (int round = 0; round < options.rounds; ++round) {
      note(fmt::format("{}: round {} of {}", d.name, round + 1, options.rounds));
      wall.awaitAll();
      undisturbed.add(run(wall, options.seconds));
      d.begin();
      disturbed.add(run(wall, options.seconds));
      d.end();
    }
    const Measured with = medianOf(disturbed.outputs_ms, "frames"),
                   without = medianOf(undisturbed.outputs_ms, "frames");
    const Measured ratio = ratioOf(with, without, "frames");
    report.text("  {:<18} the outputs take {:.2f} ms of a frame, {:.3f} of the undisturbed\n",
                d.name, with.value(), ratio.value());
    report.figure(fmt::format("{}.outputs_ms_ratio", d.name), ratio, "1");
    for (std::size_t i = 0; i < kKinds; ++i) {
      if (i != d.of) good = judge(report, d.name, i, disturbed, undisturbed) && good;
    }
  }
  return good;
}

bool measure(const Options& options, Report& report) {
  if (test::run({"Xvfb", "-help"}).status == 127)
    didNotRun("Xvfb", "there is no such program", "install it (Debian: xvfb)");
  const test::TempDir dir;
  Wall wall(dir);
  measureCosts(wall, static_cast<int>(options.seconds * options.rounds * kRate_hz), dir, report);
  return measureDisturbances(wall, options, report);
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "The cost of an output of each kind, and late frames of the others while one is slow or "
      "stuck");
  merlin::bench::Options options;
  app.option("--seconds", options.seconds, "Length of each run, in seconds").range(1.0, 3600.0);
  app.option("--rounds", options.rounds, "Runs of each kind").range(1, 1000);
  return app.run("outputs", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(options, report);
  });
}
