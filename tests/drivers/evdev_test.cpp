// The kernel's input devices read as a ball: records, the axes and buttons of a gamepad, a space
// mouse, a joystick and a clicker, and the driver's stream.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "daemon/base/random.h"
#include "drivers/evdev/device.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"

namespace merlin::evdev {
namespace {

using Kind = EvdevRecord::Kind;

std::string named(Kind kind, int code, std::string_view text) {
  EvdevRecord r;
  r.kind = kind;
  r.code = static_cast<std::uint16_t>(code);
  std::copy(text.begin(), text.end(), r.text.begin());
  std::string out;
  append(r, out);
  return out;
}

std::string axis(int code, std::int32_t low, std::int32_t high, std::int32_t value) {
  return test::evdevRecord(EvdevRecord::kAxis, code, value, low, high);
}

// Returns a controller's description as the kernel's driver xpad gives it. Resting values are
// seldom in the middle of the range.
std::string gamepad() {
  std::string text =
      named(EvdevRecord::kName, 0, "Microsoft X-Box 360 ") + named(EvdevRecord::kName, 0, "pad");
  for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) text += axis(code, -32768, 32767, 128);
  for (const int code : {ABS_Z, ABS_RZ}) text += axis(code, 0, 255, 0);
  for (const int code : {ABS_HAT0X, ABS_HAT0Y}) text += axis(code, -1, 1, 0);
  const std::pair<int, const char*> keys[] = {{BTN_SOUTH, "SOUTH"}, {BTN_EAST, "EAST"},
                                              {BTN_NORTH, "NORTH"}, {BTN_WEST, "WEST"},
                                              {BTN_TL, "TL"},       {BTN_START, "START"}};
  for (const auto& [code, name] : keys) text += named(EvdevRecord::kKey, code, name);
  return text + test::evdevRecord(EvdevRecord::kReady);
}

std::string spaceMouse() {
  std::string text = named(EvdevRecord::kName, 0, "SpaceNavigator");
  for (int code = ABS_X; code <= ABS_RZ; ++code) text += axis(code, -350, 350, 0);
  text += named(EvdevRecord::kKey, BTN_0, "0") + named(EvdevRecord::kKey, BTN_1, "1");
  return text + test::evdevRecord(EvdevRecord::kReady);
}

std::string moved(int code, std::int32_t value) {
  return test::evdevRecord(EvdevRecord::kMoved, code, value);
}
std::string pressed(int code, int value) {
  return test::evdevRecord(EvdevRecord::kPressed, code, value);
}
const std::string kReport = test::evdevRecord(EvdevRecord::kReport);

class EvdevTest : public testing::Test {
 protected:
  void connect(const std::string& description, const EvdevSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    stream_.feed(description);
    const auto opened = device_->open(stream_);
    ASSERT_TRUE(opened) << opened.error().what;
    identity_ = *opened;
  }
  const BallSample& after(const std::string& events) {
    stream_.feed(events + kReport);
    EXPECT_TRUE(device_->poll(stream_));
    EXPECT_FALSE(sink_.ball.empty());
    return sink_.ball.back();
  }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<EvdevDevice> device_;
  std::string identity_;
};

TEST(EvdevParser, ReadsWhatIsAppendedAndFindsTheNextRecordAfterRubbish) {
  EvdevParser parser;
  std::vector<EvdevRecord> records;
  const std::string bytes = axis(ABS_RZ, -5, 70000, -3) + "\xE5\xE5\x7F" +
                            named(EvdevRecord::kKey, BTN_SOUTH, "SOUTH") + kReport;
  for (const char c : bytes) {
    if (const auto r = parser.feed(static_cast<std::byte>(c))) records.push_back(*r);
  }
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[0].code, ABS_RZ);
  EXPECT_EQ(records[0].low, -5);
  EXPECT_EQ(records[0].high, 70000);
  EXPECT_EQ(records[0].value, -3);
  EXPECT_STREQ(records[1].text.data(), "SOUTH");
  EXPECT_EQ(records[2].kind, EvdevRecord::kReport);
  EXPECT_EQ(parser.badBytes(), 3u);
  EXPECT_EQ(parser.badPackets(), 1u);
}

TEST_F(EvdevTest, AGamepadMovesTurnsAndRises) {
  connect(gamepad());
  EXPECT_EQ(identity_, "Microsoft X-Box 360 pad, 8 axes, 6 keys");
  EXPECT_STREQ(device_->complaint(), "");
  EXPECT_EQ(device_->input().chosen(),
            "axes x, rz-z, y, ry, rx, -hat0x; buttons south, east, north, west, tl, start");
  EXPECT_FLOAT_EQ(after(moved(ABS_X, 32767)).translation[0], 1);
  EXPECT_FLOAT_EQ(after(moved(ABS_Y, -32768)).translation[2], -1);  // forwards is away
  EXPECT_EQ(sink_.ball.back().raw[2], 1000);  // the z axis of a Spaceball has this direction
  EXPECT_FLOAT_EQ(after(moved(ABS_RZ, 255)).translation[1], 1);
  EXPECT_FLOAT_EQ(after(moved(ABS_Z, 255)).translation[1], 0);  // triggers cancel out
  EXPECT_FLOAT_EQ(after(moved(ABS_RX, 32767)).rotation[1], 1);
  EXPECT_FLOAT_EQ(after(moved(ABS_RY, 32767)).rotation[0], 1);
  EXPECT_FLOAT_EQ(after(moved(ABS_HAT0X, 1)).rotation[2], -1);
  EXPECT_EQ(after(pressed(BTN_SOUTH, 1) + pressed(BTN_START, 1)).buttons, 0x21u);
  EXPECT_EQ(after(pressed(BTN_SOUTH, 0)).buttons, 0x20u);
}

TEST_F(EvdevTest, ItsResponseIsZeroWithinTheDeadZoneAndFineBeyondIt) {
  EvdevSettings settings;
  settings.dead_zone = 0.2;
  settings.curve = 2;
  connect(gamepad(), settings);
  EXPECT_FLOAT_EQ(after(moved(ABS_X, 6500)).translation[0], 0);
  // A deflection of 0.6 is half of the range that is left beyond the dead zone.
  EXPECT_NEAR(after(moved(ABS_X, 19660)).translation[0], 0.25, 1e-3);
  EXPECT_NEAR(after(moved(ABS_X, -19660)).translation[0], -0.25, 1e-3);
}

TEST_F(EvdevTest, ASpaceMouseMovesAsItIsPushed) {
  EvdevSettings linear;
  linear.curve = 1;
  linear.dead_zone = 0;
  connect(spaceMouse(), linear);
  const BallSample& s =
      after(moved(ABS_X, 350) + moved(ABS_Y, 175) + moved(ABS_Z, 350) + moved(ABS_RX, 35) +
            moved(ABS_RY, 70) + moved(ABS_RZ, -350) + pressed(BTN_1, 1));
  const float push[] = {1, -1, 0.5F}, twist[] = {0.1F, 1, 0.2F};
  for (int i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(s.translation[i], push[i]) << i;
    EXPECT_FLOAT_EQ(s.rotation[i], twist[i]) << i;
  }
  EXPECT_EQ(s.buttons, 2u);
}

TEST_F(EvdevTest, AHeldStickIsPublishedAgainUntilItIsLetGo) {
  connect(gamepad());
  after(moved(ABS_X, 32767));
  const Timestamp pushed = clock_.now();
  while (clock_.now() < pushed + std::chrono::seconds(1)) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ball.size(), 21u);
  after(moved(ABS_X, 128));
  const std::size_t ended = sink_.ball.size();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ball.size(), ended);
}

TEST_F(EvdevTest, ARelativeAxisThatSaysNothingMoreIsAtRest) {
  connect(test::evdevRecord(EvdevRecord::kRelative, REL_X) +
          named(EvdevRecord::kKey, BTN_LEFT, "LEFT") + test::evdevRecord(EvdevRecord::kReady));
  EXPECT_FLOAT_EQ(after(test::evdevRecord(EvdevRecord::kShifted, REL_X, 350)).translation[0], 1);
  const Timestamp pushed = clock_.now();
  while (sink_.ball.back().translation[0] != 0) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_LE(clock_.now() - pushed, std::chrono::milliseconds(110));
  EXPECT_GE(clock_.now() - pushed, std::chrono::milliseconds(60));
}

// The kernel sends no event for an axis that stands still, so only the other axis, which moves, is
// reported.
TEST_F(EvdevTest, ARelativeAxisRestsWhileAnotherOneMoves) {
  connect(test::evdevRecord(EvdevRecord::kRelative, REL_X) +
          test::evdevRecord(EvdevRecord::kRelative, REL_Y) +
          test::evdevRecord(EvdevRecord::kReady));
  EXPECT_FLOAT_EQ(after(test::evdevRecord(EvdevRecord::kShifted, REL_X, 350)).translation[0], 1);
  const std::string up = test::evdevRecord(EvdevRecord::kShifted, REL_Y, -350);
  clock_.advance(std::chrono::milliseconds(50));
  EXPECT_FLOAT_EQ(after(up).translation[0], 1);
  EXPECT_FLOAT_EQ(after(up).translation[2], -1);
  clock_.advance(std::chrono::milliseconds(10));
  EXPECT_FLOAT_EQ(after(up).translation[0], 0);
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[2], -1);
}

TEST_F(EvdevTest, AClickersKeysAreTheButtonsThatTheConfigurationNames) {
  EvdevSettings settings;
  settings.buttons = {"pagedown", "pageup"};
  connect(named(EvdevRecord::kKey, KEY_PAGEUP, "PAGEUP") +
              named(EvdevRecord::kKey, KEY_PAGEDOWN, "PAGEDOWN") +
              test::evdevRecord(EvdevRecord::kReady),
          settings);
  EXPECT_EQ(device_->input().chosen(),
            "axes none, none, none, none, none, none; buttons pagedown, pageup");
  EXPECT_EQ(after(pressed(KEY_PAGEDOWN, 1)).buttons, 1u);
  EXPECT_EQ(after(pressed(KEY_PAGEUP, 1) + pressed(KEY_PAGEDOWN, 2)).buttons, 3u);
  EXPECT_EQ(after(pressed(KEY_PAGEDOWN, 0)).buttons, 2u);
}

TEST_F(EvdevTest, KeysThatArePressedAreThereByTheKernelsNumbers) {
  connect(gamepad(), {{}, {"east"}, 0.08, 2});
  const BallSample& two = after(pressed(BTN_START, 1) + pressed(BTN_SOUTH, 1));
  EXPECT_EQ(two.buttons, 0u) << "neither is a numbered one";
  EXPECT_EQ(two.keys[0], BTN_SOUTH);
  EXPECT_EQ(two.keys[1], BTN_START);
  EXPECT_EQ(two.keys[2], 0);
  const BallSample& one = after(pressed(BTN_SOUTH, 0));
  EXPECT_EQ(one.keys[0], BTN_START);
  EXPECT_EQ(one.keys[1], 0);
  EXPECT_TRUE(sink_.keys[BTN_SOUTH]);
  EXPECT_FALSE(sink_.keys[KEY_SPACE]) << "which a gamepad has not";
}

TEST_F(EvdevTest, OfManyKeysEightAreThere) {
  std::string keyboard;
  for (int code = KEY_1; code <= KEY_0; ++code) keyboard += named(EvdevRecord::kKey, code, "1");
  connect(keyboard + test::evdevRecord(EvdevRecord::kReady));
  std::string all;
  for (int code = KEY_1; code <= KEY_0; ++code) all += pressed(code, 1);
  EXPECT_EQ(after(all).keys[kKeys - 1], KEY_1 + 7);
}

TEST_F(EvdevTest, WhatTheConfigurationNamesAndTheDeviceLacksIsAComplaint) {
  EvdevSettings settings;
  settings.axes = {"x", "-y", "none", "throttle", "none", "none"};
  connect(gamepad(), settings);
  EXPECT_STREQ(device_->complaint(), "it has no axis throttle, which the configuration names");
  EXPECT_FLOAT_EQ(after(moved(ABS_Y, -32768)).translation[1], 1);
  settings = {};
  settings.buttons = {"south", "thumbr"};
  connect(gamepad(), settings);
  EXPECT_STREQ(device_->complaint(), "it has no key \"thumbr\", which the configuration names");
}

TEST_F(EvdevTest, WhatItLacksIsNamedWholeAndLeavesTheRestAsItIs) {
  EvdevSettings settings;
  settings.axes = {"throttle", "none", "none", "none", "z-gas", "x"};
  settings.buttons = {"sout", "east"};
  connect(gamepad(), settings);
  EXPECT_STREQ(device_->complaint(),
               "it has no axis throttle, no axis gas, no key \"sout\", which the configuration "
               "names");
  EXPECT_EQ(device_->input().chosen(), "axes none, none, none, none, none, x; buttons east");
  const BallSample& s = after(moved(ABS_Y, -32768) + moved(ABS_RX, 32767) + moved(ABS_Z, 255) +
                              moved(ABS_X, 32767) + pressed(BTN_EAST, 1));
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(s.translation[i], 0) << i;
  EXPECT_FLOAT_EQ(s.rotation[0], 0);
  EXPECT_FLOAT_EQ(s.rotation[1], 0) << "half of a pair";
  EXPECT_FLOAT_EQ(s.rotation[2], 1);
  EXPECT_EQ(s.buttons, 2u) << "the second one of the configuration";
}

TEST_F(EvdevTest, AKeyThatIsPressedAtTheBeginningIsPressed) {
  std::string description = gamepad();
  description.insert(description.size() - test::evdevRecord(EvdevRecord::kReady).size(),
                     pressed(BTN_EAST, 1));
  connect(description);
  EXPECT_EQ(after(moved(ABS_X, 0)).buttons, 2u);
}

TEST_F(EvdevTest, ReconnectedItForgetsTheDeviceOfBefore) {
  connect(spaceMouse());
  after(moved(ABS_X, 350) + pressed(BTN_0, 1));
  stream_.feed(gamepad());
  EXPECT_TRUE(sink_.keys[BTN_0]);
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_FALSE(sink_.keys[BTN_0]);
  EXPECT_TRUE(sink_.keys[BTN_SOUTH]);
  EXPECT_EQ(device_->input().axes(), 8u);
  const BallSample& s = after(moved(ABS_HAT0X, 0));
  EXPECT_EQ(s.buttons, 0u);
  EXPECT_FLOAT_EQ(s.translation[0], 0);
  EXPECT_EQ(s.counter, 3u) << "one said that nothing is pressed any more";
}

// While a device is unplugged, the driver cannot notice that a button of the device is released.
TEST_F(EvdevTest, WhatWasHeldWhenItWentIsReleasedWhenItReturns) {
  connect(gamepad());
  EXPECT_TRUE(sink_.ball.empty()) << "at rest it is silent";
  after(pressed(BTN_SOUTH, 1));
  stream_.feed(gamepad());
  ASSERT_TRUE(device_->open(stream_));
  ASSERT_EQ(sink_.ball.size(), 2u);
  EXPECT_EQ(sink_.ball.back().buttons, 0u);
  EXPECT_EQ(sink_.ball.back().keys[0], 0);
  EXPECT_EQ(sink_.ball.back().received_ns, toNanoseconds(clock_.now()));
  stream_.feed(gamepad());
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.ball.size(), 2u) << "nothing was held any more";
  after(pressed(BTN_SOUTH, 1));
  std::string held = gamepad();
  held.insert(held.size() - test::evdevRecord(EvdevRecord::kReady).size(), pressed(BTN_SOUTH, 1));
  stream_.feed(held);
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.ball.back().buttons, 1u) << "it is still held";
}

TEST_F(EvdevTest, AHeldButtonActsWhenItIsDue) {
  connect(gamepad());
  after(pressed(BTN_SOUTH, 1));
  const Timestamp due = clock_.now() + std::chrono::milliseconds(70);
  sink_.due_at = due;
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ticks, std::vector{due});
  EXPECT_EQ(sink_.ball.size(), 1u) << "a button that is held is no new sample";
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(clock_.now(), due + std::chrono::milliseconds(250)) << "nothing more is due";
  EXPECT_EQ(sink_.ticks.size(), 1u);
}

// A line that sends descriptions without end must not use more and more memory.
TEST_F(EvdevTest, WhatComesAfterTheDescriptionDescribesNothing) {
  connect(gamepad());
  for (int i = 0; i < 3; ++i) stream_.feed(gamepad() + axis(ABS_THROTTLE, 0, 255, 0));
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(device_->input().name(), "Microsoft X-Box 360 pad");
  EXPECT_EQ(device_->input().axes(), 8u);
}

TEST_F(EvdevTest, ADescriptionThatDoesNotEndIsRefusedInTime) {
  device_.emplace(EvdevSettings{}, clock_, sink_);
  stream_.feed(axis(ABS_X, 0, 255, 0));
  const Timestamp began = clock_.now();
  EXPECT_EQ(device_->open(stream_).error().code, Errc::kTimeout);
  EXPECT_LE(clock_.now() - began, std::chrono::milliseconds(1100));
  stream_.feed(test::evdevRecord(EvdevRecord::kReady));
  EXPECT_EQ(device_->open(stream_).error().code, Errc::kMalformed);  // neither axes nor keys
}

TEST_F(EvdevTest, RandomBytesGiveNoSampleThatIsNotPlausible) {
  connect(gamepad());
  Random random(11);
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes = test::evdevRecord(
        static_cast<Kind>(1 + random.below(9)),
        static_cast<int>(random.below(random.below(2) ? 32 : 0x140)),
        static_cast<std::int32_t>(random.next()), static_cast<std::int32_t>(random.next()),
        static_cast<std::int32_t>(random.next()));
    bytes[random.below(bytes.size())] = static_cast<char>(random.next());
    stream_.feed(bytes);
    ASSERT_TRUE(device_->poll(stream_));
  }
  EXPECT_GT(sink_.ball.size(), 1000u);
  EXPECT_GT(device_->counters().bad_bytes, 0u);
  for (const BallSample& s : sink_.ball) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(std::abs(s.translation[axis]), 1);
      ASSERT_LE(std::abs(s.rotation[axis]), 1);
    }
    ASSERT_EQ(s.buttons >> 12, 0u);
  }
}

TEST(EvdevSettings, AxesAndButtonsThatCannotBeAreNamed) {
  EvdevSettings settings;
  EXPECT_TRUE(validate(settings, {}).empty());
  settings.axes = {"x", "-rz", "gas-brake", "none", "y", "hat0x"};
  EXPECT_TRUE(validate(settings, {}).empty());
  settings.axes = {"x", "up", "gas-gas", "-gas-brake", "", "y-"};
  std::vector<std::string> at;
  for (const SettingFault& fault : validate(settings, {})) at.push_back(fault.pointer);
  EXPECT_EQ(at, (std::vector<std::string>{"/evdev/axes/1", "/evdev/axes/2", "/evdev/axes/3",
                                          "/evdev/axes/4", "/evdev/axes/5"}));
  settings = {};
  settings.axes = {"x"};
  settings.buttons = {"a", "b", "a"};
  at.clear();
  for (const SettingFault& fault : validate(settings, {})) at.push_back(fault.pointer);
  EXPECT_EQ(at, (std::vector<std::string>{"/evdev/axes", "/evdev/buttons/2"}));
}

}  // namespace
}  // namespace merlin::evdev
