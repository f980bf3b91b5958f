#include "daemon/wall/device_feed.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "daemon/base/log.h"
#include "daemon/shm/fields.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kStaleAfter = milliseconds(500);

class DeviceFeedTest : public testing::Test {
 protected:
  void SetUp() override { start(test::defaultSlotNames(), 1); }
  // Simulates the start of a devices' process with these devices, all of which work.
  void start(const shm::SlotNames& names, std::uint64_t generation) {
    segment_.reset();
    auto made = shm::SegmentWriter<shm::DevicesSegment>::make(name_, shm::devicesFields(names),
                                                              generation, now_, {});
    ASSERT_TRUE(made);
    segment_.emplace(*std::move(made));
    for (auto& slot : (*segment_)->health) slot.publish(health(HealthState::kOk));
  }
  DeviceHealth health(HealthState state) const {
    DeviceHealth h{};
    h.state = state;
    h.since_ns = h.updated_ns = toNanoseconds(now_);
    return h;
  }
  WallInput read() {
    segment_->writeHeartbeat(now_);
    return feed_.read(now_);
  }
  static FeedSettings settings() {
    FeedSettings settings;
    settings.hands = {{"hand", "", "", {"", 2}}};
    settings.stale_after = kStaleAfter;
    return settings;
  }
  void push() {
    BallSample ball{};
    ball.received_ns = toNanoseconds(now_);
    ball.translation[0] = 1;
    ball.buttons = 2;
    (*segment_)->ball[0].publish(ball);
  }

  std::string name_ = shm::segmentName(test::privateName("feed"), "devices");
  Timestamp now_ = SystemClock().now();
  std::optional<shm::SegmentWriter<shm::DevicesSegment>> segment_;
  DeviceFeed feed_{name_, settings()};
};

// A hand that moves at 1 m/s was measured 3 ms ago, and has to be predicted to the end of the next
// frame, 33 ms ahead.
TEST_F(DeviceFeedTest, PredictsTheHandToTheDisplayTime) {
  DeviceFeed feed(name_, settings());
  feed.lookAhead(milliseconds(33));
  TrackerSample measured{};
  measured.received_ns = toNanoseconds(now_ - milliseconds(3));
  measured.position_m[0] = 0.5F;
  measured.orientation_wxyz[0] = 1;
  (*segment_)->tracker[0].stations[1].publish(measured);
  HandSample hand{};
  hand.received_ns = measured.received_ns;
  hand.position_m[0] = 0.49F;
  hand.orientation_wxyz[0] = 1;
  hand.velocity_m_s[0] = 1;
  hand.delay_s = 0.01F;
  (*segment_)->hand[0].publish(hand);
  segment_->writeHeartbeat(now_);
  EXPECT_NEAR(feed.read(now_).scene.hand->position_m[0], 0.49 + 0.003 + 0.033 + 0.010, 1e-5);
  feed.configure(settings());
  feed.lookAhead(milliseconds(66));
  EXPECT_NEAR(feed.read(now_).scene.hand->position_m[0], 0.49 + 0.003 + 0.066 + 0.010, 1e-5);
  EXPECT_EQ(read().scene.hand->position_m[0], 0.5F) << "not asked to look ahead";
  measured.received_ns += 1000;  // a newer tracker record, for which there is no HandSample yet
  (*segment_)->tracker[0].stations[1].publish(measured);
  EXPECT_EQ(feed.read(now_).scene.hand->position_m[0], 0.5F);
}

// The wheel of a mouse counts from zero after each start of the devices' process.
TEST_F(DeviceFeedTest, ARestartOfTheDevicesTurnsNoWheel) {
  const shm::SlotNames names{{{"mouse", SampleKind::kTouch}}, {}};
  const auto wheel = [&](std::uint16_t notches) {
    TouchSample touch{};
    touch.received_ns = toNanoseconds(now_);
    touch.aspect = 1;
    touch.wheel = notches;
    (*segment_)->touch[0].publish(touch);
    return read().scene.touch.spread;
  };
  start(names, 1);
  EXPECT_EQ(wheel(40), 0) << "where it stands at first moves nothing";
  EXPECT_GT(wheel(41), 0);
  now_ += seconds(2);  // the heartbeat of the old segment is too old by now
  start(names, 2);
  EXPECT_EQ(wheel(0), 0);
  EXPECT_LT(wheel(65535), 0);
}

TEST_F(DeviceFeedTest, AMousesWheelCountsBesideTheFingersOfAnotherSurface) {
  start({{{"mouse", SampleKind::kTouch}, {"table", SampleKind::kTouch}}, {}}, 1);
  TouchSample mouse{}, table{};
  mouse.received_ns = table.received_ns = toNanoseconds(now_);
  mouse.aspect = table.aspect = 1;
  table.fingers = 2;
  for (const std::size_t i : {0U, 1U}) {
    table.id[i] = static_cast<std::uint32_t>(i + 1);
    table.position[i][0] = 0.25F + 0.5F * static_cast<float>(i);
  }
  const auto touched = [&](std::uint16_t notches) {
    mouse.wheel = notches;
    (*segment_)->touch[0].publish(mouse);
    (*segment_)->touch[1].publish(table);
    return read().scene.touch;
  };
  EXPECT_FALSE(touched(4).moves());
  const render::scene::TouchMotion turned = touched(5);
  EXPECT_EQ(turned.fingers, 2u);
  EXPECT_FLOAT_EQ(turned.spread, render::scene::TouchFollower::kPerNotch);
}

TEST_F(DeviceFeedTest, SaysWhetherFingersRequestedBlankOrFreeze) {
  constexpr std::size_t kTable = 0, kBeside = 1;
  start({{{"table", SampleKind::kTouch}, {"ball", SampleKind::kBall}}, {}}, 1);
  shm::ActionState begun[2]{};
  read();
  for (const std::size_t source : {kTable, kBeside})
    (*segment_)->actions[source].publish(begun[source]);
  read();
  const auto isByFingers = [&](std::size_t source, std::size_t action) {
    ++begun[source].begun[action];
    (*segment_)->actions[source].publish(begun[source]);
    return read().by_fingers;
  };
  EXPECT_TRUE(isByFingers(kTable, actionIndex("blank")));
  EXPECT_TRUE(isByFingers(kTable, actionIndex("freeze")));
  EXPECT_FALSE(isByFingers(kTable, actionIndex("next_content")));
  EXPECT_FALSE(isByFingers(kBeside, actionIndex("blank")));
}

TEST_F(DeviceFeedTest, GivesTheNewestOfWhatThereIs) {
  push();
  TrackerSample hand{};
  hand.received_ns = toNanoseconds(now_ - milliseconds(3));
  (*segment_)->tracker[0].stations[1].publish(hand);
  const auto input = read();
  ASSERT_TRUE(input.scene.ball);
  EXPECT_EQ(input.scene.ball->translation[0], 1);
  EXPECT_TRUE(input.scene.hand) << "station 2";
  EXPECT_EQ(input.posture[0], 0);
  EXPECT_EQ(feed_.age(), Duration::zero()) << "of the ball, the newest";
}

TEST_F(DeviceFeedTest, GivesTheHeadsStationWhereOneIsNamedAndItIsFresh) {
  FeedSettings with_head = settings();
  with_head.head = {"", 3};
  DeviceFeed feed(name_, with_head);
  TrackerSample head{};
  head.received_ns = toNanoseconds(now_ - milliseconds(3));
  head.position_m[0] = 0.7F;
  (*segment_)->tracker[0].stations[2].publish(head);
  segment_->writeHeartbeat(now_);
  ASSERT_TRUE(feed.read(now_).head);
  EXPECT_EQ(feed.read(now_).head->position_m[0], 0.7F);
  EXPECT_FALSE(feed.read(now_).scene.hand) << "station 2 is silent";
  EXPECT_FALSE(read().head) << "no station is named";
  EXPECT_FALSE(feed.read(now_ + milliseconds(600)).head) << "stale";
}

TEST_F(DeviceFeedTest, ADeviceThatIsNotWellForAWhileIsLeftOut) {
  push();
  (*segment_)->health[test::kBall].publish(health(HealthState::kAbsent));
  EXPECT_TRUE(read().scene.ball);
  now_ += kStaleAfter;
  EXPECT_FALSE(read().scene.ball);
}

TEST_F(DeviceFeedTest, APushThatIsOldIsALostLettingGo) {
  push();
  now_ += milliseconds(501);
  const auto input = read();
  ASSERT_TRUE(input.scene.ball);
  EXPECT_EQ(input.scene.ball->translation[0], 0);
  EXPECT_EQ(input.scene.ball->buttons, 2u) << "a ball at rest is silent: its buttons stand";
}

TEST_F(DeviceFeedTest, AHandOrPostureThatIsOldIsNone) {
  TrackerSample hand{};
  PostureSample posture{};
  PostureState held{};
  hand.received_ns = posture.received_ns = toNanoseconds(now_);
  std::string("fist").copy(held.name, sizeof held.name - 1);
  (*segment_)->tracker[0].stations[1].publish(hand);
  (*segment_)->glove[0].posture.publish(posture);
  (*segment_)->glove[0].posture_state.publish(held);
  EXPECT_TRUE(read().scene.hand);
  EXPECT_STREQ(read().posture.data(), "fist");
  now_ += kStaleAfter + milliseconds(1);
  EXPECT_FALSE(read().scene.hand);
  EXPECT_STREQ(read().posture.data(), "");
}

TEST_F(DeviceFeedTest, GivesTheActionsOfDevicesThatWork) {
  push();
  shm::ActionState actions{};
  actions.generation = 7;
  const auto begin = [&](const char* name) {
    const auto at = static_cast<std::size_t>(
        std::find_if(kActions.begin(), kActions.end(),
                     [&](const char* a) { return std::string_view(a) == name; }) -
        kActions.begin());
    ++actions.begun[at];
    actions.held[at] = isHeldAction(name) ? 1 : 0;
    (*segment_)->actions[test::kBall].publish(actions);
  };
  begin("next_content");
  EXPECT_EQ(read().next_content, 0u) << "it began before the wall looked";
  for (const char* name :
       {"next_content", "previous_content", "previous_content", "snapshot", "snapshot",
        "reset_view", "next_mode", "blank", "freeze", "freeze", "grab", "fly", "point_at"})
    begin(name);
  const WallInput input = read();
  EXPECT_EQ(input.next_content, 1u);
  EXPECT_EQ(input.previous_content, 2u);
  EXPECT_EQ(input.snapshot, 2u);
  EXPECT_EQ(input.blank, 1u);
  EXPECT_EQ(input.freeze, 2u);
  EXPECT_EQ(input.scene.reset_view, 1u);
  EXPECT_EQ(input.scene.next_mode, 1u);
  EXPECT_TRUE(input.scene.grab && input.scene.fly && input.scene.point_at);
  EXPECT_EQ(read().snapshot, 0u) << "once";
  EXPECT_TRUE(read().scene.grab) << "as long as it is held";
  (*segment_)->health[test::kBall].publish(health(HealthState::kAbsent));
  now_ += kStaleAfter;
  EXPECT_FALSE(read().scene.grab) << "the ball is lost";
}

TEST_F(DeviceFeedTest, HeldMovesOfTwoDirectionsCancel) {
  shm::ActionState held{};
  const auto hold = [&](std::initializer_list<std::size_t> actions) {
    held = {};
    for (const std::size_t action : actions) held.held[action] = 1;
    (*segment_)->actions[test::kBall].publish(held);
    return read().scene.held;
  };
  push();
  EXPECT_FALSE(hold({}).moves());
  EXPECT_EQ(hold({actionIndex("move_left")}).right, -1);
  EXPECT_EQ(hold({actionIndex("move_right")}).right, 1);
  EXPECT_EQ(hold({actionIndex("move_up")}).up, 1);
  EXPECT_EQ(hold({actionIndex("move_down")}).up, -1);
  EXPECT_EQ(hold({actionIndex("turn_left")}).turn_right, -1);
  EXPECT_EQ(hold({actionIndex("turn_right")}).turn_right, 1);
  EXPECT_EQ(hold({actionIndex("turn_up")}).turn_up, 1);
  EXPECT_EQ(hold({actionIndex("turn_down")}).turn_up, -1);
  EXPECT_EQ(hold({actionIndex("roll_left")}).roll_right, -1);
  EXPECT_EQ(hold({actionIndex("roll_right")}).roll_right, 1);
  EXPECT_EQ(hold({actionIndex("zoom_in")}).nearer, 1);
  EXPECT_EQ(hold({actionIndex("zoom_out")}).nearer, -1);
  EXPECT_FALSE(hold({actionIndex("zoom_in"), actionIndex("zoom_out")}).moves());
}

TEST_F(DeviceFeedTest, WithoutADaemonThereIsNothing) {
  push();
  EXPECT_TRUE(read().scene.ball);
  now_ += seconds(2);  // two seconds pass without a heartbeat
  EXPECT_FALSE(feed_.read(now_).scene.ball);
}

TEST_F(DeviceFeedTest, ThePushOfTheBallIsTheCornersWhileThatIsHeld) {
  push();
  WallInput input = read();
  EXPECT_EQ(input.align.push, state::Offset{});
  EXPECT_EQ(input.scene.ball->translation[0], 1);
  shm::ActionState held{};
  held.held[actionIndex("align_push")] = 1;
  (*segment_)->actions[test::kBall].publish(held);
  now_ += milliseconds(50);
  input = read();
  EXPECT_NEAR(input.align.push.x, 3, 1e-9) << "60 pixels a second, for 50 ms";
  EXPECT_EQ(input.align.push.y, 0);
  EXPECT_EQ(input.scene.ball->translation[0], 0) << "the model stays";
  now_ += milliseconds(300);
  (*segment_)->ball[0].publish([&] {
    BallSample ball{};
    ball.received_ns = toNanoseconds(now_);
    ball.translation[1] = 0.5F;
    return ball;
  }());
  input = read();
  EXPECT_NEAR(input.align.push.y, -60 * 0.1 * 0.125, 1e-9) << "up, gently, and no jump";
}

// Only one of the two processes was updated, for example. The reason must be logged once, not at
// each attempt.
TEST_F(DeviceFeedTest, ASegmentWhoseSlotsAreNotOursIsNoDeviceAndIsReportedOnce) {
  initLog(LogLevel::kWarning);
  push();
  for (shm::Field& f : (*segment_)->fields) f.offset += 8;
  testing::internal::CaptureStderr();
  for (int attempt = 0; attempt < 3; ++attempt) {
    EXPECT_FALSE(read().scene.ball);
    now_ += seconds(1);
  }
  const std::string logged = testing::internal::GetCapturedStderr();
  EXPECT_NE(logged.find(name_ + ": its slot"), std::string::npos) << logged;
  EXPECT_EQ(logged.find(name_), logged.rfind(name_)) << logged;
  for (shm::Field& f : (*segment_)->fields) f.offset -= 8;
  for (auto& slot : (*segment_)->health) slot.publish(health(HealthState::kOk));
  EXPECT_TRUE(read().scene.ball);
}

TEST_F(DeviceFeedTest, AlignActionsArriveInTheirOrder) {
  read();
  shm::ActionState begun{};
  for (std::size_t i = 0; i < kAlignActionCount; ++i) {
    const auto* const action = std::ranges::find(kActions, std::string_view(kAlignActions[i]));
    begun.begun[action - kActions.begin()] = 1;
    begun.recent[i] = static_cast<std::uint8_t>(action - kActions.begin());
  }
  begun.sequence = kAlignActionCount;
  shm::ActionState none{};
  (*segment_)->actions[test::kBall].publish(none);
  read();
  (*segment_)->actions[test::kBall].publish(begun);
  const WallInput input = read();
  ASSERT_EQ(input.align.actions.size(), kAlignActionCount);
  for (std::size_t i = 0; i < kAlignActionCount; ++i) EXPECT_EQ(input.align.actions[i], i);
}

// While the ball controls the operator's panel, actions that are bound to the ball's buttons are
// not carried out.
TEST_F(DeviceFeedTest, ActionsOfTheBallAreLeftOutExceptThePanels) {
  const auto begin = [&](std::size_t source, std::uint32_t times) {
    shm::ActionState state{};
    state.begun[actionIndex("next_content")] = times;
    state.begun[actionIndex("operator_panel")] = times;
    state.held[actionIndex("fly")] = 1;
    (*segment_)->actions[source].publish(state);
  };
  push();
  begin(test::kBall, 0);
  begin(test::kPanel, 0);
  EXPECT_TRUE(read().scene.fly);
  feed_.leaveOutBall(true);
  begin(test::kBall, 3);
  (*segment_)->actions[test::kPanel].publish([&] {
    shm::ActionState state{};
    state.begun[actionIndex("next_content")] = 2;
    return state;
  }());
  const WallInput input = read();
  EXPECT_EQ(input.next_content, 2U) << "those of others remain";
  EXPECT_EQ(input.operator_panel, 3U);
  EXPECT_FALSE(input.scene.fly);
}

// The gestures of a hand belong to the hand's person, whichever person the tracker has.
TEST_F(DeviceFeedTest, AGesturesActionIsItsPersons) {
  FeedSettings two = settings();
  two.hands = {{"hand", "ben", "", {"", 2}}};
  two.devices = {{"ball", "ann"}, {"tracker", "ann"}};
  two.turn = seconds(3);
  const auto nextContents = [&](bool pushed) {
    DeviceFeed feed(name_, two);
    const auto read = [&](std::uint32_t times) {
      shm::ActionState state{};
      state.begun[actionIndex("next_content")] = times;
      (*segment_)->actions[shm::kFirstHandSource].publish(state);
      segment_->writeHeartbeat(now_);
      return feed.read(now_).next_content;
    };
    if (pushed) push();
    EXPECT_EQ(read(0), 0U);
    return read(1);
  };
  EXPECT_EQ(nextContents(false), 1U) << "nobody has the wall";
  EXPECT_EQ(nextContents(true), 0U) << "ann has the wall";
}

}  // namespace
}  // namespace merlin::wall
