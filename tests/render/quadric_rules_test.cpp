// Which collapses are legal: the scalar and the SIMD version are compared with each other and with
// a direct check.
#include "render/reduce/quadric/quadric_rules.h"

#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/support/quadric_bench.h"

namespace merlin::render {
namespace {

struct Bench : test::QuadricBench {
  explicit Bench(const mesh::Mesh& mesh) : QuadricBench(mesh) { evaluateAll(); }
  std::set<std::uint32_t> ringOf(std::uint32_t v) const {
    std::set<std::uint32_t> ring;
    for (const reduce::Corner& c : surface.star(surface[v])) ring.insert({c.b, c.c});
    return ring;
  }
};

// Returns a surface so rough that many of all collapses would flip a face.
mesh::Mesh roughSurface(std::uint32_t seed) { return test::noisyGrid(40, 40, 2.0, seed); }

TEST(QuadricRules, EveryProcessorGivesTheSameVerdict) {
  Bench bench(roughSurface(1));
  std::size_t verdicts[3] = {};
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      for (const auto stage : {reduce::QuadricStage::kAll, reduce::QuadricStage::kNoLink,
                               reduce::QuadricStage::kNoFlips}) {
        const reduce::Verdict wide = reduce::edgeJudge()(bench.view(), v, bench.costs, e, stage);
        ASSERT_EQ(wide, reduce::portableEdgeJudge()(bench.view(), v, bench.costs, e, stage));
        ++verdicts[static_cast<std::size_t>(wide)];
      }
    }
  }
  for (const std::size_t n : verdicts) EXPECT_GT(n, 0u);
}

// A star that cannot be treated as a fan in SIMD lanes is checked face by face, with the same
// result.
TEST(QuadricRules, LanesSeeTheFlipsThatFacesDo) {
  Bench bench(roughSurface(2));
  std::size_t flips = 0, legal = 0;
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    if (bench.surface[v].flags & reduce::kOpen) continue;
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      reduce::QuadricVertex &a = bench.surface[v], &x = bench.surface[bench.costs.neighbour[e]];
      const auto flags = std::pair{a.flags, x.flags};
      const auto judge = [&] {
        return reduce::edgeJudge()(bench.view(), v, bench.costs, e, reduce::QuadricStage::kNoLink);
      };
      const reduce::Verdict in_lanes = judge();
      a.flags |= reduce::kOpen;
      x.flags |= reduce::kOpen;
      const reduce::Verdict by_faces = judge();
      std::tie(a.flags, x.flags) = flags;
      ASSERT_EQ(in_lanes, by_faces);
      ++(in_lanes == reduce::Verdict::kFlip ? flips : legal);
    }
  }
  EXPECT_GT(flips, 100u);
  EXPECT_GT(legal, 100u);
}

TEST(QuadricRules, TheEndsShareNoNeighbourBesideTheirTriangles) {
  // A tube with three vertices around: the three edges of each ring are a triangle without a face.
  mesh::Mesh tube;
  for (std::uint32_t k = 0; k < 30; ++k) {
    const double angle = 2.0943951 * (k % 3);
    tube.positions.insert(tube.positions.end(),
                          {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                           static_cast<float>(k / 3)});
  }
  for (std::uint32_t k = 0; k < 27; ++k) {
    const std::uint32_t right = k % 3 == 2 ? k - 2 : k + 1;
    tube.triangles.insert(tube.triangles.end(), {k, right, k + 3, right, right + 3, k + 3});
  }
  Bench bench(tube);
  std::size_t refused = 0;
  for (std::uint32_t v = 0; v < 30; ++v) {
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      const std::uint32_t x = bench.costs.neighbour[e];
      if ((bench.surface[v].flags | bench.surface[x].flags) & reduce::kOpen) continue;
      const auto of_v = bench.ringOf(v), of_x = bench.ringOf(x);
      std::size_t common = 0;
      for (const std::uint32_t o : of_v) common += of_x.count(o);
      const reduce::Verdict verdict =
          reduce::edgeJudge()(bench.view(), v, bench.costs, e, reduce::QuadricStage::kAll);
      EXPECT_EQ(verdict == reduce::Verdict::kLink, common != 2);
      refused += verdict == reduce::Verdict::kLink;
    }
  }
  EXPECT_EQ(refused, 8u * 3 * 2);
}

}  // namespace
}  // namespace merlin::render
