// Walls that cannot be: each is refused, and the message names tile and figure.
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "render/tiles/tile_plan.h"

namespace merlin::render {
namespace {

struct Fault {
  const char* name;
  std::function<void(TilesSettings&)> change;
  const char* message;
};

class WrongTiles : public testing::TestWithParam<Fault> {};

TEST_P(WrongTiles, AreRefused) {
  TilesSettings settings;
  GetParam().change(settings);
  const auto plan = planTiles(settings);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(plan.error().what, GetParam().message);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Fault kPlaces[] = {
    {"TooFarRight", [](TilesSettings& s) { s.tiles[1].x = 641; },
     "tile centre at 641, 0 does not lie in the frame of 1280 x 960"},
    {"TooFarDown", [](TilesSettings& s) { s.tiles[3].y = 481; },
     "tile operator at 640, 481 does not lie in the frame of 1280 x 960"},
    {"LeftOfTheFrame", [](TilesSettings& s) { s.tiles[0].x = -1; },
     "tile left at -1, 0 does not lie in the frame of 1280 x 960"},
    {"AboveTheFrame", [](TilesSettings& s) { s.tiles[0].y = -1; },
     "tile left at 0, -1 does not lie in the frame of 1280 x 960"},
    {"FarBeyondAnything", [](TilesSettings& s) { s.tiles[2].x = std::numeric_limits<int>::max(); },
     "tile right at 2147483647, 480 does not lie in the frame of 1280 x 960"},
    {"OneOverTheOther", [](TilesSettings& s) { s.tiles[1].x = 639; },
     "tiles left and centre overlap in the frame"},
    {"OneInTheOthersPlace",
     [](TilesSettings& s) {
       s.tiles[2].x = 640;
       s.tiles[2].y = 480;
     },
     "tiles right and operator overlap in the frame"},
    {"OneCornerOverTheOther",
     [](TilesSettings& s) {
       s.frame_width = 2000;
       s.tiles[3].x = 639;
       s.tiles[3].y = 479;
     },
     "tiles left and operator overlap in the frame"},
    {"OneName", [](TilesSettings& s) { s.tiles[3].name = "left"; }, "two tiles are named \"left\""},
    {"OneTurn", [](TilesSettings& s) { s.tiles[2].turns = 1; },
     "tiles left and right both look 1 tile widths to the left"},
    {"NoTile", [](TilesSettings& s) { s.tiles.clear(); }, "a wall has at least one tile"},
};

const Fault kFigures[] = {
    {"AFieldOfViewTooNarrow", [](TilesSettings& s) { s.field_of_view_deg = 0.9; },
     "a field of view of 0.9 degrees is not 1 to 179"},
    {"AFieldOfViewTooWide", [](TilesSettings& s) { s.field_of_view_deg = 180; },
     "a field of view of 180 degrees is not 1 to 179"},
    {"AFieldOfViewThatIsNoNumber", [](TilesSettings& s) { s.field_of_view_deg = kNan; },
     "a field of view of nan degrees is not 1 to 179"},
    {"NearAtTheEye", [](TilesSettings& s) { s.near_m = 0; },
     "near 0 m and far 50 m: 0 < near < far"},
    {"FarNotBeyondNear", [](TilesSettings& s) { s.far_m = 0.05; },
     "near 0.05 m and far 0.05 m: 0 < near < far"},
    {"NearThatIsNoNumber", [](TilesSettings& s) { s.near_m = kNan; },
     "near nan m and far 50 m: 0 < near < far"},
    {"FarThatIsNoNumber", [](TilesSettings& s) { s.far_m = kNan; },
     "near 0.05 m and far nan m: 0 < near < far"},
    {"FarWithoutEnd", [](TilesSettings& s) { s.far_m = std::numeric_limits<double>::infinity(); },
     "near 0.05 m and far inf m: 0 < near < far"},
    {"ATurnThatIsNoNumber", [](TilesSettings& s) { s.tiles[0].turns = kNan; },
     "tile left: turns are nan"},
    {"ATileWithoutWidth", [](TilesSettings& s) { s.tile_width = 0; },
     "a tile of 0 x 480 pixels has no picture"},
    {"ATileWithoutHeight", [](TilesSettings& s) { s.tile_height = -480; },
     "a tile of 640 x -480 pixels has no picture"},
};

std::string nameOf(const testing::TestParamInfo<Fault>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Places, WrongTiles, testing::ValuesIn(kPlaces), nameOf);
INSTANTIATE_TEST_SUITE_P(Figures, WrongTiles, testing::ValuesIn(kFigures), nameOf);

// Two operators may have one turn, and a tile may stand anywhere in the frame.
TEST(TilesSettings, MayBeOdd) {
  TilesSettings settings;
  settings.tiles[0].kind = TileKind::kOperator;
  settings.tiles[0].turns = 0;
  settings.frame_width = 3000;
  settings.frame_height = 3000;
  settings.tiles[3].x = 1999;
  settings.tiles[3].y = 1501;
  EXPECT_TRUE(planTiles(settings));
  settings.field_of_view_deg = 179;
  EXPECT_TRUE(planTiles(settings));
  settings.field_of_view_deg = 1;
  EXPECT_TRUE(planTiles(settings));
}

}  // namespace
}  // namespace merlin::render
