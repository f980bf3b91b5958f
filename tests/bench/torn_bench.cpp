// ./dev bench torn: torn reads of the shared memory, and the state in which a killed writer leaves
// the shared memory.
//
// One process writes samples with a checksum as fast as it can, and others read them; no sample may
// be a mix of two. Then writers are killed with SIGKILL, most of them in the middle of a write: a
// reader must neither hang nor accept an incomplete value. Exits with 1 if either happened.
// must neither hang nor accept an incomplete value. Exits with 1 if either happened.
#include <atomic>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/random.h"
#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

using shm::DevicesSegment;
using Writer = shm::SegmentWriter<DevicesSegment>;
using Reader = shm::SegmentReader<DevicesSegment>;

struct Options {
  double reads = 1e9;
  int kills = 10'000;
  int readers = 1;
};

// Every byte of sample n is computed from n.
GloveSample sampleOf(std::uint32_t n) {
  GloveSample s{};
  s.received_ns = static_cast<std::int64_t>(n) * 7919;
  s.counter = n;
  s.flags = ~n;
  for (std::size_t i = 0; i < kGloveSlots; ++i)
    s.angle_rad[i] = static_cast<float>((n + i) & 0xFFFF);
  s.sensors = n * 2654435761U;
  for (std::size_t i = 0; i < sizeof s.raw; ++i) s.raw[i] = static_cast<std::uint8_t>(n + i);
  return s;
}

// Returns the value number n of the largest slot of the segment, computed from n; a writer spends
// most of its time writing this value.
DeviceHealth healthOf(std::uint64_t n) {
  DeviceHealth h{};
  h.samples = n;
  h.since_ns = static_cast<std::int64_t>(n * 7919);
  h.bad_bytes = ~n;
  for (std::size_t i = 0; i < sizeof h.reason; ++i) h.reason[i] = static_cast<char>(n + i);
  for (std::size_t i = 0; i < sizeof h.port; ++i) h.port[i] = h.identity[i] = h.reason[i];
  return h;
}

bool whole(const DeviceHealth& h) {
  const DeviceHealth right = healthOf(h.samples);
  return std::memcmp(&h, &right, sizeof h) == 0;
}

bool whole(const GloveSample& s) {
  const GloveSample right = sampleOf(s.counter);
  return std::memcmp(&s, &right, sizeof s) == 0;
}

struct Shared {
  std::atomic<std::uint64_t> reads, torn, empty;
  std::atomic<bool> stop;
};

Shared* makeShared() {
  void* at =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return new (at) Shared{};
}

pid_t child(const std::function<void()>& body) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  body();
  ::_exit(0);
}

void publishForEver(DevicesSegment& segment, const std::atomic<bool>& stop) {
  for (std::uint32_t n = 1; !stop.load(std::memory_order_relaxed); ++n)
    segment.glove[0].samples.publish(sampleOf(n));
}

void readUntil(const std::string& name, std::uint64_t reads, Shared& shared) {
  const auto reader = Reader::open(name);
  if (!reader) return;
  std::uint64_t torn = 0, empty = 0, done = 0;
  for (; done < reads; ++done) {
    // Of four reads, three are of the newest sample, and one is of the sample in the ring that will
    // be overwritten next.
    const std::uint64_t count = (*reader)->glove[0].samples.count();
    const bool oldest = (done & 3) == 3 && count > shm::kHistory;
    const auto s = oldest ? (*reader)->glove[0].samples.at(count - shm::kHistory + 1)
                          : (*reader)->glove[0].samples.newest();
    if (!s) {
      ++empty;
    } else if (!whole(*s)) {
      ++torn;
    }
  }
  shared.reads += done;
  shared.torn += torn;
  shared.empty += empty;
}

// Ends the benchmark if the shared memory segment could not be made.
const Writer& expectMade(const Result<Writer>& segment) {
  if (!segment) didNotRun("the shared memory", segment.error().what, "see /dev/shm");
  return *segment;
}

bool benchTorn(const Options& options, Report& report) {
  const std::string name = shm::segmentName(test::privateName("torn"), "devices");
  const SystemClock clock;
  const auto made = Writer::make(name, shm::devicesFields({{{"glove", SampleKind::kGlove}}, {}}), 1,
                                 clock.now(), {});
  const Writer& segment = expectMade(made);
  Shared& shared = *makeShared();
  const Timestamp start = clock.now();
  (*segment).glove[0].samples.publish(sampleOf(1));
  const pid_t writer = child([&] { publishForEver(*segment, shared.stop); });
  std::vector<pid_t> readers;
  const auto each = static_cast<std::uint64_t>(options.reads / options.readers);
  for (int i = 0; i < options.readers; ++i)
    readers.push_back(child([&] { readUntil(name, each, shared); }));
  for (const pid_t reader : readers) ::waitpid(reader, nullptr, 0);
  shared.stop = true;
  ::waitpid(writer, nullptr, 0);
  const double took = toSeconds(clock.now() - start);
  const std::uint64_t written = (*segment).glove[0].samples.count() - 1;
  const auto writes = Measured::of(static_cast<double>(written), written, "writes");
  const auto torn = shareOf(shared.torn, shared.reads - shared.empty, "reads of a whole value");
  report.text(
      "torn reads: {} of {:.3g} reads against {:.3g} writes in {:.1f} s; {:.2g} times nothing "
      "whole was found in 64 tries\n",
      shared.torn.load(), static_cast<double>(shared.reads.load()), writes.value(), took,
      static_cast<double>(shared.empty.load()));
  report.figure("torn", torn, "1");
  report.figure("writes", writes, "1");
  return shared.torn == 0 && static_cast<double>(shared.reads.load()) >= 0.999 * options.reads;
}

struct Wreck {
  int middle = 0;             // number of writers that died in the middle of a write
  std::uint64_t rubbish = 0;  // number of values that seem complete but are wrong
  double slowest_s = 0;
};

// Reads every slot of a dead writer's segment.
void inspect(const DevicesSegment& segment, const Clock& clock, Wreck& wreck) {
  const Timestamp start = clock.now();
  const std::uint64_t count = segment.glove[0].samples.count();
  const auto newest = segment.glove[0].samples.newest();
  const auto health = segment.health[0].read();
  if (!newest || !health) ++wreck.middle;
  if (newest && !whole(*newest)) ++wreck.rubbish;
  if (health && !whole(*health)) ++wreck.rubbish;
  for (std::uint64_t n = count > shm::kHistory ? count - shm::kHistory : 0; n < count; ++n) {
    const auto s = segment.glove[0].samples.at(n);
    if (s && (!whole(*s) || s->counter != n + 1)) ++wreck.rubbish;
  }
  wreck.slowest_s = std::max(wreck.slowest_s, toSeconds(clock.now() - start));
}

// Lives as a daemon does: makes the segment, as merlind does, and writes until it is killed.
void liveAndWrite(const std::string& name, std::uint64_t generation, int ready) {
  const SystemClock clock;
  const auto segment = Writer::make(name, shm::devicesFields({{{"glove", SampleKind::kGlove}}, {}}),
                                    generation, clock.now(), {});
  if (!segment) ::_exit(1);
  (**segment).glove[0].samples.publish(sampleOf(1));
  DeviceHealth health[16];
  for (std::uint64_t n = 0; n < 16; ++n) health[n] = healthOf(n);
  (**segment).health[0].publish(health[0]);
  (void)!::write(ready, "r", 1);
  for (std::uint32_t n = 2;; ++n) {
    for (std::uint32_t i = 0; i < 64; ++i) (**segment).health[0].publish(health[(n + i) % 16]);
    (**segment).glove[0].samples.publish(sampleOf(n));
  }
}

bool benchKills(const Options& options, Report& report) {
  const std::string name = shm::segmentName(test::privateName("killed"), "devices");
  const SystemClock clock;
  Random random(1);
  Wreck wreck;
  int unreadable = 0, killed = 0;
  int ready[2];
  if (::pipe(ready) != 0)
    didNotRun("the pipe of the writers", "it cannot be made", "see 'ulimit -n'");
  for (; wreck.middle < options.kills && killed < 20 * options.kills; ++killed) {
    const auto generation = static_cast<std::uint64_t>(killed) + 1;
    const pid_t writer = child([&] { liveAndWrite(name, generation, ready[1]); });
    char byte = 0;
    pollfd item{ready[0], POLLIN, 0};
    if (::poll(&item, 1, 30'000) <= 0 || ::read(ready[0], &byte, 1) != 1)
      didNotRun("a writer", "it wrote nothing within 30 s", "see /dev/shm");
    const auto reader = Reader::open(name);
    const timespec moment{0, static_cast<long>(random.below(200'000))};
    ::nanosleep(&moment, nullptr);
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    if (!reader || (*reader)->header.generation != generation) {
      ++unreadable;
    } else {
      inspect(**reader, clock, wreck);
    }
  }
  (void)SharedMemory::create(name, 4096);  // removes the last writer's segment
  const auto middle = static_cast<std::uint64_t>(wreck.middle);
  if (wreck.middle < options.kills) {
    throw DidNotRun(fmt::format("of {} killed writers {} were in the middle of a value, not {}",
                                killed, wreck.middle, options.kills));
  }
  report.text(
      "killed writers: {}, {} of them in the middle of a value; believed rubbish {}, next "
      "daemon not found {}, slowest look at 258 slots {:.2f} ms\n",
      killed, wreck.middle, wreck.rubbish, unreadable, 1000 * wreck.slowest_s);
  report.figure("believed_rubbish",
                Measured::of(static_cast<double>(wreck.rubbish), middle,
                             "writers killed in the middle of a value"),
                "1");
  report.figure("slowest_look", Measured::of(1000 * wreck.slowest_s, middle, "looks"), "ms");
  return wreck.rubbish == 0 && unreadable == 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app("Torn reads of the shared memory; killed writers.");
  app.option("--reads", options.reads, "Number of reads, of all processes together")
      .range(1.0, 1e15)
      .showDefault();
  app.option("--kills", options.kills,
             "Number of writers that are killed with -9 in the middle of a value")
      .range(1, 1'000'000)
      .showDefault();
  app.option("--readers", options.readers, "Number of processes that read")
      .range(1, 1000)
      .showDefault();
  return app.run("torn", argc, argv, [&](merlin::bench::Report& report) {
    const bool torn = benchTorn(options, report);
    const bool killed = benchKills(options, report);
    return torn && killed;
  });
}
