#include "render/reduce/pattern/working_mesh.h"

#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Vertices = std::set<std::uint32_t>;
using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

mesh::Mesh meshOf(std::size_t vertices, std::vector<std::uint32_t> triangles) {
  mesh::Mesh mesh;
  mesh.positions.resize(3 * vertices);
  mesh.triangles = std::move(triangles);
  return mesh;
}

//     4---2---5
//    / \ / \ / \        10 triangles, 19 edges; 0 and 1 are inside
//   6---0---1---7
//    \ / \ / \ /
//     8---3---9
mesh::Mesh leaf() {
  return meshOf(10, {6, 0, 4, 4, 0, 2, 0, 1, 2, 2, 1, 5, 1, 7, 5,
                     6, 8, 0, 8, 3, 0, 0, 3, 1, 3, 9, 1, 1, 9, 7});
}

mesh::Mesh tetrahedron() { return meshOf(4, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}); }

Vertices neighbours(const reduce::WorkingMesh& mesh, std::uint32_t v) {
  Vertices all;
  for (const std::uint32_t e : mesh.edgesOf(v)) all.insert(mesh.otherEnd(e, v));
  return all;
}

// Returns the ends of edges before the collapse, as pairs.
Pairs endsOf(const reduce::WorkingMesh& before, std::span<const std::uint32_t> edges) {
  Pairs ends;
  for (const std::uint32_t e : edges) ends.insert({before.ends(e)[0], before.ends(e)[1]});
  return ends;
}

constexpr std::uint32_t kNoEdge = ~std::uint32_t{0};

std::uint32_t edgeOf(const reduce::WorkingMesh& mesh, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t e : mesh.edgesOf(a)) {
    if (mesh.otherEnd(e, a) == b) return e;
  }
  return kNoEdge;
}

std::size_t trianglesAt(const reduce::WorkingMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t edge = edgeOf(mesh, a, b);
  return edge == kNoEdge ? 0 : mesh.trianglesAt(edge);
}

TEST(WorkingMesh, KnowsEveryEdgeOnce) {
  const reduce::WorkingMesh mesh(leaf());
  EXPECT_EQ(mesh.liveTriangles(), 10u);
  EXPECT_EQ(mesh.edgeCount(), 19u);
  EXPECT_EQ(mesh.ends(0), (reduce::WorkingMesh::Ends{0, 1}));  // sorted by their ends
  EXPECT_EQ(mesh.ends(1), (reduce::WorkingMesh::Ends{0, 2}));
  EXPECT_EQ(mesh.ends(18), (reduce::WorkingMesh::Ends{7, 9}));
  EXPECT_EQ(neighbours(mesh, 0), (Vertices{1, 2, 3, 4, 6, 8}));
  EXPECT_EQ(mesh.trianglesOf(0).size(), 6u);
  EXPECT_EQ(neighbours(mesh, 6), (Vertices{0, 4, 8}));
}

TEST(WorkingMesh, TellsBoundaryFromInner) {
  const reduce::WorkingMesh mesh(leaf());
  EXPECT_EQ(trianglesAt(mesh, 0, 1), 2u);
  EXPECT_EQ(trianglesAt(mesh, 4, 6), 1u);
  EXPECT_EQ(trianglesAt(mesh, 4, 5), 0u);
  for (std::uint32_t v = 0; v < 10; ++v) EXPECT_EQ(mesh.isBoundary(v), v > 1) << v;
}

// Two tetrahedra share an edge: four triangles meet there, and none of the edge's vertices is on a
// border.
TEST(WorkingMesh, TakesAnEdgeOfManyTrianglesForNoBorder) {
  const reduce::WorkingMesh mesh(meshOf(6, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2,  //
                                            0, 1, 4, 0, 4, 5, 0, 5, 1, 1, 5, 4}));
  EXPECT_EQ(trianglesAt(mesh, 0, 1), 4u);
  for (std::uint32_t v = 0; v < 6; ++v) EXPECT_FALSE(mesh.isBoundary(v)) << v;
}

TEST(WorkingMesh, AnInnerCollapseRemovesTwoFacesAndMergesTwoPairsOfEdges) {
  const reduce::WorkingMesh before(leaf());
  reduce::WorkingMesh mesh = before;
  EXPECT_EQ(endsOf(before, mesh.collapse(0, 1)), (Pairs{{0, 1}, {1, 2}, {1, 3}}));
  EXPECT_EQ(mesh.liveTriangles(), 8u);
  EXPECT_EQ(mesh.trianglesOf(0).size(), 8u);
  EXPECT_EQ(neighbours(mesh, 0), (Vertices{2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(mesh.edgesOf(0).size(), 8u);
  EXPECT_TRUE(mesh.trianglesOf(1).empty());
  EXPECT_TRUE(mesh.edgesOf(1).empty());
  EXPECT_EQ(neighbours(mesh, 2), (Vertices{0, 4, 5}));
  EXPECT_EQ(mesh.edgesOf(2).size(), 3u);
  EXPECT_EQ(mesh.trianglesOf(2).size(), 2u);
  EXPECT_EQ(trianglesAt(mesh, 0, 2), 2u);
  EXPECT_EQ(mesh.corners(4), (reduce::WorkingMesh::Corners{0, 7, 5}));  // was 1 7 5
  EXPECT_FALSE(mesh.isBoundary(0));
}

TEST(WorkingMesh, ABoundaryCollapseRemovesOneFaceAndMergesOnePair) {
  const reduce::WorkingMesh before(leaf());
  reduce::WorkingMesh mesh = before;
  EXPECT_EQ(endsOf(before, mesh.collapse(6, 4)), (Pairs{{4, 6}, {0, 4}}));
  EXPECT_EQ(mesh.liveTriangles(), 9u);
  EXPECT_EQ(neighbours(mesh, 6), (Vertices{0, 2, 8}));
  EXPECT_EQ(neighbours(mesh, 0), (Vertices{1, 2, 3, 6, 8}));
  EXPECT_TRUE(mesh.isBoundary(6));
}

// The triangles 0 1 2 and 2 3 4 touch at 2. When triangle 0 1 2 is removed, its edge 0-2 is removed
// too.
TEST(WorkingMesh, AnEdgeGoesWithItsOnlyTriangle) {
  const reduce::WorkingMesh before(meshOf(5, {0, 1, 2, 2, 3, 4}));
  reduce::WorkingMesh mesh = before;
  EXPECT_EQ(endsOf(before, mesh.collapse(0, 1)), (Pairs{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(mesh.liveTriangles(), 1u);
  EXPECT_EQ(neighbours(mesh, 2), (Vertices{3, 4}));
  EXPECT_TRUE(mesh.edgesOf(0).empty());
}

TEST(WorkingMesh, ThreeTrianglesAtAnEdgeGoTogether) {
  const reduce::WorkingMesh before(meshOf(5, {0, 1, 2, 1, 0, 3, 0, 1, 4}));
  reduce::WorkingMesh mesh = before;
  EXPECT_EQ(trianglesAt(mesh, 0, 1), 3u);
  EXPECT_EQ(mesh.collapse(0, 1).size(), 7u);  // the ids of all of its edges
  EXPECT_EQ(mesh.liveTriangles(), 0u);
}

TEST(WorkingMesh, TwoTrianglesMayBecomeOneAndBothStay) {
  reduce::WorkingMesh mesh(tetrahedron());
  mesh.collapse(0, 1);
  EXPECT_EQ(mesh.liveTriangles(), 2u);
  EXPECT_EQ(trianglesAt(mesh, 2, 3), 2u);
}

bool mayCollapse(const mesh::Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  reduce::WorkingMesh working(mesh);
  const bool may = working.linkCondition(edgeOf(working, a, b));
  return may;
}

TEST(LinkCondition, HoldsInsideAndAlongTheBorder) {
  EXPECT_TRUE(mayCollapse(leaf(), 0, 1));
  EXPECT_TRUE(mayCollapse(leaf(), 4, 6));
  EXPECT_TRUE(mayCollapse(leaf(), 0, 6));
  EXPECT_TRUE(mayCollapse(test::sphere(0), 0, 2));  // an octahedron
}

TEST(LinkCondition, FailsWhereTwoBordersWouldMeet) {
  EXPECT_FALSE(mayCollapse(test::grid(2, 1), 1, 4));  // across the strip
  EXPECT_TRUE(mayCollapse(test::grid(2, 1), 0, 1));   // along the border of the strip
  EXPECT_TRUE(mayCollapse(test::grid(1, 1), 0, 1));   // one triangle is left
}

TEST(LinkCondition, FailsWhereNothingWouldBeLeft) {
  EXPECT_FALSE(mayCollapse(meshOf(3, {0, 1, 2}), 0, 1));
}

TEST(LinkCondition, FailsOnATetrahedron) {  // two faces would coincide
  for (std::uint32_t a = 0; a < 4; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) EXPECT_FALSE(mayCollapse(tetrahedron(), a, b));
  }
}

//      3
//     / \           a tube of three sides without its ends: 0 1 2 below, 3 4 5 above.
//    4---5          Its waist cannot be closed.
TEST(LinkCondition, FailsAtAWaist) {
  const mesh::Mesh tube = meshOf(6, {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5});
  EXPECT_FALSE(mayCollapse(tube, 0, 1));
  EXPECT_FALSE(mayCollapse(tube, 3, 4));
}

TEST(LinkCondition, FailsOnTwoFacesOfTheSameCorners) {
  EXPECT_FALSE(mayCollapse(meshOf(4, {0, 1, 2, 0, 2, 1, 1, 2, 3}), 0, 1));
}

// The edges of the rim are removed one by one. The lists of the central vertex must be as if each
// edge had been taken out at once.
TEST(WorkingMesh, LongListsHoldWhatIsGoneUntilTheyAreTidied) {
  constexpr std::uint32_t kRim = 200;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < kRim; ++i)
    triangles.insert(triangles.end(), {0, 1 + i, 1 + (i + 1) % kRim});
  reduce::WorkingMesh mesh(meshOf(kRim + 1, triangles));
  for (std::uint32_t i = 2; i <= 101; ++i) (void)mesh.collapse(1, i);
  EXPECT_EQ(mesh.triangleCount(0), 100u);
  EXPECT_EQ(mesh.trianglesOf(0).size(), 200u);
  mesh.tidy(0);
  EXPECT_EQ(mesh.triangleCount(0), 100u);
  ASSERT_EQ(mesh.trianglesOf(0).size(), 100u);
  EXPECT_EQ(mesh.edgesOf(0).size(), 100u);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(mesh.trianglesOf(0)[i], 100 + i);
  EXPECT_EQ(trianglesAt(mesh, 0, 1), 2u);
}

}  // namespace
}  // namespace merlin::render
