// Blend ramps that follow from the positions of the screens: two projectors side by side whose
// pictures overlap by a quarter.
#include "render/out/room_blend.h"

#include <gtest/gtest.h>

namespace merlin::render::out {
namespace {

tiles::TilesSettings overlapping() {
  tiles::TilesSettings all;
  all.frame_width = 800;
  all.frame_height = 300;
  all.tile_width = 400;
  all.tile_height = 300;
  all.tiles.resize(2);
  const double left_m[] = {-1.75, -0.25};
  for (std::size_t i = 0; i < 2; ++i) {
    all.tiles[i].name = i == 0 ? "left" : "right";
    all.tiles[i].x = static_cast<int>(400 * i);
    // lower left, lower right, upper left corner
    all.tiles[i].screen_m = {left_m[i], -0.75, -2, left_m[i] + 2, -0.75, -2, left_m[i], 0.75, -2};
  }
  return all;
}

correct::BlendSettings blendOf(const PlacedTile& placed) {
  std::vector<OutputSettings> outputs(1);
  outputs[0].kind = OutputKind::kPng;
  outputs[0].tiles = {placed};
  outputs[0].correction.blend.automatic = true;
  EXPECT_TRUE(fillBlends(outputs, overlapping()).empty());
  return outputs[0].correction.blend;
}

TEST(RoomBlend, IsAsWideAsTheOverlapOnTheSideOfTheNeighbour) {
  const auto left = blendOf({.tile = "left"}), right = blendOf({.tile = "right"});
  EXPECT_EQ(left.right, 100);
  EXPECT_EQ(left.left + left.top + left.bottom, 0);
  EXPECT_EQ(right.left, 100);
  EXPECT_EQ(right.right + right.top + right.bottom, 0);
}

TEST(RoomBlend, IsWhereTheBorderIsInAPictureThatIsMirroredAndTurned) {
  EXPECT_EQ(blendOf({.tile = "left", .mirror = Mirror::kHorizontal}).left, 100);
  EXPECT_EQ(blendOf({.tile = "left", .mirror = Mirror::kVertical}).right, 100);
  EXPECT_EQ(blendOf({.tile = "left", .turn = Turn::k90}).bottom, 100) << "clockwise";
  EXPECT_EQ(blendOf({.tile = "left", .turn = Turn::k180}).left, 100);
  EXPECT_EQ(blendOf({.tile = "left", .turn = Turn::k270}).top, 100);
  EXPECT_EQ(blendOf({.tile = "left", .mirror = Mirror::kHorizontal, .turn = Turn::k90}).top, 100);
}

TEST(RoomBlend, LeavesOutputsAloneThatHaveTheirOwn) {
  std::vector<OutputSettings> outputs(1);
  outputs[0].tiles = {{.tile = "left"}};
  outputs[0].correction.blend.right = 7;
  EXPECT_TRUE(fillBlends(outputs, overlapping()).empty());
  EXPECT_EQ(outputs[0].correction.blend.right, 7);
}

}  // namespace
}  // namespace merlin::render::out
