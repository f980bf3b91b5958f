// Devices are isolated from each other. Of three running devices, each in turn is pulled, babbles
// or freezes, in each state of its dialogue, and recovers. The test checks which samples the other
// two devices lose meanwhile, and prints this beside a control window just before, in which all
// three worked.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/loop/device_loop.h"
#include "drivers/registry.h"
#include "tests/support/emulated_line.h"
#include "tests/support/eventually.h"
#include "tests/support/statistics.h"

namespace merlin::test {
namespace {

using std::chrono::milliseconds;

#if defined(MERLIN_ANY_SANITIZER)
constexpr bool kTimed = false;  // a sanitizer's build is too slow to check times
#else
constexpr bool kTimed = true;
#endif

constexpr const char* kNames[] = {"cyberglove", "fastrak", "spaceball"};
constexpr const char* kFaultNames[] = {"", "pulled", "babbling", "frozen"};

// Extra recovery time in seconds: during a freeze the ball may have missed its reset command, so it
// is reset again, which takes 0.3 s in the emulator.
constexpr double kBallReset[] = {0, 0, 0.3};

struct Arrival {
  std::int64_t ns;
  std::uint32_t counter;
};

// The times of all samples of a device. One thread calls add(); another may read the complete
// entries meanwhile.
class Arrivals {
 public:
  void add(std::int64_t ns, std::uint32_t counter) noexcept {
    const std::size_t n = count_.load(std::memory_order_relaxed);
    if (n >= all_.size()) return;
    all_[n] = {ns, counter};
    count_.store(n + 1, std::memory_order_release);
  }
  std::span<const Arrival> between(std::size_t from, std::size_t to) const {
    return std::span(all_).subspan(from, to - from);
  }
  std::size_t count() const { return count_.load(std::memory_order_acquire); }

 private:
  std::vector<Arrival> all_ = std::vector<Arrival>(200'000);
  std::atomic<std::size_t> count_{0};
};

// Three devices, each with its own DeviceLoop and thread.
class Bench : public SampleSink {
 public:
  Bench() {
    for (std::size_t i = 0; i < 3; ++i) {
      emulate::EmulatorSettings settings;
      settings.baud = i == 2 ? 9600 : 38400;
      lines_[i] = std::make_unique<EmulatedLine>(kNames[i], settings, "turning");
      loops_[i] = std::make_unique<DeviceLoop>(
          DeviceLoopSettings{.port = kNames[i]}, [line = lines_[i].get()] { return line->open(); },
          findDriver(kNames[i])->make({}, clock_, *this), health_[i], clock_);
    }
    for (auto& loop : loops_)
      threads_.emplace_back([&loop = *loop](const std::stop_token& stop) { loop.run(stop); });
  }

  void publish(const GloveSample& s) noexcept override { arrivals_[0].add(now(), s.counter); }
  void publish(const TrackerSample& s) noexcept override { arrivals_[1].add(now(), s.counter); }
  void publish(const BallSample& s) noexcept override { arrivals_[2].add(now(), s.counter); }
  void publish(const TouchSample&) noexcept override {}

  // Waits until the device's health is ok and another sample has arrived; false if that does not
  // happen.
  bool well(std::size_t i) {
    const bool ok = eventually([&] { return state(i) == HealthState::kOk; });
    const std::size_t before = arrivals_[i].count();
    return ok && eventually([&] { return arrivals_[i].count() > before; });
  }
  HealthState state(std::size_t i) const { return health_[i].state.load(); }
  EmulatedLine& line(std::size_t i) { return *lines_[i]; }
  const Arrivals& arrivals(std::size_t i) const { return arrivals_[i]; }
  void wait(Duration time) { clock_.sleepUntil(clock_.now() + time, {}); }
  std::int64_t now() const noexcept { return toNanoseconds(clock_.now()); }

 private:
  struct State final : HealthSink {
    void publish(const DeviceHealth& h) noexcept override { state = h.state; }
    std::atomic<HealthState> state{HealthState::kAbsent};
  };

  SystemClock clock_;
  std::array<Arrivals, 3> arrivals_;
  std::array<State, 3> health_;
  std::array<std::unique_ptr<EmulatedLine>, 3> lines_;
  std::array<std::unique_ptr<DeviceLoop>, 3> loops_;
  std::vector<std::jthread> threads_;
};

// The sample intervals of one device over several windows, their quantiles, and the number of lost
// samples.
class Windows {
 public:
  void add(std::span<const Arrival> window) {
    for (std::size_t i = 1; i < window.size(); ++i) {
      intervals_ms_.push_back(static_cast<double>(window[i].ns - window[i - 1].ns) * 1e-6);
      lost_ += window[i].counter - window[i - 1].counter - 1;
    }
  }
  double quantile(double share) const { return test::quantile(intervals_ms_, share); }
  std::uint32_t lost() const { return lost_; }
  std::size_t count() const { return intervals_ms_.size(); }

 private:
  std::vector<double> intervals_ms_;
  std::uint32_t lost_ = 0;
};

struct Marks {
  std::array<std::size_t, 3> at{};
};

Marks mark(const Bench& bench) {
  Marks m;
  for (std::size_t i = 0; i < 3; ++i) m.at[i] = bench.arrivals(i).count();
  return m;
}

struct Comparison {
  std::array<Windows, 3> control, during;
  double slowest_back_s = 0, slowest_flag_s = 0;
};

void addWindow(const Bench& bench, const Marks& from, std::array<Windows, 3>& to) {
  for (std::size_t i = 0; i < 3; ++i)
    to[i].add(bench.arrivals(i).between(from.at[i], bench.arrivals(i).count()));
}

// Measures a control window; then lets the device `victim` fail in state `state` of its dialogue
// (number of writes; -1: while streaming) and recover.
void provoke(Bench& bench, std::size_t victim, Fault fault, int state, Comparison& result) {
  const Duration kFault = milliseconds(250);
  Marks from = mark(bench);
  bench.wait(milliseconds(350));
  addWindow(bench, from, result.control);
  from = mark(bench);
  const std::int64_t failed = bench.now();
  if (state < 0) {
    bench.line(victim).fail(fault);
  } else {
    bench.line(victim).failInDialogue(fault, state);
  }
  ASSERT_TRUE(eventually([&] { return bench.line(victim).fault() == fault; }));
  if (state < 0 && fault == Fault::kPulled && kTimed) {
    ASSERT_TRUE(eventually([&] { return bench.state(victim) != HealthState::kOk; }));
    result.slowest_flag_s =
        std::max(result.slowest_flag_s, static_cast<double>(bench.now() - failed) * 1e-9);
  }
  bench.wait(kFault);
  bench.line(victim).mend();
  const std::int64_t mended = bench.now();
  const std::size_t seen = bench.arrivals(victim).count();
  ASSERT_TRUE(bench.well(victim)) << kNames[victim] << ' ' << kFaultNames[int(fault)] << ' '
                                  << state;
  const std::int64_t back = bench.arrivals(victim).between(seen, seen + 1)[0].ns;
  result.slowest_back_s =
      std::max(result.slowest_back_s, static_cast<double>(back - mended) * 1e-9);
  addWindow(bench, from, result.during);
}

void report(std::size_t victim, Fault fault, int states, Comparison& result) {
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == victim) continue;
    Windows &control = result.control[other], &during = result.during[other];
    const double change = during.quantile(0.5) / control.quantile(0.5) - 1;
    fmt::print(
        "{:10} {:8} in {:2} states | {:10} {:5} samples, lost {}, median {:+5.1f} %, "
        "p99 {:5.1f} ms of {:5.1f} ms | flagged {:3.0f} ms, back {:4.2f} s\n",
        kNames[victim], kFaultNames[static_cast<int>(fault)], states, kNames[other], during.count(),
        during.lost(), 100 * change, during.quantile(0.99), control.quantile(0.99),
        1000 * result.slowest_flag_s, result.slowest_back_s);
    EXPECT_EQ(during.lost(), 0u) << kNames[other];
    EXPECT_GT(during.count(), 50u) << kNames[other];
    if (!kTimed) continue;
    EXPECT_LE(std::abs(change), 0.10) << kNames[other];
    EXPECT_LE(during.quantile(0.99), 2 * control.quantile(0.99)) << kNames[other];
  }
}

class Isolation : public testing::TestWithParam<std::size_t> {};

TEST_P(Isolation, OfOneDeviceInEachStateFromTheOtherTwo) {
  const std::size_t victim = GetParam();
  std::signal(SIGPIPE, SIG_IGN);  // as merlind does
  Bench bench;
  for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(bench.well(i)) << kNames[i];
  const int writes = bench.line(victim).writes();
  EXPECT_GE(writes, 3);
  for (const Fault fault : {Fault::kPulled, Fault::kBabbling, Fault::kFrozen}) {
    Comparison result;
    for (int state = -1; state <= writes && !HasFatalFailure(); ++state)
      provoke(bench, victim, fault, state, result);
    report(victim, fault, writes + 2, result);
    if (!kTimed) continue;
    EXPECT_LE(result.slowest_flag_s, 0.1);
    EXPECT_LE(result.slowest_back_s, 1.0 + kBallReset[victim]);
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, Isolation, testing::Values(0, 1, 2),
                         [](const auto& device) { return std::string(kNames[device.param]); });

}  // namespace
}  // namespace merlin::test
