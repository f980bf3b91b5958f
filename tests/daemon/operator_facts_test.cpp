// The facts that the operator's tile shows, as read from the wall's slots and the message board.
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "daemon/wall/operator_facts_reader.h"
#include "tests/support/fake_clock.h"

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Uses a wall's segment without a daemon and without devices.
class OperatorFactsTest : public testing::Test {
 protected:
  render::text::OperatorFacts read() { return reader_.read(clock_.now()); }

  // Adds a frame of a wall with 30 Hz that is complete `work` after its begin.
  void addFrame(Duration work, bool moving = true) {
    const Duration period = fromSeconds(1.0 / 30);
    shm::FrameTrace frame{};
    frame.begin_ns = toNanoseconds(clock_.now());
    frame.end_ns = toNanoseconds(clock_.now() + work);
    frame.deadline_ns = toNanoseconds(clock_.now() + period);
    frame.moving = moving ? 1 : 0;
    frame.late = moving && work > period ? 1 : 0;
    wall_->trace.publish(frame);
    clock_.advance(std::max(work, period));
  }

  test::FakeClock clock_;
  std::unique_ptr<shm::WallSegment> wall_ = std::make_unique<shm::WallSegment>();
  MessageBoard board_;
  OperatorFactsReader reader_{*wall_, "/merlin-test-no-such-devices", false, board_};
};

TEST_F(OperatorFactsTest, AWallWithoutAFrameHasNoFacts) {
  EXPECT_EQ(read(), render::text::OperatorFacts{});
}

TEST_F(OperatorFactsTest, RateDetailContentModeAndPostureComeFromTheSlots) {
  shm::WallStats stats{};
  stats.rate_asked_hz = 30, stats.rate_now_hz = 15, stats.rate_held_hz = 14.96F;
  stats.late_share_1min = 0.0123F;
  stats.cost = 12'034, stats.full_cost = 69'636, stats.budget = 14'000, stats.held_cost = 14'000;
  std::strcpy(stats.cost_unit, "triangles");
  std::strcpy(stats.mode, "fly");
  std::strcpy(stats.posture, "fist");
  wall_->stats.publish(stats);
  shm::WallContent content{};
  std::strcpy(content.name, "talk");
  std::strcpy(content.slide, "03.tif");
  wall_->content.publish(content);
  const auto facts = read();
  EXPECT_EQ(facts.rate_asked_hz, 30);
  EXPECT_EQ(facts.rate_now_hz, 15);
  EXPECT_EQ(facts.rate_held_hz, 15);
  EXPECT_EQ(facts.late_percent, 1.2);
  EXPECT_EQ(facts.cost, 12'034U);
  EXPECT_EQ(facts.full_cost, 69'636U);
  EXPECT_TRUE(facts.budget_by_hand);
  EXPECT_EQ(facts.cost_unit, "triangles");
  EXPECT_EQ(facts.mode, "moves the viewer");
  EXPECT_EQ(facts.posture, "fist");
  EXPECT_EQ(facts.content, "talk");
  EXPECT_EQ(facts.slide, "03.tif");
}

// The governor's budget is what the machine can draw, which may be more detail than the picture
// has.
TEST_F(OperatorFactsTest, OfASmallPictureTheBudgetIsAllOfItAndTheBallMovesThePicture) {
  shm::WallStats stats{};
  stats.cost = stats.full_cost = 2'400, stats.budget = 933'359;
  std::strcpy(stats.mode, "fly");
  wall_->stats.publish(stats);
  shm::WallContent content{};
  std::strcpy(content.kind, "picture");
  wall_->content.publish(content);
  EXPECT_EQ(read().budget, 2'400U);
  EXPECT_EQ(read().mode, "moves the picture");
  std::strcpy(content.kind, "panorama");
  wall_->content.publish(content);
  EXPECT_EQ(read().mode, "turns the view");
}

// The devices' role may not be running, but a wall that is to have no devices must not report them
// as missing.
TEST_F(OperatorFactsTest, DevicesAreMissingOnlyWhereThereAreToBeSome) {
  EXPECT_FALSE(read().devices_missing);
  OperatorFactsReader expecting(*wall_, "/merlin-test-no-such-devices", true, board_);
  EXPECT_TRUE(expecting.read(clock_.now()).devices_missing);
}

TEST_F(OperatorFactsTest, TheChartHasMovingFramesAndMarksTheLateOne) {
  shm::WallStats stats{};
  stats.rate_now_hz = 30;
  wall_->stats.publish(stats);
  for (int i = 0; i < 30; ++i) addFrame(milliseconds(20));
  addFrame(milliseconds(45));
  for (int i = 0; i < 60; ++i) addFrame(milliseconds(1), false);  // two seconds of standstill
  int shown = 0, late = 0;
  for (const render::text::ChartColumn& column : read().chart) {
    shown += column.percent > 0;
    late += column.late;
    EXPECT_TRUE(column.late || column.percent == 0 || column.percent == 60);
  }
  EXPECT_NEAR(shown, 21, 1);  // a second, in columns of 50 ms
  EXPECT_NEAR(late, 2, 1);
}

// 256 periods are kept; those that were overwritten before they were read are left out.
TEST_F(OperatorFactsTest, FramesThatWereOverwrittenAreLeftOut) {
  shm::WallStats stats{};
  stats.rate_now_hz = 30;
  wall_->stats.publish(stats);
  for (int i = 0; i < 1000; ++i) addFrame(milliseconds(20));
  int shown = 0;
  for (const render::text::ChartColumn& column : read().chart) shown += column.percent > 0;
  EXPECT_GT(shown, 160);  // 8.5 s of ten
}

TEST_F(OperatorFactsTest, AMessageIsStrongForAMinuteAndThenFadesInTenSeconds) {
  board_.add(clock_.now(), "output left failed");
  EXPECT_EQ(read().messages, (std::vector<render::text::MessageFact>{{"output left failed", 1}}));
  clock_.advance(seconds(60));
  EXPECT_EQ(read().messages.at(0).strength, 1);
  clock_.advance(seconds(5));
  EXPECT_EQ(read().messages.at(0).strength, 0.5F);
  clock_.advance(seconds(5));
  EXPECT_TRUE(read().messages.empty());
}

TEST_F(OperatorFactsTest, TheBoardKeepsTheLastFourTheNewestFirst) {
  for (const char* text : {"a", "b", "c", "d", "e", "e"}) board_.add(clock_.now(), text);
  std::string order;
  for (const auto& message : read().messages) order += message.text;
  EXPECT_EQ(order, "edcb");
}

TEST_F(OperatorFactsTest, TextsWithoutAnEndAreCut) {
  shm::WallContent content{};
  std::memset(content.name, 'x', sizeof content.name);
  content.name[sizeof content.name - 1] = '\xC3';  // half of a UTF-8 character
  wall_->content.publish(content);
  EXPECT_EQ(read().content, std::string(63, 'x'));
}

}  // namespace
}  // namespace merlin::wall
