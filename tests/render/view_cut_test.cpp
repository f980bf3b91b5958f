// ViewCut spends the budget of triangles where the tiles look, and never exceeds it.
#include "render/lod/view_cut.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

lod::Dendrogram dendrogramOf(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  auto reduction = reduce::reduce(mesh, {.threads = 1});
  EXPECT_TRUE(reduction);
  return lod::buildDendrogram(mesh, reduction->log);
}

// Returns the view of a camera at (x, y, height) that looks straight down; it is 60 degrees and 640
// pixels wide.
lod::TileView fromAbove(float x, float y, float height) {
  constexpr float kNear = 0.1F, kFar = 1000, kTan = 0.57735F;
  Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
  projection(0, 0) = projection(1, 1) = 1 / kTan;
  projection(2, 2) = -(kFar + kNear) / (kFar - kNear);
  projection(2, 3) = -2 * kFar * kNear / (kFar - kNear);
  projection(3, 2) = -1;
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.col(3).head<3>() = Eigen::Vector3f(-x, -y, -height);
  return {projection * view, 640};
}

// A hilly grid of 60 x 60 cells, seen from above.
class OverHills : public ::testing::Test {
 protected:
  std::size_t spent() const {
    std::size_t n = clusters_.alwaysThere();
    for (std::size_t c = 0; c < clusters_.size(); ++c)
      n += clusters_.trianglesAt(c, cut_.levels()[c]);
    return n;
  }
  std::uint32_t levelAt(float x, float y) const {
    std::size_t best = 0;
    const auto away = [&](std::size_t c) {
      return std::hypot(clusters_.bounds(c).centre[0] - x, clusters_.bounds(c).centre[1] - y);
    };
    for (std::size_t c = 1; c < clusters_.size(); ++c) {
      if (away(c) < away(best)) best = c;
    }
    return cut_.levels()[best];
  }
  // Returns the triangle count of the level at the first position, divided by that at the second
  // position.
  double finerAt(float x, float y, float other_x, float other_y) const {
    return static_cast<double>(dendrogram_.trianglesAt(levelAt(x, y))) /
           static_cast<double>(dendrogram_.trianglesAt(levelAt(other_x, other_y)));
  }

  lod::Dendrogram dendrogram_ = dendrogramOf(test::noisyGrid(60, 60, 0.5, 1));
  lod::Clusters clusters_{dendrogram_, {.clusters = 64}};
  lod::ViewCut cut_{dendrogram_, clusters_, true};
};

TEST_F(OverHills, TheBudgetIsSpentAndNotExceeded) {
  for (const std::size_t budget : {500u, 1000u, 3000u}) {
    const lod::TileView tile = fromAbove(15, 15, 40);
    ASSERT_TRUE(cut_.choose(std::span(&tile, 1), budget));
    EXPECT_LE(spent(), budget);
    EXPECT_GE(spent(), budget * 9 / 10);
  }
}

TEST_F(OverHills, WhatNoTileSeesIsCoarse) {
  const lod::TileView tile = fromAbove(10, 10, 10);
  ASSERT_TRUE(cut_.choose(std::span(&tile, 1), 1500));
  EXPECT_LT(levelAt(10, 10), levelAt(50, 50));
  EXPECT_GT(finerAt(10, 10, 50, 50), 3);
}

TEST_F(OverHills, WhatAnyTileSeesIsNot) {
  const lod::TileView tiles[] = {fromAbove(10, 10, 10), fromAbove(50, 50, 10)};
  ASSERT_TRUE(cut_.choose(tiles, 1500));
  EXPECT_LT(levelAt(50, 50), clusters_.coarsestLevel());
  EXPECT_GT(finerAt(50, 50, 50, 10), 2);
}

TEST_F(OverHills, NearIsFinerThanFar) {
  // One position is seen from a height of 8, the other from a height of 20.
  const lod::TileView tiles[] = {fromAbove(10, 10, 8), fromAbove(50, 50, 20)};
  ASSERT_TRUE(cut_.choose(tiles, 1500));
  EXPECT_LT(levelAt(10, 10), levelAt(50, 50));
  EXPECT_LT(levelAt(50, 50), clusters_.coarsestLevel());
}

TEST_F(OverHills, FromAfarAnEvenCutIsAsGood) {
  const lod::TileView tile = fromAbove(30, 30, 900);
  EXPECT_FALSE(cut_.choose(std::span(&tile, 1), 1500));
}

TEST_F(OverHills, LessThanTheCoarsestIsCutEvenly) {
  const lod::TileView tile = fromAbove(10, 10, 10);
  EXPECT_FALSE(cut_.choose(std::span(&tile, 1), 20));
}

TEST_F(OverHills, AsMuchAsThereIsMeansAllThatIsSeen) {
  const lod::TileView tile = fromAbove(10, 10, 10);
  ASSERT_TRUE(cut_.choose(std::span(&tile, 1), dendrogram_.triangleCount()));
  EXPECT_EQ(levelAt(10, 10), clusters_.finestLevel());
}

// Returns a parallel projection, straight down, of the square of `side` cells about (x, y), 640
// pixels wide.
lod::TileView mapOf(float x, float y, float side) {
  Eigen::Matrix4f clip = Eigen::Matrix4f::Identity();
  clip(0, 0) = clip(1, 1) = 2 / side;
  clip(2, 2) = -1 / 100.0F;
  clip(0, 3) = -2 * x / side;
  clip(1, 3) = -2 * y / side;
  return {clip, 640};
}

TEST_F(OverHills, AParallelProjectionIsFineWhereItLooks) {
  const lod::TileView tile = mapOf(10, 10, 12);
  ASSERT_TRUE(cut_.choose(std::span(&tile, 1), 1500));
  EXPECT_LE(spent(), 1500u);
  EXPECT_GT(finerAt(10, 10, 50, 50), 3);
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const auto& centre = clusters_.bounds(c).centre;
    const float away = std::max(std::abs(centre[0] - 10), std::abs(centre[1] - 10));
    if (away < 6) {
      EXPECT_TRUE(cut_.sees(0, c)) << "seen: " << c;
    }
    if (away > 6 + 2 * clusters_.bounds(c).radius) {
      EXPECT_FALSE(cut_.sees(0, c)) << c;
    }
  }
}

// In a map of the whole model, all places have the same scale, as for an eye that is far away.
TEST_F(OverHills, AParallelProjectionOfAllIsCutEvenly) {
  const lod::TileView tile = mapOf(30, 30, 80);
  EXPECT_FALSE(cut_.choose(std::span(&tile, 1), 1500));
}

// The wall's eye is near one corner, another camera near the opposite corner. What either sees from
// near must be fine; each view gets the detail that it would get alone, reduced only because the
// two share the budget.
TEST_F(OverHills, AnotherCameraIsNotServedByTheWallsEye) {
  const lod::TileView both[] = {fromAbove(10, 10, 8), fromAbove(50, 50, 8)};
  ASSERT_TRUE(cut_.choose(std::span(both, 1), 1500));
  const std::size_t alone = dendrogram_.trianglesAt(levelAt(10, 10));
  EXPECT_LT(dendrogram_.trianglesAt(levelAt(50, 50)), alone / 4);
  ASSERT_TRUE(cut_.choose(both, 3000));
  EXPECT_GE(dendrogram_.trianglesAt(levelAt(10, 10)), alone * 9 / 10);
  EXPECT_GE(dendrogram_.trianglesAt(levelAt(50, 50)), alone * 9 / 10);
}

// Seen from above alone, the lower side of a ball is coarse. With a camera below it, the lower side
// must be as fine as the upper side.
TEST(ViewCut, ASideThatFacesAwayFromTheEyeIsFineForACameraBehind) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  const lod::Clusters clusters(d, {.clusters = 64});
  Eigen::Matrix4f from_below = mapOf(0, 0, 3).clip_from_model;
  from_below.row(2) *= -1;
  const lod::TileView tiles[] = {mapOf(0, 0, 3), {from_below, 640}};
  lod::ViewCut cut(d, clusters, false);
  const auto finest = [&](float side) {
    std::size_t most = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      if (side * clusters.bounds(c).axis[2] > 0.9F)
        most = std::max(most, d.trianglesAt(cut.levels()[c]));
    }
    return most;
  };
  ASSERT_TRUE(cut.choose(std::span(tiles, 1), 2000));
  EXPECT_LT(finest(-1), finest(1) / 4);
  ASSERT_TRUE(cut.choose(tiles, 2000));
  EXPECT_EQ(finest(-1), finest(1));
}

TEST(ViewCut, TheFarSideOfABallIsCoarseUnlessBackFacesAreDrawn) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  const lod::Clusters clusters(d, {.clusters = 64});
  const lod::TileView tile = fromAbove(0, 0, 4);
  for (const bool back_faces : {false, true}) {
    lod::ViewCut cut(d, clusters, back_faces);
    ASSERT_TRUE(cut.choose(std::span(&tile, 1), 2000));
    std::size_t front = 0;
    for (std::size_t c = 1; c < clusters.size(); ++c) {
      if (clusters.bounds(c).centre[2] > clusters.bounds(front).centre[2]) front = c;
    }
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      if (clusters.bounds(c).centre[2] < -0.85F) {
        EXPECT_EQ(cut.levels()[c] > 4 * cut.levels()[front] / 3, !back_faces);
      }
      if (clusters.bounds(c).centre[2] > 0.85F) {
        EXPECT_LT(cut.levels()[c], clusters.coarsestLevel());
      }
      EXPECT_TRUE(cut.sees(0, c));
    }
  }
}

}  // namespace
}  // namespace merlin::render
