#include "render/reduce/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "render/lod/dendrogram.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;

mesh::Mesh withNormals(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  return mesh;
}

// Returns a mesh of 441 vertices and 800 triangles.
mesh::Mesh hills() { return withNormals(test::noisyGrid(20, 20, 0.1, 1)); }

reduce::Reduction reduced(const mesh::Mesh& mesh, reduce::ReduceSettings settings = {}) {
  settings.cost = "pattern";
  auto result = reduce::reduce(mesh, settings);
  EXPECT_TRUE(result) << result.error().what;
  return *std::move(result);
}

std::string faultOf(reduce::ReduceSettings settings) {
  settings.cost = "pattern";
  const auto result = reduce::reduce(hills(), settings);
  if (result) return "none";
  EXPECT_EQ(result.error().code, Errc::kInvalidArgument);
  return result.error().what;
}

void expectSound(const mesh::Mesh& mesh, const reduce::Reduction& r) {
  const lod::CollapseLog& log = r.log;
  std::set<std::uint32_t> dead;
  for (std::size_t k = 0; k < log.children.size(); ++k) {
    for (const std::uint32_t child : log.children[k]) {
      EXPECT_LT(child, mesh.vertexCount() + k);
      EXPECT_TRUE(dead.insert(child).second) << child << " is merged twice";
    }
  }
  EXPECT_EQ(log.positions.size(), 3 * log.children.size());
  EXPECT_EQ(log.error.size(), log.children.size());
  ASSERT_EQ(log.features.size(), mesh.features.size());
  const auto finite = [](float v) { return std::isfinite(v); };
  EXPECT_TRUE(std::all_of(log.positions.begin(), log.positions.end(), finite));
  EXPECT_TRUE(std::all_of(log.error.begin(), log.error.end(), finite));
  for (std::size_t f = 0; f < log.features.size(); ++f) {
    EXPECT_EQ(log.features[f].size(), mesh.features[f].dimension * log.children.size());
    EXPECT_TRUE(std::all_of(log.features[f].begin(), log.features[f].end(), finite));
  }
  EXPECT_EQ(r.report.collapses, log.children.size());
  EXPECT_GE(r.report.triangles, 1u);
}

TEST(Reduce, StopsAtANumberOfTriangles) {
  const reduce::Reduction r = reduced(hills(), {.min_triangles = 100});
  EXPECT_STREQ(r.report.stopped, "triangles");
  EXPECT_LE(r.report.triangles, 100u);
  EXPECT_GE(r.report.triangles, 99u);  // a collapse removes two triangles at most
}

TEST(Reduce, StopsAtAShareOfTheTriangles) {
  const reduce::Reduction r = reduced(hills(), {.min_percent = 25});
  EXPECT_STREQ(r.report.stopped, "percent");
  EXPECT_LE(r.report.triangles, 200u);
  EXPECT_GE(r.report.triangles, 199u);
}

TEST(Reduce, StopsBeforeTheErrorIsLargerThanAsked) {
  const float diagonal = mesh::boundingBox(hills().positions).diagonal();
  std::size_t before = 0;
  for (const double percent : {0.1, 0.2, 0.5}) {
    const reduce::Reduction r = reduced(hills(), {.max_error_percent = percent});
    EXPECT_STREQ(r.report.stopped, "error");
    EXPECT_LE(100 * r.report.error, percent * diagonal);
    EXPECT_EQ(r.report.error, *std::max_element(r.log.error.begin(), r.log.error.end()));
    EXPECT_GT(r.report.collapses, before);
    before = r.report.collapses;
  }
}

TEST(Reduce, StopsAtWhateverComesFirst) {
  const auto stopped = [](std::size_t triangles, double percent, double error) {
    return std::string(
        reduced(hills(),
                {.min_triangles = triangles, .min_percent = percent, .max_error_percent = error})
            .report.stopped);
  };
  EXPECT_EQ(stopped(300, 25, 50), "triangles");
  EXPECT_EQ(stopped(300, 50, 50), "percent");
  EXPECT_EQ(stopped(300, 50, 0.01), "error");
}

TEST(Reduce, DoesNothingWhereAllIsAsAskedAlready) {
  for (const reduce::ReduceSettings& settings : {reduce::ReduceSettings{.min_triangles = 800},
                                                 {.min_percent = 100},
                                                 {.max_error_percent = 0}}) {
    const reduce::Reduction r = reduced(hills(), settings);
    EXPECT_EQ(r.report.collapses, 0u);
    EXPECT_EQ(r.report.triangles, 800u);
    EXPECT_EQ(r.report.error, 0);
  }
}

TEST(Reduce, OfAPlaneCostsNoError) {
  const reduce::Reduction r = reduced(withNormals(test::grid(20, 20)), {.max_error_percent = 0});
  EXPECT_STREQ(r.report.stopped, "nothing left to collapse");
  EXPECT_EQ(r.report.error, 0);
  EXPECT_LE(r.report.triangles, 2u);
}

TEST(Reduce, GoesOnUntilNothingIsLeft) {
  for (const mesh::Mesh& mesh :
       {hills(), withNormals(test::sphere(3)), withNormals(test::cube())}) {
    const reduce::Reduction r = reduced(mesh);
    EXPECT_STREQ(r.report.stopped, "nothing left to collapse");
    EXPECT_LT(r.report.triangles, 8u);
    expectSound(mesh, r);
  }
}

TEST(Reduce, IsCancelledByItsProgress) {
  const mesh::Mesh mesh = withNormals(test::grid(80, 80));
  std::vector<std::size_t> calls;
  const auto cancelled =
      reduce::reduce(mesh, {.cost = "pattern"}, [&](const reduce::ReduceProgress& p) {
        calls.push_back(p.collapses);
        EXPECT_LE(p.triangles, 12800 - p.collapses);
        return false;
      });
  ASSERT_TRUE(cancelled);
  EXPECT_EQ(calls, (std::vector<std::size_t>{4096}));
  EXPECT_STREQ(cancelled->report.stopped, "cancelled");
  EXPECT_EQ(cancelled->report.collapses, 4096u);
  expectSound(mesh, *cancelled);
}

TEST(Reduce, GivesTheSameLogTwice) {
  const reduce::Reduction a = reduced(hills()), b = reduced(hills());
  EXPECT_EQ(a.log.children, b.log.children);
  EXPECT_EQ(a.log.positions, b.log.positions);
  EXPECT_EQ(a.log.features, b.log.features);
  EXPECT_EQ(a.log.error, b.log.error);
  EXPECT_EQ(a.log.about, b.log.about);
}

TEST(Reduce, SaysWhatItDid) {
  const reduce::Reduction r = reduced(hills(), {.weights = {{"geometry", 1}, {"normal", 0.25F}},
                                                .preserve_topology = true,
                                                .min_triangles = 100});
  EXPECT_EQ(
      r.log.about,
      "cost=pattern\nfast=false\npreserve_topology=true\nstopped=triangles\nweight.geometry=1\n"
      "weight.normal=0.25\n");
  EXPECT_EQ(
      reduced(hills(), {.min_percent = 50}).log.about,
      "cost=pattern\nfast=false\npreserve_topology=false\nstopped=percent\nweight.boundary=0.5\n"
      "weight.geometry=1\nweight.normal=0.05\n");
}

TEST(Reduce, RefusesWeightsAndLimitsThatAreNone) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(faultOf({.cost = "pattern", .fast = true}),
            "cost pattern: only the cost quadric has a fast mode");
  EXPECT_EQ(
      faultOf({.weights = {{"colour", 1}}}),
      "weight colour: the mesh has no such feature; it has geometry, normal, curvature, boundary");
  EXPECT_EQ(faultOf({.weights = {{"geometry", 0}}}), "no weight is more than 0");
  EXPECT_EQ(faultOf({.min_percent = -1}), "percent -1 is not from 0 to 100");
  EXPECT_EQ(faultOf({.min_percent = 100.5}), "percent 100.5 is not from 0 to 100");
  EXPECT_EQ(faultOf({.min_percent = kNaN}), "percent nan is not from 0 to 100");
  EXPECT_EQ(faultOf({.max_error_percent = -1}), "error -1 % is not 0 or more");
  EXPECT_EQ(faultOf({.max_error_percent = kNaN}), "error nan % is not 0 or more");
}

// Returns the number of collapses that merge different labels when hills with the labels 0 (x < 10)
// and 1 are reduced to 5 % of their triangles.
long crossings(float weight) {
  mesh::Mesh mesh = hills();
  Floats labels;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) labels.push_back(v % 21 < 10 ? 0.0F : 1.0F);
  mesh.features.push_back({"label", 1, labels});
  const reduce::Reduction r =
      reduced(mesh, {.weights = {{"geometry", 1}, {"label", weight}}, .min_percent = 5});
  EXPECT_GT(r.log.children.size(), 350u);
  labels.insert(labels.end(), r.log.features[1].begin(), r.log.features[1].end());
  for (const float label : labels) EXPECT_TRUE(label == 0 || label == 1) << label;
  return std::count_if(r.log.children.begin(), r.log.children.end(), [&](const auto& children) {
    return labels[children[0]] != labels[children[1]];
  });
}

TEST(Reduce, DoesNotCrossALabelOfHighWeight) {
  EXPECT_EQ(crossings(100), 0);
  EXPECT_GT(crossings(0), 10);
}

// Returns the Euler characteristic V - E + F of the mesh.
long eulerNumber(const mesh::Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
    edges.insert(std::minmax(a, b));
  }
  return static_cast<long>(mesh.vertexCount() + mesh.triangleCount()) -
         static_cast<long>(edges.size());
}

TEST(Reduce, KeepsTheTopologyWhereItIsAskedTo) {
  const mesh::Mesh two =
      withNormals(test::together(test::sphere(2), test::moved(test::sphere(1), 3, 0, 0)));
  const reduce::Reduction r = reduced(two, {.preserve_topology = true});
  const lod::Dendrogram d = lod::buildDendrogram(two, r.log);
  EXPECT_GT(r.report.topology_refused, 0u);
  for (std::size_t level = 0; level < d.levels(); ++level) {
    ASSERT_EQ(eulerNumber(lod::extract(d, level)), 4) << level;
  }
  EXPECT_EQ(r.report.triangles, 8u);  // two tetrahedra
}

TEST(Reduce, LeavesALastTriangle) {
  mesh::Mesh one = withNormals(mesh::Mesh{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {}, {0, 1, 2}});
  const reduce::Reduction none = reduced(one);
  EXPECT_EQ(none.report.collapses, 0u);
  EXPECT_EQ(none.report.triangles, 1u);
  EXPECT_GT(none.report.topology_refused, 0u);
  const mesh::Mesh two = withNormals(test::together(one, test::moved(one, 5, 0, 0)));
  const reduce::Reduction r = reduced(two);
  EXPECT_EQ(r.report.triangles, 1u);
  EXPECT_EQ(r.report.collapses, 1u);
  expectSound(two, r);
}

// The mesh has three fins at one edge, faces that occur twice and reversed, a cube and a single
// triangle, and coincident vertices.
TEST(Reduce, TakesWhatIsNoManifold) {
  mesh::Mesh fins;
  fins.positions = {0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 1, 0, -1, -1, 0};
  fins.triangles = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  mesh::Mesh twice = test::sphere(1);
  const std::vector<std::uint32_t> once = twice.triangles;
  twice.triangles.insert(twice.triangles.end(), once.begin(), once.end());
  twice.triangles.insert(twice.triangles.end(), once.rbegin(), once.rend());
  mesh::Mesh pieces =
      test::together(test::cube(), mesh::Mesh{{5, 0, 0, 6, 0, 0, 5, 1, 0}, {}, {0, 1, 2}});
  mesh::Mesh folded = test::grid(6, 6);
  for (float& x : folded.positions) x = std::floor(x / 2);
  for (const mesh::Mesh& mesh : {fins, twice, pieces, folded}) {
    for (const bool preserve : {false, true}) {
      const mesh::Mesh ready = withNormals(mesh);
      const reduce::Reduction r = reduced(ready, {.preserve_topology = preserve});
      expectSound(ready, r);
      const lod::Dendrogram d = lod::buildDendrogram(ready, r.log);
      EXPECT_EQ(d.triangleCount(), ready.triangleCount());
      EXPECT_EQ(d.trianglesAt(d.levels() - 1), r.report.triangles);
    }
  }
}

TEST(Reduce, TakesTheFarthestAndTheSmallestCoordinates) {
  for (const float scale : {1e18F / 20, 1e-30F}) {
    mesh::Mesh mesh =
        test::together(test::noisyGrid(8, 8, 0.5, 3), test::moved(test::cube(), 15, 0, 0));
    for (float& x : mesh.positions) x *= scale;
    ASSERT_TRUE(validate(mesh));
    mesh = withNormals(mesh);
    const reduce::Reduction r = reduced(mesh);
    expectSound(mesh, r);
    EXPECT_GT(r.report.collapses, 70u);
    lod::buildDendrogram(mesh, r.log);
  }
}

}  // namespace
}  // namespace merlin::render
