// Tiles computed from the description of a room: seams, the viewer's place, presets, the canvas.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/room/canvas.h"
#include "render/room/geometry.h"
#include "render/room/presets.h"
#include "render/room/room_tiles.h"
#include "render/room/tile_table.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kRadian = std::numbers::pi / 180;

struct Wall {
  tiles::TilesSettings settings;
  tiles::TilePlan plan;

  const tiles::Tile& tile(const std::string& name) const {
    return *std::ranges::find(plan.tiles, name, &tiles::Tile::name);
  }
  const tiles::TileSettings& of(const std::string& name) const {
    return *std::ranges::find(settings.tiles, name, &tiles::TileSettings::name);
  }
};

Wall wallOf(const room::RoomSettings& room) {
  auto settings = room::roomTiles(room, {});
  EXPECT_TRUE(settings) << settings.error().what;
  auto plan = tiles::planTiles(*settings);
  EXPECT_TRUE(plan) << plan.error().what;
  return {*std::move(settings), *std::move(plan)};
}

room::RoomSettings presetRoom(room::RoomPreset name) {
  room::RoomSettings room;
  room.preset.name = name;
  return room;
}

// Returns the direction from the eye through a point of the tile's image; x and y are in -1..1, to
// the right and up.
Vector3d directionOf(const tiles::Tile& tile, float x, float y) {
  const Vector3f inside((x + tile.projection(0, 2)) / tile.projection(0, 0),
                        (y + tile.projection(1, 2)) / tile.projection(1, 1), -1);
  const Vector3f seen = tile.view.topLeftCorner<3, 3>().transpose() * inside;
  return seen.cast<double>().normalized();
}

void expectSeam(const Wall& wall, const std::string& left, const std::string& right) {
  for (const float y : {-1.0F, 1.0F}) {
    const Vector3d a = directionOf(wall.tile(left), 1, y);
    const Vector3d b = directionOf(wall.tile(right), -1, y);
    EXPECT_LT((a - b).norm(), 1e-5) << left << " " << right << " " << y;
  }
}

TEST(Room, NeighboursMeetInOneDirectionWhereverTheEyeIs) {
  for (const Vector3d& eye :
       {Vector3d(0, 0, 0), Vector3d(0.4, 0.3, -0.2), Vector3d(-0.5, -0.4, 0.1)}) {
    for (const room::RoomPreset name : {room::RoomPreset::kThree160, room::RoomPreset::kThree120}) {
      room::RoomSettings room = presetRoom(name);
      room.eye_m = {eye.x(), eye.y(), eye.z()};
      const Wall wall = wallOf(room);
      expectSeam(wall, "left", "centre");
      expectSeam(wall, "centre", "right");
    }
    room::RoomSettings room = presetRoom(room::RoomPreset::kHexagon);
    room.eye_m = {eye.x(), eye.y(), eye.z()};
    const Wall wall = wallOf(room);
    const char* const around[] = {"rear_left",   "front_left", "front",
                                  "front_right", "rear_right", "rear"};
    for (std::size_t i = 0; i < 6; ++i) expectSeam(wall, around[i], around[(i + 1) % 6]);
  }
}

// Two panels of 2 x 1 m, hinged at 120 degrees; the eye is at 0, 0, 0. The left panel ends at the
// hinge, 1 m ahead; the right one is 2 m wide and comes sqrt(3) m towards the viewer.
TEST(Room, AHingeTurnsAPanelTowardsTheViewer) {
  room::RoomSettings room;
  room.panels = {{"left", 2, 1, 0, {-2, -0.5, -1}}, {"right", 2, 1, 120}};
  const std::vector<room::Screen> panels = room::panelScreens(room);
  EXPECT_TRUE(panels[1].corner.isApprox(Vector3d(0, -0.5, -1), 1e-12)) << panels[1].corner;
  EXPECT_TRUE(panels[1].across.isApprox(Vector3d(1, 0, std::sqrt(3.0)), 1e-12));
  EXPECT_TRUE(panels[1].up.isApprox(Vector3d(0, 1, 0), 1e-12));
  room.panels[1].hinge_deg = 270;
  EXPECT_TRUE(room::panelScreens(room)[1].across.isApprox(Vector3d(0, 0, -2), 1e-12))
      << "away from him";
}

TEST(Room, YawAndPitchSayWhereAViewerLooks) {
  room::RoomSettings room;
  room.panels = {{"side", 2, 1, 0, {-3, 0, 1}, 90}, {"floor", 2, 4, 0, {-1, -1, 0}, 0, -90}};
  const std::vector<room::Screen> panels = room::panelScreens(room);
  EXPECT_TRUE(panels[0].across.isApprox(Vector3d(0, 0, -2), 1e-12)) << "on the left, faces right";
  EXPECT_TRUE(panels[0].normal().isApprox(Vector3d(1, 0, 0), 1e-12));
  EXPECT_TRUE(panels[1].up.isApprox(Vector3d(0, 0, -4), 1e-12)) << "away from the viewer";
  EXPECT_TRUE(panels[1].normal().isApprox(Vector3d(0, 1, 0), 1e-12));
}

// A panel of 2 x 1 m, 1 m away; the eye is 0.5 m right of its centre and 0.25 m above it.
TEST(Room, AnEyeBesideTheMiddleHasAnOffAxisFrustum) {
  room::RoomSettings room;
  room.panels = {{"only", 2, 1, 0, {-1, 1, -1}}};
  room.eye_m = {0.5, 1.75, 0};
  const tiles::Tile tile = wallOf(room).tile("only");
  const auto through = [&](float x, float y) {
    const Vector3d d = directionOf(tile, x, y);
    return Vector3d(d / -d.z());
  };
  EXPECT_TRUE(through(-1, -1).isApprox(Vector3d(-1.5, -0.75, -1), 1e-6));
  EXPECT_TRUE(through(1, 1).isApprox(Vector3d(0.5, 0.25, -1), 1e-6));
  EXPECT_TRUE(tile.view.isIdentity(1e-6F)) << "the view stays at right angles to the panel";
}

TEST(Room, ADisplayShowsItsPartWithoutItsBezels) {
  room::RoomSettings room;
  room.panels = {{"wall", 4, 2, 0, {-2, -1, -2}}};
  room.displays = {{"a", "", {0.5, 0.25, 1, 0.5}, 300, 200, {0.1, 0.05, 0.02, 0.03}}};
  const Wall wall = wallOf(room);
  const auto& corners = wall.of("a").screen_m;
  const double expected[] = {-1.4, -0.73, -2, -0.55, -0.73, -2, -1.4, -0.28, -2};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(corners[i], expected[i], 1e-12) << i;
  EXPECT_EQ(wall.tile("a").width, 300);
  EXPECT_EQ(wall.tile("a").height, 200);
}

// Two projectors of 1.2 x 1 m on a screen of 2 x 1 m: both show the middle 0.4 m.
TEST(Room, ProjectorsMayOverlap) {
  room::RoomSettings room;
  room.panels = {{"screen", 2, 1, 0, {-1, -0.5, -1.5}}};
  room.displays = {{"left", "screen", {0, 0, 1.2, 1}}, {"right", "screen", {0.8, 0, 1.2, 1}}};
  const Wall wall = wallOf(room);
  const Vector3d seam = Vector3d(0.2, 0.5, -1.5).normalized();
  EXPECT_LT((directionOf(wall.tile("left"), 1, 1) - seam).norm(), 1e-6);
  // In the right tile, the same point is 0.4 m from the left edge, of a width of 1.2 m.
  EXPECT_LT((directionOf(wall.tile("right"), 2 * 0.4F / 1.2F - 1, 1) - seam).norm(), 1e-6);
  const auto overlaps = room::tileOverlaps(wall.plan);
  ASSERT_EQ(overlaps.size(), 1u);
  EXPECT_EQ(overlaps[0].left, "left");
  EXPECT_EQ(overlaps[0].right, "right");
  EXPECT_NEAR(overlaps[0].width_m, 0.4, 1e-9);
  EXPECT_NEAR(overlaps[0].height_m, 1, 1e-9);
}

TEST(Room, PanelsThatTouchDoNotOverlap) {
  for (const room::RoomPreset name :
       {room::RoomPreset::kFlat, room::RoomPreset::kSix, room::RoomPreset::kHexagon})
    EXPECT_TRUE(room::tileOverlaps(wallOf(presetRoom(name)).plan).empty()) << nameOf(name);
}

TEST(Room, APanelBehindAnotherDoesNotOverlapIt) {
  room::RoomSettings room;
  room.panels = {{"near", 1, 1, 0, {-0.5, -0.5, -1}}, {"far", 1, 1, 0, {-0.5, -0.5, -1.5}}};
  EXPECT_TRUE(room::tileOverlaps(wallOf(room).plan).empty());
}

// Each direction around the viewer, at eye height, must be in exactly one tile.
TEST(RoomPresets, AHexagonClosesAroundTheViewer) {
  const Wall wall = wallOf(presetRoom(room::RoomPreset::kHexagon));
  double total_deg = 0;
  for (const room::TileFigures& f : room::tileTable(wall.settings, wall.plan)) {
    if (f.kind != tiles::TileKind::kWall) continue;
    EXPECT_NEAR(f.horizontal_deg, 60, 1e-4) << f.name;
    total_deg += f.horizontal_deg;
  }
  EXPECT_NEAR(total_deg, 360, 1e-3);
  for (int step = 0; step < 720; ++step) {
    const double left = (0.5 * step + 0.25) * kRadian;
    const Vector3f at(static_cast<float>(-std::sin(left)), 0, static_cast<float>(-std::cos(left)));
    int seen = 0;
    for (const tiles::Tile& tile : wall.plan.tiles) {
      const Eigen::Vector4f clip = tile.projection * tile.view * at.homogeneous();
      const bool inside = clip.w() > 0 && std::abs(clip.x()) < clip.w();
      seen += tile.kind == tiles::TileKind::kWall && inside ? 1 : 0;
    }
    ASSERT_EQ(seen, 1) << 0.5 * step + 0.25 << " degrees to the left";
  }
}

TEST(RoomPresets, APictureOfTheWallBeginsBehindTheViewer) {
  const Wall around = wallOf(presetRoom(room::RoomPreset::kHexagon));
  const char* const order[] = {"rear",  "rear_left",   "front_left",
                               "front", "front_right", "rear_right"};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(around.tile(order[i]).wall_x, 640 * i) << order[i];
  EXPECT_EQ(around.plan.wall_width, 6 * 640);
}

// In the picture of the wall, the tiles must be in rows and columns as the frames are in the room,
// also for projectors that overlap, and wherever the viewer looks.
TEST(RoomPresets, FramesAboveOneAnotherAreSoInAPictureOfTheWall) {
  const char* const order[] = {"upper_left", "upper_centre", "upper_right",
                               "lower_left", "lower_centre", "lower_right"};
  for (const double overlap_m : {0.0, 0.3, 0.6}) {
    for (const Vector3d& eye : {Vector3d(0, 0, 0), {0.3, 0.1, 0.7}, {-5, 1.5, -4}, {2, -4, 3}}) {
      room::RoomSettings room = presetRoom(room::RoomPreset::kSix);
      room.preset.overlap_m = overlap_m;
      room.eye_m = {eye.x(), eye.y(), eye.z()};
      const Wall wall = wallOf(room);
      for (int i = 0; i < 6; ++i) {
        ASSERT_EQ(wall.tile(order[i]).wall_x, 640 * (i % 3)) << order[i];
        ASSERT_EQ(wall.tile(order[i]).wall_y, 480 * (i / 3)) << order[i];
      }
      EXPECT_EQ(wall.plan.wall_width, 3 * 640);
      EXPECT_EQ(wall.plan.wall_height, 2 * 480);
    }
  }
}

TEST(RoomPresets, MeasuringErrorsMoveNoFrameToAnotherRow) {
  for (const double nudge_m : {-0.01, -1e-6, 1e-6, 0.01}) {  // the upper row is moved by this much
    room::RoomSettings room = room::withPanels(presetRoom(room::RoomPreset::kSix));
    room.panels[0].lower_left_m[0] += nudge_m;
    room.panels[0].lower_left_m[1] += nudge_m;
    const Wall wall = wallOf(room);
    EXPECT_EQ(wall.tile("upper_right").wall_x, wall.tile("lower_right").wall_x);
    EXPECT_EQ(wall.tile("upper_right").wall_y, 0);
    EXPECT_EQ(wall.tile("lower_right").wall_y, 480);
  }
}

// In one wall, a wide display is below two others; in the other wall, one display is above the
// middle one of three.
TEST(Room, APictureOfTheWallHasColumnsAsTheRoomHas) {
  room::RoomSettings wide;
  wide.panels = {{"screen", 4, 3, 0, {-2, -1.5, -3}}};
  wide.displays = {{"c", "", {0, 0, 4, 1}, 1280, 300},
                   {"b", "", {2, 1, 2, 2}, 640, 640},
                   {"a", "", {0, 1, 2, 2}, 640, 640}};
  const Wall below = wallOf(wide);
  EXPECT_EQ(below.tile("a").wall_x, 0);
  EXPECT_EQ(below.tile("b").wall_x, 640);
  EXPECT_EQ(below.tile("c").wall_x, 0);
  EXPECT_EQ(below.tile("a").wall_y, 0);
  EXPECT_EQ(below.tile("b").wall_y, 0);
  EXPECT_EQ(below.tile("c").wall_y, 640);
  EXPECT_EQ(below.plan.wall_width, 1280);
  EXPECT_EQ(below.plan.wall_height, 940);

  room::RoomSettings lone = presetRoom(room::RoomPreset::kThree160);
  lone = room::withPanels(lone);
  lone.panels.push_back({"above", 1.6, 1.2, 0, {-0.8, 0.6, -4.5}});
  lone.displays.clear();
  const Wall above = wallOf(lone);
  EXPECT_EQ(above.tile("above").wall_x, above.tile("centre").wall_x);
  EXPECT_EQ(above.tile("above").wall_y, 0);
  for (const char* name : {"left", "centre", "right"}) {
    EXPECT_EQ(above.tile(name).wall_y, 480) << name;
  }
  EXPECT_EQ(above.plan.wall_width, 3 * 640);
}

struct Front {
  room::RoomPreset name;
  std::size_t panels;
  const char* front;
  double distance_m, horizontal_deg;  // distance and width [degrees] of the front panel
};

// Distances computed by hand: 0.8 m / tan(half the angle between panels). For a flat wall the
// distance is its width, 4.8 m.
TEST(RoomPresets, TheFrontIsStraightAheadAsFarAsSuggested) {
  const Front expected[] = {{room::RoomPreset::kFlat, 3, "panel_2", 4.8, 18.925},
                            {room::RoomPreset::kThree160, 3, "centre", 4.53703, 20},
                            {room::RoomPreset::kThree120, 3, "centre", 1.38564, 60},
                            {room::RoomPreset::kHexagon, 6, "front", 1.38564, 60},
                            {room::RoomPreset::kArc160, 3, "centre", 1.59293, 53.3333}};
  for (const Front& e : expected) {
    const Wall wall = wallOf(presetRoom(e.name));
    EXPECT_EQ(wall.settings.tiles.size(), e.panels + 1) << "and the operator's";
    for (const room::TileFigures& f : room::tileTable(wall.settings, wall.plan)) {
      if (f.name != e.front) continue;
      EXPECT_NEAR(f.screen->distance_m, e.distance_m, 1e-5) << nameOf(e.name);
      EXPECT_NEAR(f.horizontal_deg, e.horizontal_deg, 1e-3);
      EXPECT_NEAR(f.yaw_deg, 0, 1e-4);
      EXPECT_NEAR(f.pitch_deg, 0, 1e-4);
      EXPECT_NEAR(f.screen->pixel_pitch_mm[0], 2.5, 1e-9);
      EXPECT_NEAR(f.screen->pixel_pitch_mm[1], 2.5, 1e-9);
    }
  }
  room::RoomSettings near = presetRoom(room::RoomPreset::kThree160);
  near.preset.distance_m = 2;
  EXPECT_NEAR(wallOf(near).of("centre").screen_m[2], -2, 1e-12);
}

// [GOURLEY98] 2.4.1, 2.4.4: three flat screens with a field of view of 160 degrees, and six frames
// with 120 degrees; all equally far from the viewer, as on a circle.
TEST(RoomPresets, AnArcFillsItsShareOfTheView) {
  for (const auto& [name, panels, view_deg, distance_m] :
       {std::tuple(room::RoomPreset::kArc160, 3U, 160.0, 1.59293),
        std::tuple(room::RoomPreset::kArc120, 6U, 120.0, 4.53703)}) {
    const Wall wall = wallOf(presetRoom(name));
    ASSERT_EQ(wall.settings.tiles.size(), panels + 1);
    double sum_deg = 0, left_deg = 0;
    for (const room::TileFigures& f : room::tileTable(wall.settings, wall.plan)) {
      if (!f.screen) continue;
      EXPECT_NEAR(f.screen->distance_m, distance_m, 1e-5) << nameOf(name) << " " << f.name;
      EXPECT_NEAR(f.horizontal_deg, view_deg / panels, 1e-3) << f.name;
      EXPECT_NEAR(f.pitch_deg, 0, 1e-4);
      left_deg = std::max(left_deg, double{f.yaw_deg});
      sum_deg += f.horizontal_deg;
    }
    EXPECT_NEAR(sum_deg, view_deg, 1e-3);
    EXPECT_NEAR(left_deg, (view_deg - view_deg / panels) / 2, 1e-3) << "as far left as right";
  }
  const Wall arc = wallOf(presetRoom(room::RoomPreset::kArc120));
  for (int i = 1; i < 6; ++i)
    expectSeam(arc, "panel_" + std::to_string(i), "panel_" + std::to_string(i + 1));
}

TEST(RoomPresets, AFlatRowHasAsManyPanelsAsAskedFor) {
  room::RoomSettings room = presetRoom(room::RoomPreset::kFlat);
  room.preset.panels = 4;
  room.operator_width = room.operator_height = 0;
  const Wall wall = wallOf(room);
  ASSERT_EQ(wall.settings.tiles.size(), 4u);
  EXPECT_NEAR(wall.of("panel_1").screen_m[0], -3.2, 1e-12);
  EXPECT_NEAR(wall.of("panel_4").screen_m[3], 3.2, 1e-12);
  for (std::size_t i = 0; i < 3; ++i)
    expectSeam(wall, wall.settings.tiles[i].name, wall.settings.tiles[i + 1].name);
}

TEST(RoomPresets, SixFramesAreTwoRowsWithBezelsBetween) {
  room::RoomSettings room = presetRoom(room::RoomPreset::kSix);
  room.preset.bezel_m = 0.02;
  room.preset.width = 800;
  room.preset.height = 600;
  const Wall wall = wallOf(room);
  EXPECT_NEAR(wall.of("upper_left").screen_m[1], 0.02, 1e-12);
  EXPECT_NEAR(wall.of("lower_left").screen_m[7], -0.02, 1e-12);
  EXPECT_NEAR(wall.of("upper_left").screen_m[3], -0.82, 1e-12);
  EXPECT_NEAR(wall.of("upper_centre").screen_m[0], -0.78, 1e-12);
  EXPECT_EQ(wall.tile("lower_right").width, 800);
}

// Three pictures of 2 m on a screen of 4.8 m; neighbours overlap by 0.6 m.
TEST(RoomPresets, ProjectorsOfAFlatRowOverlapOnOneScreen) {
  room::RoomSettings room;
  room.preset.name = room::RoomPreset::kFlat;
  room.preset.overlap_m = 0.6;
  const tiles::TilesSettings wall = *room::roomTiles(room, {});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(wall.tiles[i].screen_m[0], -2.4 + 1.4 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(wall.tiles[i].screen_m[3], -0.4 + 1.4 * static_cast<double>(i), 1e-9);
  }
  const auto overlaps = room::tileOverlaps(*tiles::planTiles(wall));
  ASSERT_EQ(overlaps.size(), 2u);
  EXPECT_EQ(overlaps[0].left, "panel_1");
  EXPECT_EQ(overlaps[0].right, "panel_2");
  EXPECT_NEAR(overlaps[0].width_m, 0.6, 1e-9);
}

TEST(RoomPresets, SixProjectorsOverlapBothWays) {
  room::RoomSettings room;
  room.preset.name = room::RoomPreset::kSix;
  room.preset.overlap_m = 0.3;
  const room::RoomSettings with_panels = room::withPanels(room);
  ASSERT_EQ(with_panels.panels.size(), 1u);
  EXPECT_TRUE(validate(with_panels, {}).empty());
  ASSERT_EQ(with_panels.displays.size(), 6u);
  EXPECT_EQ(with_panels.displays[2].name, "upper_right");
  const auto& part = with_panels.displays[2].part_m;
  EXPECT_NEAR(part[0] + part[2], 4.8, 1e-9) << "to the right edge of the screen";
  EXPECT_NEAR(part[1] + part[3], 2.4, 1e-9) << "and to its upper one";
  EXPECT_NEAR(part[2], 1.8, 1e-9);
  EXPECT_NEAR(part[3], 1.35, 1e-9);
  EXPECT_EQ(room::tileOverlaps(*tiles::planTiles(*room::roomTiles(room, {}))).size(), 7u + 4u)
      << "side by side, above, across";
}

TEST(RoomPresets, ExplicitPanelsMakeTheSameTiles) {
  for (int i = 1; i < static_cast<int>(std::size(room::kRoomPresetNames)); ++i) {
    room::RoomSettings room = presetRoom(static_cast<room::RoomPreset>(i));
    room.preset.bezel_m = 0.01;
    room.eye_m = {0.1, 0.2, 0.3};
    const room::RoomSettings panels = room::withPanels(room);
    EXPECT_EQ(panels.preset, room::RoomPresetSettings{});
    EXPECT_EQ(panels.panels.size(), room::panelCount(room.preset));
    const Wall a = wallOf(room), b = wallOf(panels);
    ASSERT_EQ(a.settings.tiles.size(), b.settings.tiles.size());
    for (std::size_t k = 0; k < a.settings.tiles.size(); ++k) {
      EXPECT_EQ(a.settings.tiles[k].name, b.settings.tiles[k].name);
      EXPECT_EQ(a.settings.tiles[k].screen_m, b.settings.tiles[k].screen_m);
    }
  }
}

TEST(RoomTiles, TheFrameIsThatOfTheTiles) {
  const Wall wall = wallOf(presetRoom(room::RoomPreset::kThree160));
  EXPECT_EQ(wall.plan.frame_width, 1280) << "three of 640 x 480 and the operator's";
  EXPECT_EQ(wall.plan.frame_height, 960);
  EXPECT_EQ(wall.tile("operator").kind, tiles::TileKind::kOperator);
  tiles::TilesSettings base;
  base.near_m = 0.2;
  base.tile_width = 1024;
  base.tile_height = 768;
  const auto tiles = room::roomTiles(presetRoom(room::RoomPreset::kThree160), base);
  ASSERT_TRUE(tiles);
  EXPECT_EQ(tiles->near_m, 0.2);
  EXPECT_EQ(tiles->tiles[0].width, 1024) << "displays without a size have that of all tiles";
}

TEST(Canvas, TilesNeverOverlapWhateverTheirSizes) {
  Random random(16);
  for (int round = 0; round < 300; ++round) {
    std::vector<tiles::TileSettings> tiles(1 + random.below(tiles::kMostTiles));
    std::int64_t area = 0;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      tiles[i].name = std::to_string(i);
      tiles[i].turns = static_cast<double>(i);
      tiles[i].width = 16 + static_cast<int>(random.below(2000));
      tiles[i].height = 16 + static_cast<int>(random.below(2000));
      area += std::int64_t{tiles[i].width} * tiles[i].height;
    }
    const room::CanvasSize size = room::placeOnCanvas(tiles);
    ASSERT_FALSE(size.isTooLarge());
    tiles::TilesSettings settings;
    settings.frame_width = size.width;
    settings.frame_height = size.height;
    settings.tiles = tiles;
    const SettingFaults faults = validate(settings);
    ASSERT_TRUE(faults.empty()) << faults[0].what;
    EXPECT_LT(static_cast<double>(size.width) * size.height, 3 * static_cast<double>(area));
  }
}

// A single row or column of seven tiles would waste no space, but it would be at least 15120 pixels
// long.
TEST(Canvas, AFrameIsRatherSquareThanFull) {
  std::vector<tiles::TileSettings> tiles(7);
  for (tiles::TileSettings& t : tiles) {
    t.width = 3840;
    t.height = 2160;
  }
  const room::CanvasSize size = room::placeOnCanvas(tiles);
  EXPECT_EQ(size.width, 2 * 3840);
  EXPECT_EQ(size.height, 4 * 2160);
  tiles.resize(3);
  for (tiles::TileSettings& t : tiles) t.width = t.height = 1000;
  EXPECT_EQ(room::placeOnCanvas(tiles).width, 1000)
      << "but a quarter of a square empty is too much";
  EXPECT_EQ(room::placeOnCanvas(tiles = {}).width, 0);
}

TEST(TileTable, KnowsTilesWithoutAScreenByTheirFrustaAlone) {
  const tiles::TilesSettings settings;
  const auto plan = tiles::planTiles(settings);
  const auto table = room::tileTable(settings, *plan);
  ASSERT_EQ(table.size(), 4u);
  EXPECT_NEAR(table[0].yaw_deg, 40, 1e-4);
  EXPECT_NEAR(table[0].horizontal_deg, 40, 1e-4);
  EXPECT_NEAR(table[0].vertical_deg, 30.53694, 1e-4);
  EXPECT_FALSE(table[0].screen);
  const room::Corners corners = room::cornersOf(settings.tiles[1], plan->tiles[1], 2);
  EXPECT_NEAR(corners[2][0], 2 * std::tan(20 * kRadian), 1e-6) << "upper right";
  EXPECT_NEAR(corners[2][2], -2, 1e-6);
}

}  // namespace
}  // namespace merlin::render
