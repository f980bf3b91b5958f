// Reducing a mesh with very many triangles at one vertex takes hardly more work per triangle than
// reducing another mesh.
#include "tests/support/hostile_shapes.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/mesh/non_manifold.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

struct Way {
  const char* name;
  reduce::ReduceSettings settings;
};

// Returns the number of elements that a reduction visits, divided by the number of triangles.
double workOf(const test::HostileShape& shape, Way way) {
  mesh::Mesh mesh = shape.make(24'000);
  mesh::splitNonManifold(mesh);
  mesh::ensureNormals(mesh);
  way.settings.threads = 1;
  const auto r = reduce::reduce(mesh, way.settings);
  if (!r) ADD_FAILURE() << way.name << ": " << r.error().what;
  if (!r) return 0;
  EXPECT_GT(r->report.collapses, 0u) << way.name;
  EXPECT_LE(r->report.triangles, 2u) << way.name;
  return static_cast<double>(r->report.visited) / static_cast<double>(mesh.triangleCount());
}

std::vector<Way> waysFor(const test::HostileShape& shape) {
  std::vector<Way> ways(4);
  ways[0].name = "default";
  ways[1].name = "fast";
  ways[1].settings.fast = true;
  ways[2].name = "locks";
  ways[2].settings.locked.resize(shape.make(24'000).vertexCount());
  for (std::size_t v = 1; v < ways[2].settings.locked.size(); ++v)
    ways[2].settings.locked[v] = v % 16 != 0;
  ways[3].name = "pattern";
  ways[3].settings.cost = "pattern";
  return ways;
}

// A reduction with a step that visits all triangles of a vertex would visit thousands of elements
// per triangle here.
class HostileShape : public testing::TestWithParam<test::HostileShape> {};

// Returns the work of each way of reducing a regular mesh. It bounds the work on all shapes.
const std::vector<double>& regularWork() {
  static const std::vector<double> work = [] {
    const test::HostileShape regular = test::hostileShapes().front();
    EXPECT_STREQ(regular.name, "regular");
    std::vector<double> of_ways;
    for (const Way& way : waysFor(regular)) of_ways.push_back(workOf(regular, way));
    return of_ways;
  }();
  return work;
}

TEST_P(HostileShape, TakesTenTimesTheWorkOfARegularMeshAtMost) {
  const std::vector<Way> ways = waysFor(GetParam());
  for (std::size_t i = 0; i < ways.size(); ++i)
    EXPECT_LT(workOf(GetParam(), ways[i]), 10 * regularWork()[i]) << ways[i].name;
}

INSTANTIATE_TEST_SUITE_P(Shapes, HostileShape, testing::ValuesIn(test::hostileShapes()),
                         [](const auto& shape) { return std::string(shape.param.name); });

}  // namespace
}  // namespace merlin::render
