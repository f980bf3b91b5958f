// A line that sends more than its device can send is read at a limited pace, and the health reports
// it. A line within the limit is not affected.
#include "drivers/loop/paced_stream.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/loop/device_loop.h"
#include "drivers/registry.h"
#include "tests/support/device_bench.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// A stream that sends the same byte without end, as fast as it is read (a read takes 1 us), or
// sends nothing.
class FloodStream final : public ByteStream {
 public:
  FloodStream(test::FakeClock& clock, char byte) : clock_(clock), byte_(byte) {}

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    ++reads;
    if (closed) return Error{Errc::kClosed, "closed"};
    if (quiet) {
      clock_.advance(timeout);
      return Error{Errc::kTimeout, "time-out"};
    }
    clock_.advance(std::chrono::microseconds(1));
    std::fill(buffer.begin(), buffer.end(), static_cast<std::byte>(byte_));
    bytes += buffer.size();
    return buffer.size();
  }
  Result<std::size_t> write(std::span<const std::byte> out, Duration) override {
    return out.size();
  }
  void interrupt() noexcept override { closed = true; }

  bool quiet = false, closed = false;
  std::size_t bytes = 0, reads = 0;

 private:
  test::FakeClock& clock_;
  char byte_;
};

class PacedStreamTest : public testing::Test {
 protected:
  // Reads for `time`, up to `size` bytes in each read; returns the number of bytes read.
  std::size_t readFor(Duration time, std::size_t size) {
    std::vector<std::byte> buffer(size);
    std::size_t bytes = 0;
    for (const Timestamp end = clock_.now() + time; clock_.now() < end;) {
      if (const auto got = stream_.read(buffer, milliseconds(250))) bytes += *got;
    }
    return bytes;
  }

  test::FakeClock clock_;
  int changes_ = 0;
  ReadPace pace_{15'360, [this] { ++changes_; }};
  FloodStream* line_ = new FloodStream(clock_, '\n');  // owned by stream_
  PacedStream stream_{std::unique_ptr<ByteStream>(line_), pace_, clock_};
};

TEST_F(PacedStreamTest, ReadsAFloodAtItsPaceInFewReads) {
  EXPECT_NEAR(static_cast<double>(readFor(seconds(10), 256)), 10 * 15'360 + 4096, 1100);
  EXPECT_LE(line_->reads, 10 * 100u + 10);
  EXPECT_TRUE(pace_.above());
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(pace_.sentence(), "sends more than 15.4 kB/s, the limit at which it is read");
}

// If a read takes as long as a byte takes on the line, the stream must not use one read for each
// byte.
TEST_F(PacedStreamTest, ReadsAFastFloodInFewReadsToo) {
  ReadPace fast(1e6, [] {});
  auto line = std::make_unique<FloodStream>(clock_, 'x');
  FloodStream& flood = *line;
  PacedStream stream(std::move(line), fast, clock_);
  std::byte buffer[256];
  for (const Timestamp end = clock_.now() + seconds(10); clock_.now() < end;)
    (void)stream.read(buffer, milliseconds(250));
  EXPECT_NEAR(static_cast<double>(flood.bytes), 1e7, 1e5);
  EXPECT_LE(flood.reads, 13'000u);
}

TEST_F(PacedStreamTest, SoDoesADialogueThatTakesSingleBytes) {
  EXPECT_NEAR(static_cast<double>(readFor(seconds(10), 1)), 10 * 15'360 + 4096, 1100);
  EXPECT_LE(line_->reads, 10 * 100u + 10);
}

TEST_F(PacedStreamTest, IsWellAgainSoonAfterTheFloodHasEnded) {
  readFor(seconds(2), 256);
  line_->quiet = true;
  readFor(seconds(1), 256);
  EXPECT_FALSE(pace_.above());
  EXPECT_EQ(changes_, 2);
}

TEST_F(PacedStreamTest, AConnectionThatIsCutAndOpenedAgainHasNoMore) {
  std::size_t bytes = 0;
  for (const Timestamp end = clock_.now() + seconds(10); clock_.now() < end;) {
    PacedStream another(std::make_unique<FloodStream>(clock_, '\n'), pace_, clock_);
    std::byte buffer[256];
    if (const auto got = another.read(buffer, milliseconds(250))) bytes += *got;
  }
  EXPECT_LE(bytes, 10 * 15'360u + 4096 + 256);
}

TEST_F(PacedStreamTest, IsInterruptedWithBytesThatWereReadAhead) {
  std::byte one[1];
  ASSERT_TRUE(stream_.read(one, milliseconds(250)));
  stream_.interrupt();
  const auto got = stream_.read(one, milliseconds(250));
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, Errc::kClosed);
}

// Runs a device's loop for a minute on a line that floods.
struct Flooded {
  struct Reports final : HealthSink {
    void publish(const DeviceHealth& h) noexcept override {
      all.push_back(h);
      then();
    }
    std::vector<DeviceHealth> all;
    std::function<void()> then = [] {};
  };

  void run(const char* name, char byte) {
    test::RecordingSink sink;
    const Timestamp end = clock.now() + seconds(60);
    std::stop_source stop;
    health.then = [&] {
      if (clock.now() >= end) stop.request_stop();
    };
    DeviceLoopSettings settings;
    settings.max_bytes_s = 15'360;
    settings.on_pace = [&](bool above) { told.push_back(above); };
    DeviceLoop loop(
        settings, [&] { return open(byte); }, findDriver(name)->make(DriverSettings{}, clock, sink),
        health, clock);
    loop.run(stop.get_token());
  }

  Result<std::unique_ptr<ByteStream>> open(char byte) {
    auto line = std::make_unique<Counted>(clock, byte, *this);
    return std::unique_ptr<ByteStream>(std::move(line));
  }
  struct Counted final : ByteStream {
    Counted(test::FakeClock& c, char b, Flooded& of) : flood(c, b), all(of) {}
    Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
      ++all.reads;
      auto got = flood.read(buffer, timeout);
      if (got) all.bytes += *got;
      return got;
    }
    Result<std::size_t> write(std::span<const std::byte> out, Duration) override {
      return out.size();
    }
    void interrupt() noexcept override { flood.interrupt(); }
    FloodStream flood;
    Flooded& all;
  };

  test::FakeClock clock;
  Reports health;
  std::vector<bool> told;
  std::size_t bytes = 0, reads = 0;
};

TEST(FloodedLine, OfAnyDeviceCostsItsPaceInEveryStepOfItsDialogueAndSaysSo) {
  int floods = 0;  // a dialogue may end after a few bytes, which are no flood
  for (const char* name : {"cyberglove", "fastrak", "spaceball"}) {
    for (const char byte : {'\n', '\r', '\0', 'S', '0'}) {
      Flooded line;
      line.run(name, byte);
      SCOPED_TRACE(std::string(name) + " and byte " + std::to_string(byte));
      EXPECT_LE(line.bytes, 72 * 15'360u + 4096) << "of a minute, and the last dialogue's 10 s";
      EXPECT_LE(line.reads, 72 * 110u);
      const bool flooded = line.bytes > 30 * 15'360u;
      floods += flooded ? 1 : 0;
      EXPECT_EQ(!line.told.empty() && line.told[0], flooded);
      bool opening = false, failed = false;
      for (const DeviceHealth& h : line.health.all) {
        const bool says = std::string_view(h.reason).starts_with("sends more than 15.4 kB/s");
        opening |= says && h.state == HealthState::kOpening;
        failed |= says && h.state == HealthState::kFailed;
      }
      EXPECT_EQ(opening, flooded);
      EXPECT_EQ(failed, flooded);
    }
  }
  EXPECT_GE(floods, 6);
}

TEST(FloodedLine, ADeviceAtTheSpeedOfItsLineIsNeverOne) {
  for (const char* name : {"cyberglove", "fastrak"}) {
    test::DeviceBench bench(name, {}, "visit");
    bool above = false;
    ReadPace pace(4 * 38400 / 10.0, [&] { above = true; });
    auto line = std::make_unique<test::FakeStream>(bench.clock, bench.emulator.get());
    PacedStream stream(std::move(line), pace, bench.clock);
    const auto device = findDriver(name)->make(DriverSettings{}, bench.clock, bench.sink);
    ASSERT_TRUE(device->open(stream));
    const std::uint64_t before = device->counters().samples;
    for (const Timestamp end = bench.clock.now() + seconds(20); bench.clock.now() < end;)
      ASSERT_TRUE(device->poll(stream));
    EXPECT_GE(device->counters().samples - before, 1990u);
    EXPECT_EQ(device->counters().bad_bytes, 0u);
    EXPECT_FALSE(above);
  }
}

// While the machine is suspended for a second, a pseudo-terminal keeps 4 KiB, which must not be
// taken for a flood.
TEST(FloodedLine, WhatCameWhileTheMachineWasAsleepIsNone) {
  test::FakeClock clock;
  bool above = false;
  ReadPace pace(4 * 9600 / 10.0, [&] { above = true; });
  EXPECT_GE(pace.allowed(clock.now()), 4096u);
  pace.charge(4080, clock.now());
  EXPECT_GT(pace.allowed(clock.now()), 0u);
  EXPECT_FALSE(above);
}

}  // namespace
}  // namespace merlin
