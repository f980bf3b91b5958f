// Impossible tile settings: each is refused, and the message names the tile and the value.
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "render/tiles/tile_plan.h"

namespace merlin::render {
namespace {

struct Fault {
  const char* name;
  std::function<void(tiles::TilesSettings&)> change;
  const char* message;
};

class WrongTiles : public testing::TestWithParam<Fault> {};

TEST_P(WrongTiles, AreRefused) {
  tiles::TilesSettings settings;
  GetParam().change(settings);
  const auto plan = tiles::planTiles(settings);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(plan.error().what, GetParam().message);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Fault kPlaces[] = {
    {"TooFarRight", [](tiles::TilesSettings& s) { s.tiles[1].x = 641; },
     "tile centre at 641, 0 does not lie in the frame of 1280 x 960"},
    {"TooFarDown", [](tiles::TilesSettings& s) { s.tiles[3].y = 481; },
     "tile operator at 640, 481 does not lie in the frame of 1280 x 960"},
    {"LeftOfTheFrame", [](tiles::TilesSettings& s) { s.tiles[0].x = -1; },
     "tile left at -1, 0 does not lie in the frame of 1280 x 960"},
    {"AboveTheFrame", [](tiles::TilesSettings& s) { s.tiles[0].y = -1; },
     "tile left at 0, -1 does not lie in the frame of 1280 x 960"},
    {"FarBeyondAnything",
     [](tiles::TilesSettings& s) { s.tiles[2].x = std::numeric_limits<int>::max(); },
     "tile right at 2147483647, 480 does not lie in the frame of 1280 x 960"},
    {"OneOverTheOther", [](tiles::TilesSettings& s) { s.tiles[1].x = 639; },
     "tiles left and centre overlap in the frame"},
    {"OneInTheOthersPlace",
     [](tiles::TilesSettings& s) {
       s.tiles[2].x = 640;
       s.tiles[2].y = 480;
     },
     "tiles right and operator overlap in the frame"},
    {"OneCornerOverTheOther",
     [](tiles::TilesSettings& s) {
       s.frame_width = 2000;
       s.tiles[3].x = 639;
       s.tiles[3].y = 479;
     },
     "tiles left and operator overlap in the frame"},
    {"OneName", [](tiles::TilesSettings& s) { s.tiles[3].name = "left"; },
     "two tiles are named \"left\""},
    {"OneTurn", [](tiles::TilesSettings& s) { s.tiles[2].turns = 1; },
     "tiles left and right have the same direction: 1 tile widths to the left"},
    {"NoTile", [](tiles::TilesSettings& s) { s.tiles.clear(); }, "a wall has at least one tile"},
};

const Fault kFigures[] = {
    {"AFieldOfViewTooNarrow", [](tiles::TilesSettings& s) { s.field_of_view_deg = 0.9; },
     "a field of view of 0.9 degrees is not 1 to 179"},
    {"AFieldOfViewTooWide", [](tiles::TilesSettings& s) { s.field_of_view_deg = 180; },
     "a field of view of 180 degrees is not 1 to 179"},
    {"AFieldOfViewThatIsNoNumber", [](tiles::TilesSettings& s) { s.field_of_view_deg = kNan; },
     "a field of view of nan degrees is not 1 to 179"},
    {"NearAtTheEye", [](tiles::TilesSettings& s) { s.near_m = 0; },
     "near_m is 0 and far_m is 50; they must satisfy 0 < near_m < far_m"},
    {"FarNotBeyondNear", [](tiles::TilesSettings& s) { s.far_m = 0.05; },
     "near_m is 0.05 and far_m is 0.05; they must satisfy 0 < near_m < far_m"},
    {"NearThatIsNoNumber", [](tiles::TilesSettings& s) { s.near_m = kNan; },
     "near_m is nan and far_m is 50; they must satisfy 0 < near_m < far_m"},
    {"FarThatIsNoNumber", [](tiles::TilesSettings& s) { s.far_m = kNan; },
     "near_m is 0.05 and far_m is nan; they must satisfy 0 < near_m < far_m"},
    {"FarWithoutEnd",
     [](tiles::TilesSettings& s) { s.far_m = std::numeric_limits<double>::infinity(); },
     "near_m is 0.05 and far_m is inf; they must satisfy 0 < near_m < far_m"},
    {"ATurnThatIsNoNumber", [](tiles::TilesSettings& s) { s.tiles[0].turns = kNan; },
     "tile left: turns is nan; it must be a finite number"},
    {"ATileWithoutWidth", [](tiles::TilesSettings& s) { s.tile_width = 0; },
     "a tile of 0 x 480 pixels is empty"},
    {"ATileWithoutHeight", [](tiles::TilesSettings& s) { s.tile_height = -480; },
     "a tile of 640 x -480 pixels is empty"},
};

// Gives the centre tile a view of its own.
void lookFrom(tiles::TilesSettings& s, tiles::TileCamera view) { s.tiles[1].view = view; }

const Fault kViews[] = {
    {"AnOperatorsOwnView",
     [](tiles::TilesSettings& s) { s.tiles[3].view = tiles::TileCamera::kTop; },
     "tile operator is the operator's, which sees the whole model from the front: view top is for "
     "tiles of kind wall"},
    {"AnOwnViewThatIsTurned",
     [](tiles::TilesSettings& s) { s.tiles[0].view = tiles::TileCamera::kSide; },
     "tile left has view side, a camera of its own: leave out turns, direction_deg, frustum_deg "
     "and screen_m, or set view to wall"},
    {"ACameraOfTheWallsView",
     [](tiles::TilesSettings& s) {
       s.tiles[1].camera.eye_m = {0, 1, 0};
     },
     "tile centre has view wall: camera is a setting of view free"},
    {"ACameraThatLooksNowhere",
     [](tiles::TilesSettings& s) {
       lookFrom(s, tiles::TileCamera::kFree);
       s.tiles[1].camera.eye_m = s.tiles[1].camera.look_at_m;
     },
     "tile centre: camera: eye_m and look_at_m are the same place; the camera looks from the first "
     "to the second"},
    {"ACameraThatLooksUpwardsWithUpUp",
     [](tiles::TilesSettings& s) {
       lookFrom(s, tiles::TileCamera::kFree);
       s.tiles[1].camera.look_at_m = {0, 5, 0};
     },
     "tile centre: camera: up has no length or lies along the line of sight from eye_m to "
     "look_at_m; give another direction, such as 0, 0, -1 for a camera that looks straight down"},
    {"ACameraThatSeesHalfTheWorld",
     [](tiles::TilesSettings& s) {
       lookFrom(s, tiles::TileCamera::kFree);
       s.tiles[1].camera.field_of_view_deg = 180;
     },
     "tile centre: camera: a field of view of 180 degrees is not 1 to 179"},
    {"ACameraThatIsNowhere",
     [](tiles::TilesSettings& s) {
       lookFrom(s, tiles::TileCamera::kFree);
       s.tiles[1].camera.eye_m[1] = kNan;
     },
     "tile centre: camera has something that is not a number"},
};

std::string nameOf(const testing::TestParamInfo<Fault>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Places, WrongTiles, testing::ValuesIn(kPlaces), nameOf);
INSTANTIATE_TEST_SUITE_P(Views, WrongTiles, testing::ValuesIn(kViews), nameOf);
INSTANTIATE_TEST_SUITE_P(Figures, WrongTiles, testing::ValuesIn(kFigures), nameOf);

// These settings are allowed: two operator tiles with the same turn, and tiles anywhere in the
// frame.
TEST(TilesSettings, MayBeOdd) {
  tiles::TilesSettings settings;
  settings.tiles[0].kind = tiles::TileKind::kOperator;
  settings.tiles[0].turns = 0;
  settings.frame_width = 3000;
  settings.frame_height = 3000;
  settings.tiles[3].x = 1999;
  settings.tiles[3].y = 1501;
  EXPECT_TRUE(tiles::planTiles(settings));
  settings.field_of_view_deg = 179;
  EXPECT_TRUE(tiles::planTiles(settings));
  settings.field_of_view_deg = 1;
  EXPECT_TRUE(tiles::planTiles(settings));
}

}  // namespace
}  // namespace merlin::render
