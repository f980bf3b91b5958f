// The cost `quadric` as a whole: what it preserves, when it stops, and that the number of threads
// does not change the result.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "render/compare/compare.h"
#include "render/lod/dendrogram.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

mesh::Mesh withNormals(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  return mesh;
}

reduce::Reduction reduced(const mesh::Mesh& mesh, const reduce::ReduceSettings& settings = {}) {
  auto result = reduce::reduce(mesh, settings);
  EXPECT_TRUE(result) << result.error().what;
  return *std::move(result);
}

mesh::Mesh levelOf(const mesh::Mesh& mesh, const reduce::Reduction& r, std::size_t triangles) {
  const lod::Dendrogram d = lod::buildDendrogram(mesh, r.log);
  return lod::extract(d, d.levelFor(triangles));
}

double areaOf(const mesh::Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    double p[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i)
        p[k][i] = mesh.positions[3 * std::size_t{mesh.triangles[t + k]} + i];
    }
    double u[3], v[3];
    for (int i = 0; i < 3; ++i) {
      u[i] = p[1][i] - p[0][i];
      v[i] = p[2][i] - p[0][i];
    }
    area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]) /
            2;
  }
  return area;
}

TEST(Quadric, APlateBecomesTwoTrianglesAndKeepsItsCorners) {
  const mesh::Mesh mesh = withNormals(test::grid(12, 9));
  const mesh::Mesh least = levelOf(mesh, reduced(mesh), 2);
  ASSERT_EQ(least.triangleCount(), 2u);
  EXPECT_NEAR(areaOf(least), 12 * 9, 0.5);
  const mesh::Box box = mesh::boundingBox(least.positions);
  EXPECT_NEAR(box.low[0], 0, 0.05);
  EXPECT_NEAR(box.high[0], 12, 0.05);
  EXPECT_NEAR(box.high[1], 9, 0.05);
}

mesh::Mesh bumpyBall() {
  mesh::Mesh ball = test::sphere(5);
  for (std::size_t v = 0; v < ball.vertexCount(); ++v) {
    float* p = &ball.positions[3 * v];
    const float bump = 1 + 0.05F * std::sin(6 * p[0]) * std::cos(5 * p[1]) * std::sin(7 * p[2]);
    for (int k = 0; k < 3; ++k) p[k] *= bump;
  }
  return withNormals(ball);
}

// Returns the error of the level with a twentieth of the triangles.
compare::Deviation errorOf(const mesh::Mesh& mesh, const reduce::Reduction& r) {
  compare::CompareSettings settings;
  settings.samples = 20'000;
  const auto compared =
      compare::compare(mesh, levelOf(mesh, r, mesh.triangleCount() / 20), settings);
  EXPECT_TRUE(compared);
  return compared->symmetric();
}

TEST(Quadric, ErrorIsFarBelowThePatterns) {
  const mesh::Mesh ball = bumpyBall();
  const auto quadric = errorOf(ball, reduced(ball));
  const auto pattern = errorOf(ball, reduced(ball, {.cost = "pattern"}));
  EXPECT_LT(quadric.rms, pattern.rms / 2);
  EXPECT_LT(quadric.max.high, pattern.max.high);
}

TEST(Quadric, FastIsNearlyAsGood) {
  const mesh::Mesh ball = bumpyBall();
  const reduce::Reduction fine = reduced(ball), fast = reduced(ball, {.fast = true});
  EXPECT_NE(fine.log.children, fast.log.children);
  EXPECT_LT(errorOf(ball, fast).rms, 1.15 * errorOf(ball, fine).rms);
  EXPECT_NE(fast.log.about.find("fast=true"), std::string::npos);
}

// Returns a mesh with enough vertices for a reduction in two parts.
mesh::Mesh wide() { return withNormals(test::noisyGrid(170, 170, 0.2, 7)); }

TEST(Quadric, IsTheSameBytesForAnyNumberOfThreads) {
  const mesh::Mesh mesh =
      withNormals(test::noisyGrid(350, 350, 0.2, 7));  // four parts, which become two
  const reduce::Reduction one = reduced(mesh, {.threads = 1});
  for (const unsigned threads : {2u, 3u}) {
    const reduce::Reduction more = reduced(mesh, {.threads = threads});
    EXPECT_EQ(more.log.children, one.log.children);
    EXPECT_EQ(more.log.positions, one.log.positions);
    EXPECT_EQ(more.log.features, one.log.features);
    EXPECT_EQ(more.log.error, one.log.error);
  }
}

TEST(Quadric, LockedVerticesStay) {
  const mesh::Mesh mesh = withNormals(test::noisyGrid(20, 20, 0.3, 5));
  std::vector<bool> locked(mesh.vertexCount());
  for (std::size_t v = 0; v < locked.size(); v += 40) locked[v] = true;
  const mesh::Mesh coarse = levelOf(mesh, reduced(mesh, {.locked = locked}), 60);
  std::set<std::array<float, 3>> places;
  for (std::size_t v = 0; v < coarse.vertexCount(); ++v) {
    const float* p = &coarse.positions[3 * v];
    places.insert({p[0], p[1], p[2]});
  }
  for (std::size_t v = 0; v < locked.size(); v += 40) {
    const float* p = &mesh.positions[3 * v];
    std::array<float, 3> nearest = *places.begin();
    for (const auto& q : places) {
      if (std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]) <
          std::hypot(nearest[0] - p[0], nearest[1] - p[1], nearest[2] - p[2]))
        nearest = q;
    }
    EXPECT_EQ(nearest, (std::array<float, 3>{p[0], p[1], p[2]}));
  }
}

// A needle on hills has almost no area, but it is high.
TEST(Quadric, AThinTipStays) {
  mesh::Mesh mesh = test::grid(100, 100);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float x = mesh.positions[3 * v] - 50, y = mesh.positions[3 * v + 1] - 50;
    mesh.positions[3 * v + 2] =
        std::max(0.0F, 40 * (1 - std::hypot(x, y) / 1.5F)) + 2 * std::sin(x) * std::sin(0.7F * y);
  }
  mesh = withNormals(mesh);
  const mesh::Box box = mesh::boundingBox(levelOf(mesh, reduced(mesh), 200).positions);
  EXPECT_GT(box.high[2], 39.5F);  // without the guard, 26 or less
}

TEST(Quadric, SeamsOfItsPartsAreNotSeen) {
  const mesh::Mesh mesh = wide();
  const mesh::Mesh coarse = levelOf(mesh, reduced(mesh), mesh.triangleCount() / 50);
  // Triangles might stay small along the seams between the parts, so the test counts the vertices
  // in 10 x 10 fields.
  std::vector<int> fields(100);
  for (std::size_t v = 0; v < coarse.vertexCount(); ++v) {
    const auto cell = [&](std::size_t k) {
      return std::clamp(static_cast<int>(coarse.positions[3 * v + k] / 17), 0, 9);
    };
    ++fields[static_cast<std::size_t>(10 * cell(1) + cell(0))];
  }
  const double mean = static_cast<double>(coarse.vertexCount()) / 100;
  EXPECT_LT(*std::max_element(fields.begin(), fields.end()), 3 * mean);
}

// Returns a sphere, and 20 cubes of a hundredth of its size.
mesh::Mesh specks() {
  mesh::Mesh mesh = test::sphere(4);
  for (int i = 0; i < 20; ++i) {
    mesh::Mesh speck = test::cube();
    for (float& x : speck.positions) x *= 0.01F;
    mesh = test::together(mesh, test::moved(speck, 2 + 0.1F * static_cast<float>(i), 0, 0));
  }
  return withNormals(mesh);
}

// Returns the number of the small cubes of specks() that are left at 120 triangles.
std::size_t specksLeft(const mesh::Mesh& mesh, const reduce::Reduction& r) {
  const mesh::Mesh coarse = levelOf(mesh, r, 120);
  std::set<int> alive;
  for (std::size_t v = 0; v < coarse.vertexCount(); ++v) {
    if (coarse.positions[3 * v] > 1.5F)
      alive.insert(static_cast<int>(std::lround((coarse.positions[3 * v] - 2) * 10)));
  }
  return alive.size();
}

TEST(Quadric, ComponentsStayUntilNothingElseIsLeft) {
  const mesh::Mesh mesh = specks();
  const reduce::Reduction r = reduced(mesh, {.preserve_components = true});
  EXPECT_EQ(specksLeft(mesh, r), 20u);
  // When no other collapse is left, components are removed too.
  EXPECT_LE(r.report.triangles, 2u);
}

TEST(Quadric, WhatIsSmallerThanTheErrorVanishes) {
  const mesh::Mesh mesh = specks();
  EXPECT_EQ(specksLeft(mesh, reduced(mesh)), 0u);
}

TEST(Quadric, LabelsLock) {
  mesh::Mesh mesh = withNormals(test::noisyGrid(20, 20, 0.3, 5));
  mesh::Feature label{"label", 1, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    label.values.push_back(static_cast<float>(v * 7919 % 13 < 2));  // scattered
  mesh.features.push_back(label);
  const reduce::Reduction r = reduced(mesh);
  // As long as other collapses are possible, no collapse merges nodes with different labels.
  const auto labelOf = [&](std::uint32_t n) {
    return n < mesh.vertexCount() ? label.values[n] : r.log.features[1][n - mesh.vertexCount()];
  };
  std::size_t k = 0;
  while (k < r.log.children.size() &&
         labelOf(r.log.children[k][0]) == labelOf(r.log.children[k][1]))
    ++k;
  EXPECT_GT(k, mesh.vertexCount() / 2);
  EXPECT_LT(k, r.log.children.size());
  EXPECT_EQ(r.report.by_all_rules, lod::buildDendrogram(mesh, r.log).trianglesAt(k));
}

TEST(Quadric, TopologyIsKeptWhereAsked) {
  const mesh::Mesh two =
      withNormals(test::together(test::sphere(3), test::moved(test::sphere(3), 3, 0, 0)));
  const reduce::Reduction r = reduced(two, {.preserve_topology = true});
  EXPECT_EQ(r.report.triangles, 8u);  // two tetrahedra
  EXPECT_STREQ(r.report.stopped, "nothing left to collapse");
}

TEST(Quadric, StopsWhereItIsTold) {
  const mesh::Mesh mesh = withNormals(test::noisyGrid(20, 20, 0.1, 1));
  const reduce::Reduction by_count = reduced(mesh, {.min_triangles = 300});
  EXPECT_STREQ(by_count.report.stopped, "triangles");
  EXPECT_LE(by_count.report.triangles, 300u);
  EXPECT_GE(by_count.report.triangles, 299u);
  EXPECT_EQ(by_count.report.by_all_rules, by_count.report.triangles);
  const reduce::Reduction by_percent = reduced(mesh, {.min_percent = 10});
  EXPECT_STREQ(by_percent.report.stopped, "percent");
  EXPECT_LE(by_percent.report.triangles, 80u);
  const reduce::Reduction by_error = reduced(mesh, {.max_error_percent = 0.1});
  EXPECT_STREQ(by_error.report.stopped, "error");
  EXPECT_LE(by_error.report.error, 0.001F * mesh::boundingBox(mesh.positions).diagonal());
  EXPECT_GT(by_error.report.collapses, 20u);
  EXPECT_STREQ(reduced(mesh, {.min_triangles = 10'000}).report.stopped, "triangles");
  EXPECT_EQ(reduced(mesh, {.min_triangles = 10'000}).report.collapses, 0u);
}

TEST(Quadric, IsCancelledByItsProgress) {
  const mesh::Mesh mesh = wide();
  int calls = 0;
  const auto r = reduce::reduce(mesh, {}, [&](const reduce::ReduceProgress& p) {
    EXPECT_LE(p.triangles, mesh.triangleCount());
    return ++calls < 3;
  });
  ASSERT_TRUE(r);
  EXPECT_STREQ(r->report.stopped, "cancelled");
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(lod::buildDendrogram(mesh, r->log).trianglesAt(r->report.collapses),
            r->report.triangles);
}

// Meshes that are non-manifold, have duplicate faces or are folded flat are reduced to the end,
// with correct triangle counts.
TEST(Quadric, TakesAnySurface) {
  const mesh::Mesh fins{
      {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1}, {}, {0, 1, 2, 1, 0, 3, 0, 1, 4}};
  mesh::Mesh twice = test::cube();
  twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.end());
  mesh::Mesh folded = test::grid(6, 6);
  for (float& x : folded.positions) x = std::floor(x / 2);
  mesh::Mesh point = test::grid(4, 4);
  for (float& x : point.positions) x = 1;
  mesh::Mesh fan;
  fan.positions = {0, 0, 0};
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const float a = static_cast<float>(i) * 0.00209F;
    fan.positions.insert(fan.positions.end(), {std::cos(a), std::sin(a), 0});
    fan.triangles.insert(fan.triangles.end(), {0, i + 1, (i + 1) % 3000 + 1});
  }
  const mesh::Mesh one{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {}, {0, 1, 2}};
  for (const mesh::Mesh& mesh : {fins, twice, folded, point, fan, one}) {
    const mesh::Mesh ready = withNormals(mesh);
    const reduce::Reduction r = reduced(ready);
    const lod::Dendrogram d = lod::buildDendrogram(ready, r.log);
    EXPECT_EQ(d.trianglesAt(d.levels() - 1), r.report.triangles);
    EXPECT_GE(r.report.triangles, 1u);
    EXPECT_LE(r.report.triangles, 4u);  // duplicate faces are collapsed together
    for (const float x : r.log.positions) ASSERT_TRUE(std::isfinite(x));
  }
}

TEST(Quadric, TakesTheFarthestAndTheSmallestCoordinates) {
  for (const float scale : {1e18F / 20, 1e-30F}) {
    mesh::Mesh mesh =
        test::together(test::noisyGrid(8, 8, 0.5, 3), test::moved(test::cube(), 15, 0, 0));
    for (float& x : mesh.positions) x *= scale;
    mesh = withNormals(mesh);
    const reduce::Reduction r = reduced(mesh);
    EXPECT_GT(r.report.collapses, 70u);
    for (const float x : r.log.positions) ASSERT_TRUE(std::isfinite(x));
    lod::buildDendrogram(mesh, r.log);
  }
}

// Returns a plane in which the feature `name` jumps from 0 to 1 at x = 10.
mesh::Mesh step(const std::string& name) {
  mesh::Mesh mesh = withNormals(test::grid(20, 20));
  mesh::Feature f{name, 1, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    f.values.push_back(v % 21 < 10 ? 0.0F : 1.0F);
  mesh.features.push_back(std::move(f));
  return mesh;
}

// Returns the mean error of feature 1 over the remaining vertices.
double stepError(const mesh::Mesh& coarse) {
  const mesh::Feature& f = coarse.features[1];
  double sum = 0;
  for (std::size_t v = 0; v < coarse.vertexCount(); ++v) {
    const float x = coarse.positions[3 * v];
    const double ought = std::clamp(x - 9.0F, 0.0F, 1.0F);
    sum += std::abs(f.values[v] - ought);
  }
  return sum / static_cast<double>(coarse.vertexCount());
}

TEST(Quadric, AnyModalityWithAWeightIsKept) {
  const mesh::Mesh mesh = step("thermal");
  const mesh::Mesh kept =
      levelOf(mesh, reduced(mesh, {.weights = {{"geometry", 1}, {"thermal", 1}}}), 60);
  const mesh::Mesh lost = levelOf(mesh, reduced(mesh, {.weights = {{"geometry", 1}}}), 60);
  EXPECT_LT(stepError(kept), 0.01);
  EXPECT_GT(stepError(lost), 5 * stepError(kept));
  for (const float x : kept.features[1].values) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 1);
  }
}

TEST(Quadric, LabelsAreNeverMixed) {
  const mesh::Mesh mesh = step("label");
  const reduce::Reduction r = reduced(mesh);
  for (const float x : r.log.features[1]) EXPECT_TRUE(x == 0 || x == 1) << x;
}

// A mesh with two labels, separated by a wavy border.
TEST(Quadric, LockedLabelsKeepTheEdgeBetweenThem) {
  constexpr std::uint32_t kSide = 40;
  mesh::Mesh mesh = withNormals(test::grid(kSide, kSide));
  const auto beyond = [](float x, float y) { return x - 20 - 3 * std::sin(0.3F * y); };
  mesh::Feature label{"label", 1, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[3 * v];
    p[2] = std::sin(0.3F * p[0]) * std::cos(0.2F * p[1]);
    label.values.push_back(beyond(p[0], p[1]) < 0 ? 0.0F : 1.0F);
  }
  mesh.features.push_back(label);
  const mesh::Mesh coarse = levelOf(mesh, reduced(mesh), 160);
  // `off`: distance in x from the wavy border, summed over the ends of edges between labels;
  // `ends`: their number.
  double off = 0, ends = 0;
  for (std::size_t i = 0; i < coarse.triangles.size(); ++i) {
    const std::uint32_t a = coarse.triangles[i];
    const std::uint32_t b = coarse.triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (coarse.features[1].values[a] == coarse.features[1].values[b]) continue;
    off += std::abs(beyond(coarse.positions[3 * a], coarse.positions[3 * a + 1]));
    ++ends;
  }
  EXPECT_LT(off / ends, 1.5) << "2.3 where they are locked alone";
}

TEST(Quadric, WeightsOfThePatternAreRefused) {
  const mesh::Mesh mesh = withNormals(test::grid(3, 3));
  for (const char* name : {"normal", "curvature", "boundary"}) {
    const auto r = reduce::reduce(mesh, {.weights = {{"geometry", 1}, {name, 1}}});
    ASSERT_FALSE(r) << name;
    EXPECT_NE(r.error().what.find("only the cost pattern uses this weight"), std::string::npos);
  }
  EXPECT_FALSE(reduce::reduce(mesh, {.weights = {{"geometry", 0}}}));
  EXPECT_EQ(reduce::reduce(mesh, {.cost = "cubic"}).error().what,
            "cost cubic: is not one of quadric, pattern");
}

}  // namespace
}  // namespace merlin::render
