// Geomorphs: the positions of vertices at a level, and that no vertex jumps between two levels.
#include "render/lod/geomorph.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Place = std::array<float, 3>;

const lod::Dendrogram& hills() {
  static const lod::Dendrogram made = [] {
    mesh::Mesh mesh = test::noisyGrid(40, 40, 0.5, 3);
    mesh::ensureNormals(mesh);
    return lod::buildDendrogram(mesh, reduce::reduce(mesh, {.threads = 1})->log);
  }();
  return made;
}

// The position of each node, with the interpolated positions of the nodes that a geomorph moves.
class Places {
 public:
  explicit Places(const std::vector<lod::Morph>& morphs) {
    for (const lod::Morph& m : morphs) {
      const Place own = at(m.node), parent = at(hills().parentOf(m.node));
      Place& place = moved_[m.node];
      for (std::size_t k = 0; k < 3; ++k) place[k] = parent[k] + m.own * (own[k] - parent[k]);
    }
  }
  Place at(std::uint32_t node) const {
    if (const auto found = moved_.find(node); found != moved_.end()) return found->second;
    const float* p = &hills().arrays().positions[3 * std::size_t{node}];
    return {p[0], p[1], p[2]};
  }

 private:
  std::map<std::uint32_t, Place> moved_;
};

// Returns how far the mesh jumps between a level and the next one: the sum, over the corners of all
// triangles, of the squared distance between the nodes that represent the corner at these levels.
double jump(std::size_t level, double share) {
  std::vector<lod::Morph> morphs;
  lod::morphsAt(hills(), level, share, morphs);
  const Places before(morphs);
  lod::morphsAt(hills(), level + 1, share, morphs);
  const Places after(morphs);
  double sum = 0;
  for (const std::uint32_t corner : hills().arrays().triangles) {
    std::uint32_t node = corner;
    const auto alive = [&](std::size_t l) { return hills().nodeCount() - 2 * l; };
    while (node >= alive(level)) node = hills().parentOf(node);
    const Place from = before.at(node);
    while (node >= alive(level + 1)) node = hills().parentOf(node);
    const Place to = after.at(node);
    for (std::size_t k = 0; k < 3; ++k) sum += (to[k] - from[k]) * (to[k] - from[k]);
  }
  return sum;
}

TEST(Geomorph, OfTheNodesThatDieNextThoseThatDieFirstHaveGoneFurthest) {
  const std::size_t level = hills().levelFor(1000), end = hills().levelFor(900);
  std::vector<lod::Morph> morphs;
  lod::morphsAt(hills(), level, 0.1, morphs);
  ASSERT_EQ(morphs.size(), 2 * (end - level));
  EXPECT_EQ(morphs.back().node, hills().nodeCount() - 2 * level - 1);
  EXPECT_EQ(morphs.front().node, hills().nodeCount() - 2 * end);
  const auto steps = static_cast<float>(end - level + 1);
  EXPECT_FLOAT_EQ(morphs.back().own, 1 / steps);
  EXPECT_FLOAT_EQ(morphs[morphs.size() - 2].own, 1 / steps) << "both that one collapse merges";
  EXPECT_FLOAT_EQ(morphs.front().own, 1 - 1 / steps);
  EXPECT_TRUE(
      std::is_sorted(morphs.begin(), morphs.end(),
                     [](const lod::Morph& a, const lod::Morph& b) { return a.node < b.node; }));
}

TEST(Geomorph, FromOneLevelToTheNextNothingJumps) {
  double moved = 0, jumped = 0;
  const std::size_t first = hills().levelFor(1500), last = hills().levelFor(500);
  for (std::size_t level = first; level < last; ++level) {
    moved += jump(level, 0.125);
    jumped += jump(level, 0);
  }
  EXPECT_LT(moved, jumped / 20);
}

TEST(Geomorph, ClustersAtOneLevelAreWhatTheWholeIsThere) {
  const lod::Clusters clusters(hills(), {.clusters = 12});
  const std::size_t level = (clusters.finestLevel() + clusters.coarsestLevel()) / 2;
  const std::vector<std::uint32_t> levels(clusters.size(), static_cast<std::uint32_t>(level));
  std::vector<lod::Morph> whole, each;
  lod::morphsAt(hills(), level, 0.1, whole);
  lod::morphsAt(hills(), clusters, levels, 0.1, each);
  ASSERT_GT(whole.size(), 10U);
  ASSERT_EQ(each.size(), whole.size());
  for (std::size_t i = 0; i < each.size(); ++i) {
    EXPECT_EQ(each[i].node, whole[i].node);
    EXPECT_EQ(each[i].own, whole[i].own);
  }
}

TEST(Geomorph, EachClusterHasItsOwnWindow) {
  const lod::Clusters clusters(hills(), {.clusters = 12});
  ASSERT_GT(clusters.size(), 4U);
  std::vector<std::uint32_t> levels(clusters.size());
  const std::size_t range = clusters.coarsestLevel() - clusters.finestLevel();
  for (std::size_t c = 0; c < levels.size(); ++c) {
    levels[c] =
        static_cast<std::uint32_t>(clusters.finestLevel() + range * c / (levels.size() - 1));
  }
  std::vector<lod::Morph> morphs;
  lod::morphsAt(hills(), clusters, levels, 0.2, morphs);
  std::vector<std::size_t> of(clusters.size());
  for (const lod::Morph& m : morphs) {
    const std::size_t c = clusters.clusterOf(m.node);
    const std::size_t collapse = (hills().nodeCount() - 1 - m.node) / 2;
    EXPECT_GE(collapse, levels[c]) << "alive at its cluster's level";
    EXPECT_LT(collapse, clusters.coarsestLevel());
    ++of[c];
  }
  // A coarse cluster may have no node that moves at its level.
  EXPECT_GT(std::count_if(of.begin(), of.end(), [](std::size_t n) { return n > 0; }), 6);
  EXPECT_EQ(of.back(), 0U) << "nothing of it merges any more";
}

TEST(Geomorph, WithoutAShareOrAtTheEndNothingIsOnItsWay) {
  std::vector<lod::Morph> morphs(3);
  lod::morphsAt(hills(), 10, 0, morphs);
  EXPECT_TRUE(morphs.empty());
  lod::morphsAt(hills(), hills().levels() - 1, 0.5, morphs);
  EXPECT_TRUE(morphs.empty());
}

}  // namespace
}  // namespace merlin::render
