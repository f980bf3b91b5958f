// Single collapses, computed by hand. The feature "order" determines which edge is the shortest.
#include <gtest/gtest.h>

#include "tests/render/collapses.h"

namespace merlin::render {
namespace {

using namespace test;  // collapses.h

//  8---9--10--11        grid(3, 2): 5 and 6 are inside. Each cell has a diagonal from its lower
//  | / | / | / |        left to its upper right corner.
//  4---5---6---7
//  | / | / | / |
//  0---1---2---3
mesh::Mesh strip() { return test::grid(3, 2); }

// Returns the strip with a feature "order" in which neighbours differ much, except for 5 and 6,
// which differ by 1, and 4, which differs by 2 from their mean.
mesh::Mesh orderedStrip() {
  mesh::Mesh mesh = strip();
  addFeature(mesh, "order", {100, 200, 300, 400, 2.5F, 0, 1, 500, 600, 700, 800, 900});
  return mesh;
}

TEST(Placement, OfTwoInnerVerticesIsTheMiddle) {
  mesh::Mesh mesh = orderedStrip();
  moveTo(mesh, 6, 2, 1, 0.5F);
  const reduce::Reduction r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.log.children[0], (Children{5, 6}));
  EXPECT_EQ(position(r, 0), (Floats{1.5F, 1, 0.25F}));
}

TEST(Placement, OfOneOnTheBorderIsThatOne) {
  mesh::Mesh mesh = strip();
  addFeature(mesh, "order", {100, 200, 300, 400, 1, 0, 50, 500, 600, 700, 800, 900});
  reduce::Reduction r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.log.children[0], (Children{4, 5}));
  EXPECT_EQ(position(r, 0), (Floats{0, 1, 0}));
  mesh.find("order")->values = {100, 200, 300, 400, 50, 0, 500, 600, 700, 800, 1, 900};
  r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.log.children[0], (Children{5, 10}));
  EXPECT_EQ(position(r, 0), (Floats{2, 2, 0}));
}

// The border turns by a right angle at 0, not at 1; by a right angle at 3, not at 2.
TEST(Placement, OfTwoOnTheBorderIsTheSharperCorner) {
  mesh::Mesh mesh = strip();
  addFeature(mesh, "order", {0, 1, 300, 400, 100, 50, 150, 500, 600, 700, 800, 900});
  EXPECT_EQ(position(collapseInOrder(mesh, 1), 0), (Floats{0, 0, 0}));
  mesh.find("order")->values = {300, 400, 1, 0, 100, 50, 150, 500, 600, 700, 800, 900};
  EXPECT_EQ(position(collapseInOrder(mesh, 1), 0), (Floats{3, 0, 0}));
}

// The border turns by 45 degrees at 1, and at 2 by an angle that depends on 3.
TEST(Placement, ComparesTheTurnsOfTheBorder) {
  mesh::Mesh mesh = strip();
  moveTo(mesh, 2, 2, -1, 0);
  addFeature(mesh, "order", {300, 0, 1, 400, 100, 50, 150, 500, 600, 700, 800, 900});
  moveTo(mesh, 3, 4, -1.2F, 0);  // the border turns by 39 degrees at 2
  EXPECT_EQ(position(collapseInOrder(mesh, 1), 0), (Floats{1, 0, 0}));
  moveTo(mesh, 3, 4, -0.5F, 0);  // by 59 degrees
  EXPECT_EQ(position(collapseInOrder(mesh, 1), 0), (Floats{2, -1, 0}));
}

// Two pieces touch at vertex 2: it stays, however little the border of each piece turns there.
// Vertex 1 is a sharp corner.
//
//  0-------1
//    `-2-'
//     / |
//    3--4
TEST(Placement, KeepsTheVertexWhereTwoPiecesTouch) {
  mesh::Mesh mesh;
  mesh.positions = {-1, 0.1F, 0, 1, 0.1F, 0, 0, 0, 0, -1, -1, 0, 0, -1, 0};
  mesh.triangles = {1, 0, 2, 2, 3, 4};
  addFeature(mesh, "order", {100, 1, 0, 200, 300});
  EXPECT_EQ(position(collapseInOrder(mesh, 1), 0), (Floats{0, 0, 0}));
}

TEST(Placement, MixesFeaturesAsThePositionAndTakesTheNormalOfTheNewFaces) {
  mesh::Mesh mesh = orderedStrip();
  addFeature(mesh, "heat", {0, 0, 0, 0, 7, 1, 2, 0, 0, 0, 0, 0});
  mesh.find("normal")->values.assign(36, 0.57735027F);  // differs from the surface's own normals
  const reduce::Reduction r = collapseInOrder(mesh, 2);
  EXPECT_EQ(r.log.children[1], (Children{4, 12}));
  EXPECT_EQ(r.log.features[1], (Floats{0.5F, 2.5F}));  // the mean; then 4's own value
  EXPECT_EQ(r.log.features[2], (Floats{1.5F, 7}));
  EXPECT_EQ(r.log.features[0], (Floats{0, 0, 1, 0, 0, 1}));  // normal
}

// L(5, 6) = |(3, 4)| = 5. It competes with edge 1-2, whose ends differ in "p" alone.
float firstOfStrip(float p2, float unit_of_p) {
  mesh::Mesh mesh = strip();
  addFeature(mesh, "order", {300, 200, 200, 400, 100, 0, 0, 500, 600, 700, 800, 900});
  addFeature(mesh, "p", {0, 0, p2, 0, 0, 0, 3, 0, 0, 0, 0, 0});
  addFeature(mesh, "q", {0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0});
  const reduce::Reduction r = collapse(
      mesh, {weightOf(mesh, "order"), weightOf(mesh, "p", unit_of_p), weightOf(mesh, "q")}, 1);
  return static_cast<float>(r.log.children[0][0]);
}

TEST(EdgeLength, IsTheDistanceOfTheWeightedVectors) {  // [GOURLEY98] equation 4.3
  EXPECT_EQ(firstOfStrip(4.99F, 1), 1);
  EXPECT_EQ(firstOfStrip(5.01F, 1), 5);
  // At half the weight L(5, 6) = |(1.5, 4)| = 4.272, and the difference of 1-2 counts half.
  EXPECT_EQ(firstOfStrip(2 * 4.27F, 0.5F), 1);
  EXPECT_EQ(firstOfStrip(2 * 4.28F, 0.5F), 5);
}

// Edge 4-5 had length 2.5, 2-3 has 2.2; from 4 to the merged vertex of 5 and 6 the length is 2.
TEST(EdgeLength, IsMeasuredAgainAtTheNewVertex) {
  mesh::Mesh mesh = orderedStrip();
  mesh.find("order")->values[3] = mesh.find("order")->values[2] + 2.2F;
  const reduce::Reduction r = collapseInOrder(mesh, 3);
  EXPECT_EQ(r.log.children[1], (Children{4, 12}));
  EXPECT_EQ(r.log.children[2], (Children{2, 3}));
}

TEST(EdgeLength, HoldsABorderVertexAwayFromAnInnerOne) {
  mesh::Mesh mesh = strip();
  addFeature(mesh, "order", {100, 200, 300, 400, 0.5F, 0, -1, 500, 600, 700, 800, 900});
  const auto order = weightOf(mesh, "order");
  EXPECT_EQ(collapse(mesh, {order}, 1).log.children[0], (Children{4, 5}));
  EXPECT_EQ(collapse(mesh, {order, {"boundary", 0.8F}}, 1).log.children[0], (Children{4, 5}));
  EXPECT_EQ(collapse(mesh, {order, {"boundary", 0.9F}}, 1).log.children[0], (Children{5, 6}));
}

TEST(EdgeLength, HoldsABendAwayFromAPlain) {
  mesh::Mesh mesh = strip();
  moveTo(mesh, 4, 0, 1, 0.5F);  // bent at 0, 4, 5, 8, 9; flat at 6
  addFeature(mesh, "order", {100, 200, 300, 400, 500, 0, 1, 2.5F, 600, 700, 800, 900});
  const auto order = weightOf(mesh, "order");
  EXPECT_EQ(collapse(mesh, {order}, 1).log.children[0], (Children{5, 6}));
  EXPECT_EQ(collapse(mesh, {order, {"curvature", 9}}, 1).log.children[0], (Children{6, 7}));
}

}  // namespace
}  // namespace merlin::render
