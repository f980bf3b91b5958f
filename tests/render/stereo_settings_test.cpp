// Impossible stereo settings are refused, and the message gives the reason and a remedy. Settings
// that are probably a mistake cause a warning.
#include "tests/render/stereo_settings.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace merlin::render::stereo {
namespace {

struct Wall {
  stereo::StereoSettings stereo = inMode(stereo::StereoMode::kSideBySide);
  tiles::TilesSettings tiles = oneTile();
  std::vector<out::OutputSettings> outputs = {{}};
};

struct Fault {
  const char* name;
  std::function<void(Wall&)> change;
  const char* pointer;
  const char* message;
};

class WrongStereo : public testing::TestWithParam<Fault> {};

TEST_P(WrongStereo, IsRefused) {
  Wall wall;
  GetParam().change(wall);
  const SettingFaults faults = validate(wall.stereo, wall.tiles, wall.outputs, kWallDistance_m);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_EQ(faults[0].what, GetParam().message);
}

TEST(Stereo, WhatIsProbablyNotMeantIsDoubted) {
  stereo::StereoSettings usual = inMode(stereo::StereoMode::kAnaglyph);
  usual.screen_distance_m = 3;
  EXPECT_TRUE(doubtsOf(usual).empty());
  const auto doubt = [&](double separation_m, double screen_m) {
    stereo::StereoSettings s = usual;
    s.eye_separation_m = separation_m;
    s.screen_distance_m = screen_m;
    const SettingFaults doubts = doubtsOf(s);
    return doubts.size() == 1 ? doubts[0].pointer + " " + doubts[0].what : "not one doubt";
  };
  EXPECT_EQ(doubt(0, 3),
            "/stereo/eye_separation_m is 0 in stereo mode anaglyph: both eyes see the same "
            "picture, without depth; people's are 0.05 to 0.075 m");
  EXPECT_EQ(doubt(0.63, 3),
            "/stereo/eye_separation_m is 0.63 m: everything has 10 times the parallax of eyes that "
            "are 0.063 m apart; is it meant in metres?");
  EXPECT_EQ(doubt(0.06, 250),
            "/stereo/screen_distance_m is 250 m: what is nearer than that appears in front of the "
            "screen; is it meant in metres?");
  usual.mode = stereo::StereoMode::kOff;
  usual.eye_separation_m = 0;
  EXPECT_TRUE(doubtsOf(usual).empty());
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Fault kFaults[] = {
    {"EyesFurtherApartThanTheScreenIsAway", [](Wall& w) { w.stereo.eye_separation_m = 2.5; },
     "/stereo/eye_separation_m",
     "is 2.5 m, and the screen of tile wall is only 2 m away: the eyes cannot be as far apart as "
     "that; people's are 0.05 to 0.075 m"},
    {"EyesThatAreNowhere", [](Wall& w) { w.stereo.eye_separation_m = kNan; },
     "/stereo/eye_separation_m", "is nan; allowed is 0 to 10 m"},
    {"AScreenBehindTheViewer", [](Wall& w) { w.stereo.screen_distance_m = -1; },
     "/stereo/screen_distance_m", "is -1; allowed is 0 to 1000 m"},
    {"EyesWithoutALine",
     [](Wall& w) {
       w.stereo.eyes_direction = {1e-4, 0, 0};
     },
     "/stereo/eyes_direction",
     "is 0.0001, 0, 0, which is not a direction; give x, y and z from the left to the right eye, "
     "such "
     "as 1, 0, 0"},
    {"EyesTheWrongWayRound",
     [](Wall& w) {
       w.stereo.eyes_direction = {-1, 0, 0};
     },
     "/stereo/eyes_direction",
     "is -1, 0, 0: for every screen the right eye would be behind the left one, or to the left of "
     "it; give x, y and z from the left to the right eye, such as 1, 0, 0"},
    {"EyesBehindEachOther",
     [](Wall& w) {
       w.stereo.eyes_direction = {0, 0, 1};
     },
     "/stereo/eyes_direction",
     "is 0, 0, 1: for every screen the right eye would be behind the left one, or to the left of "
     "it; give x, y and z from the left to the right eye, such as 1, 0, 0"},
    {"AHeadAtNoStation", [](Wall& w) { w.stereo.head.station = 5; }, "/stereo/head/station",
     "is 5; a tracker has stations 1 to 4, 0 is none"},
    {"AMirroredTracker",
     [](Wall& w) {
       w.stereo.head.axes = {1, 2, -3};
     },
     "/stereo/head/axes",
     "is 1, 2, -3; allowed is each of 1 to 3 once, with signs that make the axes right-handed"},
    {"ATrackerWithTheLeastInt",
     [](Wall& w) {
       w.stereo.head.axes = {std::numeric_limits<int>::min(), 2, 3};
     },
     "/stereo/head/axes",
     "is -2147483648, 2, 3; allowed is each of 1 to 3 once, with signs that make the axes "
     "right-handed"},
    {"AHeadWithoutAPlace", [](Wall& w) { w.stereo.head.origin_m[1] = kNan; }, "/stereo/head",
     "has a figure that is not a number or is beyond its range: origin_m is 0, nan, 0, scale 1, "
     "dead_band_m 0.005, dead_band_deg 2"},
    {"NothingThatFollowsTheWall", [](Wall& w) { w.tiles.tiles[0].view = tiles::TileCamera::kTop; },
     "/stereo/mode",
     "is side_by_side, and no tile follows the wall: there is nothing to see with two eyes"},
    {"AnOddWidth", [](Wall& w) { w.tiles.tiles[0].width = 639; }, "/stereo/size",
     "is half: tile wall has a width of 639 pixels, which cannot be halved; use an even number, or "
     "size full"},
    {"AnOddHeight",
     [](Wall& w) {
       w.stereo.mode = stereo::StereoMode::kTopBottom;
       w.tiles.tile_height = 479;
     },
     "/stereo/size",
     "is half: tile wall has a height of 479 pixels, which cannot be halved; use an even number, "
     "or size full"},
    {"ANameWithoutRoomForTheEyes", [](Wall& w) { w.tiles.tiles[0].name = "fourteen_chars"; },
     "/stereo/mode",
     "is side_by_side: tile fourteen_chars has a name of 14 characters, and at most 13 leave room "
     "for the .L or .R that each eye's tile adds"},
    {"TooManyTiles",
     [](Wall& w) {
       w.tiles.tiles.clear();
       w.tiles.frame_width = 16 * 17;
       w.tiles.tile_width = w.tiles.tile_height = 16;
       for (int i = 0; i < 17; ++i)
         w.tiles.tiles.push_back({std::to_string(i), tiles::TileKind::kWall, 16 * i, 0, 0.1 * i});
     },
     "/stereo/mode", "is side_by_side, which makes 34 tiles; a wall has 32 at most"},
    {"ATooLargeFrame",
     [](Wall& w) {
       w.stereo.size = stereo::EyeSize::kFull;
       w.tiles.frame_width = 16000;
     },
     "/stereo/mode",
     "is side_by_side, which needs a frame of 16640 x 480 pixels; the largest is 16384 x 16384"},
    {"APairOnItsSide",
     [](Wall& w) {
       w.outputs = {picture("a", {{"wall", 0, 0, out::Mirror::kNone, out::Turn::k90}})};
     },
     "/outputs/0/tiles/0/turn_deg",
     "is 90: stereo mode side_by_side packs both eyes' pictures of tile wall for an output that is "
     "not on its side; place wall.L and wall.R each on its own"},
    {"ARampOverBothEyes",
     [](Wall& w) {
       w.outputs = {picture("a", {{"operator"}, {"wall", 640}})};
       w.outputs[0].correction.blend.right = 40;
     },
     "/outputs/0/correction",
     "has corners, a mesh, ramps or a black level, which apply to each eye's half of the signal, "
     "and in stereo mode side_by_side the eyes' pictures of this output are not its halves; let it "
     "show one tile (tiles), use mode two_outputs or anaglyph, or only colour"},
    {"ACornerOfTheWholeFrame",
     [](Wall& w) {
       w.outputs = {picture("a", {})};
       w.outputs[0].correction.corners[0] = 1;
     },
     "/outputs/0/correction",
     "has corners, a mesh, ramps or a black level, which apply to each eye's half of the signal, "
     "and in stereo mode side_by_side the eyes' pictures of this output are not its halves; let it "
     "show one tile (tiles), use mode two_outputs or anaglyph, or only colour"},
    {"TwoOutputsThatShowBothEyes",
     [](Wall& w) {
       w.stereo.mode = stereo::StereoMode::kTwoOutputs;
       w.outputs = {{}, picture("a", {{"operator"}, {"wall", 640}})};
     },
     "/outputs/1/tiles/1/tile",
     "is \"wall\", which has two pictures in stereo mode two_outputs; name one eye's: wall.L or "
     "wall.R"},
    {"TwoOutputsWithoutOutputs", [](Wall& w) { w.stereo.mode = stereo::StereoMode::kTwoOutputs; },
     "/stereo/mode",
     "is two_outputs, and tile wall has no output for each eye: let one output show wall.L and "
     "another one wall.R (/wall/outputs/N/tiles)"},
    {"TwoOutputsOnOne",
     [](Wall& w) {
       w.stereo.mode = stereo::StereoMode::kTwoOutputs;
       w.outputs = {{}, picture("a", {{"wall.L"}, {"wall.R", 640}})};
     },
     "/stereo/mode",
     "is two_outputs, and tile wall has no output for each eye: let one output show wall.L and "
     "another one wall.R (/wall/outputs/N/tiles)"},
};

std::string nameOfCase(const testing::TestParamInfo<Fault>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Settings, WrongStereo, testing::ValuesIn(kFaults), nameOfCase);

}  // namespace
}  // namespace merlin::render::stereo
