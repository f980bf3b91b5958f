// Whose input counts when several people act on the wall, and which of several devices is used.
#include "daemon/wall/turns.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "daemon/shm/fields.h"
#include "daemon/wall/device_feed.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Turns, WhoActsFirstHasTheWallUntilIdle) {
  Turns turns(seconds(3));
  Timestamp now{};
  EXPECT_FALSE(turns.update(now, {})) << "nobody";
  EXPECT_EQ(turns.update(now, {"ann", "bob"}), "ann");
  now += seconds(2);
  EXPECT_EQ(turns.update(now, {"bob"}), "ann") << "who only acted two seconds ago";
  EXPECT_EQ(turns.update(now, {"bob", "ann"}), "ann");
  now += seconds(2);
  EXPECT_EQ(turns.update(now, {"bob"}), "ann") << "the time counts from her last act";
  now += milliseconds(1000);
  EXPECT_EQ(turns.update(now, {"bob"}), "bob");
  now += seconds(3);
  EXPECT_FALSE(turns.update(now, {})) << "idle: anybody may take it";
}

// Two gloves, two balls and a tracker give two hands and two balls; each of two people has one hand
// and one ball.
class SeveralDevicesTest : public testing::Test {
 protected:
  static shm::SlotNames names() {
    return {{{"left", SampleKind::kGlove},
             {"right", SampleKind::kGlove},
             {"room", SampleKind::kTracker},
             {"desk", SampleKind::kBall},
             {"door", SampleKind::kBall},
             {"table", SampleKind::kTouch}},
            {"left_hand", "right_hand"}};
  }
  // `person_of_right`: the person of the right glove and hand, and of the ball at the door.
  static FeedSettings settings(const std::string& person_of_right) {
    FeedSettings settings;
    settings.hands = {{"left_hand", "", "left", {"room", 1}},
                      {"right_hand", person_of_right, "right", {"room", 2}}};
    settings.devices = {{"right", person_of_right}, {"door", person_of_right}};
    settings.stale_after = milliseconds(500);
    settings.turn = seconds(3);
    return settings;
  }
  void SetUp() override {
    auto made = shm::SegmentWriter<shm::DevicesSegment>::make(name_, shm::devicesFields(names()), 1,
                                                              now_, {});
    ASSERT_TRUE(made);
    segment_.emplace(*std::move(made));
  }
  WallInput read(DeviceFeed& feed) {
    segment_->writeHeartbeat(now_);
    for (std::size_t i = 0; i < names().devices.size(); ++i) {
      DeviceHealth well{};
      well.state = HealthState::kOk;
      well.since_ns = well.updated_ns = toNanoseconds(now_);
      (*segment_)->health[i].publish(well);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      GloveSample glove{};
      glove.received_ns = toNanoseconds(now_);
      (*segment_)->glove[i].samples.publish(glove);
      TrackerSample station{};
      station.received_ns = toNanoseconds(now_);
      station.station = static_cast<std::uint32_t>(i + 1);
      (*segment_)->tracker[0].stations[i].publish(station);
    }
    return feed.read(now_);
  }
  void push(std::size_t ball, float share) {
    BallSample sample{};
    sample.received_ns = toNanoseconds(now_);
    sample.translation[0] = share;
    (*segment_)->ball[ball].publish(sample);
  }
  static std::size_t indexOf(std::string_view action) {
    return static_cast<std::size_t>(std::ranges::find(kActions, action) - kActions.begin());
  }
  void begin(std::size_t device, std::string_view action) {
    shm::ActionState& state = states_[device];
    const std::size_t index = indexOf(action);
    ++state.begun[index];
    state.recent[state.sequence++ % std::size(state.recent)] = static_cast<std::uint8_t>(index);
    (*segment_)->actions[device].publish(state);
  }
  void hold(std::size_t device, bool held, std::string_view action = "grab") {
    shm::ActionState& state = states_[device];
    const std::size_t index = indexOf(action);
    state.held[index] = held ? 1 : 0;
    if (held) ++state.begun[index];
    (*segment_)->actions[device].publish(state);
  }

  enum : std::size_t { kLeft, kRight, kRoom, kDesk, kDoor, kTable };
  std::string name_ = shm::segmentName(test::privateName("several"), "devices");
  Timestamp now_ = SystemClock().now();
  std::optional<shm::SegmentWriter<shm::DevicesSegment>> segment_;
  std::array<shm::ActionState, 5> states_{};
};

TEST_F(SeveralDevicesTest, TheBallThatIsPushedCounts) {
  DeviceFeed feed(name_, settings(""));
  push(0, 0);
  push(1, 0.5F);
  EXPECT_EQ(read(feed).scene.ball->translation[0], 0.5F);
  push(1, 0);
  push(0, 0.25F);
  EXPECT_EQ(read(feed).scene.ball->translation[0], 0.25F);
}

TEST_F(SeveralDevicesTest, TheHandThatHoldsActsAndKeepsOn) {
  DeviceFeed feed(name_, settings(""));
  EXPECT_EQ(read(feed).scene.hand->station, 1u) << "the first, while none holds anything";
  hold(kRight, true);
  WallInput input = read(feed);
  EXPECT_TRUE(input.scene.grab);
  EXPECT_EQ(input.scene.hand->station, 2u);
  hold(kLeft, true);
  EXPECT_EQ(read(feed).scene.hand->station, 2u) << "a second hand does not take over";
  hold(kRight, false);
  input = read(feed);
  EXPECT_EQ(input.scene.hand->station, 1u);
  EXPECT_FALSE(input.scene.grab) << "let go, so that nothing jumps from one hand to the other";
  EXPECT_TRUE(read(feed).scene.grab) << "and grabbed anew";
}

TEST_F(SeveralDevicesTest, AHandThatGrabsMovesWhatAnotherPointsAt) {
  DeviceFeed feed(name_, settings(""));
  hold(kLeft, true, "point_at");
  WallInput input = read(feed);
  EXPECT_EQ(input.scene.hand->station, 1u);
  EXPECT_TRUE(input.scene.point_at);
  hold(kRight, true);
  read(feed);
  input = read(feed);
  EXPECT_EQ(input.scene.hand->station, 2u);
  EXPECT_TRUE(input.scene.grab);
  EXPECT_FALSE(input.scene.point_at) << "of the hand that grabs";
  ASSERT_EQ(input.scene.other_pointers.size(), 1u);
  EXPECT_EQ(input.scene.other_pointers[0].station, 1u);
}

TEST_F(SeveralDevicesTest, AlignmentsComeInTheirOrder) {
  DeviceFeed feed(name_, settings(""));
  hold(kDesk, false);  // actions that began before the first read are ignored
  read(feed);
  for (const char* name : {"align_left", "align_left", "align_corner_next", "align_undo"})
    begin(kDesk, name);
  EXPECT_EQ(read(feed).align.actions, (std::vector<std::uint8_t>{2, 2, 1, 6}));
  EXPECT_TRUE(read(feed).align.actions.empty());
}

TEST_F(SeveralDevicesTest, AnotherPersonsInputWaitsForItsTurn) {
  DeviceFeed feed(name_, settings("bob"));
  push(0, 1);
  EXPECT_EQ(read(feed).scene.ball->translation[0], 1);
  now_ += seconds(1);
  push(0, 0);
  push(1, 0.5F);
  hold(kRight, true);
  WallInput input = read(feed);
  EXPECT_EQ(input.scene.ball->translation[0], 0) << "bob pushes, and it is not his turn";
  EXPECT_FALSE(input.scene.grab);
  EXPECT_EQ(input.scene.hand->station, 1u);
  now_ += seconds(3);
  push(1, 0.5F);
  input = read(feed);
  EXPECT_EQ(input.scene.ball->translation[0], 0.5F);
  EXPECT_TRUE(input.scene.grab);
  EXPECT_EQ(input.scene.hand->station, 2u);
}

TEST_F(SeveralDevicesTest, WhoseTurnItIsNotMayStillPoint) {
  DeviceFeed feed(name_, settings("bob"));
  push(0, 1);
  states_[kRight].held[actionIndex("point_at")] = 1;
  (*segment_)->actions[kRight].publish(states_[kRight]);
  const WallInput input = read(feed);
  EXPECT_FALSE(input.scene.point_at);
  ASSERT_EQ(input.scene.other_pointers.size(), 1u);
  EXPECT_EQ(input.scene.other_pointers[0].station, 2u);
}

// Returns settings in which the right hand holds a wand, whose buttons are those of the ball at the
// door.
FeedSettings withWand(FeedSettings settings) {
  settings.hands[1].glove = "none";
  settings.hands[1].buttons = "door";
  return settings;
}

TEST_F(SeveralDevicesTest, AWandsButtonPointsWithItsOwnHand) {
  DeviceFeed feed(name_, withWand(settings("")));
  push(0, 0);
  push(1, 0);
  hold(kDoor, true, "point_at");
  WallInput input = read(feed);
  EXPECT_TRUE(input.scene.point_at);
  EXPECT_EQ(input.scene.hand->station, 2u);
  hold(kDoor, false, "point_at");
  hold(kDesk, true, "point_at");
  input = read(feed);
  EXPECT_TRUE(input.scene.point_at);
  EXPECT_EQ(input.scene.hand->station, 1u) << "no hand holds that ball: the first hand's";
}

TEST_F(SeveralDevicesTest, AWandPointsWhileAFistMovesTheModel) {
  DeviceFeed feed(name_, withWand(settings("")));
  push(1, 0);
  hold(kDoor, true, "point_at");
  hold(kLeft, true);
  WallInput input = read(feed);
  EXPECT_EQ(input.scene.hand->station, 1u);
  EXPECT_TRUE(input.scene.grab);
  EXPECT_FALSE(input.scene.point_at) << "by the other hand";
  ASSERT_EQ(input.scene.other_pointers.size(), 1u);
  EXPECT_EQ(input.scene.other_pointers[0].station, 2u);
  hold(kLeft, false);
  hold(kDoor, true);
  read(feed);
  input = read(feed);
  EXPECT_TRUE(input.scene.grab) << "a wand grabs, too";
  EXPECT_EQ(input.scene.hand->station, 2u);
}

TEST_F(SeveralDevicesTest, FingersMoveWhatIsShownAndTakeTheTurn) {
  FeedSettings settings_of_two = settings("bob");
  settings_of_two.devices.push_back({"table", "bob"});
  DeviceFeed feed(name_, settings_of_two);
  TouchSample touch{};
  touch.received_ns = toNanoseconds(now_);
  touch.aspect = 1;
  touch.fingers = 1;
  (*segment_)->touch[0].publish(touch);
  EXPECT_EQ(read(feed).scene.touch.fingers, 1u);
  touch.position[0][0] = 0.25F;
  (*segment_)->touch[0].publish(touch);
  push(0, 1);
  const WallInput input = read(feed);
  EXPECT_EQ(input.scene.touch.right, 0.25F);
  EXPECT_FALSE(input.scene.ball && input.scene.ball->translation[0] != 0)
      << "the ball of the other person waits";
}

TEST_F(SeveralDevicesTest, OnePersonsDevicesActTogether) {
  DeviceFeed feed(name_, settings(""));
  push(0, 1);
  hold(kRight, true);
  const WallInput input = read(feed);
  EXPECT_EQ(input.scene.ball->translation[0], 1);
  EXPECT_TRUE(input.scene.grab);
}

}  // namespace
}  // namespace merlin::wall
