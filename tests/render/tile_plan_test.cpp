// The plan of the wall of 1998 ([GOURLEY98] 2.4): rectangles, frusta that touch, the operator's
// view.
#include "render/tiles/tile_plan.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

constexpr float kRadian = std::numbers::pi_v<float> / 180;

TilePlan planned(const TilesSettings& settings = {}) {
  auto plan = planTiles(settings);
  EXPECT_TRUE(plan) << plan.error().what;
  return *std::move(plan);
}

// Where a point in eye coordinates is drawn: x right, y up, -1..1 in the tile; z depth.
Vector3f drawnAt(const Matrix4f& projection, const Matrix4f& view, const Vector3f& eye) {
  const Eigen::Vector4f clip = projection * view * eye.homogeneous();
  EXPECT_GT(clip.w(), 0) << "behind the eye";
  return clip.head<3>() / clip.w();
}
Vector3f drawnAt(const Tile& tile, const Vector3f& eye) {
  return drawnAt(tile.projection, tile.view, eye);
}

// `left_deg` to the left of straight ahead, `up` metres above the eye, `distance` away.
Vector3f pointAt(float left_deg, float up, float distance) {
  const float angle = left_deg * kRadian;
  return {-distance * std::sin(angle), up, -distance * std::cos(angle)};
}

// Column of the wall's picture in which a tile draws a point.
float columnOf(const Tile& tile, const Vector3f& eye) {
  return static_cast<float>(tile.wall_x) +
         (drawnAt(tile, eye).x() + 1) / 2 * static_cast<float>(tile.width);
}

TEST(TilePlan, IsFourQuadrantsAsShipped) {
  const TilePlan plan = planned();
  EXPECT_EQ(plan.frame_width, 1280);
  EXPECT_EQ(plan.frame_height, 960);
  EXPECT_EQ(plan.wall_width, 1920);
  EXPECT_EQ(plan.wall_height, 480);
  struct Expected {
    const char* name;
    TileKind kind;
    int x, y, wall_x;
  } const expected[] = {{"left", TileKind::kWall, 0, 0, 0},
                        {"centre", TileKind::kWall, 640, 0, 640},
                        {"right", TileKind::kWall, 0, 480, 1280},
                        {"operator", TileKind::kOperator, 640, 480, -1}};
  ASSERT_EQ(plan.tiles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Tile& tile = plan.tiles[i];
    EXPECT_EQ(tile.name, expected[i].name);
    EXPECT_EQ(tile.kind, expected[i].kind);
    EXPECT_EQ(tile.x, expected[i].x);
    EXPECT_EQ(tile.y, expected[i].y);
    EXPECT_EQ(tile.wall_x, expected[i].wall_x);
    EXPECT_EQ(tile.width, 640);
    EXPECT_EQ(tile.height, 480);
  }
}

// What the left tile shows at its right edge, the centre shows at its left edge, as high.
TEST(TilePlan, FrustaTouchAndDoNotOverlap) {
  const TilePlan plan = planned();
  const Tile &left = plan.tiles[0], &centre = plan.tiles[1], &right = plan.tiles[2];
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
  const TilePlan plan = planned();
  const float ahead[] = {40, 0, -40};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3f middle = drawnAt(plan.tiles[i], pointAt(ahead[i], 0, 5));
    EXPECT_NEAR(middle.x(), 0, 1e-6) << plan.tiles[i].name;
    EXPECT_NEAR(middle.y(), 0, 1e-6);
    EXPECT_GT(drawnAt(plan.tiles[i], pointAt(ahead[i], 1, 5)).y(), 0) << "up is up";
    EXPECT_GT(drawnAt(plan.tiles[i], pointAt(ahead[i] - 5, 0, 5)).x(), 0) << "right is right";
  }
}

// From the picture's left edge at 60 degrees to its right edge: columns only grow, without a step
// at the seams, whatever the field of view.
TEST(TilePlan, TheWallsPictureGoesOnAcrossItsSeams) {
  for (const float fov : {10.0F, 40.0F, 60.0F, 100.0F}) {
    TilesSettings settings;
    settings.field_of_view_deg = fov;
    const TilePlan plan = planned(settings);
    float last = -1e-3F;
    for (int step = 0; step <= 3000; ++step) {
      const float left_deg = 1.5F * fov - fov * static_cast<float>(step) / 1000;
      const Tile& tile = plan.tiles[static_cast<std::size_t>(std::min(step / 1000, 2))];
      const float column = columnOf(tile, pointAt(left_deg, 0, 3));
      ASSERT_GT(column, last) << fov << " " << left_deg;
      // Nowhere does a step of a thousandth of a tile take more than at a tile's edge.
      const float steepest = 0.001F * fov * kRadian / 2 * 640 / std::tan(fov / 2 * kRadian) /
                             std::pow(std::cos(fov / 2 * kRadian), 2.0F);
      ASSERT_TRUE(step == 0 || column - last < 1.05F * steepest) << fov << " " << left_deg;
      last = column;
    }
    EXPECT_NEAR(last, 1920, 1e-2);
  }
}

TEST(TilePlan, WallTilesAreOrderedByWhereTheyLook) {
  TilesSettings settings;
  settings.tiles = {{"far right", TileKind::kWall, 0, 0, -1.5},
                    {"operator", TileKind::kOperator, 640, 0, 0},
                    {"far left", TileKind::kWall, 0, 480, 2},
                    {"ahead", TileKind::kWall, 640, 480, 0.5}};
  const TilePlan plan = planned(settings);
  EXPECT_EQ(plan.tiles[2].wall_x, 0);
  EXPECT_EQ(plan.tiles[3].wall_x, 640);
  EXPECT_EQ(plan.tiles[0].wall_x, 1280);
  EXPECT_EQ(plan.tiles[1].wall_x, -1);
  EXPECT_EQ(plan.wall_width, 1920);
  settings.tiles = {{"operator", TileKind::kOperator, 0, 0, 0}};
  EXPECT_EQ(planned(settings).wall_width, 0);
  EXPECT_EQ(planned(settings).wall_height, 0);
}

// 90 degrees wide, 2 : 1, from 1 m to 3 m.
TEST(Perspective, IsWhatAHandComputes) {
  const Matrix4f m = perspective(90 * kRadian, 2, 1, 3);
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
  const Matrix4f view = yawView(90 * kRadian);
  const Vector3f left = (view * Vector3f(-5, 1, 0).homogeneous()).head<3>();
  EXPECT_TRUE(left.isApprox(Vector3f(0, 1, -5), 1e-6F)) << left;
  EXPECT_TRUE((yawView(0.3F) * yawView(-0.3F)).isIdentity(1e-6F));
}

// The whole sphere is in the picture, and it fills it: somewhere it touches an edge, nearly.
void expectSphereFits(const Matrix4f& projection, const Vector3f& centre, float radius) {
  const Matrix4f view = operatorView(projection, centre, radius);
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
  // Circles through the front, up and sideways, where a sphere looks largest.
  for (float a = 0; a < 6.28F; a += 0.01F) {
    look({std::cos(a), 0, std::sin(a)});
    look({0, std::cos(a), std::sin(a)});
  }
  EXPECT_GT(widest, 0.999F);
}

TEST(OperatorView, HoldsTheSphereWhereverItIs) {
  for (const float aspect : {4.0F / 3, 1.0F, 0.5F}) {
    for (const float fov : {10.0F, 40.0F, 90.0F, 150.0F}) {
      const Matrix4f projection = perspective(fov * kRadian, aspect, 0.05F, 50);
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
  const Matrix4f projection = perspective(90 * kRadian, 1, 0.05F, 50);
  const Matrix4f view = operatorView(projection, {1, 2, -3}, 1);
  const Matrix4f turn = [&] {
    Matrix4f m = view;
    m.block<3, 1>(0, 3).setZero();
    return m;
  }();
  EXPECT_TRUE(turn.isIdentity(0));
  const Vector3f centre = (view * Vector3f(1, 2, -3).homogeneous()).head<3>();
  EXPECT_TRUE(centre.isApprox(Vector3f(0, 0, -std::numbers::sqrt2_v<float>), 1e-6F)) << centre;
}

// Three tiles of 40 degrees about the eye: 60 degrees to either side, up to far_m.
TEST(SeesBox, OfTheWallsTilesOnlyAndByTheirFrusta) {
  const TilePlan plan = planned({});
  const auto sees = [&](const Vector3f& centre, float half = 0.5F) {
    Matrix4f box = Matrix4f::Identity() * half;
    box.block<3, 1>(0, 3) = centre;
    box(3, 3) = 1;
    return seesBox(plan, box);
  };
  EXPECT_TRUE(sees({0, 0, -2}));
  EXPECT_TRUE(sees({0, 0, 0}));
  EXPECT_TRUE(sees({-3, 0, -2}));
  EXPECT_TRUE(sees({3, 0, -2}));
  EXPECT_TRUE(sees({0, 0, 30}, 100));  // the eye is in it
  EXPECT_TRUE(sees({0, 0, -50.4F}));
  EXPECT_FALSE(sees({0, 0, -50.6F}));
  EXPECT_FALSE(sees({0, 0, 2}));
  EXPECT_FALSE(sees({0, 9, -2}));
  EXPECT_FALSE(sees({-20, 0, -2}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(sees({nan, 0, 0}));
  EXPECT_FALSE(sees({0, 0, -1e30F}));
  TilesSettings operators_only;
  operators_only.tiles.erase(operators_only.tiles.begin(), operators_only.tiles.begin() + 3);
  EXPECT_FALSE(seesBox(planned(operators_only), Matrix4f::Identity()));
}

TEST(TilePlan, TheOperatorsTileHasNoTurn) {
  TilesSettings settings;
  settings.tiles[3].turns = 3;
  EXPECT_TRUE(planned(settings).tiles[3].view.isIdentity(0));
  EXPECT_EQ(planned(settings).tiles[3].projection, planned(settings).tiles[0].projection);
}

TEST(TilePlan, TilesMayHaveSizesOfTheirOwn) {
  TilesSettings s;
  s.frame_width = 1640;
  s.tiles = {{"big", TileKind::kWall, 0, 0, 0}, {"tall", TileKind::kWall, 1000, 0, -1}};
  s.tiles[0].width = 1000;
  s.tiles[0].height = 500;
  s.tiles[1].height = 960;
  const TilePlan plan = planned(s);
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
  EXPECT_FALSE(planTiles(s)) << "now they overlap in the frame";
}

TEST(TilePlan, ADirectionTurnsTheViewAfterItsTurns) {
  TilesSettings s;
  s.tiles = {{"up", TileKind::kWall, 0, 0, 1}};
  s.tiles[0].direction_deg = {5, 10, 90};
  const Tile tile = planned(s).tiles[0];
  // 45 degrees to the left (40 by a turn, 5 by yaw), 10 upwards: the middle of the tile.
  const Vector3f middle = drawnAt(tile, pointAt(45, 3 * std::tan(10 * kRadian), 3));
  EXPECT_NEAR(middle.x(), 0, 1e-5);
  EXPECT_NEAR(middle.y(), 0, 1e-5);
  const Vector3f above = drawnAt(tile, pointAt(45, 3 * std::tan(12 * kRadian), 3));
  EXPECT_GT(above.x(), 0.05F) << "rolled counter-clockwise: what is above lies to the right";
  EXPECT_NEAR(above.y(), 0, 1e-5);
}

TEST(TilePlan, AnOffAxisFrustumHasItsEdgesAtItsAngles) {
  TilesSettings s;
  s.tiles = {{"side", TileKind::kWall, 0, 0, 0}};
  s.tiles[0].frustum_deg = {-10, 35, -20, 5};
  const Tile tile = planned(s).tiles[0];
  EXPECT_NEAR(drawnAt(tile, pointAt(10, 0, 3)).x(), -1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(-35, 0, 3)).x(), 1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(0, 3 * std::tan(5 * kRadian), 3)).y(), 1, 1e-5);
  EXPECT_NEAR(drawnAt(tile, pointAt(0, -3 * std::tan(20 * kRadian), 3)).y(), -1, 1e-5);
}

// A hinged wall: two screens of 1.6 x 1.2 m that meet at an angle of 120 degrees; the eye is off
// the middle. A point is drawn where the line from the eye to it goes through the screen.
TEST(TilePlan, AScreenIsLookedThroughAtItsCorners) {
  const Vector3f lower_left(-1.4F, -0.7F, -1.1F), hinge(0.0F, -0.7F, -1.9F),
      lower_right(1.4F, -0.7F, -1.1F), up(0, 1.2F, 0);
  TilesSettings s;
  s.tiles = {{"right", TileKind::kWall, 0, 0, 0}, {"left", TileKind::kWall, 640, 0, 0}};
  const auto screen = [&](const Vector3f& a, const Vector3f& b) {
    const Vector3f c = a + up;
    return std::array<double, 9>{a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z()};
  };
  s.tiles[0].screen_m = screen(hinge, lower_right);
  s.tiles[1].screen_m = screen(lower_left, hinge);
  const TilePlan plan = planned(s);
  const Tile &right = plan.tiles[0], &left = plan.tiles[1];
  EXPECT_EQ(left.wall_x, 0) << "ordered by where they are";
  EXPECT_EQ(right.wall_x, 640);
  for (const float far : {1.0F, 7.0F}) {  // corners, and points behind them
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
  const auto why = [](const std::function<void(TileSettings&)>& change) {
    TilesSettings s;
    change(s.tiles[0]);
    const auto plan = planTiles(s);
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
  EXPECT_NE(why([](auto& t) {
              t.screen_m = {-1, -1, -2, 1, -1, -2, -1, 1, -2};
              t.direction_deg = {1, 0, 0};
            }).find("leave out direction_deg"),
            std::string::npos);
  EXPECT_NE(why([](auto& t) {
              t.kind = TileKind::kOperator;
              t.frustum_deg = {-10, 10, -5, 5};
            }).find("is the operator's"),
            std::string::npos);
}

}  // namespace
}  // namespace merlin::render
