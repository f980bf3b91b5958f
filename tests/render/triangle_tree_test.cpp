#include "render/compare/triangle_tree.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Corners = std::array<compare::Vector, 3>;

const Corners kRight = {compare::Vector{0, 0, 0}, compare::Vector{4, 0, 0},
                        compare::Vector{0, 3, 0}};

void expectNearest(const Corners& corners, const compare::Vector& p, double distance,
                   const std::array<double, 3>& barycentric) {
  const compare::NearestPoint nearest = compare::nearestOnTriangle(p, corners);
  EXPECT_NEAR(std::sqrt(nearest.distance2), distance, 1e-15);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(nearest.barycentric[k], barycentric[k], 1e-15);
}

TEST(NearestOnTriangle, IsBelowAPointInsideOnAnEdgeOrAtACornerOtherwise) {
  expectNearest(kRight, {1, 1, 2}, 2, {5. / 12, 1. / 4, 1. / 3});
  expectNearest(kRight, {1, -2, 0}, 2, {3. / 4, 1. / 4, 0});
  expectNearest(kRight, {-3, 1.5, 4}, 5, {1. / 2, 0, 1. / 2});
  expectNearest(kRight, {2 + 3, 1.5 + 4, 0}, 5, {0, 1. / 2, 1. / 2});
  expectNearest(kRight, {-3, -4, 0}, 5, {1, 0, 0});
  expectNearest(kRight, {7, -4, 0}, 5, {0, 1, 0});
  expectNearest(kRight, {0, 5, 1}, std::sqrt(5), {0, 0, 1});
  expectNearest(kRight, {4, 0, 0}, 0, {0, 1, 0});
}

TEST(NearestOnTriangle, OfOneWithoutAreaIsThatOfItsLongestEdge) {
  const Corners line = {compare::Vector{1, 1, 0}, compare::Vector{0, 0, 0},
                        compare::Vector{2, 2, 0}};
  EXPECT_NEAR(compare::nearestOnTriangle({3, 3, 1}, line).distance2, 3, 1e-14);
  EXPECT_NEAR(compare::nearestOnTriangle({0, 1, 0}, line).distance2, 0.5, 1e-14);
  EXPECT_NEAR(compare::nearestOnTriangle({-1, 0, 0}, line).distance2, 1, 1e-14);
  const Corners point = {compare::Vector{1, 2, 3}, compare::Vector{1, 2, 3},
                         compare::Vector{1, 2, 3}};
  EXPECT_EQ(compare::nearestOnTriangle({1, 2, 5}, point).distance2, 4);
}

TEST(NearestOnTriangle, HoldsForTheFarthestAndTheSmallestCoordinates) {
  for (const double s : {1e18, 1e-30}) {
    const Corners corners = {compare::Vector{0, 0, 0}, compare::Vector{4 * s, 0, 0},
                             compare::Vector{0, 3 * s, 0}};
    const compare::NearestPoint nearest = compare::nearestOnTriangle({s, s, 2 * s}, corners);
    EXPECT_NEAR(std::sqrt(nearest.distance2) / s, 2, 1e-14);
    EXPECT_NEAR(nearest.barycentric[2], 1. / 3, 1e-14);
  }
}

// As an independent check, no point of a dense set on the triangle may be nearer.
TEST(NearestOnTriangle, IsNoFartherThanAnyPointOfIt) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const double flat = trial % 3 == 0 ? 1e-7 : 1;
    Corners corners;
    for (compare::Vector& c : corners)
      c = {random.normal(), flat * random.normal(), flat * random.normal()};
    const compare::Vector p = {2 * random.normal(), random.normal(), random.normal()};
    const compare::NearestPoint nearest = compare::nearestOnTriangle(p, corners);
    compare::Vector at = compare::Vector::Zero();
    for (std::size_t k = 0; k < 3; ++k) at = at + nearest.barycentric[k] * corners[k];
    EXPECT_NEAR(std::sqrt(compare::squared(p - at)), std::sqrt(nearest.distance2), 1e-9);
    double least = std::numeric_limits<double>::infinity();
    constexpr int kNet = 60;
    for (int i = 0; i <= kNet; ++i) {
      for (int j = 0; i + j <= kNet; ++j) {
        const double u = double{1} * i / kNet, v = double{1} * j / kNet;
        least = std::min(least, compare::squared(p - ((1 - u - v) * corners[0] + u * corners[1] +
                                                      v * corners[2])));
      }
    }
    EXPECT_LE(nearest.distance2, least * (1 + 1e-12));
    EXPECT_GE(std::sqrt(nearest.distance2), std::sqrt(least) - 6.0 / kNet);
  }
}

// Returns random triangles, small and large. A third of them have integer corners, so that many
// share points or are equal; one in eleven has no area.
mesh::Mesh soup(std::size_t triangles, std::uint64_t seed) {
  mesh::Mesh mesh;
  Random random(seed);
  for (std::size_t t = 0; t < triangles; ++t) {
    const double x = random.uniform(-5, 5), y = random.uniform(-5, 5), z = random.uniform(-5, 5);
    const double size = t % 7 == 0 ? 4 : 0.3;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      for (const double c : {x, y, z}) {
        const double value = c + size * random.normal();
        mesh.positions.push_back(static_cast<float>(t % 3 == 0 ? std::round(value) : value));
      }
      mesh.triangles.push_back(static_cast<std::uint32_t>(3 * t) + (t % 11 == 0 ? 0 : corner));
    }
  }
  return mesh;
}

double bruteForce2(const compare::TriangleTree& tree, const compare::Vector& p) {
  double least2 = std::numeric_limits<double>::infinity();
  for (std::uint32_t place = 0; place < tree.size(); ++place)
    least2 = std::min(least2, tree.nearestAt(place, p).distance2);
  return least2;
}

TEST(TriangleTree, FindsWhatTryingEachTriangleFinds) {
  for (const std::size_t triangles : {1u, 2u, 4u, 5u, 9u, 100u, 2000u}) {
    const compare::TriangleTree tree(soup(triangles, triangles));
    Random random(7);
    std::uint32_t hint = compare::TriangleTree::kNone;
    for (int i = 0; i < 200; ++i) {
      const compare::Vector p = {random.uniform(-9, 9), random.uniform(-9, 9),
                                 random.uniform(-9, 9)};
      const compare::TriangleTree::Nearest nearest = tree.nearest(p);
      EXPECT_EQ(nearest.point.distance2, bruteForce2(tree, p));
      EXPECT_EQ(tree.nearestAt(nearest.place, p).distance2, nearest.point.distance2);
      const compare::TriangleTree::Nearest hinted = tree.nearest(p, hint);
      EXPECT_EQ(hinted.point.distance2, nearest.point.distance2);
      hint = hinted.place;
    }
  }
}

TEST(TriangleTree, HasEachTriangleOnce) {
  const mesh::Mesh mesh = soup(777, 3);
  const compare::TriangleTree tree(mesh);
  std::vector<std::uint32_t> triangles, all(777);
  for (std::uint32_t place = 0; place < tree.size(); ++place) {
    triangles.push_back(tree.triangleAt(place));
    const float* first = &mesh.positions[3 * mesh.triangles[3 * triangles.back()]];
    EXPECT_EQ(tree.cornersAt(place)[0].x(), first[0]);
    EXPECT_EQ(tree.cornersAt(place)[0].z(), first[2]);
  }
  std::iota(all.begin(), all.end(), 0u);
  std::sort(triangles.begin(), triangles.end());
  EXPECT_EQ(triangles, all);
}

// The distances between triangles grow exponentially, and thousands are at one position: if nodes
// were split by area alone, each split would separate one triangle.
TEST(TriangleTree, StaysShallowWhereTrianglesAreSpreadUnevenly) {
  mesh::Mesh mesh;
  for (int t = 0; t < 20000; ++t) {
    const auto x = t < 74 ? static_cast<float>(std::pow(3.0, t - 36)) : 1.0F;
    const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
    mesh.positions.insert(mesh.positions.end(), {x, 0, 0, x, 1, 0, x, 0, 1});
    mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2});
  }
  const compare::TriangleTree tree(mesh);
  for (const double x : {0.0, 1e-10, 0.5, 1.0, 1e3, 1e12, 3e17})
    EXPECT_EQ(tree.nearest({x, 0.2, 0.2}).point.distance2, bruteForce2(tree, {x, 0.2, 0.2}));
}

}  // namespace
}  // namespace merlin::render
