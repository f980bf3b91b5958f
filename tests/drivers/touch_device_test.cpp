// Touch frames and mice of the kernel: devices with slots, devices with one position, a mouse with
// its button pressed, and the driver's stream.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <linux/input.h>

#include "daemon/base/random.h"
#include "drivers/port/plausible.h"
#include "drivers/touch/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"

namespace merlin::touch {
namespace {

using Kind = EvdevRecord::Kind;

using test::evdevNamed;
using test::evdevRecord;

std::string axis(int code, std::int32_t high, std::int32_t resolution = 0) {
  return evdevRecord(EvdevRecord::kAxis, code, 0, 0, high, resolution);
}

std::string moved(int code, std::int32_t value) {
  return evdevRecord(EvdevRecord::kMoved, code, value);
}
std::string pressed(int code, int value) { return evdevRecord(EvdevRecord::kPressed, code, value); }
std::string shifted(int code, int by) { return evdevRecord(EvdevRecord::kShifted, code, by); }
const std::string kReady = evdevRecord(EvdevRecord::kReady),
                  kReport = evdevRecord(EvdevRecord::kReport);

// Returns the description of a touch frame of 800 mm by 400 mm with ten slots.
std::string frame() {
  return evdevNamed(EvdevRecord::kName, 0, "made-up frame") + axis(ABS_X, 8000, 10) +
         axis(ABS_Y, 4000, 10) + axis(ABS_MT_SLOT, 9) + axis(ABS_MT_TRACKING_ID, 65535) +
         axis(ABS_MT_POSITION_X, 8000, 10) + axis(ABS_MT_POSITION_Y, 4000, 10) +
         evdevNamed(EvdevRecord::kKey, BTN_TOUCH, "TOUCH") + kReady;
}
std::string screen(const std::string& key = evdevNamed(EvdevRecord::kKey, BTN_TOUCH, "TOUCH")) {
  return evdevNamed(EvdevRecord::kName, 0, "old screen") + axis(ABS_X, 4096) + axis(ABS_Y, 4096) +
         key + kReady;
}
std::string mouse() {
  return evdevNamed(EvdevRecord::kName, 0, "mouse") + evdevRecord(EvdevRecord::kRelative, REL_X) +
         evdevRecord(EvdevRecord::kRelative, REL_Y) +
         evdevNamed(EvdevRecord::kKey, BTN_LEFT, "LEFT") + kReady;
}

class TouchTest : public testing::Test {
 protected:
  void connect(const std::string& description, const TouchSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    stream_.feed(description);
    const auto opened = device_->open(stream_);
    ASSERT_TRUE(opened) << opened.error().what;
    identity_ = *opened;
  }
  const TouchSample& after(const std::string& events) {
    stream_.feed(events + kReport);
    while (device_->poll(stream_) && ++polls_ % 4 != 0) {
    }
    EXPECT_FALSE(sink_.touch.empty());
    return sink_.touch.back();
  }
  static std::string finger(int slot, int tracking, int x, int y) {
    return moved(ABS_MT_SLOT, slot) + moved(ABS_MT_TRACKING_ID, tracking) +
           moved(ABS_MT_POSITION_X, x) + moved(ABS_MT_POSITION_Y, y);
  }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<TouchDevice> device_;
  std::string identity_;
  int polls_ = 0;
};

TEST_F(TouchTest, TwoFingersComeMoveAndGo) {
  connect(frame());
  EXPECT_EQ(identity_, "made-up frame, 10 fingers");
  EXPECT_TRUE(sink_.touch.empty());
  const TouchSample first = after(finger(0, 7, 2000, 1000) + pressed(BTN_TOUCH, 1));
  EXPECT_EQ(first.fingers, 1u);
  EXPECT_EQ(first.counter, 1u);
  EXPECT_FLOAT_EQ(first.position[0][0], 0.25F);
  EXPECT_FLOAT_EQ(first.position[0][1], 0.25F);
  EXPECT_FLOAT_EQ(first.aspect, 2);
  const TouchSample both = after(finger(1, 8, 8000, 4000));
  EXPECT_EQ(both.fingers, 2u);
  EXPECT_EQ(both.id[0], first.id[0]);
  EXPECT_NE(both.id[1], first.id[0]);
  EXPECT_FLOAT_EQ(both.position[1][0], 1);
  const TouchSample pinched =  // slot 1 is still selected; then slot 0 is
      after(moved(ABS_MT_POSITION_X, 6000) + moved(ABS_MT_SLOT, 0) +
            moved(ABS_MT_POSITION_Y, 2000));
  EXPECT_FLOAT_EQ(pinched.position[1][0], 0.75F);
  EXPECT_FLOAT_EQ(pinched.position[0][1], 0.5F);
  EXPECT_EQ(pinched.counter, 3u);
  const TouchSample one = after(moved(ABS_MT_TRACKING_ID, -1));
  EXPECT_EQ(one.fingers, 1u);
  EXPECT_EQ(one.id[0], both.id[1]);
  EXPECT_EQ(after(moved(ABS_MT_SLOT, 1) + moved(ABS_MT_TRACKING_ID, -1)).fingers, 0u);
}

TEST_F(TouchTest, AReportThatMovesNoFingerIsNotPublished) {
  connect(frame());
  after(finger(0, 7, 2000, 1000));
  after(pressed(BTN_TOUCH, 1));
  after(moved(ABS_MT_POSITION_X, 2000));
  EXPECT_EQ(sink_.touch.size(), 1u);
}

// After events were lost, libevdev may report another finger on a slot without having reported the
// end of the first one.
TEST_F(TouchTest, AnotherTrackingNumberIsAnotherFinger) {
  connect(frame());
  const std::uint32_t first = after(finger(0, 7, 2000, 1000)).id[0];
  EXPECT_EQ(after(finger(0, 7, 3000, 1000)).id[0], first);
  EXPECT_NE(after(finger(0, 8, 3000, 1000)).id[0], first);
}

TEST_F(TouchTest, APalmIsNoFinger) {
  connect(frame());
  EXPECT_EQ(after(finger(0, 7, 2000, 1000) + finger(1, 8, 0, 0)).fingers, 2u);
  EXPECT_EQ(after(moved(ABS_MT_TOOL_TYPE, MT_TOOL_PALM)).fingers, 1u);
  EXPECT_EQ(after(finger(1, 9, 0, 0)).fingers, 2u);
}

TEST_F(TouchTest, FingersThatTouchAtTheBeginningArePublished) {
  std::string text = frame();
  text.insert(text.size() - kReady.size(), finger(2, 7, 4000, 2000) + moved(ABS_MT_SLOT, 0));
  connect(text);
  ASSERT_EQ(sink_.touch.size(), 1u);
  EXPECT_FLOAT_EQ(sink_.touch[0].position[0][0], 0.5F);
}

TEST_F(TouchTest, OfManySlotsThirtyTwoAreFollowedAndTenFingersPublished) {
  std::string text = frame();
  text.insert(text.size() - kReady.size(), axis(ABS_MT_SLOT, 99));
  connect(text);
  EXPECT_EQ(identity_, "made-up frame, 32 fingers");
  std::string fingers;
  for (int slot = 0; slot < 12; ++slot) fingers += finger(slot, slot, 100 * slot, 0);
  EXPECT_EQ(after(fingers).fingers, kFingers);
  after(finger(50, 50, 0, 0) + finger(-1, 51, 0, 0) + finger(1 << 30, 52, 0, 0));
  EXPECT_EQ(sink_.touch.size(), 1u);
}

TEST_F(TouchTest, AScreenWithOnePositionHasOneFinger) {
  connect(screen());
  EXPECT_EQ(identity_, "old screen, one finger");
  const TouchSample down = after(moved(ABS_X, 1024) + moved(ABS_Y, 2048) + pressed(BTN_TOUCH, 1));
  EXPECT_EQ(down.fingers, 1u);
  EXPECT_FLOAT_EQ(down.position[0][0], 0.25F);
  EXPECT_FLOAT_EQ(down.position[0][1], 0.5F);
  EXPECT_FLOAT_EQ(down.aspect, 16.0F / 9);  // the ranges are equal and do not show the aspect ratio
  EXPECT_FLOAT_EQ(after(moved(ABS_X, 4096)).position[0][0], 1);
  EXPECT_EQ(after(pressed(BTN_TOUCH, 0)).fingers, 0u);
  after(moved(ABS_X, 0));
  EXPECT_EQ(sink_.touch.size(), 3u);
  EXPECT_NE(after(pressed(BTN_TOUCH, 1)).id[0], down.id[0]);
}

TEST_F(TouchTest, APointerWithAPositionTouchesWhileItsLeftButtonIsPressed) {
  connect(screen(evdevNamed(EvdevRecord::kKey, BTN_LEFT, "LEFT")));
  after(pressed(BTN_LEFT, 1));
  EXPECT_EQ(sink_.touch.back().fingers, 1u);
}

TEST_F(TouchTest, APressedMouseIsAFingerThatBeginsInTheMiddle) {
  TouchSettings settings;
  settings.mouse_counts = 1000;
  settings.aspect = 2;
  connect(mouse(), settings);
  EXPECT_EQ(identity_, "mouse, a mouse");
  stream_.feed(shifted(REL_X, 500) + kReport);
  ASSERT_TRUE(device_->poll(stream_));
  ASSERT_EQ(sink_.touch.size(), 1u) << "its button is not pressed";
  EXPECT_EQ(sink_.touch[0].fingers, 0u);
  const TouchSample down = after(pressed(BTN_LEFT, 1));
  EXPECT_FLOAT_EQ(down.position[0][0], 0.5F);
  EXPECT_FLOAT_EQ(down.position[0][1], 0.5F);
  const TouchSample dragged = after(shifted(REL_X, 200) + shifted(REL_Y, -100));
  EXPECT_FLOAT_EQ(dragged.position[0][0], 0.6F);  // a count is as long in x as in y,
  EXPECT_FLOAT_EQ(dragged.position[0][1], 0.4F);  // on a surface twice as wide as high
  EXPECT_EQ(dragged.id[0], down.id[0]);
  EXPECT_FLOAT_EQ(after(shifted(REL_X, 5000)).position[0][0], 1);
  EXPECT_EQ(after(pressed(BTN_LEFT, 0)).fingers, 0u);
  const TouchSample again = after(pressed(BTN_LEFT, 1));
  EXPECT_FLOAT_EQ(again.position[0][0], 0.5F);
  EXPECT_NE(again.id[0], down.id[0]);
}

// A report that never ends must not let the count of notches overflow.
TEST_F(TouchTest, AWheelTurnsAtMostAHundredNotchesInOneReport) {
  connect(mouse());
  stream_.feed(shifted(REL_WHEEL, 2'000'000'000) + shifted(REL_WHEEL, 99) + shifted(REL_WHEEL, 99) +
               kReport);
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.touch.back().wheel, 100u);
  stream_.feed(shifted(REL_WHEEL, -1) + kReport);
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.touch.back().wheel, 99u);
}

TEST_F(TouchTest, AMousesOtherButtonsAndWheelAreThereWithoutAFinger) {
  connect(mouse());
  const auto after = [&](const std::string& events) {
    stream_.feed(events + kReport);
    EXPECT_TRUE(device_->poll(stream_));
    return sink_.touch.empty() ? TouchSample{} : sink_.touch.back();
  };
  EXPECT_TRUE(sink_.keys[BTN_LEFT]);
  EXPECT_FALSE(sink_.keys[BTN_SOUTH]);
  EXPECT_EQ(after(shifted(REL_WHEEL, 2)).wheel, 2u);
  EXPECT_EQ(after(shifted(REL_WHEEL, -3)).wheel, 65535u);
  EXPECT_EQ(after(pressed(BTN_RIGHT, 1)).buttons, 2u);
  EXPECT_EQ(after(pressed(BTN_MIDDLE, 1)).buttons, 6u);
  EXPECT_EQ(after(pressed(BTN_RIGHT, 0)).buttons, 4u);
  EXPECT_EQ(sink_.touch.size(), 6u) << "the first one is that of its beginning";
  EXPECT_EQ(sink_.touch.front().wheel, 0u);
  EXPECT_EQ(sink_.touch.back().fingers, 0u);
  EXPECT_EQ(after(pressed(BTN_LEFT, 1)).fingers, 1u);
  EXPECT_EQ(sink_.touch.back().buttons, 4u) << "the left one is the finger";
  EXPECT_EQ(after(shifted(REL_HWHEEL, 1)).counter, 7u) << "nothing is published";
  stream_.feed(mouse());
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.touch.back().buttons, 0u);
  EXPECT_EQ(sink_.touch.back().wheel, 65535u) << "the count goes on";
}

TEST_F(TouchTest, ASurfaceThatIsMountedOtherwiseIsTurned) {
  TouchSettings settings;
  settings.orientation = {true, true, false};
  connect(frame(), settings);
  const TouchSample s = after(finger(0, 7, 2000, 4000));
  EXPECT_FLOAT_EQ(s.position[0][0], 0);      // 1 - y
  EXPECT_FLOAT_EQ(s.position[0][1], 0.25F);  // x
  EXPECT_FLOAT_EQ(s.aspect, 0.5F);
  settings = {};
  settings.orientation.invert_y = true;
  settings.aspect = 1.5;
  connect(frame(), settings);
  EXPECT_FLOAT_EQ(after(finger(0, 7, 2000, 1000)).position[0][1], 0.75F);
  EXPECT_FLOAT_EQ(sink_.touch.back().aspect, 1.5F);
}

TEST_F(TouchTest, WithoutResolutionsTheAspectIsThatOfTheRanges) {
  connect(evdevNamed(EvdevRecord::kName, 0, "x") + axis(ABS_X, 3000) + axis(ABS_Y, 1000) +
          evdevNamed(EvdevRecord::kKey, BTN_TOUCH, "TOUCH") + kReady);
  EXPECT_FLOAT_EQ(after(pressed(BTN_TOUCH, 1)).aspect, 3);
}

TEST_F(TouchTest, ADeviceThatIsNeitherIsRefusedWithTheWayOut) {
  device_.emplace(TouchSettings{}, clock_, sink_);
  stream_.feed(evdevNamed(EvdevRecord::kName, 0, "pad") + axis(ABS_X, 255) + axis(ABS_Y, 255) +
               evdevNamed(EvdevRecord::kKey, BTN_SOUTH, "SOUTH") + kReady);
  const auto pad = device_->open(stream_);
  ASSERT_FALSE(pad);
  EXPECT_EQ(pad.error().code, Errc::kMalformed);
  EXPECT_EQ(
      pad.error().what,
      "\"pad\" is neither a touch surface nor a mouse; for a gamepad, joystick or space mouse "
      "set \"driver\": \"evdev\"");
  stream_.feed(axis(ABS_MT_POSITION_X, 255) + axis(ABS_MT_POSITION_Y, 255) + kReady);
  EXPECT_NE(device_->open(stream_).error().what.find("protocol A"), std::string::npos);
  stream_.feed(axis(ABS_X, 255));
  const Timestamp began = clock_.now();
  EXPECT_EQ(device_->open(stream_).error().code, Errc::kTimeout);
  EXPECT_LE(clock_.now() - began, std::chrono::milliseconds(1100));
}

TEST_F(TouchTest, ReconnectedItHasNoFingerOfBefore) {
  connect(frame());
  after(finger(0, 7, 2000, 1000));
  stream_.feed(mouse());
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.touch.back().fingers, 0u);
  EXPECT_EQ(sink_.touch.back().counter, 3u) << "the finger, its end, and the mouse's beginning";
}

TEST_F(TouchTest, AHeldPinchActsWhenItIsDue) {
  connect(frame());
  sink_.due_at = clock_.now() + std::chrono::milliseconds(70);
  const std::vector due = {sink_.due_at};
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ticks, due);
}

TEST_F(TouchTest, EventsAllocateNothing) {
  connect(frame());
  sink_.touch.reserve(1000);
  std::string events = finger(0, 7, 0, 0);
  for (int i = 1; i < 400; ++i) events += moved(ABS_MT_POSITION_X, i) + kReport;
  stream_.feed(events);
  const long before = test::allocations;
  while (sink_.touch.size() < 399) ASSERT_TRUE(device_->poll(stream_));
#ifndef MERLIN_THREAD_SANITIZER
  EXPECT_EQ(test::allocations, before);
#endif
}

TEST_F(TouchTest, EveryPrefixOfAReportPublishesNothingAndTheWholeDoes) {
  const std::string events = finger(0, 7, 2000, 1000) + kReport;
  for (std::size_t n = 0; n <= events.size(); ++n) {
    sink_.touch.clear();
    connect(frame());
    stream_.feed(events.substr(0, n));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(device_->poll(stream_));
    EXPECT_EQ(sink_.touch.size(), n == events.size() ? 1u : 0u) << n;
  }
}

TEST_F(TouchTest, RandomEventsGiveNoSampleThatIsNotPlausible) {
  Random random(11);
  for (const std::string& description : {frame(), screen(), mouse()}) {
    connect(description);
    const std::size_t before = sink_.touch.size();
    for (int i = 0; i < 30'000; ++i) {
      const int codes[] = {
          ABS_X,    ABS_Y,     ABS_MT_SLOT,      ABS_MT_TRACKING_ID, ABS_MT_POSITION_X,
          BTN_LEFT, BTN_TOUCH, ABS_MT_POSITION_Y};
      const auto value = random.below(2) ? static_cast<std::int32_t>(random.next())
                                         : static_cast<std::int32_t>(random.below(12)) - 1;
      std::string bytes = evdevRecord(static_cast<Kind>(6 + random.below(4)),
                                      codes[random.below(std::size(codes))], value);
      if (random.below(10) == 0)
        bytes[random.below(bytes.size())] = static_cast<char>(random.next());
      stream_.feed(bytes);
      ASSERT_TRUE(device_->poll(stream_));
    }
    EXPECT_GT(sink_.touch.size(), before + 100);
  }
  EXPECT_GT(device_->counters().bad_bytes, 0u);
  for (const TouchSample& s : sink_.touch) ASSERT_TRUE(plausible(s));
}

TEST(TouchSettings, OtherPortsThanInputDevicesAreRefused) {
  LineSettings line;
  line.driver = "touch";
  for (const char* good : {"", "evdev:/dev/input/event3", "replay:x", "pty:/tmp/x"}) {
    line.port = good;
    EXPECT_TRUE(validate(TouchSettings{}, line).empty()) << good;
    EXPECT_TRUE(validate(line).empty()) << good;
  }
  line.port = "serial:/dev/ttyS0";
  ASSERT_EQ(validate(TouchSettings{}, line).size(), 1u);
  EXPECT_EQ(validate(TouchSettings{}, line)[0].pointer, "/port");
}

}  // namespace
}  // namespace merlin::touch
