// The flight recorder keeps a device's last bytes and the beginning of its connection.
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/devices/flight_recorder.h"
#include "drivers/io/recording_stream.h"
#include "drivers/io/replay_stream.h"
#include "drivers/registry.h"
#include "tests/support/borrowed_stream.h"
#include "tests/support/device_bench.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"
#include "tests/support/told.h"

namespace merlin::devices {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::span<const std::byte> asBytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::string all(const std::vector<io::TranscriptChunk>& chunks) {
  std::string text;
  for (const auto& c : chunks) text += (c.to_device ? ">" : "<") + c.bytes;
  return text;
}

TEST(FlightRing, KeepsWhatWentBothWaysWithItsTimes) {
  FlightRing ring;
  test::FakeClock clock;
  ring.opened(clock.now());
  ring.said(clock.now(), asBytes("S"));
  clock.advance(milliseconds(10));
  ring.heard(clock.now(), asBytes("one"));
  ring.heard(clock.now(), asBytes("two"));  // at the same time: the same chunk
  clock.advance(milliseconds(10));
  ring.heard(clock.now(), asBytes(std::string(100, 'x')));
  Duration left_out{};
  const auto chunks = ring.take(&left_out);
  EXPECT_EQ(all(chunks), ">S<onetwo<" + std::string(46, 'x') + "<" + std::string(46, 'x') + "<" +
                             std::string(8, 'x'));
  EXPECT_EQ(chunks[1].at, milliseconds(10));
  EXPECT_EQ(left_out, Duration::zero());
}

TEST(FlightRing, ANewConnectionStartsAnew) {
  FlightRing ring;
  test::FakeClock clock;
  ring.opened(clock.now());
  ring.heard(clock.now(), asBytes("old"));
  clock.advance(seconds(1));
  ring.opened(clock.now());
  ring.heard(clock.now(), asBytes("new"));
  Duration left_out{};
  EXPECT_EQ(all(ring.take(&left_out)), "<new");
}

TEST(FlightRing, KeepsFourMinutesOfATrackerAndTheDialogueBeforeIt) {
  FlightRing ring;
  test::FakeClock clock;
  ring.opened(clock.now());
  ring.said(clock.now(), asBytes("hello"));
  const Timestamp start = clock.now();
  std::string record(32, 'r');
  for (int i = 0; i < 120 * 600; ++i) {  // ten minutes at 120 Hz
    clock.advance(std::chrono::nanoseconds(8'333'333));
    ring.heard(clock.now(), asBytes(record));
  }
  Duration left_out{};
  const auto chunks = ring.take(&left_out);
  EXPECT_EQ(chunks[0].bytes, "hello");
  EXPECT_NEAR(toSeconds(clock.now() - start - left_out), 281.6, 1);  // 32767 + 1023 records
  EXPECT_GT(toSeconds(chunks.back().at), 240);
  for (std::size_t i = 1; i < chunks.size(); ++i) ASSERT_GE(chunks[i].at, chunks[i - 1].at);
}

TEST(FlightRing, MayBeTakenWhileItIsWritten) {
  FlightRing ring;
  const SystemClock clock;
  std::atomic<int> written{0};
  std::jthread writer([&](const std::stop_token& stop) {
    for (std::uint8_t n = 0; !stop.stop_requested(); ++n) {
      if (n == 0) ring.opened(clock.now());
      const std::string same(32, static_cast<char>(n));
      ring.heard(clock.now(), asBytes(same));
      ++written;
    }
  });
  // Records are 32 equal bytes, and the value grows by one from record to record. In a snapshot
  // only four records may be incomplete: the first, the last, and those on either side of the one
  // gap that overwriting may leave.
  for (int looks = 0; looks < 50 || written < 100'000; ++looks) {
    Duration left_out{};
    std::string all;
    for (const auto& chunk : ring.take(&left_out)) {
      ASSERT_FALSE(chunk.to_device);
      all += chunk.bytes;
    }
    int cut = 0, gaps = 0;
    for (std::size_t at = 0, end = 0; at < all.size(); at = end) {
      end = std::min(all.find_first_not_of(all[at], at), all.size());
      ASSERT_LE(end - at, 32u);
      cut += end - at < 32;
      gaps += end < all.size() && static_cast<std::uint8_t>(all[end] - all[at]) != 1;
    }
    ASSERT_LE(cut, 4);
    ASSERT_LE(gaps, 1);
  }
}

// The dump of an emulated glove, replayed through the driver, must give the samples that the daemon
// received.
TEST(FlightRecorder, WhatItDumpsReplays) {
  const test::TempDir dir;
  const auto segment = std::make_unique<shm::DevicesSegment>();
  FlightRecorder recorder(*segment, dir / "flight", "lab");
  FlightRing& ring = recorder.ringOf(test::kGlove, "left", "cyberglove", 38400);
  test::DeviceBench bench("cyberglove", {}, "visit");
  io::RecordingStream stream(std::make_unique<test::BorrowedStream>(bench.stream), ring,
                             bench.clock);
  const auto device = findDriver("cyberglove")->make({}, bench.clock, bench.sink);
  ASSERT_TRUE(device->open(stream));
  for (const Timestamp end = bench.clock.now() + seconds(2); bench.clock.now() < end;)
    ASSERT_TRUE(device->poll(stream));

  DeviceHealth health{};
  health.state = HealthState::kOk;
  segment->health[test::kGlove].publish(health);
  EXPECT_TRUE(recorder.check().empty());
  health.state = HealthState::kFailed;
  std::snprintf(health.reason, sizeof health.reason, "no record for 0.5 s");
  segment->health[test::kGlove].publish(health);
  const auto sentences = test::told(recorder.check());
  ASSERT_EQ(sentences.size(), 1u);
  const std::string said = "the last bytes of left are in ";
  ASSERT_TRUE(sentences[0].starts_with(said + dir.path() + "/flight/lab-left-20")) << sentences[0];
  EXPECT_TRUE(recorder.check().empty()) << "once a fault";

  const auto transcript = io::readTranscript(sentences[0].substr(said.size()));
  ASSERT_TRUE(transcript) << transcript.error().what;
  EXPECT_EQ((*transcript)["notes"], "no record for 0.5 s; 0.0 s after the beginning are missing");
  test::FakeClock clock;
  test::RecordingSink sink;
  io::ReplayStream replay(*transcript, clock);
  const auto again = findDriver("cyberglove")->make({}, clock, sink);
  ASSERT_TRUE(again->open(replay));
  while (again->poll(replay)) continue;
  ASSERT_EQ(sink.glove.size(), bench.sink.glove.size());
  for (std::size_t i = 0; i < sink.glove.size(); ++i)
    ASSERT_TRUE(std::equal(std::begin(sink.glove[i].raw), std::end(sink.glove[i].raw),
                           std::begin(bench.sink.glove[i].raw)));
}

TEST(FlightRecorder, AFaultThatRecursIsDumpedOnce) {
  const test::TempDir dir;
  const auto segment = std::make_unique<shm::DevicesSegment>();
  FlightRecorder recorder(*segment, dir / "flight", "lab");
  (void)recorder.ringOf(test::kBall, "ball", "spaceball", 9600);
  std::int64_t now_ns = 1'000'000'000'000;
  // Returns the number of dumps after a device has worked for `works` and then failed.
  const auto dumpsOf = [&](Duration works, const char* reason) {
    DeviceHealth health{};
    health.state = HealthState::kOk;
    health.since_ns = now_ns;
    segment->health[test::kBall].publish(health);
    EXPECT_TRUE(recorder.check().empty());
    now_ns += works.count();
    health.state = HealthState::kFailed;
    health.since_ns = now_ns;
    std::snprintf(health.reason, sizeof health.reason, "%s", reason);
    segment->health[test::kBall].publish(health);
    return recorder.check().size();
  };
  EXPECT_EQ(dumpsOf(milliseconds(300), "a length of 7"), 1u);
  EXPECT_EQ(dumpsOf(milliseconds(300), "a length of 7"), 0u);
  EXPECT_EQ(dumpsOf(milliseconds(300), "a length of 8"), 1u);
  EXPECT_EQ(dumpsOf(milliseconds(4900), "a length of 8"), 0u);
  EXPECT_EQ(dumpsOf(milliseconds(5000), "a length of 8"), 1u) << "it has worked meanwhile";
}

TEST(FlightRecorder, KeepsEightDumpsOfADevice) {
  const test::TempDir dir;
  const auto segment = std::make_unique<shm::DevicesSegment>();
  for (int run = 0; run < 2; ++run) {
    FlightRecorder recorder(*segment, dir / "flight", "lab");
    recorder.ringOf(test::kBall, "ball", "spaceball", 9600);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(recorder.dump());
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& f : std::filesystem::directory_iterator(dir / "flight"))
    ++files;
  EXPECT_EQ(files, 8u);
}

// A process with a recorder, followed by another process with the same instance name.
class FlightOfACrash : public testing::Test {
 protected:
  // Records in a process of its own. Unless `in_order`, the process ends without closing the
  // recorder.
  void record(bool in_order) {
    const pid_t child = ::fork();
    if (child == 0) {
      {
        FlightRecorder recorder(*segment_, dir_ / "flight", instance_);
        if (!recorder.keepForNextRun(3)) ::_exit(1);
        FlightRing& ring = recorder.ringOf(1, "ball", "spaceball", 9600);
        const test::FakeClock clock;
        ring.opened(clock.now());
        ring.said(clock.now(), asBytes("hello"));
        ring.heard(clock.now(), asBytes("ball"));
        if (!in_order) ::_exit(0);
      }
      ::_exit(0);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
  }
  std::vector<std::string> nextRun() {
    FlightRecorder recorder(*segment_, dir_ / "flight", instance_);
    EXPECT_TRUE(recorder.keepForNextRun(3));
    auto sentences = test::told(recorder.check());
    EXPECT_TRUE(recorder.check().empty()) << "once";
    return sentences;
  }
  std::string sharedMemory() const { return "/dev/shm/" + instance_ + "-flight"; }

  test::TempDir dir_;
  std::string instance_ = test::privateName("flight");
  std::unique_ptr<shm::DevicesSegment> segment_ = std::make_unique<shm::DevicesSegment>();
};

TEST_F(FlightOfACrash, IsWrittenByTheNextRun) {
  record(false);
  const auto sentences = nextRun();
  ASSERT_EQ(sentences.size(), 1U) << "the other two places had no device";
  const std::string said = "the last bytes of ball before that are in ";
  const std::size_t at = sentences[0].find(said);
  ASSERT_NE(at, std::string::npos) << sentences[0];
  const auto transcript = io::readTranscript(sentences[0].substr(at + said.size()));
  ASSERT_TRUE(transcript) << transcript.error().what;
  EXPECT_EQ(all(transcript->chunks), ">hello<ball");
  EXPECT_EQ((*transcript)["driver"], "spaceball");
  EXPECT_EQ((*transcript)["serial"], "9600 8N1");
  EXPECT_TRUE(nextRun().empty()) << "that run ended in order";
}

TEST_F(FlightOfACrash, ARunThatEndsInOrderLeavesNothing) {
  record(true);
  EXPECT_FALSE(std::filesystem::exists(sharedMemory()));
  EXPECT_TRUE(nextRun().empty());
}

// The files are damaged: one is cut, one has another format, and one has a name that leads to
// another folder.
TEST_F(FlightOfACrash, WhatIsDamagedIsLeftOut) {
  const auto damaged = [&](std::size_t at, const std::string& bytes, std::uintmax_t size) {
    record(false);
    std::fstream file(sharedMemory(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(at));
    file << bytes;
    file.close();
    if (size > 0) std::filesystem::resize_file(sharedMemory(), size);
    return nextRun();
  };
  EXPECT_TRUE(damaged(0, "x", 0).empty());
  EXPECT_TRUE(damaged(8, std::string(1, '\x04'), 0).empty()) << "more devices than there is room";
  EXPECT_TRUE(damaged(0, "", 4096).empty());
  EXPECT_TRUE(damaged(0, "", 10).empty());
  // The names begin after the format and the number of devices; the second device is the ball.
  EXPECT_TRUE(damaged(12 + 68, "../all", 0).empty());
}

}  // namespace
}  // namespace merlin::devices
