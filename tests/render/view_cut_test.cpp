// ViewCut: where the tiles look the budget goes, and no further.
#include "render/lod/view_cut.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

Dendrogram dendrogramOf(Mesh mesh) {
  ensureNormals(mesh);
  auto reduction = reduce(mesh, {.threads = 1});
  EXPECT_TRUE(reduction);
  return buildDendrogram(mesh, reduction->log);
}

// From (x, y, height) straight down, 60 degrees wide, 640 pixels.
TileView fromAbove(float x, float y, float height) {
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

// 60 x 60 hills, seen from their lower left corner.
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
  // How many times as many triangles the first place's level has.
  double finerAt(float x, float y, float other_x, float other_y) const {
    return static_cast<double>(dendrogram_.trianglesAt(levelAt(x, y))) /
           static_cast<double>(dendrogram_.trianglesAt(levelAt(other_x, other_y)));
  }

  Dendrogram dendrogram_ = dendrogramOf(test::noisyGrid(60, 60, 0.5, 1));
  Clusters clusters_{dendrogram_, {.clusters = 64}};
  ViewCut cut_{dendrogram_, clusters_, true};
};

TEST_F(OverHills, TheBudgetIsSpentAndNotExceeded) {
  for (const std::size_t budget : {500u, 1000u, 3000u}) {
    const TileView tile = fromAbove(15, 15, 40);
    ASSERT_TRUE(cut_.choose(std::span(&tile, 1), budget));
    EXPECT_LE(spent(), budget);
    EXPECT_GE(spent(), budget * 9 / 10);
  }
}

TEST_F(OverHills, WhatNoTileSeesIsCoarse) {
  const TileView tile = fromAbove(10, 10, 10);
  ASSERT_TRUE(cut_.choose(std::span(&tile, 1), 1500));
  EXPECT_LT(levelAt(10, 10), levelAt(50, 50));
  EXPECT_GT(finerAt(10, 10, 50, 50), 3);
}

TEST_F(OverHills, WhatAnyTileSeesIsNot) {
  const TileView tiles[] = {fromAbove(10, 10, 10), fromAbove(50, 50, 10)};
  ASSERT_TRUE(cut_.choose(tiles, 1500));
  EXPECT_LT(levelAt(50, 50), clusters_.coarsestLevel());
  EXPECT_GT(finerAt(50, 50, 50, 10), 2);
}

TEST_F(OverHills, NearIsFinerThanFar) {
  // Both seen, one from 8, the other from 20.
  const TileView tiles[] = {fromAbove(10, 10, 8), fromAbove(50, 50, 20)};
  ASSERT_TRUE(cut_.choose(tiles, 1500));
  EXPECT_LT(levelAt(10, 10), levelAt(50, 50));
  EXPECT_LT(levelAt(50, 50), clusters_.coarsestLevel());
}

TEST_F(OverHills, FromAfarAnEvenCutIsAsGood) {
  const TileView tile = fromAbove(30, 30, 900);
  EXPECT_FALSE(cut_.choose(std::span(&tile, 1), 1500));
}

TEST_F(OverHills, LessThanTheCoarsestIsCutEvenly) {
  const TileView tile = fromAbove(10, 10, 10);
  EXPECT_FALSE(cut_.choose(std::span(&tile, 1), 20));
}

TEST_F(OverHills, AsMuchAsThereIsMeansAllThatIsSeen) {
  const TileView tile = fromAbove(10, 10, 10);
  ASSERT_TRUE(cut_.choose(std::span(&tile, 1), dendrogram_.triangleCount()));
  EXPECT_EQ(levelAt(10, 10), clusters_.finestLevel());
}

TEST(ViewCut, TheFarSideOfABallIsCoarseUnlessBackFacesAreDrawn) {
  const Dendrogram d = dendrogramOf(test::sphere(5));
  const Clusters clusters(d, {.clusters = 64});
  const TileView tile = fromAbove(0, 0, 4);
  for (const bool back_faces : {false, true}) {
    ViewCut cut(d, clusters, back_faces);
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
