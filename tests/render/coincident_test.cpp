#include "render/mesh/coincident.h"

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

TEST(CoincidentVertices, AreLinkedIntoARing) {
  EXPECT_EQ(
      mesh::coincidentVertices(Floats{1, 2, 3, 0, 0, 0, 1, 2, 3, 1, 2, 4, 1, 2, 3, -0.0F, 0, 0}),
      (Indices{2, 5, 4, 3, 0, 1}));
}

TEST(CoincidentVertices, AVertexAloneIsItsOwnRing) {
  EXPECT_EQ(mesh::coincidentVertices({}), Indices{});
  const auto alone = mesh::coincidentVertices(test::grid(20, 20).positions);
  for (std::uint32_t v = 0; v < alone.size(); ++v) EXPECT_EQ(alone[v], v);
}

TEST(CoincidentVertices, AgreeWithComparingEachWithEach) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    Floats positions(3 * random.below(20));
    for (float& x : positions) x = static_cast<float>(random.below(2));
    const Indices next = mesh::coincidentVertices(positions);
    ASSERT_EQ(next.size(), positions.size() / 3);
    EXPECT_EQ(mesh::coincidentVerticesBySorting(positions), next);
    for (std::size_t v = 0; v < next.size(); ++v) {
      const auto same = [&](std::size_t w) {
        return std::equal(&positions[3 * v], &positions[3 * v] + 3, &positions[3 * w]);
      };
      std::size_t expected = v;
      do expected = (expected + 1) % next.size();
      while (!same(expected));
      EXPECT_EQ(next[v], expected);
    }
  }
}

}  // namespace
}  // namespace merlin::render
