// Parts of a surface: which of them are closed, which face inwards, and how these are turned
// outwards.
#include "render/mesh/parts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "render/mesh/non_manifold.h"
#include "tests/support/meshes.h"

namespace merlin::render::mesh {
namespace {

using Indices = std::vector<std::uint32_t>;

Mesh insideOut(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
  return mesh;
}

// Adds `other`, scaled by `size` and then moved by `x` along the x axis.
void addMesh(Mesh& mesh, const Mesh& other, float size, float x) {
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < other.positions.size(); ++i)
    mesh.positions.push_back(size * other.positions[i] + (i % 3 == 0 ? x : 0));
  for (const std::uint32_t v : other.triangles) mesh.triangles.push_back(first + v);
}

// Returns the mesh with three vertices of its own for each triangle.
Mesh soupOf(const Mesh& mesh) {
  Mesh soup;
  for (const std::uint32_t v : mesh.triangles) {
    soup.triangles.push_back(static_cast<std::uint32_t>(soup.vertexCount()));
    soup.positions.insert(soup.positions.end(), &mesh.positions[3 * v], &mesh.positions[3 * v] + 3);
  }
  return soup;
}

Facing facing(const Mesh& mesh) { return facingOf(partsOf(mesh)); }

void expectFacing(const Mesh& mesh, std::size_t closed, std::size_t inwards,
                  std::size_t triangles) {
  const Facing found = facing(mesh);
  EXPECT_EQ(found.closed, closed);
  EXPECT_EQ(found.inwards, inwards);
  EXPECT_EQ(found.triangles, triangles);
}

TEST(Parts, ACubeFacesOutwards) {
  const Parts found = partsOf(test::cube());
  ASSERT_EQ(found.parts.size(), 1u);
  EXPECT_DOUBLE_EQ(found.parts[0].volume, 8);
  EXPECT_EQ(found.parts[0].triangles, 12u);
  EXPECT_EQ(found.part_of, Indices(8, 0));
  expectFacing(test::cube(), 1, 0, 0);
}

TEST(Parts, AnInsideOutCubeFacesInwardsAndIsTurned) {
  Mesh mesh = insideOut(test::cube());
  expectFacing(mesh, 1, 1, 12);
  turnOutwards(partsOf(mesh), mesh);
  EXPECT_EQ(mesh.triangles, test::cube().triangles);
}

TEST(Parts, TheInnerWallOfAHollowCubeFacesInwardsRightly) {
  Mesh hollow;
  addMesh(hollow, insideOut(test::cube()), 0.5F, 0);  // the larger part need not come first
  addMesh(hollow, test::cube(), 1, 0);
  expectFacing(hollow, 2, 0, 0);
  Mesh touching;  // the inner cube touches the outer one at x = -1
  addMesh(touching, insideOut(test::cube()), 0.5F, -0.5F);
  addMesh(touching, test::cube(), 1, 0);
  expectFacing(touching, 2, 0, 0);
  const Indices before = hollow.triangles;
  turnOutwards(partsOf(hollow), hollow);
  EXPECT_EQ(hollow.triangles, before);
}

TEST(Parts, APartThatIsNotWithinALargerOneIsNoInnerWall) {
  for (const float x : {1.1F, -1.1F, 30.0F}) {
    Mesh two = test::cube();
    addMesh(two, insideOut(test::cube()), 0.5F, x);
    expectFacing(two, 2, 1, 12);
  }
  Mesh inwards = insideOut(test::cube());
  addMesh(inwards, insideOut(test::cube()), 0.5F, 0);
  expectFacing(inwards, 2, 2, 24);  // the larger one does not face outwards
}

TEST(Parts, ALargerPartThatFacesInwardsIsTurnedAndTheOneWithinStays) {
  Mesh both = insideOut(test::cube());
  addMesh(both, test::cube(), 0.5F, 0);
  expectFacing(both, 2, 1, 12);
  const Indices inner(both.triangles.begin() + 36, both.triangles.end());
  turnOutwards(partsOf(both), both);
  EXPECT_TRUE(std::equal(inner.begin(), inner.end(), both.triangles.begin() + 36));
  expectFacing(both, 2, 0, 0);
}

TEST(Parts, TheBackOfABodyWithTwoSidesIsItsInnerWall) {
  Mesh both = insideOut(test::cube());
  addMesh(both, test::cube(), 1, 0);
  expectFacing(both, 2, 0, 0);
}

// The tilted plate has the larger bounding box, but the cube in it has the larger volume.
TEST(Parts, OnlyALargerPartHasAnInnerWall) {
  Mesh plate = test::cube();
  for (std::size_t i = 0; i < plate.positions.size(); i += 3)
    plate.positions[i] = 1e-3F * plate.positions[i] + plate.positions[i + 1];
  addMesh(plate, insideOut(test::cube()), 0.5F, 0);
  expectFacing(plate, 2, 1, 12);
}

TEST(Parts, AnOpenSurfaceFacesNowhereAndStays) {
  Mesh open = insideOut(test::cube());
  open.triangles.resize(open.triangles.size() - 3);
  expectFacing(open, 0, 0, 0);
  EXPECT_EQ(partsOf(open).parts.size(), 1u);
  const Indices before = open.triangles;
  turnOutwards(partsOf(open), open);
  EXPECT_EQ(open.triangles, before);
  expectFacing(test::grid(3, 2), 0, 0, 0);
  expectFacing(soupOf(open), 0, 0, 0);
}

TEST(Parts, OneTurnedTriangleMakesAPartOpen) {
  Mesh mesh = insideOut(test::cube());
  std::swap(mesh.triangles[1], mesh.triangles[2]);
  expectFacing(mesh, 0, 0, 0);
}

TEST(Parts, VerticesAtOnePlaceConnectWhereTheSurfaceEnds) {
  Mesh soup = soupOf(insideOut(test::cube()));
  soup.positions.insert(soup.positions.end(), {9, 9, 9});  // a vertex that no triangle uses
  const Parts found = partsOf(soup);
  ASSERT_EQ(found.parts.size(), 1u);
  EXPECT_EQ(found.part_of.back(), Parts::kNone);
  expectFacing(soup, 1, 1, 12);
  turnOutwards(found, soup);
  expectFacing(soup, 1, 0, 0);
}

// The vertices that the two bodies share exist twice, as readers make them.
TEST(Parts, BodiesThatShareAnEdgeAreTwoParts) {
  Mesh mesh = test::cube();
  addMesh(mesh, insideOut(test::cube()), 1, 2);
  for (std::size_t v = 8; v < 16; ++v) mesh.positions[3 * v + 1] += 2;
  for (std::uint32_t& v : mesh.triangles) {  // vertices 3 and 7 are the ends of the shared edge
    if (v == 8) v = 3;
    if (v == 12) v = 7;
  }
  splitNonManifold(mesh);
  expectFacing(mesh, 2, 1, 12);
}

TEST(Parts, ASheetWithTwoSidesIsNotClosed) {
  Mesh sheet = test::grid(2, 2);
  addMesh(sheet, insideOut(test::grid(2, 2)), 1, 0);
  for (std::size_t i = 0; i < sheet.positions.size(); i += 3)
    sheet.positions[i + 2] = 0.1F * sheet.positions[i] + 0.3F * sheet.positions[i + 1];
  expectFacing(sheet, 0, 0, 0);
  EXPECT_EQ(partsOf(sheet).parts.size(), 1u);
}

TEST(Parts, TrianglesWithTwoCornersAtOnePlaceAreIgnored) {
  Mesh mesh = insideOut(test::cube());
  mesh.triangles.insert(mesh.triangles.end(), {0, 0, 1, 2, 2, 2});
  expectFacing(mesh, 1, 1, 14);  // degenerate triangles are turned with the others
  Mesh none;
  none.positions = {0, 0, 0, 0, 0, 0, 1, 0, 0};
  none.triangles = {0, 1, 2, 0, 0, 0};
  EXPECT_TRUE(partsOf(none).parts.empty());
  EXPECT_TRUE(partsOf({}).parts.empty());
}

TEST(Parts, WhatIsNoNumberJoinsNothing) {
  Mesh soup = soupOf(insideOut(test::cube()));
  soup.positions[0] = std::numeric_limits<float>::quiet_NaN();
  expectFacing(soup, 0, 0, 0);
}

// The limits are those of parts.h, for a cube of 8 vertices and for a soup with 36 vertices at the
// surface's border.
TEST(Parts, AreNotLookedForWithLessMemoryThanThatTakes) {
  EXPECT_FALSE(partsWithin(12 * 8 - 1, test::cube()));
  EXPECT_FALSE(partsWithin(12 * 8 + 76 - 1, test::cube()));
  EXPECT_TRUE(partsWithin(12 * 8 + 76, test::cube()));
  const Mesh soup = soupOf(insideOut(test::cube()));
  constexpr std::size_t kTable = 4 * 128;
  EXPECT_FALSE(partsWithin((8 + 16 + 4) * 36 + kTable - 1, soup));
  const auto found = partsWithin((8 + 16 + 4) * 36 + kTable, soup);
  ASSERT_TRUE(found);
  EXPECT_EQ(facingOf(*found).inwards, 1u);
}

// Adds normals of this length: the normal of a cube's vertex is its position, scaled.
Mesh withNormals(Mesh mesh, float length) {
  Feature normal{"normal", 3, mesh.positions};
  for (float& x : normal.values) x *= length;
  mesh.features = {{"texcoord", 2, std::vector<float>(2 * mesh.vertexCount(), 0.25F)}, normal};
  return mesh;
}

TEST(Parts, NormalsAreTurnedOnlyIfTheyPointInwardsToo) {
  const auto turned = [](Mesh mesh) {
    turnOutwards(partsOf(mesh), mesh);
    return mesh;
  };
  const Mesh outwards = withNormals(test::cube(), 0.577F);
  const Mesh from_inwards = turned(withNormals(insideOut(test::cube()), -0.577F));
  const Mesh from_outwards = turned(withNormals(insideOut(test::cube()), 0.577F));
  for (const Mesh& mesh : {from_inwards, from_outwards}) {
    EXPECT_EQ(mesh.find("normal")->values, outwards.find("normal")->values);
    EXPECT_EQ(mesh.find("texcoord")->values, outwards.find("texcoord")->values);
    EXPECT_EQ(mesh.positions, outwards.positions);
    EXPECT_EQ(mesh.triangles, outwards.triangles);
  }
  const Mesh odd = withNormals(test::cube(), -0.577F);
  EXPECT_EQ(turned(odd).find("normal")->values, odd.find("normal")->values)
      << "of a part that is not turned";
}

}  // namespace
}  // namespace merlin::render::mesh
