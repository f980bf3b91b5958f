// Two eyes look through the same screens: a point in the plane of a screen has no parallax, and a
// point behind it has the parallax that follows from its distance.
#include "render/stereo/eye_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "render/room/room_tiles.h"
#include "render/stereo/anaglyph.h"
#include "render/tiles/tile_plan.h"
#include "tests/render/stereo_settings.h"

namespace merlin::render::stereo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

tiles::TilesSettings hinged() {
  room::RoomSettings room;
  room.preset.name = room::RoomPreset::kThree160;
  room.eye_m = {0.3, 0.1, -1};
  return *room::roomTiles(room, {});
}

stereo::EyeTiles eyesOf(const stereo::StereoSettings& stereo, const tiles::TilesSettings& tiles,
                        const std::vector<out::OutputSettings>& outputs = {{}}) {
  EXPECT_TRUE(validate(stereo, tiles, outputs, kWallDistance_m).empty());
  stereo::EyeTiles eyes = stereo::eyeTiles(stereo, tiles, outputs, kWallDistance_m);
  EXPECT_TRUE(validate(eyes.tiles).empty());
  EXPECT_TRUE(validate(eyes.outputs, eyes.tiles).empty());
  return eyes;
}

const tiles::Tile& tileNamed(const tiles::TilePlan& plan, const std::string& name) {
  return *std::ranges::find(plan.tiles, name, &tiles::Tile::name);
}

Vector3d shownAt(const tiles::Tile& tile, const Vector3d& point) {
  const Eigen::Matrix4d clip = (tile.projection * tile.view).cast<double>();
  return (clip * point.homogeneous()).hnormalized();
}

TEST(EyeTiles, ShowWhatLiesInTheScreenAtOnePlaceInBothPictures) {
  const tiles::TilesSettings mono = hinged();
  const stereo::EyeTiles eyes =
      eyesOf(inMode(stereo::StereoMode::kTwoOutputs), mono,
             {picture("l", {{"left.L"}, {"centre.L", 640}, {"right.L", 1280}}),
              picture("r", {{"left.R"}, {"centre.R", 640}, {"right.R", 1280}})});
  const tiles::TilePlan plan = *tiles::planTiles(eyes.tiles);
  for (const tiles::TileSettings& t : mono.tiles) {
    if (!t.followsWall()) continue;
    const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(t.screen_m.data());
    const Vector3d across = corners.col(1) - corners.col(0), up = corners.col(2) - corners.col(0);
    const tiles::Tile &left = tileNamed(plan, t.name + ".L"),
                      &right = tileNamed(plan, t.name + ".R");
    EXPECT_EQ((left.view.topLeftCorner<3, 3>()), (right.view.topLeftCorner<3, 3>()))
        << "the views are parallel, never toed in";
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {0.3, 0.8}}) {
      const Vector3d point = corners.col(0) + x * across + y * up;
      for (const tiles::Tile* tile : {&left, &right}) {
        EXPECT_NEAR(shownAt(*tile, point).x(), 2 * x - 1, 1e-5) << tile->name;
        EXPECT_NEAR(shownAt(*tile, point).y(), 2 * y - 1, 1e-5) << tile->name;
      }
    }
  }
}

// By similar triangles, the parallax on the screen is separation x (1 - distance of screen /
// distance of point).
TEST(EyeTiles, HaveTheParallaxThatThePointsDistanceSays) {
  const stereo::EyeTiles eyes =
      eyesOf(inMode(stereo::StereoMode::kAnaglyph), tiles::TilesSettings{});
  const tiles::TilePlan plan = *tiles::planTiles(eyes.tiles);
  const tiles::Tile &left = tileNamed(plan, "centre.L"), &right = tileNamed(plan, "centre.R");
  const double width_m = 2 * kWallDistance_m * std::tan(20 * M_PI / 180);
  for (const double distance_m : {0.5, 1.0, 2.0, 4.0, 40.0}) {
    const Vector3d point(0.1, -0.2, -distance_m);
    const double shift_m = (shownAt(right, point).x() - shownAt(left, point).x()) / 2 * width_m;
    EXPECT_NEAR(shift_m, 0.06 * (1 - kWallDistance_m / distance_m), 1e-5) << distance_m;
    EXPECT_NEAR(shownAt(right, point).y(), shownAt(left, point).y(), 1e-6) << "none vertically";
  }
}

TEST(EyeTiles, OfASymmetricTileHaveItsFieldOfViewInTheMiddle) {
  stereo::StereoSettings tracked;
  // With head tracking, tiles are screens in the room, but there is still only one eye.
  tracked.head.station = 2;
  tiles::TilesSettings tiles;
  tiles.tiles[0].direction_deg = {10, 20, 30};
  tiles.tiles[1].frustum_deg = {-10, 30, -5, 8};
  const tiles::TilePlan before = *tiles::planTiles(tiles);
  const stereo::EyeTiles eyes = eyesOf(tracked, tiles);
  const tiles::TilePlan plan = *tiles::planTiles(eyes.tiles);
  ASSERT_EQ(plan.tiles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(plan.tiles[i].projection.isApprox(before.tiles[i].projection, 1e-5F)) << i;
    EXPECT_TRUE(plan.tiles[i].view.isApprox(before.tiles[i].view, 1e-5F)) << i;
    EXPECT_EQ(plan.tiles[i].wall_x, before.tiles[i].wall_x) << i;
  }
}

TEST(EyeTiles, WithoutStereoAreTheTilesThatWere) {
  const stereo::EyeTiles eyes = eyesOf({}, tiles::TilesSettings{});
  ASSERT_EQ(eyes.tiles.tiles.size(), 4u);
  EXPECT_FALSE(eyes.tiles.tiles[0].hasScreen());
  EXPECT_EQ(eyes.tiles.tiles[0].turns, 1);
  EXPECT_EQ(eyes.tiles.frame_width, 1280);
}

struct Place {
  std::string name;
  int x, y, width, height;
  bool operator==(const Place&) const = default;
};
void PrintTo(const Place& p, std::ostream* out) {
  *out << p.name << " at " << p.x << ", " << p.y << ": " << p.width << " x " << p.height;
}

std::vector<Place> placesIn(const stereo::EyeTiles& eyes) {
  std::vector<Place> places;
  for (const tiles::TileSettings& t : eyes.tiles.tiles)
    places.push_back({t.name, t.x, t.y, t.width, t.height});
  return places;
}

TEST(EyeTiles, AreWhereTheirModeSays) {
  const auto placed = [](stereo::StereoMode mode, stereo::EyeSize size) {
    return placesIn(eyesOf(inMode(mode, size), oneTile()));
  };
  const Place op{"operator", 640, 0, 640, 480};
  EXPECT_EQ(placed(stereo::StereoMode::kSideBySide, stereo::EyeSize::kHalf),
            (std::vector<Place>{{"wall.L", 0, 0, 320, 480}, {"wall.R", 320, 0, 320, 480}, op}));
  EXPECT_EQ(placed(stereo::StereoMode::kTopBottom, stereo::EyeSize::kHalf),
            (std::vector<Place>{{"wall.L", 0, 0, 640, 240}, {"wall.R", 0, 240, 640, 240}, op}));
  EXPECT_EQ(placed(stereo::StereoMode::kSideBySide, stereo::EyeSize::kFull),
            (std::vector<Place>{{"wall.L", 0, 0, 640, 480}, {"wall.R", 1280, 0, 640, 480}, op}));
  EXPECT_EQ(placed(stereo::StereoMode::kTopBottom, stereo::EyeSize::kFull),
            (std::vector<Place>{{"wall.L", 0, 0, 640, 480}, {"wall.R", 0, 480, 640, 480}, op}));
  EXPECT_EQ(placed(stereo::StereoMode::kAnaglyph, stereo::EyeSize::kHalf),
            placed(stereo::StereoMode::kTopBottom, stereo::EyeSize::kFull))
      << "the frame becomes a square rather than a strip";
}

TEST(EyeTiles, OfTheLeftEyeAreTheWallsPicture) {
  const stereo::EyeTiles eyes =
      eyesOf(inMode(stereo::StereoMode::kAnaglyph), tiles::TilesSettings{});
  const tiles::TilePlan plan = *tiles::planTiles(eyes.tiles);
  EXPECT_EQ(plan.wall_width, 3 * 640);
  EXPECT_EQ(tileNamed(plan, "left.L").wall_x, 0);
  EXPECT_EQ(tileNamed(plan, "centre.L").wall_x, 640);
  EXPECT_EQ(tileNamed(plan, "centre.R").wall_x, -1);
}

// Unless the settings say otherwise, the line between the eyes is parallel to the middle tile,
// which is turned to the left here.
TEST(EyeTiles, HaveEyesAlongTheMiddleTile) {
  tiles::TilesSettings tiles;
  for (std::size_t i = 0; i < 3; ++i) tiles.tiles[i].direction_deg = {30, 0, 0};
  stereo::StereoSettings stereo = inMode(stereo::StereoMode::kAnaglyph);
  const Vector3d along(0.06 * std::cos(M_PI / 6), 0, -0.06 * std::sin(M_PI / 6));
  EXPECT_TRUE(Vector3d(eyesOf(stereo, tiles).tiles.eyes_m.data()).isApprox(along, 1e-6));
  stereo.eyes_direction = {0, 5, 0};
  EXPECT_TRUE(Vector3d(eyesOf(stereo, tiles).tiles.eyes_m.data()).isApprox(Vector3d(0, 0.06, 0)));
}

TEST(EyeTiles, ASignalHasAPartForEachEyeIfTheyAreItsHalves) {
  const auto partsOf = [](stereo::StereoMode mode, const std::vector<out::PlacedTile>& tiles) {
    const stereo::EyeTiles eyes = eyesOf(inMode(mode), oneTile(), {picture("a", tiles)});
    return stereo::signalParts(eyes.outputs[0], eyes.tiles);
  };
  using correct::SignalParts;
  EXPECT_EQ(partsOf(stereo::StereoMode::kSideBySide, {{"wall"}}), (SignalParts{2, 1}));
  EXPECT_EQ(partsOf(stereo::StereoMode::kTopBottom, {{"wall"}}), (SignalParts{1, 2}));
  EXPECT_EQ(partsOf(stereo::StereoMode::kTopBottom, {{"wall.L"}, {"wall.R", 640}}),
            (SignalParts{2, 1}))
      << "as they are placed";
  EXPECT_EQ(partsOf(stereo::StereoMode::kSideBySide, {{"wall.R"}}), (SignalParts{1, 1}));
  EXPECT_EQ(partsOf(stereo::StereoMode::kSideBySide, {{"operator"}}), (SignalParts{1, 1}));
  EXPECT_EQ(partsOf(stereo::StereoMode::kAnaglyph, {{"wall"}}), (SignalParts{1, 1}));
  EXPECT_EQ(partsOf(stereo::StereoMode::kSideBySide, {{"operator"}, {"wall", 640}}), std::nullopt);
  EXPECT_EQ(partsOf(stereo::StereoMode::kSideBySide, {{"wall", 100}}), std::nullopt)
      << "the left eye's picture is not a half";
}

// On a mirrored tile each eye's picture is mirrored, but the left eye's picture stays on the left.
TEST(EyeTiles, ArePackedOnOutputsThatShowTheirTile) {
  const std::vector<out::OutputSettings> outputs = {
      {},
      picture("a", {{"operator"}, {"wall", 640, 10, out::Mirror::kHorizontal, out::Turn::k180}}),
      picture("b", {{"wall.R"}})};
  const stereo::EyeTiles eyes = eyesOf(inMode(stereo::StereoMode::kSideBySide), oneTile(), outputs);
  EXPECT_TRUE(eyes.outputs[0].tiles.empty());
  const auto& packed = eyes.outputs[1].tiles;
  ASSERT_EQ(packed.size(), 3u);
  EXPECT_EQ(packed[1].tile, "wall.L");
  EXPECT_EQ(packed[1].x, 640);
  EXPECT_EQ(packed[2].tile, "wall.R");
  EXPECT_EQ(packed[2].x, 960);
  EXPECT_EQ(packed[2].y, 10);
  EXPECT_EQ(packed[2].mirror, out::Mirror::kHorizontal);
  EXPECT_EQ(packed[2].turn, out::Turn::k180);
  ASSERT_EQ(eyes.outputs[2].tiles.size(), 1u);
  EXPECT_EQ(eyes.outputs[2].tiles[0].tile, "wall.R");
  EXPECT_EQ(stereo::pointerInSettings(eyes, "/1/tiles/2/tile"), "/1/tiles/1/tile");
  EXPECT_EQ(stereo::pointerInSettings(eyes, "/1/tiles/0"), "/1/tiles/0");
  EXPECT_EQ(stereo::pointerInSettings(eyes, "/1/correction"), "/1/correction");
  EXPECT_EQ(stereo::pointerInSettings(eyes, ""), "");
}

TEST(EyeTiles, ArePackedOneAboveTheOther) {
  const stereo::EyeTiles eyes =
      eyesOf(inMode(stereo::StereoMode::kTopBottom, stereo::EyeSize::kFull), oneTile(),
             {picture("a", {{"wall", 7, 10}})});
  const auto& packed = eyes.outputs[0].tiles;
  ASSERT_EQ(packed.size(), 2u);
  EXPECT_EQ(packed[1].tile, "wall.R");
  EXPECT_EQ(packed[1].x, 7);
  EXPECT_EQ(packed[1].y, 490);
}

TEST(EyeTiles, AreOneAnaglyphOnEachOutputButInSharedMemory) {
  const stereo::EyeTiles eyes = eyesOf(inMode(stereo::StereoMode::kAnaglyph), oneTile(),
                                       {{}, picture("a", {}), picture("b", {{"wall", 5}})});
  EXPECT_TRUE(eyes.outputs[0].tiles.empty());
  ASSERT_EQ(eyes.outputs[1].tiles.size(), 2u);
  EXPECT_EQ(eyes.outputs[1].tiles[0].tile, "wall.L");
  EXPECT_EQ(eyes.outputs[1].tiles[0].right_eye, "wall.R");
  EXPECT_EQ(eyes.outputs[1].tiles[1].tile, "operator");
  EXPECT_EQ(eyes.outputs[1].tiles[1].x, 640);
  EXPECT_EQ(eyes.outputs[1].tiles[1].right_eye, "");
  EXPECT_EQ(stereo::pointerInSettings(eyes, "/1/tiles/1"), "/1")
      << "no tile is named in the settings";
  EXPECT_EQ(eyes.outputs[2].tiles[0].x, 5);
  EXPECT_EQ(eyes.outputs[2].tiles[0].right_eye, "wall.R");
  const out::PictureSize size = *out::pictureSize(eyes.outputs[1], eyes.tiles);
  EXPECT_EQ(size.width, 1280);
  EXPECT_EQ(size.height, 480) << "without the second part of the frame";
}

TEST(Anaglyph, TakesBrightnessFromTheLeftEyeAndGreenAndBlueFromTheRightOne) {
  const std::vector<std::uint8_t> left = {255, 255, 255, 255, 0,  0,   0,  0,
                                          255, 0,   0,   9,   10, 200, 30, 9};
  const std::vector<std::uint8_t> right = {1, 2, 3, 4, 255, 255, 255, 255, 7, 8, 9, 9, 0, 0, 0, 9};
  std::vector<std::uint8_t> out(16);
  stereo::composeAnaglyph(left, right, out);
  EXPECT_EQ(out, (std::vector<std::uint8_t>{255, 2, 3, 255, 0, 255, 255, 255, 77, 8, 9, 255, 124, 0,
                                            0, 255}));
  std::vector<std::uint8_t> same = left;
  stereo::composeAnaglyph(same, right, same);
  EXPECT_EQ(same, out) << "in place";
}

// The viewer moves towards the screen and to the right. The frusta change, but the screen's corners
// must remain at the tiles' corners.
TEST(PlaceViewer, KeepsEachScreensCornersAtTheTilesCorners) {
  tiles::TilePlan plan =
      *tiles::planTiles(eyesOf(inMode(stereo::StereoMode::kAnaglyph), hinged()).tiles);
  const tiles::TilePlan before = plan;
  const tiles::Viewer viewer{{0.3, -0.2, -0.4}, {0.05, 0.02, 0}};
  ASSERT_TRUE(tiles::placeViewer(plan, viewer));
  for (const tiles::Tile& t : plan.tiles) {
    if (!t.followsWall()) continue;
    const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(t.screen_m.data());
    EXPECT_NEAR(shownAt(t, corners.col(0)).x(), -1, 1e-5);
    EXPECT_NEAR(shownAt(t, corners.col(0)).y(), -1, 1e-5);
    EXPECT_NEAR(shownAt(t, corners.col(1)).x(), 1, 1e-5);
    EXPECT_NEAR(shownAt(t, corners.col(2)).y(), 1, 1e-5);
    const Vector3f eye = -t.view.topLeftCorner<3, 3>().transpose() * t.view.block<3, 1>(0, 3);
    EXPECT_TRUE(eye.cast<double>().isApprox(viewer.placeOf(t.eye), 1e-5)) << t.name;
  }
  ASSERT_TRUE(tiles::placeViewer(plan, {{0, 0, 0}, Vector3d(0.06, 0, 0)}));
  for (std::size_t i = 0; i < plan.tiles.size(); ++i)
    EXPECT_EQ(plan.tiles[i].projection, before.tiles[i].projection) << "and back";
}

TEST(PlaceViewer, RefusesAPlaceBehindAScreenOrThatAlmostTouchesIt) {
  tiles::TilePlan plan =
      *tiles::planTiles(eyesOf(inMode(stereo::StereoMode::kAnaglyph), hinged()).tiles);
  const tiles::TilePlan before = plan;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3d& place : {Vector3d(0, 0, -9), Vector3d(-0.3, 0, -3.536), Vector3d(0, nan, 0)})
    EXPECT_FALSE(tiles::placeViewer(plan, {place, Vector3d(0.06, 0, 0)})) << place.transpose();
  for (std::size_t i = 0; i < plan.tiles.size(); ++i)
    EXPECT_EQ(plan.tiles[i].projection, before.tiles[i].projection);
}

}  // namespace
}  // namespace merlin::render::stereo
