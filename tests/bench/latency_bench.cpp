// ./dev bench latency: from a byte on a line to a client of the shared memory, for MERLIN's reader,
// for the same with idle cores kept awake (devices.cpu_latency_us = 0), for that reader over a line
// that is asked once a millisecond, over one that is asked without a pause, and for a bare blocking
// loop without a device: interleaved in one run, over a pseudo-terminal and over a socket pair,
// idle and with all cores loaded.
//
// Absolute times belong to this machine and this minute; the ratios are what counts. A pty's bytes
// pass through a kernel worker, a socket pair's do not.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <functional>
#include <thread>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/cyberglove/device.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/emulate/emulator.h"
#include "drivers/io/cpu_latency.h"
#include "drivers/io/fd_stream.h"
#include "drivers/io/pty_master.h"
#include "tests/support/process.h"
#include "tests/support/statistics.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

using Segment = shm::DevicesSegment;
using test::quantile;

enum Reader { kMerlin, kAwake, kSleeping, kSpinning, kBare, kReaders };
constexpr const char* kReaderNames[] = {"MERLIN", "MERLIN, awake", "sleeps 1 ms", "spins",
                                        "bare blocking"};
enum Line { kSocketPair, kPty, kLines };
constexpr const char* kLineNames[] = {"socket pair", "pty"};

struct Options {
  std::string bin, config;
  int samples = 1000;  // a round
  int rounds = 4;
  double rate_hz = 250;
};

// Between the processes of one round; written once each, by sample number.
struct Times {
  static constexpr std::size_t kMost = 1 << 16;
  std::atomic<std::uint32_t> received;
  std::atomic<bool> stop;
  std::int64_t sent_ns[kMost], received_ns[kMost];
};

std::int64_t now() { return toNanoseconds(SystemClock().now()); }

bool askForRealTime() {
  const sched_param priority{50};
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority) == 0;
}

pid_t child(const std::function<void()>& body) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  body();
  ::_exit(0);
}

// A client as any other: maps the segment, sleeps on the glove's word, notes when it has a sample.
void runClient(const std::string& name, Times& times) {
  askForRealTime();
  const auto reader = shm::SegmentReader<Segment>::open(name);
  if (!reader) return;
  const auto& glove = (*reader)->glove;
  times.received = 0;
  for (std::uint64_t seen = 0; !times.stop;) {
    glove.wait(seen, {0, 100'000'000});
    const std::uint64_t count = glove.count();
    if (count == seen) continue;
    const std::int64_t at = now();
    const auto sample = glove.newest();
    seen = count;
    if (!sample || sample->counter >= Times::kMost) continue;
    times.received_ns[sample->counter] = at;
    times.received = sample->counter;
  }
}

// A line that is asked, not waited for: with a pause of a millisecond, or with none.
class AskedStream final : public ByteStream {
 public:
  AskedStream(int fd, bool sleeps) : fd_(fd), sleeps_(sleeps) {}
  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    for (const Timestamp end = clock_.now() + timeout; clock_.now() < end;) {
      const ssize_t n = ::read(fd_, buffer.data(), buffer.size());
      if (n > 0) return static_cast<std::size_t>(n);
      if (stop_) return Error{Errc::kClosed, "stopped"};
      const timespec pause{0, 1'000'000};
      if (sleeps_) ::nanosleep(&pause, nullptr);
    }
    return Error{Errc::kTimeout, "time-out"};
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration) override {
    (void)!::write(fd_, bytes.data(), bytes.size());
    return bytes.size();
  }
  void interrupt() noexcept override { stop_ = true; }

 private:
  SystemClock clock_;
  int fd_;
  bool sleeps_;
  std::atomic<bool> stop_{false};
};

// Both ends of a line, the device's and the reader's, non-blocking.
struct Ends {
  UniqueFd device, reader;
  std::optional<io::PtyMaster> pty;
  int deviceFd() const { return pty ? pty->fd() : device.get(); }
};

Ends makeLine(Line kind) {
  Ends ends;
  if (kind == kPty) {
    auto pty = io::PtyMaster::open("");
    if (!pty) return ends;
    ends.pty.emplace(*std::move(pty));
    ends.reader.reset(
        ::open(ends.pty->slavePath().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    return ends;
  }
  int fds[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, fds) != 0) return ends;
  ends.device.reset(fds[0]);
  ends.reader.reset(fds[1]);
  return ends;
}

std::string record(std::uint32_t n) {
  cyberglove::Record r;
  for (std::size_t i = 0; i < 22; ++i) r.values[i] = static_cast<std::uint8_t>(1 + (n + i) % 255);
  return cyberglove::encode(r, {.values = 22, .timestamp = false, .status = true});
}

// Reads, publishes and wakes, and does nothing else: what any blocking reader needs at least.
void bareLoop(int fd, Segment& segment, const std::atomic<bool>& stop) {
  std::byte buffer[256];
  GloveSample sample{};
  std::size_t bytes = 0;
  while (!stop) {
    pollfd item{fd, POLLIN, 0};
    if (::poll(&item, 1, 100) <= 0) continue;
    const ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n <= 0) continue;
    bytes += static_cast<std::size_t>(n);
    for (const std::size_t length = record(0).size(); bytes >= length; bytes -= length) {
      ++sample.counter;
      segment.glove.publish(sample);
    }
  }
}

// Answers the driver's dialogue until the glove streams.
void serveDialogue(int fd, emulate::Emulator& emulator, const std::atomic<bool>& streaming) {
  const SystemClock clock;
  std::byte received[64];
  std::string out;
  while (!streaming) {
    pollfd item{fd, POLLIN, 0};
    ::poll(&item, 1, 1);
    const ssize_t n = ::read(fd, received, sizeof received);
    if (n > 0) emulator.receive(std::span(received, static_cast<std::size_t>(n)), clock.now());
    emulator.advance(clock.now(), out);
    if (!out.empty()) (void)!::write(fd, out.data(), out.size());
    out.clear();
  }
}

struct Round {
  std::vector<double> latency_us;
  double cpu_share = 0;
  bool real_time = false;
};

// The reader's thread: opens as the driver does, says so, reads until it is stopped.
struct ReaderThread {
  std::atomic<bool> streaming{false}, stop{false}, real_time{false};
  std::atomic<double> cpu_s{0};

  void run(Reader kind, int fd, Segment& segment) {
    real_time = kind != kSpinning && askForRealTime();  // a spinning one would stop the machine
    shm::ShmSink sink(segment);
    const SystemClock clock;
    std::unique_ptr<ByteStream> stream;
    if (kind == kMerlin || kind == kAwake) stream = std::make_unique<io::FdStream>(fd, [] {});
    if (kind == kSleeping || kind == kSpinning)
      stream = std::make_unique<AskedStream>(fd, kind == kSleeping);
    const auto device = cyberglove::makeDevice({}, clock, sink);
    if (stream && !device->open(*stream)) return;
    streaming = true;
    timespec before{}, after{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
    if (stream) {
      while (!stop && device->poll(*stream)) continue;
    } else {
      bareLoop(fd, segment, stop);
    }
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
    cpu_s = static_cast<double>(after.tv_sec - before.tv_sec) +
            1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec);
  }
};

// Sends `samples` records at irregular intervals about the rate, so that no loop can fall in step.
void sendRecords(int fd, int samples, double rate_hz, std::uint32_t first, Times& times) {
  const SystemClock clock;
  Timestamp due = clock.now();
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(samples); ++i) {
    due += fromSeconds((0.5 + static_cast<double>(i * 7919 % 1000) / 1000) / rate_hz);
    timespec at{due.time_since_epoch() / std::chrono::seconds(1),
                (due.time_since_epoch() % std::chrono::seconds(1)).count()};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    const std::string bytes = record(first + i);
    times.sent_ns[first + i] = now();
    (void)!::write(fd, bytes.data(), bytes.size());
  }
}

Round runRound(const Options& options, Reader kind, Line line, Times& times) {
  const std::string name = shm::segmentName(test::privateName("latency"), "devices");
  const SystemClock clock;
  const auto segment =
      shm::SegmentWriter<Segment>::make(name, shm::devicesFields(), 1, clock.now(), {});
  Ends ends = makeLine(line);
  Round round;
  if (!segment || !ends.reader.valid()) return round;
  std::fill(std::begin(times.received_ns), std::end(times.received_ns), 0);
  times.stop = false;
  times.received = ~0U;
  const auto awake = kind == kAwake ? io::limitCpuLatency(0)
                                    : Result<UniqueFd>(Error{Errc::kUnsupported, "not asked for"});
  if (kind == kAwake && !awake) {
    fmt::print("{}\n", awake.error().what);
    return round;
  }
  const pid_t client = child([&] { runClient(name, times); });
  while (times.received == ~0U) std::this_thread::yield();
  ReaderThread reader;
  std::thread thread([&] { reader.run(kind, ends.reader.get(), **segment); });
  const auto emulator = emulate::findEmulator("cyberglove")
                            ->make({}, *emulate::findMotionScript("still"), clock.now());
  serveDialogue(ends.deviceFd(), *emulator, reader.streaming);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto first = static_cast<std::uint32_t>((**segment).glove.count()) + 1;
  const Timestamp start = clock.now();
  std::thread sender([&] {
    askForRealTime();  // it stands for the hardware
    sendRecords(ends.deviceFd(), options.samples, options.rate_hz, first, times);
  });
  sender.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double took = toSeconds(clock.now() - start);
  reader.stop = times.stop = true;
  thread.join();
  ::waitpid(client, nullptr, 0);
  const auto last = first + static_cast<std::uint32_t>(options.samples);
  for (std::uint32_t n = first; n < last; ++n) {
    // One that the client slept over was replaced by the next: it waited for as long.
    std::uint32_t m = n;
    while (m < last && times.received_ns[m] == 0) ++m;
    if (m < last)
      round.latency_us.push_back(1e-3 *
                                 static_cast<double>(times.received_ns[m] - times.sent_ns[n]));
  }
  round.cpu_share = reader.cpu_s / took;
  round.real_time = reader.real_time;
  return round;
}

struct Row {
  double median = 0, p99 = 0, p999 = 0;
};

std::array<Row, kReaders> benchLine(const Options& options, Line line, bool loaded, Times& times) {
  std::vector<pid_t> hogs;
  for (unsigned i = 0; loaded && i < std::thread::hardware_concurrency(); ++i) {
    hogs.push_back(child([] {
      for (volatile std::uint64_t n = 0;;) n = n + 1;
    }));
  }
  std::array<Round, kReaders> all;
  for (int r = 0; r < options.rounds; ++r) {
    for (int kind = 0; kind < kReaders; ++kind) {
      const Round round = runRound(options, static_cast<Reader>(kind), line, times);
      auto& to = all[static_cast<std::size_t>(kind)];
      to.latency_us.insert(to.latency_us.end(), round.latency_us.begin(), round.latency_us.end());
      to.cpu_share += round.cpu_share / options.rounds;
      to.real_time = round.real_time;
    }
  }
  for (const pid_t hog : hogs) ::kill(hog, SIGKILL);
  for (const pid_t hog : hogs) ::waitpid(hog, nullptr, 0);
  std::array<Row, kReaders> rows;
  for (std::size_t kind = 0; kind < kReaders; ++kind) {
    auto& v = all[kind].latency_us;
    rows[kind] = {quantile(v, 0.5), quantile(v, 0.99), quantile(v, 0.999)};
    fmt::print("{:11} {:6} {:13} {:5} {:9.1f} {:9.1f} {:10.1f} {:7.1f} %  {}\n", kLineNames[line],
               loaded ? "loaded" : "idle", kReaderNames[kind], v.size(), rows[kind].median,
               rows[kind].p99, rows[kind].p999, 100 * all[kind].cpu_share,
               all[kind].real_time ? "real-time" : "");
  }
  std::fflush(stdout);
  return rows;
}

const char* verdict(bool good) { return good ? "yes" : "NO"; }

void benchReaders(const Options& options) {
  void* at =
      ::mmap(nullptr, sizeof(Times), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  Times& times = *new (at) Times;
  double load = 0;
  ::getloadavg(&load, 1);
  fmt::print(
      "from the line's byte to a client of the shared memory, microseconds (the machine's load "
      "before: {:.2f}; \"idle\" is idle where that is small)\n",
      load);
  fmt::print("line        load   reader            n    median       p99      p99.9      CPU\n");
  const auto pair_idle = benchLine(options, kSocketPair, false, times);
  const auto pty_idle = benchLine(options, kPty, false, times);
  const auto pair_loaded = benchLine(options, kSocketPair, true, times);
  benchLine(options, kPty, true, times);
  for (const Reader kind : {kMerlin, kAwake}) {
    const double share = pair_idle[kind].median / pair_idle[kSleeping].median;
    const double pty_share = pty_idle[kind].median / pty_idle[kSleeping].median;
    fmt::print(
        "{}: median of the sleeping loop's, idle: 1/{:.1f} (socket pair), 1/{:.1f} (pty); asked at "
        "most 1/20: {}\n",
        kReaderNames[kind], 1 / share, 1 / pty_share, verdict(share <= 0.05 && pty_share <= 0.05));
    fmt::print(
        "{}: socket pair p99: idle {:.0f} us (asked 200): {}; loaded {:.0f} us (asked 2000): {}\n",
        kReaderNames[kind], pair_idle[kind].p99, verdict(pair_idle[kind].p99 <= 200),
        pair_loaded[kind].p99, verdict(pair_loaded[kind].p99 <= 2000));
  }
  const double bare = pty_idle[kMerlin].median / pty_idle[kBare].median;
  const double bare99 = pty_idle[kMerlin].p99 / pty_idle[kBare].p99;
  fmt::print(
      "pty: {:.2f} times the bare loop's median, {:.2f} times its p99 (asked at most 1.2): "
      "{}\n",
      bare, bare99, verdict(bare <= 1.2 && bare99 <= 1.2));
}

double cpuSeconds(pid_t pid) {
  std::istringstream words(test::readText(fmt::format("/proc/{}/stat", pid)));
  std::string word;
  double ticks = 0;
  for (int i = 1; words >> word && i <= 15; ++i) {
    if (i >= 14) ticks += std::stod(word);
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

nlohmann::json demoConfig(const Options& options, const test::TempDir& dir) {
  auto config = nlohmann::json::parse(test::readText(options.config));
  const auto folder = std::filesystem::absolute(options.config).parent_path();
  for (auto* path : {&config["devices"]["postures"], &config["wall"]["model"]})
    *path = (folder / path->get<std::string>()).string();
  config["instance"] = test::privateName("latency");
  config["run_directory"] = dir.path();
  config["devices"]["glove"] = {{"rate_hz", 150}};
  config["devices"]["script"] = "turning";
  config.erase("$schema");
  return config;
}

// All three devices at the highest rate that they have, through a real merlind.
void benchCpu(const Options& options, const test::TempDir& dir) {
  test::writeText(dir / "devices.json", demoConfig(options, dir).dump());
  test::Process daemon({options.bin + "/merlind", "--config", dir / "devices.json", "--role",
                        "devices", "--emulate"});
  if (!daemon.saysEventually("ready")) return;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  const double before = cpuSeconds(daemon.pid());
  std::this_thread::sleep_for(std::chrono::seconds(10));
  const double share = (cpuSeconds(daemon.pid()) - before) / 10;
  fmt::print(
      "three devices at full rate, with postures, status and shared memory: {:.1f} % of a "
      "core (asked at most 5): {}\n",
      100 * share, verdict(share <= 0.05));
  daemon.kill(SIGTERM);
}

// L = wire + parse and publish + age at pick-up + wait for the frame + draw and present.
void benchEquation(const Options& options, const test::TempDir& dir) {
  auto config = demoConfig(options, dir);
  test::writeText(dir / "wall.json", config.dump());
  test::Process daemon({options.bin + "/merlind", "--config", dir / "wall.json", "--emulate"});
  if (!daemon.saysEventually("ready")) {
    fmt::print("no wall (./dev demo makes its model): {}\n", daemon.output());
    return;
  }
  const auto name = config["instance"].get<std::string>();
  const auto wall = shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(name, "wall"));
  const auto devices = shm::SegmentReader<Segment>::open(shm::segmentName(name, "devices"));
  std::vector<double> age, work;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  for (int i = 0; wall && devices && i < 300; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(23));
    const auto s = (*wall)->stats.read();
    if (!s || !s->moving) continue;
    age.push_back(static_cast<double>(s->input_age_ms));
    work.push_back(static_cast<double>(s->work_ms));
  }
  daemon.kill(SIGTERM);
  const double frame_ms = 1000 / config["wall"]["rate"]["rate_hz"].get<double>();
  fmt::print(
      "\nL = wire + parse and publish + age at pick-up + wait for the frame + draw + present "
      "[ms]\n");
  for (const auto& [device, bytes, baud] : {std::tuple{"glove 25 B, 38400 baud", 25, 38400},
                                            {"Fastrak 32 B, 38400 baud", 32, 38400},
                                            {"ball 16 B, 9600 baud", 16, 9600}}) {
    fmt::print("  wire: {:25} {:5.1f}   (10 bits a byte, computed)\n", device,
               10'000.0 * bytes / baud);
  }
  fmt::print(
      "  parse and publish               see the table above: the median of MERLIN's rows\n");
  fmt::print("  age at pick-up            {:11.1f}   (median; newest sample when a frame begins)\n",
             quantile(age, 0.5));
  fmt::print("  wait for the frame        {:11.1f}   (mean of 0 to {:.1f}, computed)\n",
             frame_ms / 2, frame_ms);
  fmt::print(
      "  draw, to the last pixel   {:11.1f}   (median; this includes presenting: the frame "
      "buffer is where pixels are written)\n",
      quantile(work, 0.5));
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  CLI::App app("Latency from a line's byte to a client of the shared memory.");
  app.add_option("--bin", options.bin, "Folder of merlind and merlin")->required();
  app.add_option("--config", options.config, "The demo's configuration")->required();
  app.add_option("--samples", options.samples, "A round")->capture_default_str();
  app.add_option("--rounds", options.rounds)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  merlin::bench::benchReaders(options);
  const merlin::test::TempDir dir;
  merlin::bench::benchCpu(options, dir);
  merlin::bench::benchEquation(options, dir);
}
