// Tiles at their places on an output, mirrored and turned.
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
    settings_.tiles = {{"a", TileKind::kWall, 0, 0, 0}, {"b", TileKind::kWall, 3, 0, -1}};
    settings_.tiles[1].width = 2;
    plan_ = *planTiles(settings_);
    for (const char c : std::string("ABCghDEFij"))
      canvas_.insert(canvas_.end(), {static_cast<std::uint8_t>(c), 1, 2, 255});
  }
  // Lines of the output; a pixel without a tile is a dot.
  std::string shown(const std::vector<PlacedTile>& tiles) {
    std::vector<OutputSettings> outputs = {{OutputKind::kPng, "", "a.png"}};
    outputs[0].tiles = tiles;
    EXPECT_TRUE(validate(outputs, settings_).empty());
    TileArrangement arrangement(plan_, tiles);
    const Signal signal = arrangement.apply({5, 2, canvas_});
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

  TilesSettings settings_;
  TilePlan plan_;
  std::vector<std::uint8_t> canvas_;
};

TEST_F(TileArrangementTest, PutsTilesAtTheirPlaces) {
  EXPECT_EQ(shown({{"b", 0, 0}, {"a", 2, 1}}), "gh...\nijABC\n..DEF\n");
}

TEST_F(TileArrangementTest, TurnsThemClockwise) {
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kNone, Turn::k0}}), "ABC\nDEF\n");
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kNone, Turn::k90}}), "DA\nEB\nFC\n");
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kNone, Turn::k180}}), "FED\nCBA\n");
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kNone, Turn::k270}}), "CF\nBE\nAD\n");
}

TEST_F(TileArrangementTest, MirrorsThemBeforeItTurnsThem) {
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kHorizontal}}), "CBA\nFED\n");
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kVertical}}), "DEF\nABC\n");
  EXPECT_EQ(shown({{"a", 0, 0, Mirror::kHorizontal, Turn::k90}}), "FC\nEB\nDA\n");
  EXPECT_EQ(shown({{"a", 1, 0, Mirror::kVertical, Turn::k270}, {"b", 0, 3}}),
            ".FC\n.EB\n.DA\ngh.\nij.\n");
}

TEST_F(TileArrangementTest, PlacesThatAreNoneAreFound) {
  const auto fault = [&](const OutputSettings& output) {
    const SettingFaults faults = validate({output}, settings_);
    return faults.empty() ? "" : faults[0].pointer + " " + faults[0].what;
  };
  OutputSettings png{OutputKind::kPng, "", "a.png"};
  png.tiles = {{"a", 0, 0}, {"c", 9, 9}};
  EXPECT_EQ(fault(png), "/0/tiles/1/tile is \"c\"; the wall's tiles are a, b");
  png.tiles = {{"a", 0, 0}, {"b", 2, 1}};
  EXPECT_EQ(fault(png), "/0/tiles/1 overlaps another tile on this output");
  png.tiles = {{"a", 0, 0, Mirror::kNone, Turn::k90}, {"b", 2, 1}};
  EXPECT_EQ(fault(png), "") << "turned, it is only two pixels wide";
  OutputSettings shared;
  shared.tiles = {{"a", 0, 0}};
  EXPECT_EQ(fault(shared),
            "/0/tiles is not a setting of kind shared_memory, which holds the whole frame");
}

}  // namespace
}  // namespace merlin::render
