// Settings of the wall that are checked together: contents, rooms, tiles, stereo, outputs.
#include <string>

#include <gtest/gtest.h>

#include "config/drawn_wall.h"
#include "config/loader.h"
#include "config/writer.h"
#include "tests/support/findings.h"

namespace merlin {
namespace {

using test::findingsOf;
using Verdict = LoadedSettings::Verdict;

std::string wallIs(const std::string& members) {
  return findingsOf(loadSettings("{\"wall\": {" + members + "}}", ""));
}

TEST(WallConfig, AContentIsOneFileAndItsNameIsItsOwn) {
  const auto contents = [](const std::string& list) {
    return findingsOf(loadSettings("{\"wall\": {\"contents\": [" + list + "]}}", ""));
  };
  EXPECT_EQ(contents(R"({"model": "a.mrm"}, {"picture": "b.tif", "show_as": "panorama"},
                        {"slides": "c", "name": "talk"})"),
            "");
  EXPECT_EQ(
      contents(R"({"model": "a.mrm", "picture": "b.tif"})"),
      "f.json:1: /wall/contents/0 names more than one file; give it one of model, picture and "
      "slides\n");
  EXPECT_EQ(contents(R"({"name": "sky"})"),
            "f.json:1: /wall/contents/0 names no file; give it one of model, picture and slides\n");
  EXPECT_EQ(contents(R"({"picture": "a.tif", "name": "sky"}, {"picture": "b.tif", "name": "sky"})"),
            "f.json:1: /wall/contents/1/name is \"sky\", the name of another content; give each "
            "its own name\n");
}

TEST(WallConfig, ARoomReplacesTheTiles) {
  const auto loaded = loadSettings(R"({"wall": {
    "room": {"preset": {"name": "three_120", "width": 800, "height": 600}, "eye_m": [0.1, 0, 0]},
    "tiles": {"near_m": 0.1},
    "outputs": [{"kind": "png", "path": "a.png", "tiles": [{"tile": "right"}]}]}})",
                                   "/");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const render::tiles::TilesSettings& tiles = loaded.settings.wall.tiles;
  ASSERT_EQ(tiles.tiles.size(), 4u);
  EXPECT_EQ(tiles.tiles[2].name, "right");
  EXPECT_EQ(tiles.tiles[2].width, 800);
  EXPECT_EQ(tiles.near_m, 0.1);
  EXPECT_EQ(tiles.frame_width, 1600);
  EXPECT_EQ(tiles.frame_height, 1200);
  const std::string text = settingsText(loaded.settings);
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << findingsOf(again);
  EXPECT_EQ(settingsText(again.settings), text) << "what is printed can be read";
  EXPECT_EQ(again.settings.wall.tiles.tiles[2].screen_m, tiles.tiles[2].screen_m);
}

TEST(WallConfig, ARoomAndTilesByHandExcludeEachOther) {
  const std::string room = R"("room": {"preset": {"name": "flat"}})";
  EXPECT_EQ(wallIs(room), "");
  EXPECT_EQ(wallIs(room + R"(, "tiles": {"tile_width": 320})"), "");
  EXPECT_EQ(wallIs("\n" + room + ",\n" + R"("tiles": {"frame_width": 1280,
                   "tiles": [{"name": "a"}]})"),
            "f.json:3: /wall/tiles/frame_width is given together with /wall/room, from which it is "
            "computed: leave out one of the two\n"
            "f.json:4: /wall/tiles/tiles is given together with /wall/room, from which it is "
            "computed: leave out one of the two\n");
}

TEST(WallConfig, WhatIsWrongWithARoomIsSaidOnce) {
  EXPECT_EQ(wallIs("\n\"room\": {\"panels\": [\n"
                   R"({"name": "a", "width_m": 2, "height_m": 1, "lower_left_m": [-1, 0, 1]}]},
                   "outputs": [{"kind": "png", "path": "a.png", "tiles": [{"tile": "a"}]}])"),
            "f.json:3: /wall/room/panels/0 cannot be used: panel a does not face the viewer: the "
            "eye is 1.000 m behind it; check eye_m, yaw_deg and the hinges\n");
  EXPECT_EQ(wallIs(R"("room": {"eye_m": [0, 1, 0]})"),
            "f.json:1: /wall/room cannot be used: the room has no panels: list them in /panels, or "
            "choose a preset in /preset/name (flat, three_160, three_120, six, hexagon, "
            "arc_160, arc_120)\n");
  EXPECT_EQ(wallIs(R"("room": {"preset": {"name": "cave"}})"),
            "f.json:1: /wall/room/preset/name is the string \"cave\"; allowed is one of none, "
            "flat, three_160, three_120, six, hexagon, arc_160, arc_120\n");
  EXPECT_EQ(
      wallIs(R"("room": {"preset": {"name": 3}})"),
      "f.json:1: /wall/room/preset/name is the number 3; allowed is one of \"none\", "
      "\"flat\", \"three_160\", \"three_120\", \"six\", \"hexagon\", \"arc_160\", \"arc_120\"\n");
}

// The wall has three projectors on a hinged screen. The measured figures are rounded, so left and
// right are symmetric only up to the rounding.
TEST(WallConfig, TheShippedRoomIsThreePanelsAroundTheViewer) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-three-160.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const auto& tiles = loaded.settings.wall.tiles.tiles;
  ASSERT_EQ(tiles.size(), 4u);
  const auto& left = tiles[0].screen_m;
  const auto& right = tiles[2].screen_m;
  EXPECT_NEAR(left[0], -right[3], 0.004) << "symmetric";
  EXPECT_NEAR(left[2], right[5], 0.004);
  EXPECT_NEAR(left[3], tiles[1].screen_m[0], 1e-12) << "hinged";
}

// The overlap is 0.3 m of a picture that is 1.6 m and 1024 pixels wide.
TEST(WallConfig, TheShippedFlatWallIsBlendedByWhatTheRoomSays) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-flat-overlap.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const auto& outputs = loaded.settings.wall.outputs;
  ASSERT_EQ(outputs.size(), 4u);
  const double ramps[3][2] = {{0, 192}, {192, 192}, {192, 0}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& blend = outputs[i + 1].correction.blend;
    EXPECT_EQ(blend.left, ramps[i][0]) << i;
    EXPECT_EQ(blend.right, ramps[i][1]) << i;
    EXPECT_EQ(blend.top + blend.bottom, 0) << i;
  }
  const std::string text = settingsText(loaded.settings);
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << findingsOf(again);
  EXPECT_EQ(settingsText(again.settings), text) << "what is printed can be read";
}

TEST(WallConfig, ABlendThatCannotFollowFromTheRoomSaysWhy) {
  const auto said = [](const std::string& wall) {
    return findingsOf(loadSettings("{\"wall\": {" + wall + "}}", "/"));
  };
  const std::string tiles = R"("tiles": {"tile_width": 320, "tile_height": 240,
      "frame_width": 640, "frame_height": 240, "tiles": [{"name": "a"}, {"name": "b", "x": 320, "turns": 1}]}, )";
  EXPECT_NE(said(tiles + R"("outputs": [{"kind": "png", "path": "a.png",
      "correction": {"blend": {"automatic": true}}}])")
                .find("/wall/outputs/0/correction/blend/automatic is true, and the output does not "
                      "show exactly one tile"),
            std::string::npos);
  EXPECT_NE(said(tiles + R"("outputs": [{"kind": "png", "path": "a.png", "tiles": [{"tile": "a"}],
      "correction": {"blend": {"automatic": true}}}])")
                .find("it is not known where the screen of the tile a is"),
            std::string::npos);
  const std::string room = R"("room": {"preset": {"name": "flat", "overlap_m": 0.3}}, )";
  EXPECT_NE(said(room + R"("outputs": [{"kind": "png", "path": "a.png",
      "tiles": [{"tile": "panel_1"}], "correction": {"blend": {"automatic": true, "right": 5}}}])")
                .find("is true, and right is 5, while other screens overlap by"),
            std::string::npos);
}

TEST(WallConfig, TheShippedStereoWallHasTwoPicturesOnEachProjector) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-stereo.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  EXPECT_EQ(loaded.settings.wall.tiles.tiles.size(), 4u) << "what is set";
  const WallSettings drawn = drawnWall(loaded.settings.wall);
  EXPECT_EQ(drawn.tiles.tiles.size(), 7u) << "what is drawn";
  ASSERT_EQ(drawn.outputs[2].tiles.size(), 2u);
  EXPECT_EQ(drawn.outputs[2].tiles[0].tile, "centre.L");
  EXPECT_EQ(drawn.outputs[2].tiles[1].tile, "centre.R");
  const std::string text = settingsText(loaded.settings);
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << findingsOf(again);
  EXPECT_EQ(settingsText(again.settings), text) << "what is printed can be read";
}

TEST(WallConfig, TheShippedWallWithoutADesktopHasFourDisplays) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-kms-four.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const auto& outputs = loaded.settings.wall.outputs;
  ASSERT_EQ(outputs.size(), 5u);
  EXPECT_EQ(outputs[3].kind, render::out::OutputKind::kKms);
  EXPECT_EQ(outputs[3].kms.connector, "DP-1");
  EXPECT_EQ(outputs[3].kms.mode, "1024x768@60");
  EXPECT_EQ(outputs[3].tiles[0].tile, "right");
}

TEST(WallConfig, ViewsOfTilesAndDisplaysAreChecked) {
  EXPECT_EQ(wallIs(R"("tiles": {"tiles": [{"name": "a", "view": "side"},
                     {"name": "b", "x": 640, "view": "free",
                      "camera": {"eye_m": [0, 3, -2], "up": [0, 0, -1]}}]})"),
            "");
  EXPECT_EQ(wallIs("\n"
                   R"("tiles": {"tiles": [{"name": "a", "turns": 1, "view": "top"}]})"),
            "f.json:2: /wall/tiles/tiles/0 cannot be used: tile a has view top, a camera of its "
            "own: leave "
            "out turns, direction_deg, frustum_deg and screen_m, or set view to wall\n");
  const std::string panel = R"("room": {"panels": [{"name": "p", "width_m": 2, "height_m": 1,
                                        "lower_left_m": [-1, -0.5, -2]}], "displays": [)";
  EXPECT_EQ(wallIs(panel + R"({"name": "d", "view": "top"}]})"), "");
  EXPECT_EQ(
      wallIs(panel + R"({"name": "d", "view": "free", "camera": {"look_at_m": [0, 0, 0]}}]})"),
      "f.json:2: /wall/room/displays/0 cannot be used: tile d: camera: eye_m and look_at_m are the "
      "same place; the camera looks from the first to the second\n");
}

TEST(WallConfig, StereoIsCheckedWithTheRestOfTheWall) {
  const std::string room = R"("room": {"preset": {"name": "flat"}})";
  EXPECT_EQ(wallIs(room + R"(, "stereo": {"mode": "anaglyph"})"), "");
  EXPECT_EQ(
      wallIs(room + ",\n"
                    R"("stereo": {"mode": "anaglyph", "screen_distance_m": 2})"),
      "f.json:2: /wall/stereo/screen_distance_m is given together with /wall/room, which says how "
      "far away each screen is: leave out one of the two\n");
  EXPECT_EQ(wallIs("\n"
                   R"("stereo": {"mode": "two_outputs"})"),
            "f.json:2: /wall/stereo/mode is two_outputs, and tile left has no output for each eye: "
            "let one "
            "output show left.L and another one left.R (/wall/outputs/N/tiles)\n");
  EXPECT_EQ(wallIs("\n"
                   R"("stereo": {"head": {"station": 1}})"),
            "f.json:2: /wall/stereo/head/station is 1, the station of the hand "
            "/hands/0 too; the head needs its own station\n");
}

// The nearest allowed value would have another meaning (0: no stereo, or the distance of the wall),
// so the value is refused instead of adjusted.
TEST(WallConfig, StereoDistancesOutOfRangeAreRefused) {
  EXPECT_EQ(wallIs(R"("stereo": {"mode": "anaglyph", "eye_separation_m": -0.063})"),
            "f.json:1: /wall/stereo/eye_separation_m is -0.063; allowed is 0 to 10; it is in "
            "metres, people's are 0.05 to 0.075\n");
  EXPECT_EQ(wallIs(R"("stereo": {"mode": "anaglyph", "eye_separation_m": 63})"),
            "f.json:1: /wall/stereo/eye_separation_m is 63; allowed is 0 to 10; it is in metres, "
            "people's are 0.05 to 0.075\n");
  EXPECT_EQ(wallIs(R"("stereo": {"mode": "anaglyph", "screen_distance_m": -1})"),
            "f.json:1: /wall/stereo/screen_distance_m is -1; allowed is 0 to 1000; it is in "
            "metres, usually 1 to 10; 0 is /wall/scene/wall_distance_m\n");
  const auto loaded = loadSettings(R"({"wall": {"stereo": {"eye_separation_m": -0.063}}})", "");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
}

TEST(WallConfig, StereoThatIsProbablyNotMeantIsSaidAndUsed) {
  const auto loaded =
      loadSettings(R"({"wall": {"stereo": {"mode": "anaglyph", "eye_separation_m": 0}}})", "");
  EXPECT_EQ(loaded.verdict(), Verdict::kAdjusted);
  EXPECT_EQ(findingsOf(loaded),
            "f.json:1: /wall/stereo/eye_separation_m is 0 in stereo mode anaglyph: both eyes see "
            "the same picture, without depth; people's are 0.05 to 0.075 m\n");
  const auto whole =
      loadSettings(R"({"wall": {"stereo": {"mode": "anaglyph", "size": "full"}}})", "");
  EXPECT_EQ(whole.verdict(), Verdict::kAdjusted);
  EXPECT_EQ(findingsOf(whole),
            "f.json:1: /wall/stereo/size is \"full\", which has no effect in stereo mode anaglyph: "
            "\"full\" is for side_by_side and top_bottom; leave it out\n");
  EXPECT_EQ(wallIs(R"("stereo": {"mode": "top_bottom", "size": "full"})"), "");
}

TEST(WallConfig, AnOverlayNeedsAnOperatorsTile) {
  EXPECT_EQ(wallIs(R"("operator": {"overlay": true})"), "");
  EXPECT_EQ(wallIs(R"("operator": {"overlay": true}, "tiles": {"frame_width": 640,
                       "frame_height": 480, "tiles": [{"name": "a"}]})"),
            "f.json:1: /wall/operator/overlay needs a tile of kind operator; the wall has none\n");
}

TEST(WallConfig, APanelNeedsAnOperatorsTileWithRoom) {
  EXPECT_EQ(wallIs(R"("operator": {"panel": true})"), "");
  EXPECT_EQ(wallIs(R"("operator": {"panel": true}, "tiles": {"tile_width": 319})"),
            "f.json:1: /wall/operator/panel needs a tile of kind operator of at least 320 x 240 "
            "pixels; the wall has none\n");
  EXPECT_EQ(findingsOf(loadSettings(
                R"({"bindings": [{"input": "button.3", "action": "operator_panel"}]})", "")),
            "f.json:1: /bindings/0/action is operator_panel, which needs the panel: "
            "/wall/operator/panel is off\n");
}

// In stereo, the one entry "left" stands for two placed tiles; the finding has to name the entry in
// the file.
TEST(WallConfig, AFaultOfAnOutputInStereoIsWhereTheFileHasIt) {
  EXPECT_EQ(
      wallIs(R"("stereo": {"mode": "side_by_side"}, "outputs": [
    {"kind": "png", "path": "a.png", "tiles": [
      {"tile": "left"},
      {"tile": "nobody", "x": 700}]}])"),
      "f.json:4: /wall/outputs/0/tiles/1/tile is \"nobody\"; the wall's tiles are left.L, left.R, "
      "centre.L, centre.R, right.L, right.R, operator\n");
}

}  // namespace
}  // namespace merlin
