// The operator's panel: what its controls request, where they are, and how they react to pointer
// and ball.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "render/panel/panel_input.h"

namespace merlin::render::panel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using C = ControlId;

PanelFacts someFacts() {
  PanelFacts f;
  f.content = "scan";
  f.rate_hz = 30;
  f.detail = 14'000, f.full_detail = 69'636;
  f.detail_unit = "triangles";
  return f;
}

PanelOptions someOptions() {
  PanelOptions o;
  o.contents = {{"scan", true}, {"map", false}, {"mug", true}, {"dome", false}};
  o.snapshots = o.projectors = o.video = o.lamp = true;
  return o;
}

std::optional<Request> request(C id, const PanelFacts& facts = someFacts()) {
  return requestOf(id, facts, someOptions());
}

TEST(PanelControls, StepTheRateAmongRatesThatPeopleUse) {
  PanelFacts f = someFacts();
  EXPECT_EQ(request(C::kRateLess, f), (Request{"rate", "25"}));
  EXPECT_EQ(request(C::kRateMore, f), (Request{"rate", "40"}));
  f.rate_hz = 33.3;
  EXPECT_EQ(request(C::kRateLess, f), (Request{"rate", "30"}));
  EXPECT_EQ(request(C::kRateMore, f), (Request{"rate", "40"}));
  f.rate_hz = 240;
  EXPECT_EQ(request(C::kRateMore, f), std::nullopt);
  f.rate_hz = 5;
  EXPECT_EQ(request(C::kRateLess, f), std::nullopt);
  EXPECT_EQ(request(C::kRateAuto, f), (Request{"rate", "auto"}));
}

TEST(PanelControls, StepTheDetailByAQuarterUpToAllOfIt) {
  PanelFacts f = someFacts();
  EXPECT_EQ(request(C::kDetailMore, f), (Request{"triangles", "18000"}));
  EXPECT_EQ(request(C::kDetailLess, f), (Request{"triangles", "11000"}));
  f.detail = 60'000;
  EXPECT_EQ(request(C::kDetailMore, f), (Request{"triangles", "69636"}));
  f.detail = 69'636;
  EXPECT_EQ(request(C::kDetailMore, f), std::nullopt);
  f.detail = 100;
  EXPECT_EQ(request(C::kDetailLess, f), std::nullopt);
  f.detail = 0;  // no frame has been drawn yet
  EXPECT_EQ(request(C::kDetailMore, f), std::nullopt);
  EXPECT_EQ(request(C::kDetailAuto, f), (Request{"triangles", "auto"}));
}

TEST(PanelControls, ModelAndPictureShowTheNextContentOfThatKind) {
  PanelFacts f = someFacts();
  EXPECT_EQ(request(C::kModel, f), std::nullopt) << "a model is shown";
  EXPECT_EQ(request(C::kPicture, f), (Request{"show", "map"}));
  f.content = "mug";
  EXPECT_EQ(request(C::kPicture, f), (Request{"show", "dome"}));
  f.content = "dome", f.kind = ShownKind::kPanorama;
  EXPECT_EQ(request(C::kModel, f), (Request{"show", "scan"}));
  PanelOptions models = someOptions();
  models.contents = {{"scan", true}};
  EXPECT_EQ(requestOf(C::kPicture, someFacts(), models), std::nullopt);
}

TEST(PanelControls, StepThroughContentsAndSlidesUnlessThereIsNoOther) {
  const std::optional<Request> next = Request{"next_content"},
                               previous = Request{"previous_content"};
  EXPECT_EQ(request(C::kPrevious), previous);
  EXPECT_EQ(request(C::kNext), next);
  PanelOptions one = someOptions();
  one.contents = {{"scan", true}};
  PanelFacts f = someFacts();
  EXPECT_EQ(requestOf(C::kPrevious, f, one), std::nullopt);
  EXPECT_EQ(requestOf(C::kNext, f, one), std::nullopt);
  f.content = "a file that is not in the configuration";
  EXPECT_EQ(requestOf(C::kPrevious, f, one), previous);
  EXPECT_EQ(requestOf(C::kNext, f, one), next);
  PanelFacts missing = someFacts();
  missing.missing = {"dome", "mug"};
  EXPECT_EQ(request(C::kPrevious, missing), previous);
  missing.missing = {"map", "dome", "mug"};
  EXPECT_EQ(request(C::kPrevious, missing), std::nullopt);
  EXPECT_EQ(request(C::kNext, missing), std::nullopt);
  EXPECT_EQ(request(C::kPicture, missing), std::nullopt);
  missing.missing = {"map"};
  EXPECT_EQ(request(C::kPicture, missing), (Request{"show", "dome"}));
  PanelFacts slides = someFacts();
  slides.slide = "03.tif";
  EXPECT_EQ(requestOf(C::kNext, slides, one), next);
  EXPECT_EQ(requestOf(C::kPrevious, slides, one), previous);
}

TEST(PanelControls, TheModeOfTheBallIsThatOfAModel) {
  PanelFacts f = someFacts();
  EXPECT_EQ(request(C::kMode, f), (Request{"next_mode"}));
  for (const auto kind : {ShownKind::kPicture, ShownKind::kPanorama}) {
    f.kind = kind;
    EXPECT_EQ(request(C::kMode, f), std::nullopt) << "it would change nothing";
  }
}

TEST(PanelControls, ShowTheStateThatTheyChange) {
  PanelFacts f = someFacts();
  const auto lit = [&](C id) { return isLit(id, f, false); };
  EXPECT_TRUE(lit(C::kModel) && !lit(C::kPicture) && lit(C::kRateAuto) && lit(C::kDetailAuto));
  EXPECT_FALSE(lit(C::kLampOff) || lit(C::kProjectorsOn) || lit(C::kProjectorsOff));
  f.kind = ShownKind::kPicture;
  f.rate_by_hand = f.detail_by_hand = f.blank = true;
  f.lamp = 2, f.video = 1, f.projectors_wanted = true;
  EXPECT_TRUE(lit(C::kPicture) && lit(C::kBlank) && lit(C::kLampFast) && lit(C::kVideoB));
  EXPECT_TRUE(lit(C::kProjectorsOn));
  EXPECT_FALSE(lit(C::kModel) || lit(C::kRateAuto) || lit(C::kDetailAuto) || lit(C::kLampOn) ||
               lit(C::kFreeze) || lit(C::kVideoA) || lit(C::kProjectorsOff));
}

TEST(PanelControls, ArrowsTurnAModelShiftAPictureAndLookAroundInAPanorama) {
  const auto right = [](ShownKind kind) { return motionOf(C::kRight, kind); };
  EXPECT_GT(right(ShownKind::kModel).turn_rad_s[1], 0);
  EXPECT_GT(right(ShownKind::kPicture).way_radii_s[0], 0);
  EXPECT_LT(right(ShownKind::kPanorama).turn_rad_s[1], 0);
  EXPECT_LT(motionOf(C::kUp, ShownKind::kModel).turn_rad_s[0], 0);
  for (const auto kind : {ShownKind::kModel, ShownKind::kPicture, ShownKind::kPanorama}) {
    EXPECT_GT(motionOf(C::kNearer, kind).way_radii_s[2], 0);
    EXPECT_EQ(motionOf(C::kReset, kind).turn_rad_s, (std::array<float, 3>{}));
  }
}

struct TileSize {
  int width, height, em;
};
constexpr TileSize kTiles[] = {{320, 240, 10},   {640, 480, 13},   {1024, 768, 21},
                               {1920, 1080, 30}, {3840, 2160, 60}, {400, 900, 25}};

bool isInside(const Rect& inner, const Rect& outer) {
  return text::common(inner, outer) == inner && inner.width > 0 && inner.height > 0;
}

TEST(PanelLayout, EveryControlIsOnThePanelOnceAndOverlapsNoOther) {
  for (const TileSize& tile : kTiles) {
    const auto layout = layOutPanel(tile.width, tile.height, tile.em, someOptions());
    ASSERT_TRUE(layout);
    EXPECT_TRUE(isInside(layout->at, {0, 0, tile.width, tile.height})) << tile.width;
    std::vector<Rect> all = {layout->notice};
    std::set<C> ids;
    for (const Button& button : layout->buttons) {
      EXPECT_TRUE(ids.insert(button.id).second);
      all.push_back(button.at);
    }
    for (const Field& field : layout->fields) all.push_back(field.at);
    EXPECT_EQ(ids.size(), 30U);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_TRUE(isInside(all[i], {0, 0, layout->at.width, layout->at.height})) << i;
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_EQ(text::common(all[i], all[j]).width * text::common(all[i], all[j]).height, 0);
    }
  }
}

TEST(PanelLayout, WhatAWallLacksHasNoControls) {
  PanelOptions none = someOptions();
  none.projectors = none.video = none.lamp = false;
  const auto layout = layOutPanel(640, 480, 13, none);
  for (const C id : {C::kLampOn, C::kProjectorsOn, C::kVideoA})
    EXPECT_EQ(layout->find(id), nullptr);
  EXPECT_NE(layout->find(C::kBlank), nullptr);
}

TEST(PanelLayout, ATileThatIsTooSmallHasNoPanel) {
  EXPECT_FALSE(layOutPanel(319, 240, 10, someOptions()));
  EXPECT_FALSE(layOutPanel(320, 239, 10, someOptions()));
}

TEST(PanelLayout, APointHitsTheButtonThatItIsOn) {
  const auto layout = *layOutPanel(640, 480, 13, someOptions());
  for (const Button& button : layout.buttons) {
    const int x = layout.at.x + button.at.x, y = layout.at.y + button.at.y;
    const auto hit = [&](int px, int py) {
      const Button* const found = buttonAt(layout, {px, py});
      return found && found->id == button.id;
    };
    EXPECT_TRUE(hit(x, y));
    EXPECT_TRUE(hit(x + button.at.width - 1, y + button.at.height - 1));
    EXPECT_FALSE(hit(x - 1, y));
    EXPECT_FALSE(hit(x + button.at.width, y));
    EXPECT_FALSE(hit(x, y + button.at.height));
  }
  EXPECT_EQ(buttonAt(layout, {0, 0}), nullptr);
  EXPECT_EQ(buttonAt(layout, {-2'000'000, 2'000'000}), nullptr);
}

TEST(PanelLayout, TheBallReachesEveryControlAndStaysAtTheEdge) {
  for (const TileSize& tile : kTiles) {
    const auto layout = *layOutPanel(tile.width, tile.height, tile.em, someOptions());
    std::set<C> reached = {C::kReset};
    for (std::size_t before = 0; before != reached.size();) {
      before = reached.size();
      for (const C id : std::set<C>(reached)) {
        for (const auto& [right, down] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          reached.insert(neighbourOf(layout, id, right, down));
      }
    }
    EXPECT_EQ(reached.size(), layout.buttons.size()) << tile.width;
    EXPECT_EQ(neighbourOf(layout, C::kReset, 0, 1), C::kDown);
    EXPECT_EQ(neighbourOf(layout, C::kReset, -1, 0), C::kLeft);
    EXPECT_EQ(neighbourOf(layout, C::kLeft, -1, 0), C::kLeft);
    EXPECT_EQ(neighbourOf(layout, C::kModel, 0, -1), C::kModel);
  }
}

class PanelInputTest : public testing::Test {
 protected:
  Point at(C id) const {
    const Rect& r = layout_.find(id)->at;
    return {layout_.at.x + r.x + r.width / 2, layout_.at.y + r.y + r.height / 2};
  }
  void point(C id, bool pressed) { input_.point(at(id), pressed, now_); }
  std::vector<C> acts() { return input_.takeActs(); }
  std::vector<C> after(Duration time) {
    now_ += time;
    input_.update(now_);
    return acts();
  }
  void ball(float right, float up, bool button = false) { input_.ball({right, up, button}, now_); }
  void enter() {
    input_.enterByBall(now_);
    ball(0, 0);
  }

  PanelLayout layout_ = *layOutPanel(640, 480, 13, someOptions());
  PanelInput input_{layout_};
  Timestamp now_{seconds(100)};
};

using Acted = std::vector<C>;

TEST_F(PanelInputTest, AClickActsWhenItIsReleasedOnItsControl) {
  point(C::kFreeze, false);
  EXPECT_EQ(input_.hovered(), C::kFreeze);
  EXPECT_EQ(input_.pressed(), std::nullopt);
  point(C::kFreeze, true);
  EXPECT_EQ(input_.pressed(), C::kFreeze);
  EXPECT_EQ(acts(), Acted{});
  point(C::kFreeze, false);
  EXPECT_EQ(acts(), Acted{C::kFreeze});
  EXPECT_EQ(input_.pressed(), std::nullopt);
}

TEST_F(PanelInputTest, DraggedAwayOrOntoAControlItDoesNothing) {
  point(C::kFreeze, true);
  point(C::kBlank, true);
  EXPECT_EQ(input_.pressed(), std::nullopt);
  point(C::kBlank, false);
  EXPECT_EQ(acts(), Acted{});
  input_.point({1, 1}, true, now_);
  point(C::kBlank, true);
  point(C::kBlank, false);
  EXPECT_EQ(acts(), Acted{});
}

TEST_F(PanelInputTest, AStepActsAtOnceAndRepeatsWhileItIsHeld) {
  point(C::kRateMore, true);
  EXPECT_EQ(acts(), Acted{C::kRateMore});
  EXPECT_EQ(after(milliseconds(490)), Acted{});
  EXPECT_EQ(after(milliseconds(10)), Acted{C::kRateMore});
  EXPECT_EQ(after(milliseconds(190)), Acted{});
  EXPECT_EQ(after(milliseconds(10)), Acted{C::kRateMore});
  point(C::kRateMore, false);
  EXPECT_EQ(after(milliseconds(1000)), Acted{});
}

TEST_F(PanelInputTest, AMotionLastsAsLongAsItIsHeldAndGivesNoCommand) {
  point(C::kLeft, true);
  EXPECT_EQ(after(milliseconds(1400)), Acted{});
  EXPECT_EQ(input_.pressed(), C::kLeft);
  point(C::kLeft, false);
  EXPECT_EQ(input_.pressed(), std::nullopt);
  EXPECT_EQ(acts(), Acted{});
}

TEST_F(PanelInputTest, APressThatIsNotHeardOfAnyMoreIsLetGo) {
  point(C::kLeft, true);
  after(milliseconds(1000));
  point(C::kLeft, true);
  after(milliseconds(1400));
  EXPECT_EQ(input_.pressed(), C::kLeft);
  after(milliseconds(100));
  EXPECT_EQ(input_.pressed(), std::nullopt);
}

TEST_F(PanelInputTest, APointerThatLeavesLetsGo) {
  point(C::kBlank, true);
  input_.leave();
  EXPECT_EQ(input_.hovered(), std::nullopt);
  point(C::kBlank, false);
  EXPECT_EQ(acts(), Acted{});
}

TEST_F(PanelInputTest, EachPushOfTheBallSelectsTheNextControl) {
  EXPECT_EQ(input_.selected(), std::nullopt);
  enter();
  EXPECT_EQ(input_.selected(), C::kReset);
  ball(0, -0.8F);
  EXPECT_EQ(input_.selected(), C::kDown);
  ball(0, -0.8F);
  EXPECT_EQ(input_.selected(), C::kDown) << "one push, one step";
  ball(0.05F, 0);
  ball(0, 0.8F);
  EXPECT_EQ(input_.selected(), C::kReset);
  ball(0, 0);
  ball(0.9F, 0.4F);
  EXPECT_EQ(input_.selected(), C::kRight) << "the stronger direction counts";
}

TEST_F(PanelInputTest, APushThatIsHeldGoesOnFromControlToControl) {
  enter();
  ball(0, -1);
  now_ += milliseconds(500);
  ball(0, -1);
  EXPECT_EQ(input_.selected(), C::kRateLess) << "below the arrow down";
}

TEST_F(PanelInputTest, TheBallsButtonPressesWhatIsSelected) {
  enter();
  ball(0, 0, true);
  EXPECT_EQ(acts(), Acted{C::kReset});
  EXPECT_EQ(input_.pressed(), C::kReset);
  ball(0, 0, true);
  EXPECT_EQ(acts(), Acted{}) << "once";
  ball(0, 0);
  ball(-1, 0);
  ball(0, 0, true);
  EXPECT_EQ(input_.pressed(), C::kLeft);
  ball(0, 1, true);
  EXPECT_EQ(input_.pressed(), C::kLeft);
  EXPECT_EQ(input_.selected(), C::kLeft) << "whoever presses the button moves the ball";
}

TEST_F(PanelInputTest, TheBallBeginsInTheMiddleWhereverItLeft) {
  enter();
  ball(0, -1);
  EXPECT_EQ(input_.selected(), C::kDown);
  input_.leaveByBall();
  EXPECT_EQ(input_.selected(), std::nullopt);
  enter();
  EXPECT_EQ(input_.selected(), C::kReset);
}

TEST_F(PanelInputTest, TheButtonThatEnteredPressesNothing) {
  input_.enterByBall(now_);
  ball(0, 0, true);
  EXPECT_EQ(acts(), Acted{});
  ball(0, 0);
  ball(0, 0, true);
  EXPECT_EQ(acts(), Acted{C::kReset});
}

TEST_F(PanelInputTest, ABallThatIsNotUsedForHalfAMinuteLeaves) {
  enter();
  after(seconds(29));
  ball(1, 0);
  after(seconds(29));
  EXPECT_TRUE(input_.byBall());
  after(seconds(1));
  EXPECT_FALSE(input_.byBall());
  EXPECT_EQ(input_.selected(), std::nullopt);
  ball(0, 0, true);
  EXPECT_EQ(acts(), Acted{});
}

// A client sends events without end, but the number of waiting requests is limited.
TEST_F(PanelInputTest, ActsThatNobodyTakesAreBounded) {
  for (int i = 0; i < 1000; ++i) {
    point(C::kBlank, true);
    point(C::kBlank, false);
  }
  EXPECT_LE(acts().size(), 16U);
}

}  // namespace
}  // namespace merlin::render::panel
