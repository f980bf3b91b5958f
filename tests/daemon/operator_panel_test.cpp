// The operator's panel in merlind: what pointer and ball do to the wall, and which actions they
// request.
#include "daemon/wall/operator_panel.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"

namespace merlin::wall {
namespace {

using namespace render::panel;
using std::chrono::milliseconds;
using C = ControlId;

PanelOptions options() {
  PanelOptions o;
  o.contents = {{"scan", true}, {"map", false}};
  o.projectors = o.lamp = true;
  return o;
}

PanelPlace place() { return {{640, 480, 640, 480}, *layOutPanel(640, 480, 13, options())}; }

// A panel at the lower right of a frame, with a wall's segment but without a daemon and devices.
class OperatorPanelTest : public testing::Test {
 protected:
  OperatorPanelTest() {
    shm::WallStats stats{};
    stats.rate_asked_hz = 30;
    stats.budget = 14'321;
    std::strcpy(stats.mode, "object");
    wall_->stats.publish(stats);
    shm::WallContent content{};
    std::strcpy(content.name, "scan");
    std::strcpy(content.kind, "model");
    wall_->content.publish(content);
  }
  // Simulates a frame 20 ms after the last one; returns the part of the input that the scene
  // receives.
  WallInput frame() {
    clock_.advance(milliseconds(20));
    WallInput input = input_;
    panel_.update(input, clock_.now());
    attendance_.update(input, clock_.now());
    input_.operator_panel = 0;
    return input;
  }
  void frames(Duration time) {
    for (Duration t{}; t < time; t += milliseconds(20)) frame();
  }
  Point at(C id) const {
    const Rect panel = panel_.place().inFrame(), r = panel_.place().layout.find(id)->at;
    return {panel.x + r.x + r.width / 2, panel.y + r.y + r.height / 2};
  }
  void click(C id) {
    panel_.point(at(id), true);
    panel_.point(at(id), false);
  }
  std::vector<Request> requests() { return panel_.takeRequests(); }
  BallSample& ball() {
    return input_.scene.ball ? *input_.scene.ball : input_.scene.ball.emplace();
  }

  test::FakeClock clock_;
  std::unique_ptr<shm::WallSegment> wall_ = std::make_unique<shm::WallSegment>();
  Attendance attendance_{{}};
  MissingContents missing_{{}};
  WallInput input_;
  OperatorPanel panel_{
      place(),
      options(),
      {*wall_, wall_->panel, "/merlin-test-no-such-devices", 30, 2, attendance_, missing_, clock_}};
};

using Requests = std::vector<Request>;

TEST_F(OperatorPanelTest, ShowsTheWallsStateAndPublishesItsPlace) {
  frame();
  const PanelFacts& f = panel_.view().facts;
  EXPECT_EQ(f.content, "scan");
  EXPECT_EQ(f.rate_hz, 30);
  EXPECT_FALSE(f.rate_by_hand || f.detail_by_hand || f.flies || f.blank);
  EXPECT_EQ(f.detail, 14'000U) << "two digits, so that it stands still";
  EXPECT_EQ(f.projectors, "");
  const auto published = wall_->panel.read();
  ASSERT_TRUE(published);
  const Rect at = panel_.place().inFrame();
  EXPECT_EQ(published->x, at.x);
  EXPECT_EQ(published->height, at.height);
  EXPECT_EQ(published->by_ball, 0U);

  shm::WallStats stats{};
  stats.rate_asked_hz = 20;
  stats.held_cost = 12'345;
  std::strcpy(stats.mode, "fly");
  wall_->stats.publish(stats);
  panel_.report({"warming", true});
  frames(milliseconds(100));
  EXPECT_TRUE(f.rate_by_hand && f.detail_by_hand && f.flies);
  EXPECT_EQ(f.detail, 12'345U);
  EXPECT_EQ(f.projectors, "warming");
}

TEST_F(OperatorPanelTest, ShowsNoMoreDetailThanThePictureHas) {
  shm::WallStats stats{};
  stats.budget = 933'359, stats.full_cost = 2'400;
  wall_->stats.publish(stats);
  frame();
  EXPECT_EQ(panel_.view().facts.detail, 2'400U);
}

TEST_F(OperatorPanelTest, AClickAsksForACommandAndIsATouch) {
  frame();
  attendance_.toggleFreeze();
  frame();
  click(C::kRateMore);
  EXPECT_EQ(requests(), (Requests{{"rate", "40"}}));
  frame();
  EXPECT_EQ(attendance_.shown(), Attendance::Shown::kPicture);
  click(C::kProjectorsOn);
  click(C::kPicture);
  EXPECT_EQ(requests(), (Requests{{"projector_on"}, {"show", "map"}}));
  EXPECT_EQ(requests(), Requests{});
}

TEST_F(OperatorPanelTest, AClickMovesNothingAndAHeldArrowTurnsTheModel) {
  frame();
  click(C::kBlank);
  EXPECT_TRUE(frame().scene.step.turn_rad.isZero(0));
  panel_.point(at(C::kRight), true);
  WallInput moved = frame();
  EXPECT_NEAR(moved.scene.step.turn_rad.y(), 0.02, 1e-6);
  EXPECT_TRUE(moved.scene.step.way_m.isZero(0));
  panel_.point(at(C::kRight), false);
  EXPECT_TRUE(frame().scene.step.turn_rad.isZero(0));
  panel_.point(at(C::kNearer), true);
  moved = frame();
  EXPECT_NEAR(moved.scene.step.way_m.z(), 0.8 * 2 * 0.02, 1e-6);
  frames(milliseconds(1500));
  EXPECT_TRUE(frame().scene.step.way_m.isZero(0)) << "nobody was heard of";
}

// On a black wall nobody sees the panel, so the first click only makes the wall bright.
TEST_F(OperatorPanelTest, APressOnABlackPanelOnlyMakesItBright) {
  frame();
  attendance_.toggleBlank();
  frames(milliseconds(40));
  ASSERT_EQ(attendance_.shown(), Attendance::Shown::kBlank);
  click(C::kProjectorsOff);
  EXPECT_EQ(requests(), Requests{});
  frames(milliseconds(40));
  EXPECT_EQ(attendance_.shown(), Attendance::Shown::kPicture);
  click(C::kProjectorsOff);
  EXPECT_EQ(requests(), (Requests{{"projector_off"}}));
}

TEST_F(OperatorPanelTest, FreezeIsUndoneByItsOwnButton) {
  frame();
  click(C::kFreeze);
  EXPECT_EQ(requests(), (Requests{{"freeze"}}));
  attendance_.toggleFreeze();
  frames(milliseconds(200));
  EXPECT_TRUE(panel_.view().facts.frozen);
  click(C::kFreeze);
  EXPECT_EQ(requests(), (Requests{{"freeze"}}));
  frame();
  EXPECT_EQ(attendance_.shown(), Attendance::Shown::kFrozen) << "the press alone ended it";
}

TEST_F(OperatorPanelTest, TheBallWorksThePanelAndNotTheModel) {
  ball();
  input_.operator_panel = 1;
  frame();
  EXPECT_TRUE(panel_.takesBall());
  EXPECT_EQ(wall_->panel.read()->by_ball, 1U);
  frame();
  ball().translation[1] = -1;
  WallInput left = frame();
  EXPECT_EQ(left.scene.ball->translation[1], 0);
  EXPECT_EQ(panel_.view().selected, C::kDown);
  ball().translation[1] = 0;
  ball().buttons = 1;
  left = frame();
  EXPECT_NEAR(left.scene.step.turn_rad.x(), 0.02, 1e-6);
  ball().buttons = 0;
  frame();
  input_.operator_panel = 1;
  frame();
  EXPECT_FALSE(panel_.takesBall());
  EXPECT_EQ(wall_->panel.read()->by_ball, 0U);
  ball().translation[1] = 1;
  EXPECT_EQ(frame().scene.ball->translation[1], 1);
}

TEST_F(OperatorPanelTest, AVisitorLeavesByTheButtonLeave) {
  ball();
  panel_.toggleBall();
  frames(milliseconds(40));
  ASSERT_TRUE(panel_.takesBall());
  click(C::kBall);
  EXPECT_EQ(requests(), (Requests{{"operator_panel"}}));
  panel_.toggleBall();
  frame();
  EXPECT_FALSE(panel_.takesBall());
}

TEST_F(OperatorPanelTest, ABallThatIsLostLeavesAndOneThatIsNotThereDoesNotEnter) {
  ball();
  panel_.toggleBall();
  frame();
  ASSERT_TRUE(panel_.takesBall());
  input_.scene.ball.reset();
  frame();
  EXPECT_FALSE(panel_.takesBall());
  panel_.toggleBall();
  frames(milliseconds(200));
  EXPECT_FALSE(panel_.takesBall());
  EXPECT_EQ(panel_.view().facts.notice, "There is no ball that works.");
}

TEST_F(OperatorPanelTest, ThePushesOfTheBallOnThePanelAreTouches) {
  ball();
  panel_.toggleBall();
  frames(milliseconds(600));
  attendance_.toggleBlank();
  frames(milliseconds(40));
  ball().translation[0] = 1;
  frame();
  EXPECT_EQ(attendance_.shown(), Attendance::Shown::kPicture);
  EXPECT_EQ(panel_.view().selected, C::kReset) << "that touch only made it bright";
}

TEST_F(OperatorPanelTest, ARefusalIsShownForFifteenSeconds) {
  panel_.refuse("projector_on: they cool down");
  frames(milliseconds(120));
  EXPECT_EQ(panel_.view().facts.notice, "projector_on: they cool down");
  frames(std::chrono::seconds(15));
  EXPECT_EQ(panel_.view().facts.notice, "");
}

TEST(ProjectorsTogether, AreWhatTheyHaveInCommon) {
  EXPECT_EQ(together({}).power, "");
  const ProjectorsSeen same = together({{"on", true}, {"on", true}});
  EXPECT_EQ(same.power, "on");
  EXPECT_EQ(same.wanted, true);
  const ProjectorsSeen differ = together({{"on", true}, {"warming", true}, {"off", false}});
  EXPECT_EQ(differ.power, "mixed");
  EXPECT_EQ(differ.wanted, std::nullopt);
}

TEST(PanelOptionsOf, AWallOfAnotherMachinesDevicesWorksNoneOfThem) {
  Settings settings;
  settings.devices.gpio.chip = "gpiochip0";
  settings.devices.gpio.lamp_line = 3;
  EXPECT_TRUE(panelOptions(settings, {}).lamp);
  EXPECT_FALSE(panelOptions(settings, {}).projectors);
  settings.wall.input.endpoint = "tcp://lab:7000";
  EXPECT_FALSE(panelOptions(settings, {}).lamp);
}

}  // namespace
}  // namespace merlin::wall
