#include "tests/bench/latency_round.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/emulate/emulator.h"
#include "drivers/io/cpu_latency.h"
#include "drivers/io/fd_stream.h"
#include "drivers/io/pty_master.h"
#include "tests/bench/figures.h"
#include "tests/bench/latency_line.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {

// Times that the processes of a round share; indexed by sample number. Each entry is written once.
struct Times {
  static constexpr std::size_t kMost = 1 << 16;
  std::atomic<std::uint32_t> received;
  std::atomic<bool> stop;
  std::int64_t sent_ns[kMost], received_ns[kMost];
};

Times& makeTimes() {
  void* at =
      ::mmap(nullptr, sizeof(Times), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return *new (at) Times;
}

pid_t child(const std::function<void()>& body) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  body();
  ::_exit(0);
}

namespace {

using Segment = shm::DevicesSegment;

std::int64_t now() { return toNanoseconds(SystemClock().now()); }

// Repeatedly waits for the channel's next sample and stores its time of arrival.
template <typename Sample>
void noteArrivals(const shm::Channel<Sample>& channel, Times& times) {
  times.received = 0;
  for (std::uint64_t seen = 0; !times.stop;) {
    channel.wait(seen, {0, 100'000'000});
    const std::uint64_t count = channel.count();
    if (count == seen) continue;
    const std::int64_t at = now();
    const auto sample = channel.newest();
    seen = count;
    if (!sample || sample->counter >= Times::kMost) continue;
    times.received_ns[sample->counter] = at;
    times.received = sample->counter;
  }
}

// Runs a usual client, which maps the segment.
void runClient(const std::string& name, const Kind& kind, Times& times) {
  askForRealTime();
  const auto reader = shm::SegmentReader<Segment>::open(name);
  if (!reader) return;
  withChannel(**reader, kind, [&](const auto& channel) { noteArrivals(channel, times); });
}

// A line that is polled, every millisecond or without a pause, instead of waited for.
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

// Both ends of a line, the device's and the reader's. Both are non-blocking.
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

// Only reads, publishes and wakes the client: the minimum work of any blocking reader.
template <typename Sample>
void bareLoop(int fd, std::size_t length, shm::Channel<Sample>& channel,
              const std::atomic<bool>& stop) {
  std::byte buffer[256];
  Sample sample{};
  std::size_t bytes = 0;
  while (!stop) {
    pollfd item{fd, POLLIN, 0};
    if (::poll(&item, 1, 100) <= 0) continue;
    const ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n <= 0) continue;
    bytes += static_cast<std::size_t>(n);
    for (; bytes >= length; bytes -= length) {
      ++sample.counter;
      channel.publish(sample);
    }
  }
}

// The reader's thread: opens the line as the driver does, sets `streaming`, and reads until `stop`
// is set.
struct ReaderThread {
  std::atomic<bool> streaming{false}, stop{false}, ended{false}, real_time{false};
  std::atomic<double> cpu_s{0};

  void run(Reader reader, const Kind& kind, int fd, Segment& segment) {
    read(reader, kind, fd, segment);
    ended = true;
  }

 private:
  void read(Reader reader, const Kind& kind, int fd, Segment& segment) {
    // A spinning thread with real-time priority would block the machine.
    real_time = reader != kSpinning && askForRealTime();
    shm::ShmSink sink(segment, kind.kind, 0);
    const SystemClock clock;
    std::unique_ptr<ByteStream> stream;
    if (reader == kMerlin || reader == kAwake) stream = std::make_unique<io::FdStream>(fd, [] {});
    if (reader == kSleeping || reader == kSpinning)
      stream = std::make_unique<AskedStream>(fd, reader == kSleeping);
    const auto device = kind.make(clock, sink);
    if (stream && !device->open(*stream)) return;
    streaming = true;
    timespec before{}, after{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
    if (stream) {
      while (!stop && device->poll(*stream)) continue;
    } else {
      withChannel(segment, kind,
                  [&](auto& channel) { bareLoop(fd, kind.record(0).size(), channel, stop); });
    }
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
    cpu_s = static_cast<double>(after.tv_sec - before.tv_sec) +
            1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec);
  }
};

void sendRecords(int fd, const RoundSize& size, const Kind& kind, std::uint32_t first,
                 Times& times) {
  atIrregularTimes(static_cast<std::uint32_t>(size.samples), size.rate_hz, [&](std::uint32_t n) {
    const std::string bytes = kind.record(first + n);
    times.sent_ns[first + n] = now();
    (void)!::write(fd, bytes.data(), bytes.size());
  });
}

// Serves the dialogue with which the driver begins. A bare loop has no dialogue, and would count a
// greeting as a record, so it gets none.
void beginDialogue(int fd, const Kind& kind, Reader reader, const std::function<bool()>& done) {
  if (!kind.emulator) return serveGreeting(fd, reader == kBare ? "" : kind.greeting(), done);
  const auto emulator = emulate::findEmulator(kind.emulator)
                            ->make({}, *emulate::findMotionScript("still"), SystemClock().now());
  serveDialogue(fd, *emulator, done);
}

// Returns the latency of each record from the line to the client [us].
std::vector<double> latencies(const Times& times, std::uint32_t first, std::uint32_t last) {
  std::vector<double> all_us;
  for (std::uint32_t n = first; n < last; ++n) {
    // The client may miss a record while it sleeps; the record's latency is then that of the next
    // one seen.
    std::uint32_t m = n;
    while (m < last && times.received_ns[m] == 0) ++m;
    if (m < last)
      all_us.push_back(1e-3 * static_cast<double>(times.received_ns[m] - times.sent_ns[n]));
  }
  return all_us;
}

// A client process that has opened the segment.
class Client {
 public:
  Client(const std::string& name, const Kind& kind, Times& times) : times_(times) {
    times.stop = false;
    times.received = kNone;
    pid_ = child([&] { runClient(name, kind, times); });
    if (test::eventually([&] { return times.received != kNone; })) return;
    stop();
    didNotRun("a client of " + name, "it did not open the segment within 30 s", "see /dev/shm");
  }
  ~Client() { stop(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  void stop() {
    times_.stop = true;
    ::waitpid(pid_, nullptr, 0);
  }
  Times& times_;
  pid_t pid_ = -1;
};

}  // namespace

Round runRound(const RoundSize& size, Reader reader, Line line, Times& times, const Kind& kind) {
  const std::string name = shm::segmentName(test::privateName("latency"), "devices");
  const SystemClock clock;
  const auto segment = shm::SegmentWriter<Segment>::make(
      name, shm::devicesFields({{{kind.name, kind.kind}}, {}}), 1, clock.now(), {});
  if (!segment) didNotRun("the shared memory", segment.error().what, "see /dev/shm");
  Ends ends = makeLine(line);
  if (!ends.reader.valid())
    didNotRun(kLineNames[line], "it cannot be made", "see 'ulimit -n' and /dev/pts");
  std::fill(std::begin(times.received_ns), std::end(times.received_ns), 0);
  std::optional<UniqueFd> awake;
  if (reader == kAwake) awake.emplace(*io::limitCpuLatency(0));
  std::optional<Client> client(std::in_place, name, kind, times);
  ReaderThread reading;
  std::thread thread([&] { reading.run(reader, kind, ends.reader.get(), **segment); });
  beginDialogue(ends.deviceFd(), kind, reader, [&] { return reading.streaming || reading.ended; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::uint32_t first = withChannel(**segment, kind, [](const auto& channel) {
    const auto sample = channel.newest();
    return sample ? sample->counter + 1 : 1;
  });
  const Timestamp start = clock.now();
  std::thread sender([&] {
    askForRealTime();  // this thread plays the hardware, so nothing may delay it
    sendRecords(ends.deviceFd(), size, kind, first, times);
  });
  sender.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double took = toSeconds(clock.now() - start);
  const bool ended_early = reading.ended;
  reading.stop = true;
  thread.join();
  client.reset();
  if (ended_early)
    didNotRun(fmt::format("{} on a {}", kReaderNames[reader], kLineNames[line]),
              "it ended before its line did",
              fmt::format("see drivers/{}", kind.emulator ? kind.emulator : kind.name));
  return {latencies(times, first, first + static_cast<std::uint32_t>(size.samples)),
          reading.cpu_s / took, reading.real_time};
}

}  // namespace merlin::bench
