// Witnesses: their distances are compared with a plain search in double precision, and they keep
// their positions.
#include "render/reduce/quadric/quadric_witness.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/compare/triangle_distance.h"
#include "tests/support/meshes.h"
#include "tests/support/quadric_bench.h"

namespace merlin::render {
namespace {

// A rough mesh with a border, with vertices of more than eight triangles, and with witnesses away
// from their vertices.
struct Bench : test::QuadricBench {
  explicit Bench(std::uint32_t seed) : QuadricBench(test::noisyGrid(30, 30, 1.0, seed)) {
    Random random(seed);
    const auto any = [&] { return static_cast<float>(random.uniform() - 0.5); };
    for (std::uint32_t v = 0; v < surface.vertexCount(); ++v)
      surface[v].witness.set({any(), any(), any()});
    evaluateAll();
  }

  compare::Vector at(std::uint32_t v) const {
    const float* p = surface[v].position;
    return {p[0], p[1], p[2]};
  }
  // Returns the squared distance of the witness of `of` from the triangles that remain of both
  // stars after edge (v, x) is collapsed to `to`.
  double plainDistance2(std::uint32_t of, std::uint32_t v, std::uint32_t x,
                        const compare::Vector& to) const {
    const std::array<float, 3> from = surface[of].witness.get();
    const compare::Vector witness = at(of) + compare::Vector{from[0], from[1], from[2]};
    double nearest = compare::squared(witness - to);
    for (const std::uint32_t end : {v, x}) {
      for (const reduce::Corner& c : surface.star(surface[end])) {
        if (c.b == v || c.b == x || c.c == v || c.c == x) continue;
        nearest = std::min(nearest,
                           compare::nearestOnTriangle(witness, {to, at(c.b), at(c.c)}).distance2);
      }
    }
    return nearest;
  }
};

TEST(QuadricWitness, TheFartherOfTwoIsFoundWithItsDistance) {
  Bench bench(1);
  std::size_t of_neighbour = 0, edges = 0;
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e, ++edges) {
      const reduce::EdgeCosts& costs = bench.costs;
      const std::uint32_t x = costs.neighbour[e];
      const compare::Vector to = bench.at(v) + compare::Vector{costs.x[e], costs.y[e], costs.z[e]};
      const double of_v = bench.plainDistance2(v, v, x, to);
      const double of_x = bench.plainDistance2(x, v, x, to);
      const reduce::FartherWitness found = reduce::fartherWitness()(bench.view(), v, costs, e);
      ASSERT_NEAR(found.distance2, std::max(of_v, of_x),
                  1e-4 * (1 + compare::squared(to - bench.at(v))));
      const bool either = std::fabs(of_v - of_x) <= 1e-3;
      ASSERT_TRUE(either || found.end == (of_x > of_v ? 1u : 0u));
      of_neighbour += found.end;
    }
  }
  EXPECT_GT(of_neighbour, edges / 4);
  EXPECT_LT(of_neighbour, edges * 3 / 4);
}

TEST(QuadricWitness, EveryProcessorFindsTheSame) {
  Bench bench(2);
  for (std::uint32_t v = 0; v < bench.surface.vertexCount(); ++v) {
    reduce::edgeEvaluator()(bench.view(), v, bench.costs);
    for (std::uint32_t e = 0; e < bench.costs.count; ++e) {
      const reduce::FartherWitness wide = reduce::fartherWitness()(bench.view(), v, bench.costs, e);
      const reduce::FartherWitness portable =
          reduce::portableFartherWitness()(bench.view(), v, bench.costs, e);
      ASSERT_EQ(wide.distance2, portable.distance2);
      ASSERT_EQ(wide.end, portable.end);
    }
  }
}

TEST(QuadricWitness, StaysWhereItIsWhenItsVertexMoves) {
  Random random(3);
  reduce::QuadricVertex a{}, b{};
  b.position[0] = 3;
  b.witness.set({0.5F, -1.25F, 2});
  const float first[] = {2, 0.125F, -1};
  reduce::keepWitness(a, b, first);
  std::copy_n(first, 3, a.position);
  for (int move = 0; move < 30; ++move) {
    float to[3];
    for (float& x : to) x = static_cast<float>(4 * random.uniform());
    reduce::keepWitness(a, a, to);
    std::copy_n(to, 3, a.position);
  }
  const std::array<float, 3> from = a.witness.get();
  EXPECT_NEAR(a.position[0] + from[0], 3.5F, 0.01F);
  EXPECT_NEAR(a.position[1] + from[1], -1.25F, 0.01F);
  EXPECT_NEAR(a.position[2] + from[2], 2, 0.01F);
}

TEST(ShortVector, KeepsAnyLengthToItsPrecision) {
  reduce::ShortVector v;
  for (const float scale : {1e-25F, 1e-3F, 1.0F, 1.999F, 2.0F, 12345.0F, 1e25F}) {
    const std::array<float, 3> given = {scale, -scale / 3, scale / 1000};
    v.set(given);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(v.get()[k], given[k], scale / 8000);
  }
  v.set({0, 0, 0});
  EXPECT_EQ(v.get(), (std::array<float, 3>{0, 0, 0}));
  const float huge = std::numeric_limits<float>::max();
  v.set({huge, -huge, 0});  // beyond the range that the format can hold
  EXPECT_TRUE(std::isfinite(v.get()[0]));
}

}  // namespace
}  // namespace merlin::render
