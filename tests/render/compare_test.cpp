#include "render/compare/compare.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

constexpr double kSqrt2 = std::numbers::sqrt2, kSqrt3 = std::numbers::sqrt3;

compare::CompareSettings quick() { return {.samples = 20'000}; }

compare::Comparison compared(const mesh::Mesh& a, const mesh::Mesh& b,
                             const compare::CompareSettings& settings = quick()) {
  auto result = compare::compare(a, b, settings);
  EXPECT_TRUE(result) << result.error().what;
  return *std::move(result);
}

std::string faultOf(const mesh::Mesh& a, const mesh::Mesh& b,
                    const compare::CompareSettings& settings = quick()) {
  const auto result = compare::compare(a, b, settings);
  if (result) return "none";
  EXPECT_EQ(result.error().code, Errc::kInvalidArgument);
  return result.error().what;
}

mesh::Mesh scaled(mesh::Mesh mesh, float by) {
  for (float& x : mesh.positions) x *= by;
  return mesh;
}

// Returns the mesh, rotated about the x axis.
mesh::Mesh turned(mesh::Mesh mesh, double angle_deg) {
  const double c = std::cos(angle_deg * std::numbers::pi / 180);
  const double s = std::sin(angle_deg * std::numbers::pi / 180);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    const double y = double{mesh.positions[i + 1]}, z = double{mesh.positions[i + 2]};
    mesh.positions[i + 1] = static_cast<float>(c * y - s * z);
    mesh.positions[i + 2] = static_cast<float>(s * y + c * z);
  }
  return mesh;
}

mesh::Mesh withFeature(mesh::Mesh mesh, const std::string& name, std::vector<float> row) {
  mesh::Feature feature{name, row.size(), {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    feature.values.insert(feature.values.end(), row.begin(), row.end());
  mesh.features.push_back(std::move(feature));
  return mesh;
}

void expectHolds(const compare::Interval& max, double value, double width) {
  constexpr double kRounding = 1e-7;  // rounding of the meshes' coordinates, which are floats
  EXPECT_LE(max.low, value + kRounding);
  EXPECT_GE(max.high, value - kRounding);
  EXPECT_LE(max.high - max.low, width);
}

// Two surfaces: ground() is a floor of two triangles from x = -1 to 1; walls() are walls at x = -1
// and x = 1. Every corner of the floor touches a wall; the floor's middle line is 1 away from both.
mesh::Mesh ground() { return {{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, {}, {0, 1, 2, 0, 2, 3}}; }
mesh::Mesh walls() {
  const mesh::Mesh wall{{0, -2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2}, {}, {0, 1, 2, 0, 2, 3}};
  return test::together(test::moved(wall, -1, 0, 0), test::moved(wall, 1, 0, 0));
}

TEST(Compare, OfParallelPlanesIsTheirDistance) {
  const mesh::Mesh fine = test::grid(9, 9);
  const mesh::Mesh coarse = test::moved(scaled(test::grid(2, 2), 4.5F), 0, 0, 0.25F);
  const compare::Comparison c = compared(fine, coarse);
  EXPECT_NEAR(c.diagonal, 9 * kSqrt2, 1e-6);
  for (const compare::Deviation& d : {c.forward, c.backward, c.symmetric()}) {
    EXPECT_NEAR(d.rms, 0.25, 1e-12);
    EXPECT_NEAR(d.mean, 0.25, 1e-12);
    EXPECT_NEAR(d.max.low, 0.25, 1e-12);
    EXPECT_GE(d.max.high, 0.25);
    EXPECT_LE(d.max.high - d.max.low, 0.0001 * c.diagonal);
    EXPECT_EQ(d.facet_rms_deg, 0.0);
    EXPECT_FALSE(d.normal_rms_deg) << "no normals";
    EXPECT_TRUE(d.features.empty());
  }
}

TEST(Compare, OfCubesIsLargestAtTheCorners) {
  const compare::Comparison c = compared(test::cube(), scaled(test::cube(), 1.5F));
  const double width = 0.0001 * c.diagonal;
  expectHolds(c.forward.max, 0.5, width);
  EXPECT_NEAR(c.forward.rms, 0.5, 1e-12);
  expectHolds(c.backward.max, kSqrt3 * 0.5, width);
  expectHolds(c.symmetric().max, kSqrt3 * 0.5, width);
  EXPECT_GT(c.backward.rms, 0.5);
  EXPECT_EQ(c.symmetric().rms, c.backward.rms);
}

// From the octahedron to its subdivision, the largest distance is that between a facet, at
// 1/sqrt(3) from the centre, and the parallel facet of the subdivision, at sqrt(2/3). In the other
// direction it is that between the middle of an edge and the new vertex above it, (1,1,0)/sqrt(2).
TEST(Compare, OfASphereIsItsSagitta) {
  const compare::Comparison c = compared(test::sphere(0), test::sphere(1));
  expectHolds(c.forward.max, (kSqrt2 - 1) / kSqrt3, 0.0001 * c.diagonal);
  expectHolds(c.backward.max, 1 - 1 / kSqrt2, 0.0001 * c.diagonal);
  // The triangles of the fine sphere, with edges of 4 degrees, lie at most 0.0006 inside the unit
  // sphere.
  const compare::Interval max = compared(test::sphere(0), test::sphere(5)).forward.max;
  EXPECT_NEAR(max.low, 1 - 1 / kSqrt3, 0.001);
}

TEST(Compare, FindsASpike) {
  const mesh::Mesh plane = test::grid(20, 20);
  mesh::Mesh spike = plane;
  spike.positions[3 * (10 * 21 + 10) + 2] = 3;
  const compare::Comparison c = compared(spike, plane);
  EXPECT_EQ(c.forward.max.low, 3);
  expectHolds(c.forward.max, 3, 0.0001 * c.diagonal);
  EXPECT_LT(c.backward.max.high, 1) << "the plane is near to the spike's foot";
}

TEST(Compare, FindsAMaximumThatIsAtNoVertex) {
  for (const double width_percent : {1.0, 0.01, 0.0001}) {
    compare::CompareSettings settings = quick();
    settings.width_percent = width_percent;
    const compare::Comparison c = compared(ground(), walls(), settings);
    expectHolds(c.forward.max, 1, width_percent / 100 * c.diagonal);
  }
}

// The middle between the walls is at x = 0.15, which is not reached by repeated halving of the
// floor.
TEST(Compare, DropsNothingThatMatters) {
  const mesh::Mesh wall{{0, -2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2}, {}, {0, 1, 2, 0, 2, 3}};
  const mesh::Mesh apart =
      test::together(test::moved(wall, -1, 0, 0), test::moved(wall, 1.3F, 0, 0));
  for (const double width_percent : {30.0, 10.0, 5.0, 2.0, 1.0, 0.3, 0.1, 0.01}) {
    compare::CompareSettings settings = quick();
    settings.width_percent = width_percent;
    const compare::Comparison c = compared(ground(), apart, settings);
    expectHolds(c.forward.max, 1.15, width_percent / 100 * c.diagonal);
  }
}

TEST(Compare, StopsAtItsBudgetWithAnIntervalThatStillHolds) {
  compare::CompareSettings settings = quick();
  settings.max_evaluations = 1;
  const compare::Interval none = compared(ground(), walls(), settings).forward.max;
  EXPECT_EQ(none.evaluations, 4u) << "the vertices";
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 2);
  settings.max_evaluations = 5;
  settings.width_percent = 1e-9;
  const compare::Interval some = compared(ground(), walls(), settings).forward.max;
  EXPECT_GE(some.evaluations, 5u);
  EXPECT_LT(some.evaluations, 20u);
  EXPECT_LE(some.low, 1);
  EXPECT_GE(some.high, 1);
}

// The maximum is compared with that of a dense set of points on rough surfaces.
TEST(Compare, HoldsTheMaximumOfRoughSurfaces) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const mesh::Mesh a = test::noisyGrid(6, 6, 1, seed), b = test::noisyGrid(5, 7, 1, seed + 100);
    const compare::Comparison c = compared(a, b);
    const compare::TriangleTree tree(b);
    double most2 = 0;
    Random random(seed);
    for (std::size_t i = 0; i < a.triangles.size(); i += 3) {
      for (int trial = 0; trial < 400; ++trial) {
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const auto corner = [&](std::size_t k) {
          return compare::vectorAt(&a.positions[3 * a.triangles[i + k]]);
        };
        most2 = std::max(
            most2,
            tree.nearest((1 - u - v) * corner(0) + u * corner(1) + v * corner(2)).point.distance2);
      }
    }
    EXPECT_GE(c.forward.max.high, std::sqrt(most2));
    EXPECT_LE(c.forward.max.high - c.forward.max.low, 0.0001 * c.diagonal);
    EXPECT_LE(c.forward.max.low, std::sqrt(most2) + 0.1);
  }
}

TEST(Compare, SpreadsItsSamplesOverTheArea) {  // the distance is 1 - |x|
  const compare::Comparison c = compared(ground(), walls());
  EXPECT_NEAR(c.forward.mean, 0.5, 1e-3);
  EXPECT_NEAR(c.forward.rms, 1 / kSqrt3, 1e-3);
  // A thousand times as many triangles on one side of the middle must not change the mean.
  mesh::Mesh half = scaled(test::grid(20, 50), 0.05F);
  for (std::size_t i = 1; i < half.positions.size(); i += 3) half.positions[i] *= 0.8F;
  mesh::Mesh uneven =
      test::together(test::moved(half, 0, -1, 0),
                     {{-1, -1, 0, 0, -1, 0, 0, 1, 0, -1, 1, 0}, {}, {0, 1, 2, 0, 2, 3}});
  EXPECT_NEAR(compared(uneven, walls()).forward.mean, 0.5, 1e-3);
}

TEST(Compare, MeasuresFeaturesAtThePointsThatAreNearest) {
  const auto ramp = [](mesh::Mesh mesh, float offset) {
    mesh::Feature f{"range", 1, {}};
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
      f.values.push_back(mesh.positions[3 * v] + offset);
    mesh.features.push_back(f);
    return mesh;
  };
  const mesh::Mesh a = withFeature(ramp(test::grid(9, 9), 0), "colour", {0.5F, 0.25F, 1});
  const mesh::Mesh b = withFeature(ramp(test::moved(scaled(test::grid(2, 2), 4.5F), 0, 0, 0.5F), 2),
                                   "colour", {0.5F, 0.25F, 0.25F});
  for (const compare::Deviation& d : {compared(a, b).forward, compared(a, b).backward}) {
    ASSERT_EQ(d.features.size(), 2u);
    EXPECT_EQ(d.features[0].name, "range");
    EXPECT_NEAR(d.features[0].rms, 2, 1e-6) << "both rise with x, whatever their triangles";
    EXPECT_EQ(d.features[1].name, "colour");
    EXPECT_NEAR(d.features[1].rms, 0.75 / kSqrt3, 1e-9);
  }
  compare::CompareSettings one = quick();
  one.features = {"colour"};
  EXPECT_EQ(compared(a, b, one).forward.features.size(), 1u);
}

TEST(Compare, LeavesOutWhatOnlyOneHas) {
  const mesh::Mesh a = withFeature(withFeature(test::grid(2, 2), "heat", {1, 2}), "label", {1});
  const mesh::Mesh b = withFeature(test::grid(2, 2), "heat", {1});
  EXPECT_TRUE(compared(a, b).symmetric().features.empty());
}

TEST(Compare, MeasuresAnglesOfFacetsAndOfNormals) {
  const mesh::Mesh plane = test::grid(4, 4);
  EXPECT_NEAR(*compared(plane, turned(plane, 30)).forward.facet_rms_deg, 30, 1e-4);
  EXPECT_NEAR(*compared(turned(plane, 120), plane).backward.facet_rms_deg, 120, 1e-4);
  const compare::Comparison c = compared(withFeature(plane, "normal", {0, 0, 1}),
                                         withFeature(plane, "normal", {0, 0.6F, 0.8F}));
  EXPECT_NEAR(*c.symmetric().normal_rms_deg, 36.8698976, 1e-5);
  EXPECT_EQ(*c.symmetric().facet_rms_deg, 0);
  EXPECT_TRUE(c.symmetric().features.empty()) << "a normal is an angle";
}

TEST(Compare, IsNothingForOneMeshTwice) {
  const mesh::Mesh mesh = test::noisyGrid(30, 30, 0.3, 2);
  const compare::Comparison c = compared(mesh, mesh);
  EXPECT_LT(c.symmetric().rms, 1e-7);
  EXPECT_EQ(c.forward.max.evaluations, c.backward.max.evaluations);
  expectHolds(c.symmetric().max, 0, 0.0001 * c.diagonal);
}

// Returns the results of a comparison as raw bytes, to be compared bit by bit.
std::string bitsOf(const compare::Comparison& c) {
  std::string bits;
  const auto add = [&](double value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bits.append(bytes, sizeof value);
  };
  for (const compare::Deviation& d : {c.forward, c.backward}) {
    for (const double value : {d.rms, d.mean, d.max.low, d.max.high, *d.facet_rms_deg,
                               *d.normal_rms_deg, static_cast<double>(d.max.evaluations)})
      add(value);
    for (const compare::FeatureError& f : d.features) add(f.rms);
  }
  return bits;
}

TEST(Compare, GivesTheSameBitsForAnyNumberOfThreads) {
  mesh::Mesh a = withFeature(test::noisyGrid(90, 90, 1, 1), "colour", {1, 0, 0});
  mesh::Mesh b = withFeature(test::noisyGrid(40, 170, 1, 2), "colour", {0, 0, 0});
  Random random(3);
  for (mesh::Mesh* mesh : {&a, &b}) {
    mesh::ensureNormals(*mesh);
    for (float& x : mesh->find("colour")->values) x = static_cast<float>(random.uniform());
  }
  const auto bits = [&](unsigned threads, std::uint64_t seed) {
    return bitsOf(compared(a, b, {.samples = 30'001, .seed = seed, .threads = threads}));
  };
  const std::string one = bits(1, 1);
  EXPECT_TRUE(one == bits(2, 1));
  EXPECT_TRUE(one == bits(3, 1));
  EXPECT_TRUE(one == bits(0, 1));
  EXPECT_FALSE(one == bits(1, 2)) << "a seed changes the samples";
}

TEST(Compare, TakesTrianglesWithoutArea) {
  mesh::Mesh bad = test::grid(3, 3);
  bad.triangles.insert(bad.triangles.begin(), {0, 0, 0, 1, 1, 2});
  bad.triangles.insert(bad.triangles.end(), {0, 1, 2, 5, 5, 5});
  const compare::Comparison c = compared(bad, test::moved(bad, 0, 0, 2));
  EXPECT_NEAR(c.forward.rms, 2, 1e-12);
  EXPECT_NEAR(c.backward.max.high, 2, 1e-3);
  EXPECT_EQ(*c.symmetric().facet_rms_deg, 0);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const mesh::Mesh plane = test::grid(2, 2), empty;
  const mesh::Mesh line{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {}, {0, 1, 2}};
  EXPECT_EQ(faultOf(empty, plane), "the first mesh: has no triangles");
  EXPECT_EQ(faultOf(plane, empty), "the second mesh: has no triangles");
  EXPECT_EQ(faultOf(plane, line), "the second mesh: none of 1 triangles has an area");
  EXPECT_EQ(faultOf(plane, withFeature(plane, "heat", {1}), {.features = {"heat"}}),
            "feature heat: the first mesh lacks it, the second has dimension 1");
  EXPECT_EQ(faultOf(withFeature(plane, "heat", {1, 2}), withFeature(plane, "heat", {1}),
                    {.features = {"heat"}}),
            "feature heat: the first mesh has dimension 2, the second has dimension 1");
  EXPECT_EQ(faultOf(plane, plane, {.samples = 0}), "samples 0: at least 1 is needed");
  EXPECT_EQ(faultOf(plane, plane, {.width_percent = 0}),
            "width 0 % is not a finite number above 0");
  EXPECT_EQ(faultOf(plane, plane, {.width_percent = std::numeric_limits<double>::quiet_NaN()}),
            "width nan % is not a finite number above 0");
  mesh::Mesh broken = plane;
  broken.triangles[0] = 99;
  const auto malformed = compare::compare(plane, broken, quick());
  ASSERT_FALSE(malformed);
  EXPECT_EQ(malformed.error().code, Errc::kMalformed);
  EXPECT_EQ(malformed.error().what,
            "the second mesh: triangle 0: there is no vertex 99, the mesh has 9 (0 to 8)");
}

TEST(Compare, TellsHowFarItIsAndIsCancelled) {
  double share = 0;
  std::size_t points = 0;
  const mesh::Mesh a = test::noisyGrid(60, 60, 1, 1), b = test::noisyGrid(60, 60, 1, 2);
  compare::CompareSettings settings = quick();
  settings.threads = 1;
  const auto all = compare::compare(a, b, settings, [&](const compare::CompareProgress& p) {
    EXPECT_GE(p.share, share);
    share = p.share;
    points = std::max(points, p.points);
    return true;
  });
  ASSERT_TRUE(all);
  EXPECT_GT(share, 0.8);
  EXPECT_LE(share, 1);
  EXPECT_GT(points, 2 * settings.samples);
  const auto cancelled = compare::compare(
      a, b, settings, [&](const compare::CompareProgress& p) { return p.share < 0.7; });
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kClosed);
}

}  // namespace
}  // namespace merlin::render
