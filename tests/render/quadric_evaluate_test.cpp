// The edges of one vertex: costs and positions compared with plain sums over planes in double
// precision.
#include "render/reduce/quadric/quadric_evaluate.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "tests/support/meshes.h"
#include "tests/support/quadric_bench.h"

namespace merlin::render {
namespace {

using Vec = Eigen::Vector3d;

struct Bench : test::QuadricBench {
  explicit Bench(const mesh::Mesh& m, std::size_t channels = 0)
      : QuadricBench(m, channels), mesh(m) {}

  Vec at(std::uint32_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(surface[v].position).cast<double>();
  }

  // Returns the sum of twice the area times the squared distance of p, over the planes of v's
  // triangles and of its border edges.
  double distanceTo(std::uint32_t v, const Vec& p) const {
    double sum = 0;
    for (const reduce::Corner& c : surface.star(surface[v])) {
      const Vec n = (at(c.b) - at(v)).cross(at(c.c) - at(v));
      sum += n.norm() * std::pow(n.normalized().dot(p - at(v)), 2);
    }
    return sum;
  }

  mesh::Mesh mesh;
};

TEST(QuadricEvaluate, CostIsTheDistanceToThePlanesOfBothStars) {
  Bench bench(test::noisyGrid(9, 9, 0.3, 1));
  bench.evaluateAll(reduce::edgeEvaluator());
  std::size_t looked = 0;
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    if (bench.surface[v].flags & reduce::kOpen) continue;
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      const std::uint32_t x = bench.costs.neighbour[e];
      if (bench.surface[x].flags & reduce::kOpen) continue;
      const Vec to = bench.at(v) + Vec(bench.costs.x[e], bench.costs.y[e], bench.costs.z[e]);
      const double plain = bench.distanceTo(v, to) + bench.distanceTo(x, to);
      EXPECT_NEAR(bench.costs.cost[e], plain, 1e-3 * plain + 1e-5);
      ++looked;
    }
  }
  EXPECT_GT(looked, 200u);
}

TEST(QuadricEvaluate, PlaceIsTheLeastOfTheCost) {
  Bench bench(test::noisyGrid(9, 9, 0.3, 2));
  bench.evaluateAll(reduce::edgeEvaluator());
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    if (bench.surface[v].flags & reduce::kOpen) continue;
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      const std::uint32_t x = bench.costs.neighbour[e];
      if (bench.surface[x].flags & reduce::kOpen) continue;
      const Vec to = bench.at(v) + Vec(bench.costs.x[e], bench.costs.y[e], bench.costs.z[e]);
      const double here = bench.distanceTo(v, to) + bench.distanceTo(x, to);
      for (const Vec& step : {Vec(0.02, 0, 0), Vec(0, 0.02, 0), Vec(0, 0, 0.02)}) {
        for (const double sign : {-1.0, 1.0}) {
          const Vec p = to + sign * step;
          EXPECT_GT(bench.distanceTo(v, p) + bench.distanceTo(x, p), here - 1e-6);
        }
      }
    }
  }
}

TEST(QuadricEvaluate, InAPlaneTheMiddleIsTaken) {
  Bench bench(test::grid(6, 6));
  bench.evaluateAll(reduce::edgeEvaluator());
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      if ((bench.surface[v].flags | bench.surface[bench.costs.neighbour[e]].flags) & reduce::kOpen)
        continue;
      EXPECT_NEAR(bench.costs.x[e], bench.costs.rx[e] / 2, 1e-4);
      EXPECT_NEAR(bench.costs.y[e], bench.costs.ry[e] / 2, 1e-4);
      EXPECT_LT(bench.costs.cost[e], 1e-9);
    }
  }
}

// The scalar and the SIMD version have to agree in every bit, so that a model is reduced
// identically on all machines.
TEST(QuadricEvaluate, EveryProcessorGivesTheSameBits) {
  for (const std::size_t channels : {0u, 3u, 9u}) {
    Bench a(test::noisyGrid(30, 30, 0.4, 3), channels), b(a.mesh, channels);
    Random random(1);
    for (std::uint32_t v = 0; v < a.surface.vertexCount(); ++v) {
      for (std::size_t k = 0; k < channels; ++k)
        a.values.value(v, k) = b.values.value(v, k) = static_cast<float>(random.normal());
    }
    a.evaluateAll(reduce::edgeEvaluator());
    b.evaluateAll(reduce::portableEdgeEvaluator());
    for (std::uint32_t v = 0; v < a.surface.vertexCount(); ++v) {
      reduce::edgeEvaluator()(a.view(), v, a.costs);
      reduce::portableEdgeEvaluator()(b.view(), v, b.costs);
      ASSERT_EQ(a.costs.count, b.costs.count);
      for (std::uint32_t e = 0; e < a.costs.count; ++e) {
        ASSERT_EQ(a.costs.cost[e], b.costs.cost[e]);
        ASSERT_EQ(a.costs.x[e], b.costs.x[e]);
        ASSERT_EQ(a.costs.y[e], b.costs.y[e]);
        ASSERT_EQ(a.costs.z[e], b.costs.z[e]);
      }
    }
  }
}

TEST(QuadricEvaluate, QuadricsFirstThenEdgesIsTheSame) {
  const mesh::Mesh grid = test::noisyGrid(30, 30, 0.4, 3);
  for (const std::size_t channels : {0u, 2u}) {
    for (const auto evaluator : {reduce::edgeEvaluator, reduce::portableEdgeEvaluator}) {
      Bench both(grid, channels), apart(grid, channels);
      Random random(1);
      for (std::uint32_t v = 0; v < both.surface.vertexCount(); ++v) {
        for (std::size_t k = 0; k < channels; ++k)
          both.values.value(v, k) = apart.values.value(v, k) = static_cast<float>(random.normal());
      }
      both.evaluateAll(evaluator(reduce::Evaluate::kBoth));
      apart.evaluateAll(evaluator(reduce::Evaluate::kQuadric));
      for (std::uint32_t v = 0; v < both.surface.vertexCount(); ++v) {
        evaluator(reduce::Evaluate::kBoth)(both.view(), v, both.costs);
        evaluator(reduce::Evaluate::kEdges)(apart.view(), v, apart.costs);
        ASSERT_EQ(apart.costs.count, both.costs.count);
        ASSERT_EQ(apart.costs.cheapest, both.costs.cheapest);
        for (std::uint32_t e = 0; e < both.costs.count; ++e) {
          ASSERT_EQ(apart.costs.cost[e], both.costs.cost[e]);
          ASSERT_EQ(apart.costs.x[e], both.costs.x[e]);
        }
      }
    }
  }
}

// Returns the sum over v's triangles of area times (g p + d - s)^2, for a channel that is linear on
// each triangle.
double channelError(const Bench& bench, std::uint32_t v, std::size_t k, const Vec& p, double s) {
  double sum = 0;
  for (const reduce::Corner& c : bench.surface.star(bench.surface[v])) {
    const Vec u = bench.at(c.b) - bench.at(v), w = bench.at(c.c) - bench.at(v), n = u.cross(w);
    Eigen::Matrix3d rows;
    rows << u.transpose(), w.transpose(), n.transpose();
    const double here = bench.values.value(v, k);
    const Vec g = rows.inverse() *
                  Vec(bench.values.value(c.b, k) - here, bench.values.value(c.c, k) - here, 0);
    sum += n.norm() * std::pow(here + g.dot(p - bench.at(v)) - s, 2);
  }
  return sum;
}

void expectChannelsCostWhatTheirBestValueLeaves(std::size_t channels) {
  Bench bench(test::noisyGrid(9, 9, 0.3, 4), channels);
  Random random(2);
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    for (std::size_t k = 0; k < channels; ++k)
      bench.values.value(v, k) = static_cast<float>(random.normal());
  }
  bench.evaluateAll(reduce::edgeEvaluator());
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    if (bench.surface[v].flags & reduce::kOpen) continue;
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      const std::uint32_t x = bench.costs.neighbour[e];
      if (bench.surface[x].flags & reduce::kOpen) continue;
      const Vec to = bench.at(v) + Vec(bench.costs.x[e], bench.costs.y[e], bench.costs.z[e]);
      double plain = bench.distanceTo(v, to) + bench.distanceTo(x, to);
      for (std::size_t k = 0; k < channels; ++k) {
        // The sum is a parabola in s; its minimum follows from three values.
        const auto f = [&](double s) {
          return channelError(bench, v, k, to, s) + channelError(bench, x, k, to, s);
        };
        const double a = (f(1) + f(-1)) / 2 - f(0), b = (f(1) - f(-1)) / 2;
        plain += f(0) - b * b / (4 * a);
      }
      EXPECT_NEAR(bench.costs.cost[e], plain, 2e-3 * plain + 1e-4);
    }
  }
}

TEST(QuadricEvaluate, ChannelsCostWhatTheirBestValueLeaves) {
  expectChannelsCostWhatTheirBestValueLeaves(2);
  // There are more channels than the evaluation keeps between its two passes.
  expectChannelsCostWhatTheirBestValueLeaves(9);
}

}  // namespace
}  // namespace merlin::render
