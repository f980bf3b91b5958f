// Test cards, checked by single pixels and counts of pixels, and the overlay that shows them.
#include <array>
#include <bit>

#include <gtest/gtest.h>

#include "render/testcard/area.h"
#include "render/testcard/card_overlay.h"
#include "render/testcard/card_tiles.h"
#include "render/testcard/font.h"

namespace merlin::render::testcard {
namespace {

using Rgb = std::array<int, 3>;
constexpr Rgb kNone = {9, 9, 9};  // the canvas before anything is drawn
const Rgb kBlackPixel = {0, 0, 0}, kWhitePixel = {255, 255, 255};

// A canvas with one tile of 320 x 240 pixels at (10, 20).
struct Canvas {
  static constexpr int kWidth = 340, kHeight = 270, kX = 10, kY = 20, kTileWidth = 320,
                       kTileHeight = 240;
  Rgb at(int x, int y) const {
    const auto i = static_cast<std::size_t>(4 * (y * kWidth + x));
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
  Rgb inTile(int x, int y) const { return at(kX + x, kY + y); }

  std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(4 * kWidth * kHeight, 9);
};

testcard::CardTile tile() {
  return {"left", Canvas::kX, Canvas::kY, Canvas::kTileWidth, Canvas::kTileHeight};
}

Canvas drawn(testcard::Card card, testcard::CardTile t = tile(),
             std::optional<testcard::MarkedCorner> mark = {}) {
  Canvas canvas;
  testcard::drawCard(card, std::vector{std::move(t)}, mark, canvas.pixels, Canvas::kWidth);
  return canvas;
}

TEST(TestCard, EachFillsItsTileAndNothingElse) {
  for (std::size_t card = 0; card < testcard::kCards; ++card) {
    const Canvas c = drawn(static_cast<testcard::Card>(card));
    EXPECT_EQ(testcard::cardNamed(testcard::kCardNames[card]), static_cast<testcard::Card>(card));
    for (int y = 0; y < Canvas::kHeight; ++y) {
      for (int x = 0; x < Canvas::kWidth; ++x) {
        const bool inside = x >= Canvas::kX && x < Canvas::kX + Canvas::kTileWidth &&
                            y >= Canvas::kY && y < Canvas::kY + Canvas::kTileHeight;
        const auto alpha = static_cast<std::size_t>(4 * (y * Canvas::kWidth + x) + 3);
        ASSERT_EQ(c.pixels[alpha], inside ? 255 : 9)
            << testcard::kCardNames[card] << " " << x << " " << y;
      }
    }
  }
  EXPECT_FALSE(testcard::cardNamed("off"));
}

TEST(TestCard, CardsOfTinyAndOddTilesStayInside) {
  for (std::size_t card = 0; card < testcard::kCards; ++card) {
    for (const auto& [w, h] : {std::pair{16, 16}, std::pair{17, 231}, std::pair{320, 16}}) {
      const Canvas c =
          drawn(static_cast<testcard::Card>(card), {"a long name", 10, 20, w, h, {"line"}, 9, 9});
      EXPECT_EQ(c.at(9, 20), kNone);
      EXPECT_EQ(c.at(10 + w, 20), kNone);
      EXPECT_EQ(c.at(10, 20 + h), kNone);
      EXPECT_NE(c.at(9 + w, 19 + h), kNone);
    }
  }
}

TEST(TestCard, TheGridReachesTheBorderAndItsCirclesAreRound) {
  const Canvas c = drawn(testcard::Card::kGrid);
  for (int x = 0; x < 320; ++x) {
    EXPECT_EQ(c.inTile(x, 0), kWhitePixel);
    EXPECT_EQ(c.inTile(x, 239), kWhitePixel);
  }
  EXPECT_EQ(c.inTile(1, 11), kBlackPixel) << "one pixel wide";
  // The 17 lines cover 319 pixels from the first to the last.
  EXPECT_EQ(c.inTile(20, 10), (Rgb{200, 200, 200}));
  EXPECT_EQ(c.inTile(40, 10), (Rgb{200, 200, 200}));
  EXPECT_EQ(c.inTile(30, 11), kBlackPixel);
  // The middle lies between two pixels in each direction.
  for (const int x : {159, 160}) EXPECT_EQ(c.inTile(x, 5), (Rgb{0, 255, 0}));
  for (const int y : {119, 120}) EXPECT_EQ(c.inTile(5, y), (Rgb{0, 255, 0}));
  // A circle of radius 120 passes these points, at 45 degrees on all four sides.
  const int d = 84;  // 120 / sqrt 2, the pixel before
  for (const int x : {159 - d, 160 + d}) {
    for (const int y : {119 - d, 120 + d}) EXPECT_EQ(c.inTile(x, y), kWhitePixel) << x << " " << y;
  }
}

TEST(TestCard, EdgesShowStripsOfOverlapAndWhichCornerIsWhich) {
  testcard::CardTile t = tile();
  t.right = 96;
  t.top = 10;
  const Canvas c = drawn(testcard::Card::kEdges, t);
  EXPECT_EQ(c.inTile(0, 100), kWhitePixel);
  EXPECT_EQ(c.inTile(1, 100), kBlackPixel) << "the border is one pixel wide";
  EXPECT_EQ(c.inTile(319, 100), kWhitePixel);
  EXPECT_EQ(c.inTile(223, 180), kBlackPixel);
  EXPECT_EQ(c.inTile(224, 180), (Rgb{255, 0, 255})) << "the first pixel of the strip";
  EXPECT_EQ(c.inTile(225, 180), (Rgb{70, 0, 70}));
  EXPECT_EQ(c.inTile(100, 9), (Rgb{255, 0, 255}));
  EXPECT_EQ(c.inTile(100, 10), kBlackPixel);
  EXPECT_EQ(c.inTile(2, 2), (Rgb{255, 0, 0}));
  EXPECT_EQ(c.inTile(317, 2), (Rgb{0, 255, 0}));
  EXPECT_EQ(c.inTile(2, 237), (Rgb{0, 0, 255}));
  EXPECT_EQ(c.inTile(317, 237), (Rgb{255, 255, 0}));
}

TEST(TestCard, RampsGoFromZeroToFull) {
  const Canvas c = drawn(testcard::Card::kRamps);
  for (const auto& [x, value] : {std::pair{0, 0}, std::pair{160, 128}, std::pair{319, 255}}) {
    EXPECT_EQ(c.inTile(x, 20), (Rgb{value, value, value}));
    EXPECT_EQ(c.inTile(x, 60), (Rgb{value, 0, 0}));
    EXPECT_EQ(c.inTile(x, 100), (Rgb{0, value, 0}));
    EXPECT_EQ(c.inTile(x, 140), (Rgb{0, 0, value}));
  }
  EXPECT_EQ(c.inTile(0, 180), kBlackPixel);
  EXPECT_EQ(c.inTile(160, 180)[0], 127) << "the ninth of 17 steps";
  EXPECT_EQ(c.inTile(319, 180), kWhitePixel);
  EXPECT_EQ(c.inTile(30, 220), (Rgb{2, 2, 2}));
  EXPECT_EQ(c.inTile(319, 220), kWhitePixel);
  EXPECT_EQ(c.inTile(290, 220), (Rgb{253, 253, 253}));
}

// Returns one of two projectors with 320 pixels over 1.6 m each. They overlap by 0.3 m, which is
// not a whole number of cells.
testcard::CardTile projector(double left_m) {
  testcard::CardTile t = tile();
  t.part = {left_m, 0, 1.6, 1.2, 2.9, 1.2};
  return t;
}

TEST(TestCard, LinesAndRampsOfTilesThatOverlapLieOnOneAnother) {
  const double pixel_m = 1.6 / 320;
  const auto places = [&](double left_m) {  // places of the lines within the overlap [m]
    const Canvas c = drawn(testcard::Card::kGrid, projector(left_m));
    std::vector<double> found;
    for (int x = 1; x < 319; ++x) {
      const double at = left_m + (x + 0.5) * pixel_m;
      if (c.inTile(x, 3) == Rgb{200, 200, 200} && at > 1.31 && at < 1.59) found.push_back(at);
    }
    return found;
  };
  const auto left = places(0), right = places(1.3);
  ASSERT_GE(left.size(), 2u);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], pixel_m);
  const Canvas ramp = drawn(testcard::Card::kRamps, projector(0)),
               next = drawn(testcard::Card::kRamps, projector(1.3));
  EXPECT_EQ(ramp.inTile(0, 20)[0], 0);
  EXPECT_EQ(next.inTile(319, 20)[0], 255);
  for (int x = 0; x < 60; ++x) {
    for (const int y : {20, 60, 180, 220})
      EXPECT_NEAR(ramp.inTile(260 + x, y)[0], next.inTile(x, y)[0], 1) << x;
  }
}

TEST(TestCard, CirclesAreRoundOnTheScreenAlsoIfItsPixelsAreNotSquare) {
  testcard::CardTile half = tile();
  half.part = {0, 0, 3.2, 1.2, 3.2, 1.2};  // pixels twice as wide as high
  const Canvas c = drawn(testcard::Card::kGrid, half);
  for (const int x : {100, 219}) {  // 0.6 m from the middle, 0.01 m a pixel
    EXPECT_EQ(c.inTile(x, 119), kWhitePixel) << "left and right of the middle";
  }
  EXPECT_EQ(c.inTile(150, 2), kWhitePixel) << "and 117 pixels above it";
}

int count(const Canvas& c, const Rgb& colour, int top, int bottom) {
  int found = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = 1; x < 319; ++x) found += c.inTile(x, y) == colour ? 1 : 0;
  }
  return found;
}

TEST(TestCard, NamesAreAsLargeAsTheTileAllowsAndHaveTheirLinesBelow) {
  testcard::CardTile t = tile();
  t.lines = {"output beamer 1", "320 x 240"};
  const Canvas c = drawn(testcard::Card::kNames, t);
  // Each of the 4 characters of "left" is 8 font pixels wide, and the name may take 80 % of 320
  // pixels, so each font pixel becomes 8 pixels wide and high.
  int pixels = 0;
  for (const char letter : t.name) {
    for (const std::uint8_t row : testcard::glyph(letter)) pixels += std::popcount(row);
  }
  EXPECT_EQ(count(c, kWhitePixel, 40, 140), pixels * 8 * 8);
  EXPECT_GT(count(c, {220, 220, 220}, 144, 239), 500);
  EXPECT_EQ(c.inTile(5, 5), (Rgb{70, 20, 20}));
}

TEST(TestCard, FocusHasSinglePixelsNextToEachOther) {
  const Canvas c = drawn(testcard::Card::kFocus);
  const int y = 120, x = 26 * 5 / 4;  // in the left column, which is chequered
  EXPECT_NE(c.inTile(x, y), c.inTile(x + 1, y));
  EXPECT_NE(c.inTile(x, y), c.inTile(x, y + 1));
  EXPECT_EQ(c.inTile(x, y), c.inTile(x + 1, y + 1));
  EXPECT_NE(c.inTile(160, 30), c.inTile(161, 30)) << "columns";
  EXPECT_EQ(c.inTile(160, 30), c.inTile(160, 31));
  EXPECT_EQ(c.inTile(160, 210), c.inTile(161, 210)) << "rows";
  EXPECT_NE(c.inTile(160, 210), c.inTile(160, 211));
  const int star = count(c, kWhitePixel, 95, 145);
  EXPECT_GT(star, 1000);
}

TEST(TestCard, TheCornerThatIsMovedIsMarked) {
  constexpr Rgb kMark = {255, 90, 0};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Canvas c = drawn(testcard::Card::kGrid, tile(), testcard::MarkedCorner{0, corner});
    for (std::size_t i = 0; i < 4; ++i) {
      const int x = i % 2 ? 317 : 2, y = i / 2 ? 237 : 2;
      EXPECT_EQ(c.inTile(x, y) == kMark, i == corner) << corner << " " << i;
    }
  }
  EXPECT_NE(drawn(testcard::Card::kRamps, tile(), testcard::MarkedCorner{0, 0}).inTile(2, 2),
            kMark);
  EXPECT_NE(drawn(testcard::Card::kGrid, tile(), testcard::MarkedCorner{1, 0}).inTile(2, 2), kMark)
      << "another tile's";
}

TEST(Font, ABoxStandsForWhatIsNoCharacter) {
  EXPECT_EQ(testcard::glyph(' ')[0], 0);
  EXPECT_EQ(testcard::glyph('A')[0], 0x0C);
  EXPECT_EQ(testcard::glyph('~')[0], 0x6E);
  for (const char c : {'\n', '\x7f', '\xc3'}) EXPECT_EQ(testcard::glyph(c)[0], 0x7F);
}

// A plan of two tiles; each test arranges the left one on the wall's first output in its own way.
class CardTiles : public testing::Test {
 protected:
  CardTiles() {
    tiles::TilesSettings settings;
    settings.tile_width = 320;
    settings.tile_height = 240;
    settings.frame_width = 640;
    settings.frame_height = 240;
    settings.tiles = {{"left", tiles::TileKind::kWall, 0, 0, 1},
                      {"right", tiles::TileKind::kWall, 320, 0, 0}};
    plan_ = *tiles::planTiles(settings);
    output_.kind = out::OutputKind::kPng;
    output_.name = "beamer";
    output_.correction.blend.left = 40;
    output_.correction.blend.bottom = 30;
  }
  testcard::CardTile leftAs(out::PlacedTile placed) {
    placed.tile = "left";
    output_.tiles = {placed};
    return testcard::cardTiles(plan_, {out::OutputSettings{}, output_}, {})[0];
  }
  // Returns which corner of the tile each corner of the output's picture is, in the picture's
  // order.
  std::array<std::size_t, 4> corners() const {
    std::array<std::size_t, 4> all{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto mark = testcard::cornerOf(plan_, output_, i);
      EXPECT_TRUE(mark && mark->tile == 0);
      all[i] = mark ? mark->corner : 9;
    }
    return all;
  }
  static std::array<int, 4> strips(const testcard::CardTile& t) {
    return {t.left, t.right, t.top, t.bottom};
  }

  tiles::TilePlan plan_;
  out::OutputSettings output_;
};

TEST_F(CardTiles, SayWhichOutputShowsThemAndOnWhichPanelTheyAre) {
  output_.tiles = {{"left", 0, 0}};
  const auto tiles =
      testcard::cardTiles(plan_, {out::OutputSettings{}, output_}, {{"right", "p 2"}});
  EXPECT_EQ(tiles[0].lines, (std::vector<std::string>{"output beamer", "320 x 240"}));
  EXPECT_EQ(tiles[1].lines, (std::vector<std::string>{"320 x 240", "panel p 2"}));
}

// Two projectors on one screen, with no blend in the settings.
TEST(CardTilesOnAScreen, HaveTheirPartAndTheStripsOfTheirNeighbours) {
  tiles::TilesSettings settings;
  settings.frame_width = 640;
  settings.frame_height = 240;
  settings.tile_width = 320;
  settings.tile_height = 240;
  tiles::TileSettings left{"left", tiles::TileKind::kWall, 0, 0, 0},
      right{"right", tiles::TileKind::kWall, 320, 0, 0};
  left.screen_m = {-1.4, -0.6, -2, 0.2, -0.6, -2, -1.4, 0.6, -2};
  right.screen_m = {-0.2, -0.6, -2, 1.4, -0.6, -2, -0.2, 0.6, -2};
  settings.tiles = {left, right};
  const auto plan = tiles::planTiles(settings);
  ASSERT_TRUE(plan) << plan.error().what;
  const auto cards = testcard::cardTiles(*plan, {}, {});
  EXPECT_EQ((std::array{cards[0].left, cards[0].right}), (std::array{0, 80}));
  EXPECT_EQ((std::array{cards[1].left, cards[1].right}), (std::array{80, 0}));
  EXPECT_EQ((std::array{cards[1].top, cards[1].bottom}), (std::array{0, 0}));
  EXPECT_NEAR(cards[0].part.left, 0, 1e-9);
  EXPECT_NEAR(cards[1].part.left, 1.2, 1e-9);
  EXPECT_NEAR(cards[1].part.width, 1.6, 1e-9);
  EXPECT_NEAR(cards[1].part.plane_width, 2.8, 1e-9);
  EXPECT_NEAR(cards[1].part.top, 0, 1e-9);
}

TEST_F(CardTiles, InAnAnaglyphBothEyesSayTheSame) {
  output_.tiles = {{"left", 0, 0}};
  output_.tiles[0].right_eye = "right";
  plan_.tiles[0].name = output_.tiles[0].tile = "wall.L";
  plan_.tiles[1].name = output_.tiles[0].right_eye = "wall.R";
  plan_.tiles[0].eye = tiles::Eye::kLeft;
  plan_.tiles[1].eye = tiles::Eye::kRight;
  const auto cards = testcard::cardTiles(plan_, {output_}, {{"wall", "p"}});
  EXPECT_EQ(cards[0].name, "wall");
  EXPECT_EQ(cards[1].name, "wall");
  EXPECT_EQ(cards[0].lines, (std::vector<std::string>{"output beamer", "320 x 240", "panel p"}));
  EXPECT_EQ(cards[0].lines, cards[1].lines);
}

TEST_F(CardTiles, StripsAndCornersAreThoseOfTheTileAlsoIfItIsTurned) {
  EXPECT_EQ(strips(leftAs({})), (std::array{40, 0, 0, 30}));
  EXPECT_EQ(corners(), (std::array<std::size_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(strips(leftAs({"", 0, 0, out::Mirror::kHorizontal})), (std::array{0, 40, 0, 30}));
  EXPECT_EQ(corners(), (std::array<std::size_t, 4>{1, 0, 3, 2}));
  EXPECT_EQ(strips(leftAs({"", 0, 0, out::Mirror::kNone, out::Turn::k180})),
            (std::array{0, 40, 30, 0}));
  EXPECT_EQ(corners(), (std::array<std::size_t, 4>{3, 2, 1, 0}));
  // Turned clockwise, the tile's top is at the output's right side, and the tile's left side at the
  // output's top.
  EXPECT_EQ(strips(leftAs({"", 0, 0, out::Mirror::kNone, out::Turn::k90})),
            (std::array{0, 30, 0, 40}));
  EXPECT_EQ(corners(), (std::array<std::size_t, 4>{2, 0, 3, 1}));
}

TEST_F(CardTiles, AStripReachesOnlyTheTilesAtThatSide) {
  output_.tiles = {{"left", 0, 0}, {"right", 320, 0}};
  const auto tiles = testcard::cardTiles(plan_, {output_}, {});
  EXPECT_EQ(strips(tiles[0]), (std::array{40, 0, 0, 30}));
  EXPECT_EQ(strips(tiles[1]), (std::array{0, 0, 0, 30}));
  EXPECT_EQ(testcard::cornerOf(plan_, output_, 1)->tile, 1u);
  output_.tiles = {{"left", 10, 0}};
  EXPECT_EQ(strips(testcard::cardTiles(plan_, {output_}, {})[0]), (std::array{30, 0, 0, 30}));
  EXPECT_FALSE(testcard::cornerOf(plan_, output_, 0)) << "there is no tile";
}

TEST(CardOverlay, CoversTheTilesUntilItIsTakenOff) {
  Canvas canvas;
  const Canvas before = canvas, card = drawn(testcard::Card::kRamps);
  testcard::CardOverlay overlay(Canvas::kWidth, Canvas::kHeight, {tile()});
  overlay.draw(canvas.pixels);
  EXPECT_EQ(canvas.pixels, before.pixels);
  EXPECT_FALSE(overlay.hasChanged());
  EXPECT_FALSE(overlay.isShown());
  overlay.show(testcard::Card::kGrid);
  overlay.show(testcard::Card::kRamps);
  EXPECT_TRUE(overlay.hasChanged());
  for (int frame = 0; frame < 2; ++frame) {
    overlay.draw(canvas.pixels);
    EXPECT_EQ(canvas.pixels, card.pixels);
    EXPECT_FALSE(overlay.hasChanged());
    EXPECT_TRUE(overlay.isShown());
    overlay.erase(canvas.pixels);
    EXPECT_EQ(canvas.pixels, before.pixels);
  }
  overlay.show(std::nullopt);
  EXPECT_TRUE(overlay.hasChanged());
  overlay.draw(canvas.pixels);
  EXPECT_EQ(canvas.pixels, before.pixels);
  overlay.erase(canvas.pixels);
  EXPECT_EQ(canvas.pixels, before.pixels);
  EXPECT_FALSE(overlay.isShown());
}

}  // namespace
}  // namespace merlin::render::testcard
