#include <string>

#include <gtest/gtest.h>

#include "drivers/spaceball/calibration.h"
#include "drivers/spaceball/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/device_bench.h"

namespace merlin::spaceball {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct Ball : test::DeviceBench {
  explicit Ball(const char* script_name, const char* model = "2003", int garbage_every = 0)
      : DeviceBench("spaceball", {.baud = 9600, .model = model, .garbage_every = garbage_every},
                    script_name),
        device(makeDevice(SpaceballSettings{}, clock, sink)) {}

  void type(std::string_view bytes) {
    emulator->receive(std::as_bytes(std::span(bytes)), clock.now());
  }

  std::unique_ptr<Device> device;
};

TEST(SpaceballDevice, OpensEachModelAndSaysWhatItIs) {
  const std::pair<const char*, const char*> kModels[] = {
      {"2003", "Spaceball 2003, firmware 2.13"},
      {"3003", "Spaceball 3003, firmware 2.63"},
      {"4000", "Spaceball 4000 FLX, firmware 2.43"},
  };
  for (const auto& [model, expected] : kModels) {
    Ball ball("turning", model);
    const auto identity = ball.device->open(ball.stream);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, expected);
    EXPECT_LT(ball.clock.now() - ball.start, seconds(1));
    ASSERT_TRUE(ball.pollFor(*ball.device, seconds(2)));
    EXPECT_GT(ball.sink.ball.size(), 30u) << model;
  }
}

TEST(SpaceballDevice, SpeaksTheDialogueOfTheFactSheet) {  // sections 4 and 8
  Ball ball("still");
  ASSERT_TRUE(ball.device->open(ball.stream));
  EXPECT_EQ(ball.stream.written(), "\r@RESET\rCB\rNT\rFT?\rFR?\rP@r@r\rMSSV\rZ\rk\r");
  Ball flx("still", "4000");
  ASSERT_TRUE(flx.device->open(flx.stream));
  EXPECT_EQ(flx.stream.written(), "\r@RESET\rCB\rNT\rFT?\rFR?\rP@r@r\rM\rZ\rk\r");
}

TEST(SpaceballDevice, StreamsTwentyTimesASecondWhilePushed) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  const auto before = ball.sink.ball.size();
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(10)));
  EXPECT_NEAR(static_cast<double>(ball.sink.ball.size() - before), 200, 2);
  const BallSample& last = ball.sink.ball.back();
  EXPECT_NEAR(last.period_us, 50'000, 100);
  EXPECT_EQ(last.counter, ball.sink.ball.size());
  EXPECT_EQ(last.raw[4], 960);                        // 0.6 of the full deflection, 1600
  EXPECT_NEAR(last.rotation[1], 944 / 1584.0, 1e-6);  // after subtracting the dead zone
  EXPECT_EQ(ball.device->counters().bad_bytes, 0u);
}

TEST(SpaceballDevice, IsSilentAtRestAndYetWell) {
  Ball ball("still");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  const auto at_rest = ball.sink.ball.size();
  EXPECT_LE(at_rest, 2u);  // the state of its buttons, and a displacement of zero
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(60)));
  EXPECT_EQ(ball.sink.ball.size(), at_rest);
  const std::string& written = ball.stream.written();
  EXPECT_TRUE(written.ends_with("\rk\rk\rk\rk\rk\r"));  // pings; the ball answers each
}

TEST(SpaceballDevice, ReportsKeysAndTheEndOfAPush) {
  Ball ball("visit");  // pushed at the start; button 1 is pressed for 0.3 s after 15 s
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(18)));
  bool down = false, up_again = false, pushed = false, let_go = false;
  for (const BallSample& s : ball.sink.ball) {
    down |= s.buttons == 1;
    up_again |= down && s.buttons == 0;
    pushed |= s.rotation[1] > 0.5F;
    let_go |= pushed && s.rotation[1] == 0;
  }
  EXPECT_TRUE(down && up_again && pushed && let_go);
}

TEST(SpaceballDevice, AHeldButtonActsWhenItIsDue) {
  Ball ball("still");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  ball.sink.due_at = ball.clock.now() + milliseconds(70);
  const std::vector due = {ball.sink.due_at};
  ASSERT_TRUE(ball.device->poll(ball.stream));
  EXPECT_EQ(ball.sink.ticks, due);
}

TEST(SpaceballDevice, IsLostThreeSecondsAfterItFallsSilent) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  ball.stream.mute();
  const Duration time = ball.timeToFail(*ball.device, seconds(10));
  EXPECT_GE(time, milliseconds(2900));
  EXPECT_LE(time, milliseconds(3250));
}

TEST(SpaceballDevice, IsLostWhenWhatComesIsNoPacket) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ball.stream.mute();
  const Timestamp from = ball.clock.now();
  Result<Ok> polled = Ok{};
  while (polled) {
    ball.stream.feed("x\r");
    ball.clock.advance(milliseconds(100));
    polled = ball.device->poll(ball.stream);
    ASSERT_LT(ball.clock.now() - from, seconds(10));
  }
  EXPECT_EQ(polled.error().code, Errc::kTimeout);
  EXPECT_LE(ball.clock.now() - from, milliseconds(3250));
}

TEST(SpaceballDevice, IsSetUpAgainAfterAResetOfItsOwn) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  const auto before = ball.stream.written().size();
  ball.type("@RESET\r");  // sent by the ball, as after a reset by its watchdog
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  EXPECT_EQ(ball.stream.written().substr(before), "CB\rNT\rFT?\rFR?\rP@r@r\rMSSV\rZ\rk\r");
  const auto samples = ball.sink.ball.size();
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  EXPECT_NEAR(static_cast<double>(ball.sink.ball.size() - samples), 20, 1);
}

// A ball that is already running and ignores @RESET.
struct Awake final : emulate::Emulator {
  explicit Awake(emulate::Emulator& ball) : ball_(ball) {}
  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.find('@') != 1) ball_.receive(bytes, now);
  }
  void advance(Timestamp now, std::string& out) override { ball_.advance(now, out); }
  Timestamp nextDue() const override { return ball_.nextDue(); }

  emulate::Emulator& ball_;
};

TEST(SpaceballDevice, AsksABallThatDoesNotReset) {
  Ball ball("turning", "3003");
  Awake awake(*ball.emulator);
  ball.stream.plug(&awake);
  const auto identity = ball.device->open(ball.stream);
  ASSERT_TRUE(identity) << identity.error().what;
  EXPECT_EQ(*identity, "Spaceball 3003, firmware 2.63");
  EXPECT_TRUE(ball.stream.written().starts_with("\r@RESET\r\rhm\rhv\rCB\r"));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  EXPECT_GT(ball.sink.ball.size(), 15u);
}

TEST(SpaceballDevice, SaysThatNothingAnswers) {
  Ball ball("still");
  ball.stream.mute();
  const auto identity = ball.device->open(ball.stream);
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, Errc::kTimeout);
  EXPECT_EQ(identity.error().what, "no answer to @RESET, nor to hm and hv, within 3.5 s");
  EXPECT_LE(ball.clock.now() - ball.start, milliseconds(3500));
}

TEST(SpaceballDevice, StreamsOnPastGarbageAndCountsIt) {
  Ball ball("turning", "2003", 5);
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(20)));
  // The ball sent 400 packets; each burst of garbage destroys the packet after it.
  EXPECT_GT(ball.sink.ball.size(), 300u);
  EXPECT_GT(ball.device->counters().bad_packets, 50u);
  EXPECT_GT(ball.device->counters().bad_bytes, 50u * 16);
}

TEST(SpaceballDevice, OpensAgainAndCountsOn) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  const auto first = ball.sink.ball.size();
  ASSERT_TRUE(ball.device->open(ball.stream));
  ASSERT_TRUE(ball.pollFor(*ball.device, seconds(1)));
  EXPECT_GT(ball.sink.ball.size(), first + 15);
  EXPECT_EQ(ball.sink.ball.back().counter, ball.sink.ball.size());
  EXPECT_EQ(ball.device->counters().samples, ball.sink.ball.size());
}

TEST(SpaceballDevice, EndsAtOnceWhenTheLineIsClosed) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ball.stream.interrupt();
  const auto polled = ball.device->poll(ball.stream);
  ASSERT_FALSE(polled);
  EXPECT_EQ(polled.error().code, Errc::kClosed);
  EXPECT_EQ(ball.device->open(ball.stream).error().code, Errc::kClosed);
}

TEST(SpaceballDevice, AllocatesNothingWhileItStreams) {
  Ball ball("turning");
  ASSERT_TRUE(ball.device->open(ball.stream));
  ball.stream.mute();
  ball.sink.ball.reserve(100);
  std::string bytes;
  for (int i = 0; i < 50; ++i)
    bytes += encode({{1, 0x0D11, 3, 4, 5, 6}, 800}) + (i % 7 ? "" : "x\r");
  ball.stream.feed(bytes);
  const long before = test::allocations;
  while (ball.sink.ball.size() < 50) ASSERT_TRUE(ball.device->poll(ball.stream));
  EXPECT_EQ(test::allocations - before, 0);
}

TEST(SpaceballCalibration, MapsAxesAndStartsAtTheEdgeOfTheDeadZone) {
  SpaceballSettings settings;
  settings.full_scale_translation = 1016;
  settings.full_scale_rotation = 116;
  settings.axis_map = {1, -3, 2, 4, 5, -6};
  BallSample sample{};
  calibrate({{16, 516, -1016, 66, -20000, 17}, 800}, settings, sample);
  EXPECT_FLOAT_EQ(sample.translation[0], 0);     // within the dead zone
  EXPECT_FLOAT_EQ(sample.translation[1], 1);     // -z
  EXPECT_FLOAT_EQ(sample.translation[2], 0.5F);  // y
  EXPECT_FLOAT_EQ(sample.rotation[0], 0.5F);
  EXPECT_FLOAT_EQ(sample.rotation[1], -1);  // clamped
  EXPECT_FLOAT_EQ(sample.rotation[2], -0.01F);
  EXPECT_EQ(sample.raw[2], -1016);
  EXPECT_EQ(sample.period_us, 50'000u);
}

}  // namespace
}  // namespace merlin::spaceball
