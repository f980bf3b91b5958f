// Tiles at their positions on an output, mirrored and rotated.
#include "render/frame/tile_arrangement.h"

#include <string>

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

// Two tiles side by side in a frame of 5 x 2 pixels: "a" of 3 x 2 and "b" of 2 x 2, whose pixels
// are letters:  ABC gh
//           DEF ij
class TileArrangementTest : public testing::Test {
 protected:
  TileArrangementTest() {
    settings_.tile_width = 3;
    settings_.tile_height = settings_.frame_height = 2;
    settings_.frame_width = 5;
    settings_.tiles = {{"a", tiles::TileKind::kWall, 0, 0, 0},
                       {"b", tiles::TileKind::kWall, 3, 0, -1}};
    settings_.tiles[1].width = 2;
    plan_ = *tiles::planTiles(settings_);
    for (const char c : std::string("ABCghDEFij"))
      canvas_.insert(canvas_.end(), {static_cast<std::uint8_t>(c), 1, 2, 255});
  }
  // Returns the output's rows as text; a pixel outside all tiles is a dot.
  std::string shown(const std::vector<out::PlacedTile>& tiles) {
    std::vector<out::OutputSettings> outputs = {{out::OutputKind::kPng, "", "a.png"}};
    outputs[0].tiles = tiles;
    EXPECT_TRUE(validate(outputs, settings_).empty());
    frame::TileArrangement arrangement(plan_, tiles);
    const out::Signal signal = arrangement.apply({5, 2, canvas_});
    std::string text;
    for (int y = 0; y < signal.height; ++y) {
      for (int x = 0; x < signal.width; ++x) {
        const std::uint8_t* pixel =
            &signal.pixels[static_cast<std::size_t>(4 * (y * signal.width + x))];
        EXPECT_EQ(pixel[3], 255);
        text += pixel[0] ? static_cast<char>(pixel[0]) : '.';
      }
      text += '\n';
    }
    return text;
  }

  tiles::TilesSettings settings_;
  tiles::TilePlan plan_;
  std::vector<std::uint8_t> canvas_;
};

TEST_F(TileArrangementTest, PutsTilesAtTheirPlaces) {
  EXPECT_EQ(shown({{"b", 0, 0}, {"a", 2, 1}}), "gh...\nijABC\n..DEF\n");
}

TEST_F(TileArrangementTest, TurnsThemClockwise) {
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kNone, out::Turn::k0}}), "ABC\nDEF\n");
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kNone, out::Turn::k90}}), "DA\nEB\nFC\n");
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kNone, out::Turn::k180}}), "FED\nCBA\n");
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kNone, out::Turn::k270}}), "CF\nBE\nAD\n");
}

TEST_F(TileArrangementTest, MirrorsThemBeforeItTurnsThem) {
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kHorizontal}}), "CBA\nFED\n");
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kVertical}}), "DEF\nABC\n");
  EXPECT_EQ(shown({{"a", 0, 0, out::Mirror::kHorizontal, out::Turn::k90}}), "FC\nEB\nDA\n");
  EXPECT_EQ(shown({{"a", 1, 0, out::Mirror::kVertical, out::Turn::k270}, {"b", 0, 3}}),
            ".FC\n.EB\n.DA\ngh.\nij.\n");
}

TEST_F(TileArrangementTest, PlacesThatAreNoneAreFound) {
  const auto fault = [&](const out::OutputSettings& output) {
    const SettingFaults faults = out::validate({output}, settings_);
    return faults.empty() ? "" : faults[0].pointer + " " + faults[0].what;
  };
  out::OutputSettings png{out::OutputKind::kPng, "", "a.png"};
  png.tiles = {{"a", 0, 0}, {"c", 9, 9}};
  EXPECT_EQ(fault(png), "/0/tiles/1/tile is \"c\"; the wall's tiles are a, b");
  png.tiles = {{"a", 0, 0}, {"b", 2, 1}};
  EXPECT_EQ(fault(png), "/0/tiles/1 overlaps another tile on this output");
  png.tiles = {{"a", 0, 0, out::Mirror::kNone, out::Turn::k90}, {"b", 2, 1}};
  EXPECT_EQ(fault(png), "") << "turned, it is only two pixels wide";
  out::OutputSettings shared;
  shared.tiles = {{"a", 0, 0}};
  EXPECT_EQ(fault(shared),
            "/0/tiles is not a setting of kind shared_memory, which holds the whole frame");
}

// The anaglyph's red is the brightness of the pixels of "a"; its green and blue are those of "b",
// which is mirrored.
TEST_F(TileArrangementTest, ComposesTwoEyesIntoOneAnaglyph) {
  settings_.tiles[0].width = 2;
  settings_.frame_width = 5;
  plan_ = *tiles::planTiles(settings_);
  for (std::size_t i = 0; i < canvas_.size(); i += 4)
    canvas_[i + 2] = static_cast<std::uint8_t>(canvas_[i] + 100);
  out::PlacedTile both{"a", 1, 0, out::Mirror::kHorizontal};
  both.right_eye = "b";
  frame::TileArrangement arrangement(plan_, {both});
  const out::Signal signal = arrangement.apply({5, 2, canvas_});
  ASSERT_EQ(signal.width, 3);
  ASSERT_EQ(signal.height, 2);
  const auto pixel = [&](std::size_t x, std::size_t y) {
    const std::uint8_t* p = &signal.pixels[4 * (3 * y + x)];
    return std::vector<int>{p[0], p[1], p[2], p[3]};
  };
  const auto light = [](int red) { return (77 * red + 150 + 29 * (red + 100) + 128) / 256; };
  EXPECT_EQ(pixel(0, 0), (std::vector<int>{0, 0, 0, 255}));
  EXPECT_EQ(pixel(2, 0), (std::vector<int>{light('A'), 1, 'g' + 100, 255}));
  EXPECT_EQ(pixel(1, 0), (std::vector<int>{light('B'), 1, 'h' + 100, 255}));
  EXPECT_EQ(pixel(2, 1), (std::vector<int>{light('D'), 1, 'i' + 100, 255}));
}

}  // namespace
}  // namespace merlin::render
