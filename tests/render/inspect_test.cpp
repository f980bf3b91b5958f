#include "render/mesh/inspect.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

// Returns a tetrahedron that faces outwards; its volume is 1/6.
mesh::Mesh tetrahedron() {
  mesh::Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return mesh;
}

// Adds `other`, moved by (x, 0, 0).
void append(mesh::Mesh& mesh, const mesh::Mesh& other, float x) {
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < other.positions.size(); ++i)
    mesh.positions.push_back(other.positions[i] + (i % 3 == 0 ? x : 0));
  for (const std::uint32_t v : other.triangles) mesh.triangles.push_back(first + v);
}

void turn(mesh::Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
}

// Expects that the inspection has found no peculiarity.
void expectNothingOdd(const mesh::Inspection& is) {
  EXPECT_EQ(is.degenerate + is.no_area + is.duplicate, 0u);
  EXPECT_EQ(is.non_manifold_edges + is.turned_edges + is.non_manifold_vertices, 0u);
  EXPECT_EQ(is.isolated + is.not_finite + is.not_unit + is.inside_out, 0u);
}

TEST(Inspect, ACubeIsClosed) {
  const auto is = mesh::inspect(test::cube());
  EXPECT_EQ(is.components, 1u);
  EXPECT_EQ(is.closed, 1u);
  EXPECT_DOUBLE_EQ(is.volume, 8);
  EXPECT_TRUE(is.holes.empty());
  EXPECT_EQ(is.box.low, (std::array<float, 3>{-1, -1, -1}));
  EXPECT_EQ(is.box.high, (std::array<float, 3>{1, 1, 1}));
  expectNothingOdd(is);
}

TEST(Inspect, AnOpenCubeHasOneHoleOfItsOutline) {
  mesh::Mesh open = test::cube();
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 6);  // the side z = -1
  const auto is = mesh::inspect(open);
  EXPECT_EQ(is.components, 1u);
  EXPECT_EQ(is.closed, 0u);
  ASSERT_EQ(is.holes.size(), 1u);
  EXPECT_DOUBLE_EQ(is.holes[0].length, 8);
  EXPECT_EQ(is.holes[0].edges, 4u);
  EXPECT_EQ(is.volume, 0) << "of closed components only";
  expectNothingOdd(is);
}

TEST(Inspect, TheLongestHoleComesFirst) {
  mesh::Mesh sheet = test::grid(4, 4);
  const std::size_t cell = 6 * (1 * 4 + 2);  // a cell that is not at the edge
  sheet.triangles.erase(sheet.triangles.begin() + cell, sheet.triangles.begin() + cell + 6);
  const auto is = mesh::inspect(sheet);
  ASSERT_EQ(is.holes.size(), 2u);
  EXPECT_DOUBLE_EQ(is.holes[0].length, 16);
  EXPECT_DOUBLE_EQ(is.holes[1].length, 4);
  expectNothingOdd(is);
}

// At a vertex where two holes touch, each fan of triangles reaches from one hole to the other.
TEST(Inspect, HolesThatTouchAreOneLoop) {
  mesh::Mesh sheet = test::grid(4, 4);
  for (const int cell : {2 * 4 + 2, 1 * 4 + 1})  // diagonal neighbours, the later one first
    sheet.triangles.erase(sheet.triangles.begin() + 6 * cell,
                          sheet.triangles.begin() + 6 * cell + 6);
  const auto is = mesh::inspect(sheet);
  EXPECT_EQ(is.non_manifold_vertices, 1u);
  EXPECT_EQ(is.components, 1u);
  ASSERT_EQ(is.holes.size(), 2u);
  EXPECT_DOUBLE_EQ(is.holes[0].length, 16);
  EXPECT_DOUBLE_EQ(is.holes[1].length, 8);
}

TEST(Inspect, TwoComponents) {
  mesh::Mesh two = test::cube();
  append(two, tetrahedron(), 5);
  const auto is = mesh::inspect(two);
  EXPECT_EQ(is.components, 2u);
  EXPECT_EQ(is.closed, 2u);
  EXPECT_NEAR(is.volume, 8 + 1.0 / 6, 1e-12);
  expectNothingOdd(is);
}

TEST(Inspect, ABowTieHasOneNonManifoldVertex) {
  mesh::Mesh bow;
  bow.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0};
  bow.triangles = {0, 1, 2, 0, 3, 4};
  const auto is = mesh::inspect(bow);
  EXPECT_EQ(is.non_manifold_vertices, 1u);
  EXPECT_EQ(is.non_manifold_edges, 0u);
  EXPECT_EQ(is.components, 1u);
  ASSERT_EQ(is.holes.size(), 2u);
  EXPECT_NEAR(is.holes[0].length, 2 + std::sqrt(2.0), 1e-6);
}

TEST(Inspect, AFinHasANonManifoldEdge) {
  mesh::Mesh fin;
  fin.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  fin.triangles = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  const auto is = mesh::inspect(fin);
  EXPECT_EQ(is.non_manifold_edges, 1u);
  EXPECT_EQ(is.non_manifold_vertices, 0u) << "all of it hangs together at the edge";
  EXPECT_EQ(is.closed, 0u);
}

TEST(Inspect, AnInsideOutTetrahedronHasANegativeVolume) {
  mesh::Mesh turned = tetrahedron();
  turn(turned);
  const auto is = mesh::inspect(turned);
  EXPECT_EQ(is.inside_out, 1u);
  EXPECT_NEAR(is.volume, -1.0 / 6, 1e-12);
  EXPECT_EQ(mesh::inspect(tetrahedron()).inside_out, 0u);
}

TEST(Inspect, TheInnerWallOfAHollowBodyIsNotInsideOut) {
  mesh::Mesh hollow = test::cube(), wall = tetrahedron();
  turn(wall);
  append(hollow, wall, -0.5F);
  const auto is = mesh::inspect(hollow);
  EXPECT_EQ(is.closed, 2u);
  EXPECT_EQ(is.inside_out, 0u);
  EXPECT_NEAR(is.volume, 8 - 1.0 / 6, 1e-7);
}

TEST(Inspect, OneTurnedTriangleTurnsItsThreeEdges) {
  mesh::Mesh turned = tetrahedron();
  std::swap(turned.triangles[1], turned.triangles[2]);
  const auto is = mesh::inspect(turned);
  EXPECT_EQ(is.turned_edges, 3u);
  EXPECT_EQ(is.closed, 0u);
  EXPECT_TRUE(is.holes.empty());
}

TEST(Inspect, CountsTrianglesThatAreNone) {
  mesh::Mesh odd = tetrahedron();
  odd.positions.insert(odd.positions.end(), {2, 0, 0, 9, 9, 9});
  odd.triangles.insert(odd.triangles.end(), {0, 0, 1, 1, 3, 0, 3, 1, 0, 0, 1, 4});
  const auto is = mesh::inspect(odd);
  EXPECT_EQ(is.degenerate, 1u);
  EXPECT_EQ(is.duplicate, 2u) << "whichever way they face";
  EXPECT_EQ(is.no_area, 1u);
  EXPECT_EQ(is.isolated, 1u);
}

// In the soup, no two triangles share a vertex, as in an STL file.
TEST(Inspect, VerticesAtOnePlaceAreOne) {
  const mesh::Mesh cube = test::cube();
  mesh::Mesh soup;
  for (const std::uint32_t v : cube.triangles) {
    soup.triangles.push_back(static_cast<std::uint32_t>(soup.vertexCount()));
    soup.positions.insert(soup.positions.end(), &cube.positions[3 * v], &cube.positions[3 * v] + 3);
  }
  const auto is = mesh::inspect(soup);
  EXPECT_EQ(is.closed, 1u);
  EXPECT_DOUBLE_EQ(is.volume, 8);
  expectNothingOdd(is);
}

TEST(Inspect, CountsWhatIsNoNumberAndNormalsOfAnotherLength) {
  mesh::Mesh odd = tetrahedron();
  odd.positions[10] = std::numeric_limits<float>::quiet_NaN();
  odd.features.push_back({"normal", 3, {0, 0, 1, 0, 2, 0, 0, 0, 0, 1, 0, 0}});
  const auto is = mesh::inspect(odd);
  EXPECT_EQ(is.not_finite, 1u);
  EXPECT_EQ(is.not_unit, 2u);
  EXPECT_EQ(is.box.high, (std::array<float, 3>{1, 1, 0}));
}

TEST(Inspect, AFeaturesRangeLeavesOutWhatIsNoNumber) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const auto range = mesh::rangeOf({"heat", 1, {3, kNone, -2, 7}});
  EXPECT_EQ(range.low, -2);
  EXPECT_EQ(range.high, 7);
  EXPECT_EQ(range.not_numbers, 1u);
  EXPECT_EQ(mesh::rangeOf({"heat", 1, {kNone}}).high, 0);
}

TEST(Inspect, OfNothingIsNothing) {
  const auto is = mesh::inspect({});
  EXPECT_EQ(is.components, 0u);
  EXPECT_EQ(is.box.high, (std::array<float, 3>{}));
  expectNothingOdd(is);
}

}  // namespace
}  // namespace merlin::render
