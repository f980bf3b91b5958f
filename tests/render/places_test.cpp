#include "render/mesh/places.h"

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

TEST(SamePlace, IsARingThroughTheVerticesOfAPlace) {
  EXPECT_EQ(mesh::samePlace(Floats{1, 2, 3, 0, 0, 0, 1, 2, 3, 1, 2, 4, 1, 2, 3, -0.0F, 0, 0}),
            (Indices{2, 5, 4, 3, 0, 1}));
}

TEST(SamePlace, LeavesThoseAloneThatAre) {
  EXPECT_EQ(mesh::samePlace({}), Indices{});
  const auto alone = mesh::samePlace(test::grid(20, 20).positions);
  for (std::uint32_t v = 0; v < alone.size(); ++v) EXPECT_EQ(alone[v], v);
}

TEST(SamePlace, AgreesWithComparingEachWithEach) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    Floats positions(3 * random.below(20));
    for (float& x : positions) x = static_cast<float>(random.below(2));
    const Indices next = mesh::samePlace(positions);
    ASSERT_EQ(next.size(), positions.size() / 3);
    EXPECT_EQ(mesh::samePlaceBySorting(positions), next);
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
