// The plates over the operator's tile: their places, their content, and that no pixels of them
// remain after they are erased.
#include "render/text/operator_overlay.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/text/font_file.h"
#include "render/text/notice_overlay.h"
#include "tests/support/fake_clock.h"

namespace merlin::render::text {
namespace {

using std::chrono::milliseconds;

class FakeSource final : public OperatorSource {
 public:
  OperatorFacts read(Timestamp) override {
    ++reads;
    return facts;
  }
  OperatorFacts facts;
  int reads = 0;
};

OperatorFacts someFacts() {
  OperatorFacts f;
  f.rate_asked_hz = f.rate_held_hz = f.rate_now_hz = 30;
  f.cost = 12'034, f.full_cost = 69'636, f.budget = 14'000;
  f.cost_unit = "triangles";
  f.content = "ankylosaurus", f.mode = "moves the model", f.posture = "fist";
  f.devices = {{"glove", "ok", DeviceLight::kGood}, {"ball", "absent", DeviceLight::kBad}};
  return f;
}

tiles::TilePlan planOf(int width, int height) {
  tiles::TilesSettings settings;
  settings.tile_width = width, settings.tile_height = height;
  settings.frame_width = 2 * width, settings.frame_height = 2 * height;
  settings.tiles = {{"left", tiles::TileKind::kWall, 0, 0, 1},
                    {"centre", tiles::TileKind::kWall, width, 0, 0},
                    {"right", tiles::TileKind::kWall, 0, height, -1},
                    {"operator", tiles::TileKind::kOperator, width, height, 0}};
  return *tiles::planTiles(settings);
}

// A frame of noise, and an overlay that draws on it.
struct Wall {
  explicit Wall(int width = 640, int height = 480)
      : plan(planOf(width, height)),
        overlay(*OperatorOverlay::make(plan, source, clock)),
        canvas(static_cast<std::size_t>(4 * plan.frame_width * plan.frame_height)) {
    source.facts = someFacts();
    for (std::size_t i = 0; i < canvas.size(); ++i)
      canvas[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 2654435761U >> 7);
    before = canvas;
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(4 * (y * plan.frame_width + x));
  }
  // Returns the number of pixels of a tile in the canvas that differ from the picture.
  int changedIn(std::size_t tile) const {
    const tiles::Tile& t = plan.tiles[tile];
    int changed = 0;
    for (int y = t.y; y < t.y + t.height; ++y) {
      for (int x = t.x; x < t.x + t.width; ++x)
        changed += !std::equal(&canvas[at(x, y)], &canvas[at(x, y)] + 4, &before[at(x, y)]);
    }
    return changed;
  }

  test::FakeClock clock;
  FakeSource source;
  tiles::TilePlan plan;
  std::unique_ptr<OperatorOverlay> overlay;
  std::vector<std::uint8_t> canvas, before;
};

TEST(OperatorOverlay, DrawsOverTheOperatorsTileAlone) {
  Wall wall;
  wall.overlay->draw(wall.canvas);
  EXPECT_GT(wall.changedIn(3), 50'000);
  for (std::size_t tile = 0; tile < 3; ++tile) EXPECT_EQ(wall.changedIn(tile), 0) << tile;
}

TEST(OperatorOverlay, LeavesMoreThanHalfOfTheTileToThePicture) {
  for (const auto& [width, height] : {std::pair{640, 480}, {1920, 1080}, {1024, 768}}) {
    Wall wall(width, height);
    wall.source.facts.messages = {{"a message", 1}};
    wall.overlay->draw(wall.canvas);
    EXPECT_LT(wall.changedIn(3), width * height / 2) << width;
  }
}

TEST(OperatorOverlay, EraseRestoresEachByte) {
  Wall wall;
  wall.source.facts.messages = {{"output left failed: no display", 1}, {"an older one", 0.5F}};
  for (int i = 0; i < 3; ++i) {
    wall.overlay->draw(wall.canvas);
    EXPECT_NE(wall.canvas, wall.before);
    wall.overlay->erase(wall.canvas);
    EXPECT_EQ(wall.canvas, wall.before);
    wall.clock.advance(milliseconds(200));
    wall.source.facts.messages.push_back({"more", 1});
  }
}

// The smallest tile with plates has 320 x 240 pixels; there the two plates overlap.
TEST(OperatorOverlay, EraseRestoresWhereThePlatesOverlap) {
  Wall wall(320, 240);
  for (int i = 0; i < 4; ++i)
    wall.source.facts.messages.push_back({"a long message that overlaps the other plate", 1});
  wall.overlay->draw(wall.canvas);
  EXPECT_NE(wall.canvas, wall.before);
  wall.overlay->erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
}

TEST(OperatorOverlay, ATileThatIsTooSmallHasNoPlates) {
  Wall wall(319, 240);
  EXPECT_FALSE(wall.overlay->hasChanged());
  wall.overlay->draw(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
  wall.overlay->erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
}

TEST(OperatorOverlay, ReadsTheFactsAtMostTenTimesASecond) {
  Wall wall;
  for (int frame = 0; frame < 120; ++frame) {  // at 120 Hz, for a second
    wall.source.facts.budget += 100;
    wall.overlay->draw(wall.canvas);
    wall.overlay->erase(wall.canvas);
    wall.clock.advance(fromSeconds(1.0 / 120));
  }
  EXPECT_EQ(wall.source.reads, 10);
}

TEST(OperatorOverlay, AWallThatStandsIsPresentedAnewOnlyIfTheFactsDiffer) {
  Wall wall;
  EXPECT_TRUE(wall.overlay->hasChanged());  // the overlay was never drawn
  wall.overlay->draw(wall.canvas);
  wall.overlay->erase(wall.canvas);
  for (int period = 0; period < 120; ++period) {
    wall.clock.advance(fromSeconds(1.0 / 60));
    EXPECT_FALSE(wall.overlay->hasChanged());
  }
  EXPECT_LE(wall.source.reads, 5);
  wall.source.facts.posture = "flat";
  wall.clock.advance(milliseconds(500));
  EXPECT_TRUE(wall.overlay->hasChanged());
}

// The last frame before a standstill, for example the first frame of another content, may follow
// the frame before so soon that the facts are not read for it.
TEST(OperatorOverlay, WhatTheLastFrameDidNotReadIsLookedAtSoonAfterIt) {
  Wall wall;
  wall.overlay->draw(wall.canvas);
  wall.overlay->erase(wall.canvas);
  wall.clock.advance(milliseconds(50));
  wall.source.facts.content = "meadow";
  wall.overlay->draw(wall.canvas);
  wall.overlay->erase(wall.canvas);
  EXPECT_FALSE(wall.overlay->hasChanged()) << "at most ten times a second";
  wall.clock.advance(milliseconds(50));
  EXPECT_TRUE(wall.overlay->hasChanged());
  wall.overlay->draw(wall.canvas);
  wall.overlay->erase(wall.canvas);
  wall.source.facts.posture = "flat";
  wall.clock.advance(milliseconds(450));
  EXPECT_FALSE(wall.overlay->hasChanged()) << "then twice a second again";
}

TEST(OperatorOverlay, IsHiddenAndShownFromTheNextFrameOn) {
  Wall wall;
  wall.overlay->draw(wall.canvas);
  wall.overlay->erase(wall.canvas);
  wall.overlay->show(false);
  EXPECT_TRUE(wall.overlay->hasChanged());
  wall.overlay->draw(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
  wall.overlay->erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
  EXPECT_FALSE(wall.overlay->hasChanged());
  wall.overlay->show(true);
  EXPECT_TRUE(wall.overlay->hasChanged());
}

TEST(OperatorOverlay, WhatIsBeneathIsStillSeen) {
  Wall bright, dark;
  std::ranges::fill(bright.canvas, std::uint8_t{255});
  std::fill(dark.canvas.begin(), dark.canvas.end(), std::uint8_t{0});
  bright.overlay->draw(bright.canvas);
  dark.overlay->draw(dark.canvas);
  const std::size_t corner = bright.at(640 + 8, 480 + 8);  // a pixel of the plate without text
  EXPECT_GT(bright.canvas[corner], dark.canvas[corner] + 50);
  EXPECT_LT(bright.canvas[corner], 100);  // dark enough for white text
}

TEST(OperatorOverlay, AnyTextStaysOnItsPlate) {
  Wall wall;
  OperatorFacts& f = wall.source.facts;
  const std::string hostile = "\xFF\xC0\xE2\x82\x1B[31m" + std::string(5000, 'W');
  f.content = f.slide = f.mode = f.posture = f.cost_unit = hostile;
  f.devices.assign(40, {hostile, hostile, DeviceLight::kBad});
  f.messages.assign(40, {hostile, 1});
  f.rate_asked_hz = 1e300, f.rate_held_hz = -1e300, f.late_percent = 1e300;
  wall.overlay->draw(wall.canvas);
  for (std::size_t tile = 0; tile < 3; ++tile) EXPECT_EQ(wall.changedIn(tile), 0) << tile;
  wall.overlay->erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
}

// Returns the number of red pixels of the plates. With these facts, only the bars of late frames
// are red.
int redPixels(const OperatorFacts& facts) {
  const int sizes[] = {13, 20};
  const GlyphAtlas atlas = *GlyphAtlas::make(fontFile(), sizes);
  int red = 0;
  for (const Plate& plate : drawPlates(facts, {{&atlas, 0}, {&atlas, 1}}, {0, 0, 640, 480})) {
    for (std::size_t i = 0; i < plate.rgba.size(); i += 4)
      red += plate.rgba[i] > 200 && plate.rgba[i + 1] < 120 && plate.rgba[i + 2] < 120;
  }
  return red;
}

TEST(OperatorPlate, ALateFrameIsRedInTheChart) {
  OperatorFacts facts = someFacts();
  facts.devices.pop_back();  // removes the device whose dot is red
  for (ChartColumn& column : facts.chart) column = {60, false};
  EXPECT_EQ(redPixels(facts), 0);
  facts.chart[100] = {140, true};
  EXPECT_NEAR(redPixels(facts), 52, 8);  // a column of 70 % of the chart's height, one pixel wide
}

TEST(FrameChart, AFrameIsSeenInTheColumnsOfItsPeriod) {
  FrameChart chart;
  const Timestamp began{std::chrono::seconds(1000)};
  const Duration period = milliseconds(100);
  chart.add({began, began + milliseconds(60), began + period, period, false});
  const auto columns = chart.at(began + milliseconds(149));
  EXPECT_EQ(columns[kChartColumns - 3], (ChartColumn{60, false}));
  EXPECT_EQ(columns[kChartColumns - 2], (ChartColumn{60, false}));
  EXPECT_EQ(columns[kChartColumns - 1], ChartColumn{});
  EXPECT_EQ(columns[kChartColumns - 4], ChartColumn{});
}

TEST(FrameChart, ALateFrameIsMarkedAndTheLongestOfAColumnCounts) {
  FrameChart chart;
  const Timestamp began{std::chrono::seconds(1000)};
  const Duration period = milliseconds(10);
  for (int i = 0; i < 5; ++i) {
    const Timestamp at = began + i * period;
    const bool late = i == 2;
    chart.add({at, at + milliseconds(late ? 15 : 5), at + period, period, late});
  }
  const auto columns = chart.at(began);
  EXPECT_EQ(columns[kChartColumns - 1], (ChartColumn{150, true}));
}

TEST(FrameChart, AfterTenSecondsAFrameIsGone) {
  FrameChart chart;
  const Timestamp began{std::chrono::seconds(1000)};
  chart.add({began, began + milliseconds(20), began + milliseconds(33), milliseconds(33), false});
  EXPECT_EQ(chart.at(began + milliseconds(9950))[0].percent, 61);
  EXPECT_EQ(chart.at(began + milliseconds(10'000)), FrameChart::Columns{});
}

// A frame that takes a minute, a period of zero, times before the clock's origin.
TEST(FrameChart, AnyTimesAreAccepted) {
  FrameChart chart;
  const Timestamp began{std::chrono::seconds(1000)};
  chart.add(
      {began, began + std::chrono::seconds(60), began + milliseconds(33), milliseconds(33), true});
  const auto columns = chart.at(began + std::chrono::seconds(60) - Duration(1));
  EXPECT_TRUE(std::ranges::all_of(columns, [](const ChartColumn& c) {
    return c == ChartColumn{255, true};
  }));
  chart.add({began, began, began, Duration::zero(), false});
  chart.add({Timestamp(milliseconds(-50)), began, began, milliseconds(33), false});
}

TEST(NoticeOverlay, IsOverTheFirstTileOfTheWallForAWhile) {
  Wall wall;
  NoticeOverlay notice(wall.plan, wall.clock);
  EXPECT_FALSE(notice.hasChanged());
  ASSERT_TRUE(notice.show("Reading scan.pgm: 45 %", wall.clock.now() + milliseconds(5000)));
  EXPECT_TRUE(notice.hasChanged());
  notice.draw(wall.canvas);
  EXPECT_FALSE(notice.hasChanged());
  EXPECT_GT(wall.changedIn(0), 5'000);
  EXPECT_LT(wall.changedIn(0), 640 * 480 / 20) << "a small plate";
  for (std::size_t tile = 1; tile < 4; ++tile) EXPECT_EQ(wall.changedIn(tile), 0) << tile;
  notice.erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);

  wall.clock.advance(milliseconds(4999));
  EXPECT_FALSE(notice.hasChanged());
  ASSERT_TRUE(notice.show("Reading scan.pgm: 46 %", wall.clock.now() + milliseconds(5000)));
  EXPECT_TRUE(notice.hasChanged()) << "another sentence";
  notice.draw(wall.canvas);
  notice.erase(wall.canvas);
  wall.clock.advance(milliseconds(5000));
  EXPECT_TRUE(notice.hasChanged()) << "its time is over";
  notice.draw(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
  EXPECT_FALSE(notice.hasChanged());
}

TEST(NoticeOverlay, ALongSentenceEndsInTheTileAndAnEmptyOneEndsIt) {
  Wall wall;
  NoticeOverlay notice(wall.plan, wall.clock);
  const Timestamp until = wall.clock.now() + milliseconds(5000);
  ASSERT_TRUE(notice.show(std::string(150, 'W'), until));
  notice.draw(wall.canvas);
  EXPECT_GT(wall.changedIn(0), 15'000);
  EXPECT_EQ(wall.changedIn(1), 0);
  notice.erase(wall.canvas);
  ASSERT_TRUE(notice.show("", until));
  notice.draw(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
}

}  // namespace
}  // namespace merlin::render::text
