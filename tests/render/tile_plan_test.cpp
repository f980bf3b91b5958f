// The tile plan of the wall of 1998 ([GOURLEY98] 2.4): rectangles, adjacent frusta, the operator's
// view.
#include "render/tiles/tile_plan.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

constexpr float kRadian = std::numbers::pi_v<float> / 180;

tiles::TilePlan planned(const tiles::TilesSettings& settings = {}) {
  auto plan = tiles::planTiles(settings);
  EXPECT_TRUE(plan) << plan.error().what;
  return *std::move(plan);
}

// Projects a point in eye coordinates. Returns x to the right and y up, both -1..1 in the tile, and
// the depth z.
Vector3f drawnAt(const Matrix4f& projection, const Matrix4f& view, const Vector3f& eye) {
  const Eigen::Vector4f clip = projection * view * eye.homogeneous();
  EXPECT_GT(clip.w(), 0) << "behind the eye";
  return clip.head<3>() / clip.w();
}
Vector3f drawnAt(const tiles::Tile& tile, const Vector3f& eye) {
  return drawnAt(tile.projection, tile.view, eye);
}

// Returns a point in eye coordinates: `left_deg` to the left of straight ahead, `up` metres above
// the eye, at `distance` metres.
Vector3f pointAt(float left_deg, float up, float distance) {
  const float angle = left_deg * kRadian;
  return {-distance * std::sin(angle), up, -distance * std::cos(angle)};
}

// Returns the column, in the image of the whole wall, at which a tile draws the point.
float columnOf(const tiles::Tile& tile, const Vector3f& eye) {
  return static_cast<float>(tile.wall_x) +
         (drawnAt(tile, eye).x() + 1) / 2 * static_cast<float>(tile.width);
}

TEST(TilePlan, IsFourQuadrantsAsShipped) {
  const tiles::TilePlan plan = planned();
  EXPECT_EQ(plan.frame_width, 1280);
  EXPECT_EQ(plan.frame_height, 960);
  EXPECT_EQ(plan.wall_width, 1920);
  EXPECT_EQ(plan.wall_height, 480);
  struct Expected {
    const char* name;
    tiles::TileKind kind;
    int x, y, wall_x, wall_y;
  } const expected[] = {{"left", tiles::TileKind::kWall, 0, 0, 0, 0},
                        {"centre", tiles::TileKind::kWall, 640, 0, 640, 0},
                        {"right", tiles::TileKind::kWall, 0, 480, 1280, 0},
                        {"operator", tiles::TileKind::kOperator, 640, 480, -1, -1}};
  ASSERT_EQ(plan.tiles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const tiles::Tile& tile = plan.tiles[i];
    EXPECT_EQ(tile.name, expected[i].name);
    EXPECT_EQ(tile.kind, expected[i].kind);
    EXPECT_EQ(tile.x, expected[i].x);
    EXPECT_EQ(tile.y, expected[i].y);
    EXPECT_EQ(tile.wall_x, expected[i].wall_x);
    EXPECT_EQ(tile.wall_y, expected[i].wall_y);
    EXPECT_EQ(tile.width, 640);
    EXPECT_EQ(tile.height, 480);
  }
}

// A point at the right edge of the left tile must be at the left edge of the centre tile, at the
// same height.
TEST(TilePlan, FrustaTouchAndDoNotOverlap) {
  const tiles::TilePlan plan = planned();
  const tiles::Tile &left = plan.tiles[0], &centre = plan.tiles[1], &right = plan.tiles[2];
  for (const float up : {-3.0F, -0.5F, 0.0F, 0.1F, 2.0F}) {
    for (const float distance : {0.1F, 2.0F, 40.0F}) {
      const Vector3f seam = pointAt(20, up, distance), other = pointAt(-20, up, distance);
      EXPECT_NEAR(drawnAt(left, seam).x(), 1, 1e-5);
      EXPECT_NEAR(drawnAt(centre, seam).x(), -1, 1e-5);
      const float tolerance = 1e-5F * std::max(1.0F, std::abs(drawnAt(left, seam).y()));
      EXPECT_NEAR(drawnAt(left, seam).y(), drawnAt(centre, seam).y(), tolerance);
      EXPECT_NEAR(drawnAt(left, seam).z(), drawnAt(centre, seam).z(), 1e-5);
      EXPECT_NEAR(drawnAt(centre, other).x(), 1, 1e-5);
      EXPECT_NEAR(drawnAt(right, other).x(), -1, 1e-5);
      EXPECT_NEAR(drawnAt(centre, other).y(), drawnAt(right, other).y(), tolerance);
    }
  }
}

TEST(TilePlan, TilesLookWhereTheirNameSays) {
  const tiles::TilePlan plan = planned();
  const float ahead[] = {40, 0, -40};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3f middle = drawnAt(plan.tiles[i], pointAt(ahead[i], 0, 5));
    EXPECT_NEAR(middle.x(), 0, 1e-6) << plan.tiles[i].name;
    EXPECT_NEAR(middle.y(), 0, 1e-6);
    EXPECT_GT(drawnAt(plan.tiles[i], pointAt(ahead[i], 1, 5)).y(), 0) << "up is up";
    EXPECT_GT(drawnAt(plan.tiles[i], pointAt(ahead[i] - 5, 0, 5)).x(), 0) << "right is right";
  }
}

// From the image's left edge at 60 degrees to its right edge, the column must increase without a
// jump at the seams, whatever the field of view.
TEST(TilePlan, TheWallsPictureGoesOnAcrossItsSeams) {
  for (const float fov : {10.0F, 40.0F, 60.0F, 100.0F}) {
    tiles::TilesSettings settings;
    settings.field_of_view_deg = fov;
    const tiles::TilePlan plan = planned(settings);
    float last = -1e-3F;
    for (int step = 0; step <= 3000; ++step) {
      const float left_deg = 1.5F * fov - fov * static_cast<float>(step) / 1000;
      const tiles::Tile& tile = plan.tiles[static_cast<std::size_t>(std::min(step / 1000, 2))];
      const float column = columnOf(tile, pointAt(left_deg, 0, 3));
      ASSERT_GT(column, last) << fov << " " << left_deg;
      // A step of a thousandth of a tile's field of view is widest at the edge of the tile.
      const float steepest = 0.001F * fov * kRadian / 2 * 640 / std::tan(fov / 2 * kRadian) /
                             std::pow(std::cos(fov / 2 * kRadian), 2.0F);
      ASSERT_TRUE(step == 0 || column - last < 1.05F * steepest) << fov << " " << left_deg;
      last = column;
    }
    EXPECT_NEAR(last, 1920, 1e-2);
  }
}

TEST(TilePlan, WallTilesAreOrderedByWhereTheyLook) {
  tiles::TilesSettings settings;
  settings.tiles = {{"far right", tiles::TileKind::kWall, 0, 0, -1.5},
                    {"operator", tiles::TileKind::kOperator, 640, 0, 0},
                    {"far left", tiles::TileKind::kWall, 0, 480, 2},
                    {"ahead", tiles::TileKind::kWall, 640, 480, 0.5}};
  const tiles::TilePlan plan = planned(settings);
  EXPECT_EQ(plan.tiles[2].wall_x, 0);
  EXPECT_EQ(plan.tiles[3].wall_x, 640);
  EXPECT_EQ(plan.tiles[0].wall_x, 1280);
  EXPECT_EQ(plan.tiles[1].wall_x, -1);
  EXPECT_EQ(plan.wall_width, 1920);
  settings.tiles = {{"operator", tiles::TileKind::kOperator, 0, 0, 0}};
  EXPECT_EQ(planned(settings).wall_width, 0);
  EXPECT_EQ(planned(settings).wall_height, 0);
}

// A field of view of 90 degrees, aspect ratio 2:1, near 1 m, far 3 m.
TEST(Perspective, IsWhatAHandComputes) {
  const Matrix4f m = tiles::perspective(90 * kRadian, 2, 1, 3);
  Matrix4f expected;
  expected << 1, 0, 0, 0,  //
      0, 2, 0, 0,          //
      0, 0, -2, -3,        //
      0, 0, -1, 0;
  EXPECT_TRUE(m.isApprox(expected, 1e-6F)) << m;
  const Matrix4f view = Matrix4f::Identity();
  EXPECT_TRUE(drawnAt(m, view, {1, 0.5F, -1}).isApprox(Vector3f(1, 1, -1), 1e-6F)) << "near";
  EXPECT_TRUE(drawnAt(m, view, {-3, -1.5F, -3}).isApprox(Vector3f(-1, -1, 1), 1e-6F)) << "far";
}

TEST(YawView, TurnsTheEyeToTheLeft) {
  const Matrix4f view = tiles::yawView(90 * kRadian);
  const Vector3f left = (view * Vector3f(-5, 1, 0).homogeneous()).head<3>();
  EXPECT_TRUE(left.isApprox(Vector3f(0, 1, -5), 1e-6F)) << left;
  EXPECT_TRUE((tiles::yawView(0.3F) * tiles::yawView(-0.3F)).isIdentity(1e-6F));
}

// Expects that the whole sphere is visible and almost touches an edge of the image.
void expectSphereFits(const Matrix4f& projection, const Vector3f& centre, float radius) {
  const Matrix4f view = tiles::operatorView(projection, centre, radius);
  Random random(7);
  float widest = 0;
  const auto look = [&](const Vector3f& direction) {
    const Vector3f at = drawnAt(projection, view, centre + radius * direction.normalized());
    ASSERT_LE(at.head<2>().cwiseAbs().maxCoeff(), 1 + 5e-4F) << centre.transpose() << radius;
    widest = std::max(widest, at.head<2>().cwiseAbs().maxCoeff());
  };
  for (int i = 0; i < 200; ++i) {
    look({static_cast<float>(random.normal()), static_cast<float>(random.normal()),
          static_cast<float>(random.normal())});
  }
  // The vertical and the horizontal great circle through the front of the sphere, where it looks
  // largest.
  for (float a = 0; a < 6.28F; a += 0.01F) {
    look({std::cos(a), 0, std::sin(a)});
    look({0, std::cos(a), std::sin(a)});
  }
  EXPECT_GT(widest, 0.999F);
}

TEST(OperatorView, HoldsTheSphereWhereverItIs) {
  for (const float aspect : {4.0F / 3, 1.0F, 0.5F}) {
    for (const float fov : {10.0F, 40.0F, 90.0F, 150.0F}) {
      const Matrix4f projection = tiles::perspective(fov * kRadian, aspect, 0.05F, 50);
      for (const Vector3f& centre :
           {Vector3f(0, 0, 0), Vector3f(0, 0, -2), Vector3f(3, -1, 7), Vector3f(-9, 20, -30)}) {
        for (const float radius : {0.1F, 1.0F, 12.0F}) {
          expectSphereFits(projection, centre, radius);
        }
      }
    }
  }
}

TEST(OperatorView, LooksFromTheFrontAndDoesNotTurn) {
  const Matrix4f projection = tiles::perspective(90 * kRadian, 1, 0.05F, 50);
  const Matrix4f view = tiles::operatorView(projection, {1, 2, -3}, 1);
  const Matrix4f turn = [&] {
    Matrix4f m = view;
    m.block<3, 1>(0, 3).setZero();
    return m;
  }();
  EXPECT_TRUE(turn.isIdentity(0));
  const Vector3f centre = (view * Vector3f(1, 2, -3).homogeneous()).head<3>();
  EXPECT_TRUE(centre.isApprox(Vector3f(0, 0, -std::numbers::sqrt2_v<float>), 1e-6F)) << centre;
}

// Three tiles of 40 degrees around the eye see 60 degrees to either side, up to the distance far_m.
TEST(SeesBox, OfTheWallsTilesOnlyAndByTheirFrusta) {
  const tiles::TilePlan plan = planned({});
  const auto sees = [&](const Vector3f& centre, float half = 0.5F) {
    Matrix4f box = Matrix4f::Identity() * half;
    box.block<3, 1>(0, 3) = centre;
    box(3, 3) = 1;
    return tiles::seesBox(plan, box);
  };
  EXPECT_TRUE(sees({0, 0, -2}));
  EXPECT_TRUE(sees({0, 0, 0}));
  EXPECT_TRUE(sees({-3, 0, -2}));
  EXPECT_TRUE(sees({3, 0, -2}));
  EXPECT_TRUE(sees({0, 0, 30}, 100));  // the eye is inside the box
  EXPECT_TRUE(sees({0, 0, -50.4F}));
  EXPECT_FALSE(sees({0, 0, -50.6F}));
  EXPECT_FALSE(sees({0, 0, 2}));
  EXPECT_FALSE(sees({0, 9, -2}));
  EXPECT_FALSE(sees({-20, 0, -2}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(sees({nan, 0, 0}));
  EXPECT_FALSE(sees({0, 0, -1e30F}));
  tiles::TilesSettings operators_only;
  operators_only.tiles.erase(operators_only.tiles.begin(), operators_only.tiles.begin() + 3);
  EXPECT_FALSE(tiles::seesBox(planned(operators_only), Matrix4f::Identity()));
}

TEST(TilePlan, TheOperatorsTileHasNoTurn) {
  tiles::TilesSettings settings;
  settings.tiles[3].turns = 3;
  EXPECT_TRUE(planned(settings).tiles[3].view.isIdentity(0));
  EXPECT_EQ(planned(settings).tiles[3].projection, planned(settings).tiles[0].projection);
}

TEST(TilePlan, TilesThatLookUpwardsAreAboveInTheWallsPicture) {
  tiles::TilesSettings s;
  s.tiles = {{"low right", tiles::TileKind::kWall, 0, 0, -1},
             {"high right", tiles::TileKind::kWall, 640, 0, -1},
             {"low", tiles::TileKind::kWall, 0, 480, 0},
             {"high", tiles::TileKind::kWall, 640, 480, 0}};
  s.tiles[1].direction_deg = s.tiles[3].direction_deg = {0, 30, 0};
  const tiles::TilePlan plan = planned(s);
  const std::pair<int, int> expected[] = {{640, 480}, {640, 0}, {0, 480}, {0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(std::pair(plan.tiles[i].wall_x, plan.tiles[i].wall_y), expected[i])
        << plan.tiles[i].name;
  }
  EXPECT_EQ(plan.wall_height, 960);
}

// In the wall's picture no tile covers another one, and all tiles are inside the picture, whatever
// their directions are.
TEST(TilePlan, NoTileCoversAnotherInTheWallsPicture) {
  Random random(4);
  for (int wall = 0; wall < 500; ++wall) {
    tiles::TilesSettings s;
    s.tile_width = 64;
    s.tile_height = 48;
    s.tiles.clear();
    for (int i = 0; i < 12; ++i) {
      tiles::TileSettings t{"t" + std::to_string(i), tiles::TileKind::kWall, 80 * i, 0};
      t.turns = i;
      t.width = 8 + static_cast<int>(64 * random.uniform());
      t.height = 8 + static_cast<int>(64 * random.uniform());
      t.direction_deg = {-40.0 * i + 90 * random.uniform(), 160 * random.uniform() - 80,
                         360 * random.uniform()};
      if (i > 0 && random.uniform() < 0.3) t.direction_deg = s.tiles.back().direction_deg;
      s.tiles.push_back(t);
    }
    const tiles::TilePlan plan = planned(s);
    for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
      const tiles::Tile& a = plan.tiles[i];
      ASSERT_TRUE(a.wall_x >= 0 && a.wall_x + a.width <= plan.wall_width);
      ASSERT_TRUE(a.wall_y >= 0 && a.wall_y + a.height <= plan.wall_height);
      for (std::size_t k = 0; k < i; ++k) {
        const tiles::Tile& b = plan.tiles[k];
        const bool apart = a.wall_x + a.width <= b.wall_x || b.wall_x + b.width <= a.wall_x ||
                           a.wall_y + a.height <= b.wall_y || b.wall_y + b.height <= a.wall_y;
        ASSERT_TRUE(apart) << "wall " << wall << ": " << a.name << " and " << b.name;
      }
    }
  }
}

TEST(TilePlan, TilesMayHaveSizesOfTheirOwn) {
  tiles::TilesSettings s;
  s.frame_width = 1640;
  s.tiles = {{"big", tiles::TileKind::kWall, 0, 0, 0},
             {"tall", tiles::TileKind::kWall, 1000, 0, -1}};
  s.tiles[0].width = 1000;
  s.tiles[0].height = 500;
  s.tiles[1].height = 960;
  const tiles::TilePlan plan = planned(s);
  EXPECT_EQ(plan.tiles[0].width, 1000);
  EXPECT_EQ(plan.tiles[0].height, 500);
  EXPECT_EQ(plan.tiles[1].width, 640);
  EXPECT_EQ(plan.tiles[1].height, 960);
  EXPECT_EQ(plan.wall_width, 1640);
  EXPECT_EQ(plan.wall_height, 960);
  EXPECT_EQ(plan.tiles[1].wall_x, 1000);
  EXPECT_NEAR(plan.tiles[0].projection(1, 1) / plan.tiles[0].projection(0, 0), 2, 1e-6)
      << "square pixels";
  s.tiles[0].width = 1001;
  EXPECT_FALSE(tiles::planTiles(s)) << "now they overlap in the frame";
}

TEST(TilePlan, ADirectionTurnsTheViewAfterItsTurns) {
  tiles::TilesSettings s;
  s.tiles = {{"up", tiles::TileKind::kWall, 0, 0, 1}};
  s.tiles[0].direction_deg = {5, 10, 90};
  const tiles::Tile tile = planned(s).tiles[0];
  // 45 degrees to the left (40 from its turn, 5 from its yaw) and 10 upwards: the tile's centre.
  const Vector3f middle = drawnAt(tile, pointAt(45, 3 * std::tan(10 * kRadian), 3));
  EXPECT_NEAR(middle.x(), 0, 1e-5);
  EXPECT_NEAR(middle.y(), 0, 1e-5);
  const Vector3f above = drawnAt(tile, pointAt(45, 3 * std::tan(12 * kRadian), 3));
  EXPECT_GT(above.x(), 0.05F) << "rolled counter-clockwise: what is above lies to the right";
  EXPECT_NEAR(above.y(), 0, 1e-5);
}

TEST(TilePlan, AnOffAxisFrustumHasItsEdgesAtItsAngles) {
  tiles::TilesSettings s;
  s.tiles = {{"side", tiles::TileKind::kWall, 0, 0, 0}};
  s.tiles[0].frustum_deg = {-10, 35, -20, 5};
  const tiles::Tile tile = planned(s).tiles[0];
  EXPECT_NEAR(drawnAt(tile, pointAt(10, 0, 3)).x(), -1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(-35, 0, 3)).x(), 1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(0, 3 * std::tan(5 * kRadian), 3)).y(), 1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(0, -3 * std::tan(20 * kRadian), 3)).y(), -1, 1e-5);
}

// A hinged wall has two screens of 1.6 x 1.2 m at an angle of 120 degrees, with the eye off-centre.
// A point must be drawn where the line from the eye to the point crosses the screen.
TEST(TilePlan, AScreenIsLookedThroughAtItsCorners) {
  const Vector3f lower_left(-1.4F, -0.7F, -1.1F), hinge(0.0F, -0.7F, -1.9F),
      lower_right(1.4F, -0.7F, -1.1F), up(0, 1.2F, 0);
  tiles::TilesSettings s;
  s.tiles = {{"right", tiles::TileKind::kWall, 0, 0, 0},
             {"left", tiles::TileKind::kWall, 640, 0, 0}};
  const auto screen = [&](const Vector3f& a, const Vector3f& b) {
    const Vector3f c = a + up;
    return std::array<double, 9>{a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z()};
  };
  s.tiles[0].screen_m = screen(hinge, lower_right);
  s.tiles[1].screen_m = screen(lower_left, hinge);
  const tiles::TilePlan plan = planned(s);
  const tiles::Tile &right = plan.tiles[0], &left = plan.tiles[1];
  EXPECT_EQ(left.wall_x, 0) << "ordered by where they are";
  EXPECT_EQ(right.wall_x, 640);
  for (const float far : {1.0F, 7.0F}) {  // the screens' corners, and points behind them
    const Vector3f at[] = {drawnAt(left, far * lower_left), drawnAt(left, far * (hinge + up)),
                           drawnAt(right, far * hinge), drawnAt(right, far * (lower_right + up))};
    const float expected[][2] = {{-1, -1}, {1, 1}, {-1, -1}, {1, 1}};
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(at[k].x(), expected[k][0], 1e-4) << k;
      EXPECT_NEAR(at[k].y(), expected[k][1], 1e-4) << k;
    }
  }
  const Vector3f middle = (hinge + lower_right + up) / 2;
  EXPECT_NEAR(drawnAt(right, 3 * middle).x(), 0, 1e-4);
}

TEST(TilePlan, FrustaThatAreNoneAreRefused) {
  const auto why = [](const std::function<void(tiles::TileSettings&)>& change) {
    tiles::TilesSettings s;
    change(s.tiles[0]);
    const auto plan = tiles::planTiles(s);
    return plan ? "" : plan.error().what;
  };
  EXPECT_EQ(why([](auto& t) { t.direction_deg = {0, 1, 0}; }), "");
  EXPECT_NE(why([](auto& t) {
              t.frustum_deg = {10, -10, -5, 5};
            }).find("left must be less"),
            std::string::npos);
  EXPECT_NE(why([](auto& t) {
              t.frustum_deg = {-90, 90, -5, 5};
            }).find("-89.5 to 89.5"),
            std::string::npos);
  EXPECT_NE(why([](auto& t) {
              t.screen_m = {-1, -1, -2, 1, -1, -2, 0, 1, -2};
            }).find("not three corners of a rectangle"),
            std::string::npos);
  EXPECT_NE(why([](auto& t) {
              t.screen_m = {1, -1, -2, -1, -1, -2, 1, 1, -2};
            }).find("does not see its front"),
            std::string::npos);
  EXPECT_EQ(why([](auto& t) { t.screen_m = {-1, -0.1, -0.005, 1, -0.1, -0.005, -1, 0.1, -0.005}; }),
            "tile left: screen_m: the screen is 179.43 x 174.28 degrees wide and high as seen from "
            "the eye; each must be less than 179");
  EXPECT_NE(why([](auto& t) {
              t.screen_m = {-1, -1, -2, 1, -1, -2, -1, 1, -2};
              t.direction_deg = {1, 0, 0};
            }).find("leave out direction_deg"),
            std::string::npos);
  EXPECT_NE(why([](auto& t) {
              t.kind = tiles::TileKind::kOperator;
              t.frustum_deg = {-10, 10, -5, 5};
            }).find("is the operator's"),
            std::string::npos);
}

// Returns the position, in clip coordinates of the tile, of a point of a content whose middle is at
// `centre`.
Vector3f shownAt(const tiles::Tile& tile, const Vector3f& centre, float radius,
                 const Vector3f& point) {
  const tiles::TileMatrices matrices = tiles::matricesOf(tile, centre, radius);
  return (matrices.projection * matrices.view * point.homogeneous()).hnormalized();
}

TEST(OwnViews, ShowTheContentAlongTheWallsAxes) {
  tiles::TilesSettings s;
  s.tiles = {{"top", tiles::TileKind::kWall, 0, 0, 0},
             {"side", tiles::TileKind::kWall, 640, 0, 0},
             {"front", tiles::TileKind::kWall, 0, 480, 0}};
  s.tiles[0].view = tiles::TileCamera::kTop;
  s.tiles[1].view = tiles::TileCamera::kSide;
  s.tiles[2].view = tiles::TileCamera::kFront;
  const tiles::TilePlan plan = planned(s);
  const Vector3f centre(3, -1, -7);
  const Vector3f right = Vector3f::UnitX(), up = Vector3f::UnitY(), near = Vector3f::UnitZ();
  // For each view: the directions that point to the right, upwards and away from the camera in its
  // picture.
  const struct {
    Vector3f right, up, away;
  } expected[] = {{right, -near, -up}, {-near, up, -right}, {right, up, -near}};
  for (std::size_t i = 0; i < 3; ++i) {
    const tiles::Tile& tile = plan.tiles[i];
    EXPECT_EQ(tile.wall_x, -1) << "no part of the wall's picture";
    const auto at = [&](const Vector3f& from_centre) {
      return shownAt(tile, centre, 2, centre + from_centre);
    };
    EXPECT_TRUE(at(Vector3f::Zero()).isZero(1e-5F));
    EXPECT_NEAR(at(2 * expected[i].right).x(), 0.75, 1e-5) << "round, in a tile of 4 : 3";
    EXPECT_NEAR(at(2 * expected[i].up).y(), 1, 1e-5) << "up to the edge";
    EXPECT_NEAR(at(2 * expected[i].away).z(), 1 / 1.05, 1e-5) << "and all of it";
    EXPECT_TRUE(at(2 * expected[i].away).head<2>().isZero(1e-5F)) << "parallel";
  }
  EXPECT_EQ(plan.wall_width, 0);
}

TEST(OwnViews, OfAFreeCameraAreItsPerspective) {
  tiles::TilesSettings s;
  s.tiles = {{"above", tiles::TileKind::kWall, 0, 0, 0}};
  s.tiles[0].view = tiles::TileCamera::kFree;
  s.tiles[0].camera = {{1, 3, -2}, {1, 0, -2}, {0, 0, -1}, 90};
  const tiles::TilePlan plan = planned(s);
  const auto at = [&](const Vector3f& p) { return shownAt(plan.tiles[0], {9, 9, 9}, 1, p); };
  EXPECT_TRUE(at({1, 0, -2}).head<2>().isZero(1e-5F)) << "looked at";
  EXPECT_NEAR(at({4, 0, -2}).x(), 1, 1e-5) << "45 degrees to the right";
  EXPECT_NEAR(at({1, 1, -3.5F}).y(), 1, 1e-5) << "up: away from the person, tan = 3 / 4";
}

// The default free camera must equal a tile of the wall that looks straight ahead.
TEST(OwnViews, OfACameraAtTheEyeAreTheWalls) {
  tiles::TilesSettings s;
  s.tiles = {{"wall", tiles::TileKind::kWall, 0, 0, 0},
             {"camera", tiles::TileKind::kWall, 640, 0, 0}};
  s.tiles[1].view = tiles::TileCamera::kFree;
  const tiles::TilePlan plan = planned(s);
  EXPECT_EQ(plan.tiles[0].projection, plan.tiles[1].projection);
  EXPECT_EQ(plan.tiles[0].view, plan.tiles[1].view);
}

// A view that is fitted to the whole content does not count as seeing the content; a free camera
// that sees it does.
TEST(OwnViews, OfTheWholeContentDoNotCountAsSeeingIt) {
  tiles::TilesSettings s;
  s.tiles = {{"wall", tiles::TileKind::kWall, 0, 0, 0},
             {"other", tiles::TileKind::kWall, 640, 0, 0}};
  Eigen::Matrix4f aside = Eigen::Matrix4f::Identity() * 0.5F;
  aside.col(3) = Eigen::Vector4f(20, 0, -2, 1);
  s.tiles[1].view = tiles::TileCamera::kTop;
  EXPECT_FALSE(tiles::seesBox(planned(s), aside));
  s.tiles[1].view = tiles::TileCamera::kFree;
  s.tiles[1].camera.look_at_m = {20, 0, -2};
  EXPECT_TRUE(tiles::seesBox(planned(s), aside));
}

}  // namespace
}  // namespace merlin::render
