// Bindings turn inputs of the devices into actions in shared memory; each reader receives each
// action once.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/actions/action_reader.h"
#include "daemon/actions/action_sink.h"
#include "daemon/actions/action_writer.h"
#include "daemon/actions/pinch.h"
#include "daemon/actions/settings.h"
#include "daemon/base/commands.h"
#include "drivers/port/held_ball.h"
#include "tests/support/local_devices.h"
#include "tests/support/recording_sink.h"

namespace merlin::actions {
namespace {

constexpr std::size_t kGrab = actionIndex("grab"), kNextMode = actionIndex("next_mode"),
                      kReset = actionIndex("reset_view"), kLampOn = actionIndex("lamp_on"),
                      kLampOff = actionIndex("lamp_off");

class ActionsTest : public testing::Test {
 protected:
  // Returns a writer for one device. `source`: index of the device in the segment.
  ActionWriter writer(const std::vector<Binding>& bindings, std::size_t source,
                      std::uint64_t generation = 1) {
    const auto devices = test::defaultSlotNames().devices;
    Source of;
    if (source < devices.size()) of = {devices[source].name, devices[source].kind};
    return {bindings, of, generation, segment_->actions[source]};
  }
  Actions read() { return reader_.read(segment_.slots()); }
  shm::ActionState state(std::size_t source) const { return *segment_->actions[source].read(); }
  static BallSample ball(std::uint32_t buttons) {
    BallSample b{};
    b.buttons = buttons;
    b.received_ns = 5;
    return b;
  }
  static PostureState posture(const std::string& name) {
    PostureState p{};
    name.copy(p.name, sizeof p.name - 1);
    return p;
  }

  test::LocalDevices segment_;
  ActionReader reader_;
};

TEST_F(ActionsTest, AnActionBeginsOnceAPress) {
  ActionWriter w = writer({{"ball.button.2", "next_mode"}}, test::kBall);
  (void)read();
  for (int press = 0; press < 3; ++press) {
    for (int i = 0; i < 5; ++i) w.update(ball(2));
    EXPECT_EQ(read().all.begun[kNextMode], 1u) << press;
    for (int i = 0; i < 5; ++i) w.update(ball(0));
    EXPECT_EQ(read().all.begun[kNextMode], 0u) << press;
  }
  w.update(ball(2 | 4));
  w.update(ball(2 | 8));  // other buttons change while button 2 is held
  w.update(ball(4));
  EXPECT_EQ(read().all.begun[kNextMode], 1u);
  EXPECT_EQ(state(test::kBall).begun[kNextMode], 4u);
  EXPECT_EQ(state(test::kBall).changed_ns, 5);
}

TEST_F(ActionsTest, OnLeaveAnActionBeginsWhenTheInputEnds) {
  ActionWriter w = writer(
      {{"ball.button.1", "lamp_on"}, {"ball.button.1", "lamp_off", When::kLeave}}, test::kBall);
  (void)read();
  w.update(ball(1));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOn});
  w.update(ball(0));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOff});
}

// Both actions begin between two reads; the reader must receive them in the order in which they
// began.
TEST_F(ActionsTest, TheirOrderIsKept) {
  ActionWriter w = writer(
      {{"ball.button.1", "lamp_on"}, {"ball.button.1", "lamp_off", When::kLeave}}, test::kBall);
  (void)read();
  w.update(ball(1));
  w.update(ball(0));
  w.update(ball(1));
  EXPECT_EQ(read().in_order, (std::vector<std::size_t>{kLampOn, kLampOff, kLampOn}));
  for (int i = 0; i < 100; ++i) w.update(ball(i % 2 ? 1 : 0));
  const auto last = read().in_order;
  EXPECT_EQ(last.size(), 12u) << "more than a dozen: the last ones";
  EXPECT_EQ(last.back(), kLampOn);
}

TEST_F(ActionsTest, WhatLastsIsHeldUntilTheInputEnds) {
  ActionWriter w = writer({{"ball.button.1", "grab"}, {"ball.button.2", "grab"}}, test::kBall);
  w.update(ball(1));
  EXPECT_TRUE(read().all.held[kGrab]);
  w.update(ball(1 | 2));
  w.update(ball(2));
  EXPECT_TRUE(read().all.held[kGrab]) << "the other button holds it";
  w.update(ball(0));
  EXPECT_FALSE(read().all.held[kGrab]);
}

TEST_F(ActionsTest, EveryInputDoesWhatItIsBoundTo) {
  const std::vector<Binding> bindings = {{"ball.button.12", "next_mode"},
                                         {"glove.switch", "reset_view"},
                                         {"posture.point", "grab"},
                                         {"panel.button", "next_mode"}};
  ActionWriter glove = writer(bindings, test::kGlove);
  ActionWriter ball_writer = writer(bindings, test::kBall);
  ActionWriter panel = writer(bindings, test::kPanel);
  (void)read();
  ball_writer.update(ball(0x7FF));  // buttons 1 to 11, which are not bound
  EXPECT_TRUE(read().in_order.empty());
  ball_writer.update(ball(1U << 11));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kNextMode});
  GloveSample sample{};
  sample.flags = GloveSample::kPlugged | GloveSample::kLight;
  glove.update(sample, nullptr);
  EXPECT_TRUE(read().in_order.empty());
  sample.flags = GloveSample::kWristSwitch;
  const PostureState fist = posture("fist"), point = posture("point");
  glove.update(sample, &fist);
  const Actions switched = read();
  EXPECT_EQ(switched.all.begun[kReset], 1u);
  EXPECT_FALSE(switched.all.held[kGrab]);
  glove.update(sample, &point);
  EXPECT_TRUE(read().all.held[kGrab]);
  panel.press(7);
  panel.press(8);
  EXPECT_EQ(read().all.begun[kNextMode], 2u);
}

TEST_F(ActionsTest, ADeviceThatIsLostLetsGo) {
  const std::vector<Binding> bindings = {{"ball.button.1", "grab"},
                                         {"ball.button.2", "next_mode", When::kLeave}};
  test::RecordingSink samples;
  struct Healths final : HealthSink {
    void publish(const DeviceHealth&) noexcept override { ++published; }
    int published = 0;
  } healths;
  ActionSink sink(writer(bindings, test::kBall), {&segment_->glove[0].posture_state, samples,
                                                  healths, std::chrono::milliseconds(500)});
  (void)read();
  sink.publish(ball(3));
  DeviceHealth health{};
  health.state = HealthState::kAbsent;
  health.since_ns = 1'000'000'000;
  health.updated_ns = 1'499'999'999;
  sink.publish(health);
  EXPECT_TRUE(read().all.held[kGrab]) << "it may come back";
  health.updated_ns = 1'500'000'000;
  sink.publish(health);
  const Actions actions = read();
  EXPECT_FALSE(actions.all.held[kGrab]);
  EXPECT_EQ(actions.all.begun[kNextMode], 1u) << "the input has ended";
  EXPECT_EQ(healths.published, 2);
}

TEST_F(ActionsTest, WhatBeganBeforeTheFirstLookOrBeforeARestartIsPast) {
  const std::vector<Binding> bindings = {{"ball.button.2", "next_mode"}};
  {
    ActionWriter w = writer(bindings, test::kBall);
    w.update(ball(2));
  }
  EXPECT_EQ(read().all.begun[kNextMode], 0u);
  ActionWriter restarted = writer(bindings, test::kBall, 2);
  restarted.update(ball(2));
  restarted.update(ball(0));
  restarted.update(ball(2));
  EXPECT_EQ(read().all.begun[kNextMode], 0u);
  restarted.update(ball(0));
  restarted.update(ball(2));
  EXPECT_EQ(read().all.begun[kNextMode], 1u);
}

TEST_F(ActionsTest, WhatStaysBoundGoesOnAndWhatIsNoMoreEnds) {
  ActionWriter w = writer({{"ball.button.1", "grab"}, {"ball.button.2", "fly"}}, test::kBall);
  w.update(ball(1 | 2));
  EXPECT_TRUE(read().all.held[kGrab]);
  w.rebind({{"ball.button.3", "next_mode"}, {"ball.button.1", "grab"}});
  w.adopt(9);
  const Actions after = read();
  EXPECT_TRUE(after.all.held[kGrab]);
  EXPECT_FALSE(after.all.held[actionIndex("fly")]);
  EXPECT_TRUE(after.in_order.empty()) << "nothing begins anew";
  EXPECT_EQ(state(test::kBall).changed_ns, 9);
  w.update(ball(1 | 4));
  EXPECT_EQ(read().all.begun[kNextMode], 0u) << "the third button was never seen released";
  w.update(ball(1));
  w.update(ball(1 | 4));
  const Actions pressed = read();
  EXPECT_EQ(pressed.all.begun[kNextMode], 1u);
  EXPECT_TRUE(pressed.all.held[kGrab]);
}

// An input that is pressed while its binding changes must trigger nothing, neither when the press
// is seen nor when it ends.
TEST_F(ActionsTest, ANewBindingWaitsForTheNextPress) {
  ActionWriter w = writer({{"ball.button.1", "next_mode"}}, test::kBall);
  w.update(ball(1));
  (void)read();
  w.rebind({{"ball.button.1", "grab"}, {"ball.button.1", "lamp_off", When::kLeave}});
  for (int i = 0; i < 3; ++i) w.update(ball(1));
  EXPECT_FALSE(read().all.held[kGrab]);
  w.update(ball(0));
  EXPECT_TRUE(read().in_order.empty());
  w.update(ball(1));
  EXPECT_TRUE(read().all.held[kGrab]);
  w.update(ball(0));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOff});
  ActionWriter panel = writer({}, test::kPanel);
  (void)read();
  panel.rebind({{"panel.button", "next_mode"}});
  panel.press(3);
  EXPECT_EQ(read().all.begun[kNextMode], 1u) << "the panel's button is released between presses";
}

// A ball at rest sends no samples, but its health is still reported.
TEST_F(ActionsTest, ADeviceThatSendsNothingIsReboundByItsHealth) {
  test::RecordingSink samples;
  test::RecordingHealth healths;
  ActionSink sink(
      writer({{"ball.button.1", "grab"}}, test::kBall),
      {&segment_->glove[0].posture_state, samples, healths, std::chrono::milliseconds(500)});
  sink.publish(ball(1));
  EXPECT_TRUE(read().all.held[kGrab]);
  sink.reload({}, std::chrono::milliseconds(100));
  DeviceHealth health{};
  health.state = HealthState::kOk;
  sink.publish(health);
  EXPECT_FALSE(read().all.held[kGrab]);
  sink.reload({{"ball.button.1", "grab"}}, std::chrono::milliseconds(100));
  sink.publish(ball(0));
  sink.publish(ball(1));
  EXPECT_TRUE(read().all.held[kGrab]);
  health.state = HealthState::kAbsent;
  health.updated_ns = 100'000'000;
  sink.publish(health);
  EXPECT_FALSE(read().all.held[kGrab]) << "the new time counts";
}

TEST_F(ActionsTest, AChordNeedsBoth) {
  Binding chord{"ball.button.1", "next_mode"};
  chord.with = "ball.button.2";
  ActionWriter w = writer({chord}, test::kBall);
  (void)read();
  w.update(ball(1));
  w.update(ball(0));
  w.update(ball(2));
  EXPECT_EQ(read().all.begun[kNextMode], 0u);
  w.update(ball(1 | 2));
  w.update(ball(1 | 2));
  EXPECT_EQ(read().all.begun[kNextMode], 1u);
  w.update(ball(2));
  w.update(ball(1 | 2));
  EXPECT_EQ(read().all.begun[kNextMode], 1u) << "again";
}

BallSample at(BallSample ball, int ms) {
  ball.received_ns = std::int64_t{ms} * 1'000'000;
  return ball;
}

Binding chordOf(const char* input, const char* with, const char* action) {
  Binding chord{input, action};
  chord.with = with;
  return chord;
}

TEST_F(ActionsTest, WhileAChordIsHeldItsInputsAloneDoNothing) {
  ActionWriter w = writer({{"ball.button.1", "lamp_on"},
                           {"button.2", "next_mode"},
                           chordOf("ball.button.1", "ball.button.2", "lamp_off")},
                          test::kBall);
  (void)read();
  w.update(ball(2));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kNextMode}) << "no chord yet";
  w.update(ball(1 | 2));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOff});
  w.update(ball(1));
  w.update(ball(0));
  EXPECT_TRUE(read().in_order.empty()) << "what is left of a chord begins nothing";
  w.update(ball(1 | 2));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOff}) << "both at once";
  w.update(ball(0));
  w.update(ball(1));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOn}) << "alone again";
  w.update(ball(1 | 2));
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kLampOff}) << "the second one only in it";
}

TEST_F(ActionsTest, APressThatBecomesAChordIsNoShortAndNoLongOne) {
  Binding late{"ball.button.1", "blank"}, again{"ball.button.1", "next_content"};
  late.after_s = 1;
  again.repeat_s = 0.5;
  ActionWriter w = writer({{"ball.button.1", "next_mode", When::kLeave},
                           late,
                           again,
                           {"ball.button.1", "grab"},
                           chordOf("ball.button.2", "ball.button.1", "lamp_off")},
                          test::kBall);
  (void)read();
  w.update(at(ball(1), 0));
  EXPECT_EQ(read().all.begun[actionIndex("next_content")], 1u);
  w.update(at(ball(1 | 2), 100));
  w.update(at(ball(1), 200));
  w.update(at(ball(1), 2000));
  const Actions during = read();
  EXPECT_EQ(during.in_order, std::vector<std::size_t>{kLampOff});
  EXPECT_TRUE(during.all.held[kGrab]) << "it had begun before";
  w.update(at(ball(0), 2100));
  const Actions after = read();
  EXPECT_TRUE(after.in_order.empty());
  EXPECT_FALSE(after.all.held[kGrab]);
  w.update(at(ball(1), 3000));
  w.update(at(ball(0), 3100));
  EXPECT_EQ(read().all.begun[kNextMode], 1u) << "the next press is one of its own";
}

TEST_F(ActionsTest, ALongPressIsNotAShortOneToo) {
  Binding brief{"ball.button.1", "next_mode", When::kLeave};
  Binding longer{"ball.button.1", "reset_view"};
  longer.after_s = 0.8;
  ActionWriter w = writer({brief, longer}, test::kBall);
  (void)read();
  w.update(at(ball(1), 0));
  w.update(at(ball(0), 300));
  Actions actions = read();
  EXPECT_EQ(actions.all.begun[kNextMode], 1u);
  EXPECT_EQ(actions.all.begun[kReset], 0u);
  w.update(at(ball(1), 1000));
  w.update(at(ball(1), 1799));
  EXPECT_EQ(read().all.begun[kReset], 0u);
  w.adopt(1'800'000'000);
  EXPECT_EQ(read().all.begun[kReset], 1u) << "though the ball sends nothing";
  w.update(at(ball(0), 2000));
  actions = read();
  EXPECT_EQ(actions.all.begun[kNextMode], 0u) << "this end is the long press's";
  EXPECT_EQ(actions.all.begun[kReset], 0u);
}

TEST_F(ActionsTest, WhatRepeatsDoesSoWhileItsInputIsHeld) {
  Binding next{"ball.button.1", "next_mode"};
  next.repeat_s = 0.5;
  ActionWriter w = writer({next}, test::kBall);
  (void)read();
  w.update(at(ball(1), 0));
  for (int ms = 100; ms <= 1100; ms += 100) w.adopt(std::int64_t{ms} * 1'000'000);
  EXPECT_EQ(read().all.begun[kNextMode], 3u) << "at 0, 0.5 and 1 s";
  w.update(at(ball(0), 1200));
  w.adopt(5'000'000'000);
  EXPECT_EQ(read().all.begun[kNextMode], 0u);
}

// A gamepad sends nothing while a button is held, so time-outs and repetitions must not depend on
// samples.
TEST_F(ActionsTest, WhatRepeatsOrWaitsIsInTimeWithADeviceThatIsSilent) {
  Binding next{"ball.button.1", "next_mode"};
  next.repeat_s = 0.1;
  Binding later{"ball.button.1", "reset_view"};
  later.after_s = 0.6;
  test::RecordingSink samples;
  test::RecordingHealth healths;
  ActionSink sink(writer({next, later}, test::kBall),
                  {nullptr, samples, healths, std::chrono::milliseconds(500)});
  HeldBall held(sink);
  Timestamp now{std::chrono::seconds(10)};
  EXPECT_EQ(sink.due(), Timestamp::max());
  EXPECT_EQ(held.wait(now), std::chrono::milliseconds(250));
  (void)read();
  held.sample().buttons = 1;
  held.publish(now);
  const auto beginsUntil = [&](Timestamp end, std::size_t action, Duration late) {
    while (now + held.wait(now) <= end) {
      now += held.wait(now) + late;
      held.hold(now);
    }
    return read().all.begun[action];
  };
  const Timestamp pressed = now;
  EXPECT_EQ(beginsUntil(pressed + std::chrono::milliseconds(599), kReset, {}), 0u);
  EXPECT_EQ(beginsUntil(pressed + std::chrono::milliseconds(600), kReset, {}), 1u);
  EXPECT_EQ(beginsUntil(pressed + std::chrono::milliseconds(2050), kNextMode,
                        std::chrono::milliseconds(9)),
            14u)
      << "each tenth of a second, without the delays adding up";
  now += std::chrono::seconds(5);
  held.hold(now);
  held.hold(now);
  EXPECT_EQ(read().all.begun[kNextMode], 1u) << "no burst after a pause";
  held.sample().buttons = 0;
  held.publish(now);
  EXPECT_EQ(sink.due(), Timestamp::max());
  EXPECT_EQ(samples.ball.size(), 2u);
}

TEST_F(ActionsTest, AnAxisThatIsPushedIsAnInput) {
  ActionWriter w = writer({{"ball.axis.x-", "next_mode"}, {"axis.rz+", "reset_view"}}, test::kBall);
  (void)read();
  const auto push = [&](float x, float rz) {
    BallSample sample = ball(0);
    sample.translation[0] = x;
    sample.rotation[2] = rz;
    w.update(sample);
  };
  push(0.9F, -0.9F);
  EXPECT_TRUE(read().in_order.empty()) << "the other way";
  for (const float x : {-0.6F, -0.45F, -0.55F, -0.4F, -0.6F}) push(x, 0);
  EXPECT_EQ(read().all.begun[kNextMode], 1u) << "it trembles about one half";
  push(-0.3F, 0.6F);
  push(-0.6F, 0.6F);
  const Actions actions = read();
  EXPECT_EQ(actions.all.begun[kNextMode], 1u);
  EXPECT_EQ(actions.all.begun[kReset], 1u);
}

TEST(BindingSettings, ChordsAndTimesFitTheirInput) {
  const auto pointers = [](const Binding& binding) {
    std::string all;
    for (const SettingFault& fault : validate({binding})) all += fault.pointer + " ";
    return all;
  };
  const Binding good{"ball.button.1", "next_mode", When::kEnter, "ball.button.2", 0.5, 0.2};
  EXPECT_EQ(pointers(good), "");
  for (const char* with :
       {"ball.button.1", "button.2", "pad.button.2", "panel.button", "nonsense"}) {
    Binding bad = good;
    bad.with = with;
    EXPECT_EQ(pointers(bad), "/0/with ") << with;
  }
  EXPECT_EQ(pointers({"ball.button.1", "grab", When::kHold, "", 0, 0.2}), "/0/repeat_s ");
  EXPECT_EQ(pointers({"ball.button.1", "next_mode", When::kEnter, "", 0, 1e-9}), "/0/repeat_s ");
  EXPECT_EQ(pointers({"ball.button.1", "next_mode", When::kEnter, "", 0, 0.05}), "");
  EXPECT_EQ(pointers({"ball.button.1", "next_mode", When::kLeave, "", 0, 0.2}), "/0/repeat_s ");
  EXPECT_EQ(pointers({"panel.button", "next_mode", When::kEnter, "", 0.5, 0}), "/0 ");
  EXPECT_TRUE(validate({{"ball.button.1", "next_mode", When::kEnter, "", 0, 0},
                        {"ball.button.1", "next_mode", When::kEnter, "", 0.8, 0}})
                  .empty())
      << "at different times";
}

TEST_F(ActionsTest, AGestureIsThatOfItsHandOrOfAny) {
  const std::vector<Binding> bindings = {{"gesture.push", "next_mode"},
                                         {"left.gesture.push", "reset_view"},
                                         {"posture.push", "lamp_on"},
                                         {"panel.button", "lamp_off"}};
  const auto hand = [&](const char* name, std::size_t slot) {
    return ActionWriter(bindings, {name, std::nullopt, true}, 1, segment_->actions[slot]);
  };
  ActionWriter left = hand("left", test::kBall), right = hand("right", test::kGlove);
  (void)read();
  left.gesture("pull", 3);
  EXPECT_TRUE(read().in_order.empty());
  left.gesture("push", 4);
  EXPECT_EQ(read().in_order, (std::vector<std::size_t>{kNextMode, kReset}));
  right.gesture("push", 5);
  right.gesture("push", 6);
  EXPECT_EQ(read().in_order, (std::vector<std::size_t>{kNextMode, kNextMode}));
  EXPECT_EQ(state(test::kGlove).changed_ns, 6);
}

// Returns the code that a kernel might have for this name; nothing for any other name.
std::optional<std::uint16_t> keyCode(std::string_view name) {
  if (name == "key_space") return 57;
  if (name == "key_tab") return 15;
  if (name == "btn_right") return kFirstMouseButton + 1;
  if (name == "btn_south") return 0x130;
  return std::nullopt;
}

TEST_F(ActionsTest, AKeyIsNamedAsTheKernelDoes) {
  Binding chord{"key.space", "reset_view"};
  chord.with = "key.tab";
  ActionWriter pad({{"pad.key.space", "next_mode"},
                    chord,
                    {"other.key.space", "lamp_on"},
                    {"button.south", "grab"},
                    {"key.none", "lamp_off"}},
                   {"pad", SampleKind::kBall, false, &keyCode}, 1, segment_->actions[test::kBall]);
  (void)read();
  const auto press = [&](std::initializer_list<std::uint16_t> keys) {
    BallSample sample = ball(0);
    std::copy(keys.begin(), keys.end(), sample.keys);
    pad.update(sample);
    return read();
  };
  EXPECT_TRUE(press({15}).in_order.empty());
  EXPECT_EQ(press({57}).in_order, std::vector<std::size_t>{kNextMode});
  EXPECT_EQ(press({15, 57}).in_order, std::vector<std::size_t>{kReset}) << "with tab";
  EXPECT_TRUE(press({57, 0x130}).all.held[kGrab]);
  EXPECT_FALSE(press({}).all.held[kGrab]);
  EXPECT_EQ(read().in_order.size(), 0u) << "a key that there is not is not the empty place";
}

TEST_F(ActionsTest, AMousesButtonsAreInputs) {
  ActionWriter mouse({{"button.right", "next_mode"}, {"touch.button.south", "reset_view"}},
                     {"touch", SampleKind::kTouch, false, &keyCode}, 1,
                     segment_->actions[test::kBall]);
  (void)read();
  const auto press = [&](std::uint16_t buttons) {
    TouchSample sample{};
    sample.buttons = buttons;
    mouse.update(sample);
    return read().in_order;
  };
  EXPECT_TRUE(press(0xFFFD).empty()) << "all others";
  EXPECT_EQ(press(2), std::vector<std::size_t>{kNextMode});
}

TEST_F(ActionsTest, ADeviceThatLacksABoundKeySaysSoOnceItWorks) {
  Binding chord{"pad.button.1", "reset_view"};
  chord.with = "pad.key.space";
  test::RecordingSink samples;
  test::RecordingHealth health;
  ActionSink sink(
      ActionWriter({{"key.tab", "next_mode"}, {"pad.button.south", "grab"}, chord},
                   {"pad", SampleKind::kBall, false, &keyCode}, 1, segment_->actions[test::kBall]),
      {nullptr, samples, health, std::chrono::seconds(1)});
  const auto reason = [&](HealthState state, const char* own = "") {
    DeviceHealth h{};
    h.state = state;
    std::string_view(own).copy(h.reason, sizeof h.reason - 1);
    sink.publish(h);
    return std::string(health.last().reason);
  };
  EXPECT_EQ(reason(HealthState::kOk), "") << "a device that has not told its keys";
  DeviceKeys keys;
  keys.set(0x130);
  sink.describe(keys);
  EXPECT_EQ(reason(HealthState::kOpening), "");
  EXPECT_EQ(reason(HealthState::kOk),
            "it has no key.space, which a binding names; `merlin devices` "
            "lists the keys that it has");
  EXPECT_EQ(reason(HealthState::kOk, "a fault"), "a fault");
  sink.describe({});
  EXPECT_EQ(reason(HealthState::kOk).substr(0, 26), "it has no button.south, wh");
  keys.set(57);
  sink.describe(keys);
  EXPECT_EQ(reason(HealthState::kOk), "") << "key.tab may be that of another device";
}

// Returns a sample of two fingers at the same height and `apart` from each other, on a surface
// twice as wide as high.
TouchSample fingers(float apart, std::uint32_t second = 2) {
  TouchSample sample{};
  sample.fingers = 2;
  sample.aspect = 2;
  sample.id[0] = 1;
  sample.id[1] = second;
  for (const std::size_t i : {0U, 1U}) {
    sample.position[i][0] = 0.5F + (i == 0 ? -apart : apart) / 4;
    sample.position[i][1] = 0.5F;
  }
  return sample;
}

TEST(Pinch, IsAnInputThatIsNotThePostureOrTheGestureOfThatName) {
  EXPECT_EQ(*parseInput("touch.pinch"),
            (Input{Input::Kind::kPinch, "touch", Pinch::kTogether, {}}));
  EXPECT_EQ(*parseInput("spread"), (Input{Input::Kind::kPinch, "", Pinch::kApart, {}}));
  EXPECT_EQ(parseInput("posture.pinch")->kind, Input::Kind::kPosture);
  EXPECT_EQ(parseInput("left.posture.pinch")->kind, Input::Kind::kPosture);
  EXPECT_EQ(parseInput("gesture.spread")->kind, Input::Kind::kGesture);
  EXPECT_EQ(parseInput("key.pinch")->kind, Input::Kind::kKey);
  EXPECT_FALSE(parseInput("touch.pinch+"));
  EXPECT_FALSE(parseInput("a.touch.pinch"));
}

TEST(Pinch, BeginsAtALargeRatioAndEndsAtASmallerOne) {
  Pinch pinch;
  EXPECT_EQ(pinch.update(fingers(0.5F)), 0u);
  EXPECT_EQ(pinch.update(fingers(0.36F)), 0u) << "by 1.39";
  EXPECT_EQ(pinch.update(fingers(0.35F)), Pinch::kTogether) << "by 1.43";
  EXPECT_EQ(pinch.update(fingers(0.39F)), Pinch::kTogether) << "by 1.28";
  EXPECT_EQ(pinch.update(fingers(0.41F)), 0u) << "by 1.22";
  EXPECT_EQ(pinch.update(fingers(0.36F)), 0u);
  EXPECT_EQ(pinch.update(fingers(0.69F)), 0u) << "by 1.38";
  EXPECT_EQ(pinch.update(fingers(0.71F)), Pinch::kApart) << "by 1.42";
  EXPECT_EQ(pinch.update(fingers(0.64F)), Pinch::kApart) << "by 1.28";
  EXPECT_EQ(pinch.update(fingers(0.61F)), 0u) << "by 1.22";
}

TEST(Pinch, IsOfTheSameFingersInWhateverOrderTheyCome) {
  Pinch pinch;
  (void)pinch.update(fingers(0.6F));
  TouchSample swapped = fingers(0.3F);
  std::swap(swapped.id[0], swapped.id[1]);
  EXPECT_EQ(pinch.update(swapped), Pinch::kTogether);
  EXPECT_EQ(pinch.update(fingers(0.3F, 3)), 0u) << "another finger begins anew";
  EXPECT_EQ(pinch.update(fingers(0.2F, 3)), Pinch::kTogether);
  TouchSample one = fingers(0.2F, 3);
  one.fingers = 1;
  EXPECT_EQ(pinch.update(one), 0u);
  EXPECT_EQ(pinch.update(fingers(0.2F, 3)), 0u);
  TouchSample many = fingers(0.2F, 3);
  many.fingers = 4000;
  EXPECT_EQ(pinch.update(many), 0u) << "no more than a sample has";
}

TEST(Pinch, IsNoMatterOfAFewMillimetresAndNotOfTurning) {
  Pinch pinch;
  (void)pinch.update(fingers(0.002F));
  EXPECT_EQ(pinch.update(fingers(0.015F)), 0u);
  EXPECT_EQ(pinch.update(fingers(0.05F)), Pinch::kApart);
  TouchSample upright = fingers(0.4F, 9);
  (void)pinch.update(upright);
  for (const std::size_t i : {0U, 1U}) {
    upright.position[i][0] = 0.2F;
    upright.position[i][1] = i == 0 ? 0.1F : 0.5F;
  }
  EXPECT_EQ(pinch.update(upright), 0u) << "as far apart, one above the other";
}

TEST_F(ActionsTest, APinchIsHeldUntilTheFingersAreLiftedOrLost) {
  Binding repeated{"spread", "next_mode"};
  repeated.repeat_s = 1;
  ActionWriter wall({{"wall.pinch", "grab"}, {"other.pinch", "reset_view"}, repeated},
                    {"wall", SampleKind::kTouch}, 1, segment_->actions[test::kBall]);
  (void)read();
  const auto at = [&](float apart, std::int64_t ns, std::uint32_t second = 2) {
    TouchSample sample = fingers(apart, second);
    sample.received_ns = ns;
    wall.update(sample);
    return read();
  };
  EXPECT_FALSE(at(0.8F, 1).all.held[kGrab]);
  EXPECT_TRUE(at(0.4F, 2).all.held[kGrab]);
  TouchSample lifted{};
  wall.update(lifted);
  EXPECT_FALSE(read().all.held[kGrab]);
  (void)at(0.2F, 4, 3);
  EXPECT_EQ(at(0.8F, 5, 3).in_order, std::vector<std::size_t>{kNextMode});
  wall.adopt(1'000'000'006);
  EXPECT_EQ(read().in_order, std::vector<std::size_t>{kNextMode}) << "repeats while it is held";
  (void)at(0.8F, 7, 4);
  EXPECT_TRUE(at(0.4F, 8, 4).all.held[kGrab]);
  wall.release(9);
  EXPECT_FALSE(read().all.held[kGrab]);
}

TEST(BindingSettings, AGestureTriggersWhatHappensOnce) {
  EXPECT_TRUE(validate({{"left.gesture.swipe_left", "next_content"}}).empty());
  const auto what = [](const Binding& binding) {
    const SettingFaults faults = validate({binding});
    return faults.size() == 1 ? faults[0].what : "";
  };
  EXPECT_EQ(what({"gesture.push", "grab"}),
            "binds gesture.push to grab; a gesture only triggers actions that happen once, when it "
            "is made");
  EXPECT_EQ(what({"gesture.push", "lamp_on", When::kLeave}),
            "binds gesture.push to its end; a gesture only triggers actions that happen once, when "
            "it is made");
  EXPECT_EQ(what({"gesture.push", "lamp_on", When::kEnter, "", 0.5, 0}),
            "gives gesture.push with, after_s or repeat_s, which it has not: it only tells that it "
            "was made");
  EXPECT_EQ(what({"posture.fist", "lamp_on", When::kEnter, "gesture.push"}),
            "is \"gesture.push\"; allowed are the forms of input, without gestures and "
            "panel.button");
  EXPECT_EQ(what({"gesture.", "lamp_on"}).find("is \"gesture.\"; allowed are "), 0u);
  const SettingFaults twice =
      validate({{"gesture.push", "lamp_on"}, {"left.gesture.push", "lamp_off"}});
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].other, "/0");
}

TEST(BindingSettings, AnInputThatIsNoneIsFound) {
  for (const std::string input : {"",
                                  "ball",
                                  "ball.button.",
                                  "ball.button.0",
                                  "ball.button.13",
                                  "ball.button.-1",
                                  "ball.button.+1",
                                  "ball.button.1x",
                                  "ball.button.X1",
                                  "ball.button.",
                                  "ball.key.",
                                  "ball.key.a b",
                                  "key",
                                  "ball.button. 1",
                                  "ball.button.99999999999",
                                  "ball.axis.x",
                                  "ball.axis.w+",
                                  "ball.axis.+",
                                  "posture.",
                                  "posture",
                                  "glove",
                                  "glove.switch.1",
                                  "Glove.switch",
                                  "Ball.button.1",
                                  "a.b.button.1",
                                  ".button.1",
                                  "panel",
                                  "panel."}) {
    const SettingFaults faults = validate({{"glove.switch", "grab"}, {input, "reset_view"}});
    ASSERT_EQ(faults.size(), 1u) << input;
    EXPECT_EQ(faults[0].pointer, "/1/input");
  }
  for (int n = 1; n <= 12; ++n)
    EXPECT_TRUE(validate({{"ball.button." + std::to_string(n), "grab"}}).empty()) << n;
  EXPECT_TRUE(validate(defaultBindings()).empty());
}

TEST(BindingSettings, WhatLastsIsHeldAndWhatHappensOnceIsNot) {
  for (const auto& [action, when] :
       {std::pair{"grab", When::kEnter}, {"fly", When::kLeave}, {"reset_view", When::kHold}}) {
    const SettingFaults faults = validate({{"posture.fist", action, when}});
    ASSERT_EQ(faults.size(), 1u) << action;
    EXPECT_EQ(faults[0].pointer, "/0/on");
  }
}

TEST(BindingSettings, ThePanelsButtonTriggersWhatHappensOnce) {
  EXPECT_TRUE(validate({{"panel.button", "projector_on"}}).empty());
  EXPECT_EQ(validate({{"panel.button", "grab"}}).size(), 1u);
  EXPECT_EQ(validate({{"panel.button", "lamp_on", When::kLeave}}).size(), 1u);
}

}  // namespace
}  // namespace merlin::actions
