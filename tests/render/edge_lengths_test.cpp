// The lengths of edges in pattern space, which MERLIN can show before a reduction.
#include "render/reduce/edge_lengths.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Lengths = std::vector<float>;

// Returns a square of two triangles, 3 x 4, so that the diagonal of its bounding box is 5. Its
// feature "heat" has the range 20.
mesh::Mesh square() {
  mesh::Mesh mesh{{0, 0, 0, 3, 0, 0, 3, 4, 0, 0, 4, 0}, {}, {0, 1, 2, 0, 2, 3}};
  mesh::ensureNormals(mesh);
  mesh.features.push_back({"heat", 1, {10, 30, 10, 15}});
  return mesh;
}

Lengths lengthsBy(const reduce::Weights& weights) {
  const auto lengths = reduce::edgeLengths(square(), weights);
  EXPECT_TRUE(lengths) << lengths.error().what;
  return lengths ? *lengths : Lengths();
}

void expectNear(const Lengths& got, const Lengths& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-6) << i;
}

// Equation 4.3, for the edges 0-1, 1-2, 2-0, 0-2, 2-3, 3-0.
TEST(EdgeLengths, AreDistancesOfTheWeightedVectors) {
  expectNear(lengthsBy({{"geometry", 1}}), {0.6F, 0.8F, 1, 1, 0.6F, 0.8F});
  expectNear(lengthsBy({{"geometry", 10}}), {6, 8, 10, 10, 6, 8});
  expectNear(lengthsBy({{"heat", 2}}), {2, 2, 0, 0, 0.5F, 0.5F});
  expectNear(lengthsBy({{"geometry", 5}, {"heat", 4}}),
             {5, std::hypot(4.0F, 4.0F), 5, 5, std::hypot(3.0F, 1.0F), std::hypot(4.0F, 1.0F)});
  expectNear(lengthsBy({{"normal", 3}, {"curvature", 3}, {"boundary", 3}}), Lengths(6, 0));
}

TEST(EdgeLengths, NameAWeightThatCannotBe) {
  const auto lengths = reduce::edgeLengths(square(), {{"warmth", 1}});
  ASSERT_FALSE(lengths);
  EXPECT_EQ(lengths.error().what,
            "weight warmth: the mesh has no such feature; it has geometry, normal, curvature, "
            "boundary, heat");
}

// "the edges which are colored red will be the first to be collapsed" ([GOURLEY98] 5.1); this is
// checked for each set of weights.
TEST(EdgeLengths, NameTheEdgeThatIsCollapsedFirst) {
  mesh::Mesh mesh = test::noisyGrid(12, 12, 0.3, 7);
  mesh::ensureNormals(mesh);
  for (const reduce::Weights& weights : {reduce::Weights{{"geometry", 1}},
                                         {{"geometry", 1}, {"curvature", 1.5F}},
                                         {{"normal", 1}, {"boundary", 2}},
                                         reduce::presetWeights(reduce::presets()[0], mesh)}) {
    const Lengths lengths = *reduce::edgeLengths(mesh, weights);
    std::vector<std::size_t> order(lengths.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return lengths[i]; });
    const auto log = reduce::reduce(
        mesh, {.cost = "pattern", .weights = weights, .min_triangles = mesh.triangleCount() - 1});
    ASSERT_TRUE(log);
    ASSERT_EQ(log->report.flips_refused, 0u) << "the shortest edge may go";
    const auto [a, b] = log->log.children[0];
    const std::size_t i = order[0];
    const std::uint32_t c = mesh.triangles[i], d = mesh.triangles[i - i % 3 + (i + 1) % 3];
    EXPECT_EQ(std::minmax(a, b), std::minmax(c, d));
  }
}

}  // namespace
}  // namespace merlin::render
