// Flips and errors computed by hand. The feature "order" determines which edge is the shortest.
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/collapses.h"

namespace merlin::render {
namespace {

using namespace test;  // collapses.h

//  6---7---8       grid(2, 2) with 4 at (0.5, 0.9). 4 has the faces 0 1 4, 0 4 3, 1 5 4, 3 4 7,
//  | / | / |       4 5 8 and 4 8 7. 1-4 is the shortest edge, 0-4 the next.
//  3---4---5
//  | / | / |
//  0---1---2
mesh::Mesh window(float x5) {
  mesh::Mesh mesh = test::grid(2, 2);
  moveTo(mesh, 4, 0.5F, 0.9F, 0);
  moveTo(mesh, 5, x5, 1, 0);
  addFeature(mesh, "order", {-2, 1, 1600, 200, 0, 100, 3200, 400, 800});
  return mesh;
}

TEST(Flip, IsRefusedAndTheNextEdgeGoes) {  // [GOURLEY98] 4.3
  // After the collapse 4 5 8 becomes 1 5 8, which flips if vertex 5 is left of the line from 1 to
  // 8; that line passes (1.5, 1).
  const reduce::Reduction refused = collapseInOrder(window(1.2F), 1);
  EXPECT_EQ(refused.report.flips_refused, 1u);
  EXPECT_EQ(refused.log.children[0], (Children{0, 4}));
  const reduce::Reduction taken = collapseInOrder(window(1.6F), 1);
  EXPECT_EQ(taken.report.flips_refused, 0u);
  EXPECT_EQ(taken.log.children[0], (Children{1, 4}));
}

TEST(Flip, IsAFaceWithoutAreaToo) {
  const reduce::Reduction refused = collapseInOrder(window(1.5F), 1);
  EXPECT_EQ(refused.report.flips_refused, 1u);
  EXPECT_EQ(refused.log.children[0], (Children{0, 4}));
}

// Edge 1-4 has length 1, then 4, then 16; edge 0-4 is collapsed once it is shorter.
TEST(Flip, LengthensItsEdgeFourfold) {
  mesh::Mesh mesh = window(1.2F);
  for (const auto& [length, refusals] :
       {std::pair{3.9F, 1U}, {4.1F, 2U}, {15.9F, 2U}, {16.1F, 3U}}) {
    mesh.find("order")->values[0] = -length;
    const reduce::Reduction r = collapseInOrder(mesh, 1);
    EXPECT_EQ(r.report.flips_refused, refusals) << length;
    EXPECT_EQ(r.log.children[0], (Children{0, 4})) << length;
  }
}

// A triangle that has no area before the collapse cannot flip: 3 4 7 is degenerate and stays so.
TEST(Flip, IsNoneOfAFaceThatHadNoArea) {
  mesh::Mesh mesh = window(2);
  moveTo(mesh, 3, 0, 1.2F, 0);
  moveTo(mesh, 4, 0.5F, 1.6F, 0);
  moveTo(mesh, 7, 1, 2, 0);
  const reduce::Reduction r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.report.flips_refused, 0u);
  EXPECT_EQ(r.log.children[0], (Children{1, 4}));
}

// Returns a mesh that is flat except for vertex 4, which is `height` above the rest; the first
// collapse moves 4 to 0.
mesh::Mesh tent(float height) {
  mesh::Mesh mesh = window(2);
  moveTo(mesh, 4, 1, 1, height);
  mesh.find("order")->values = {1, 1000, 1600, 200, 0, 100, 3200, 400, 800};
  return mesh;
}

TEST(Error, IsTheWayFromAnOldVertexToTheNewFaces) {  // equation 4.8
  const reduce::Reduction r = collapseInOrder(tent(0.75F), 1);
  EXPECT_EQ(r.log.children[0], (Children{0, 4}));
  EXPECT_EQ(r.log.error, (Floats{0.75F}));
  EXPECT_EQ(r.report.error, 0.75F);
}

// The new faces are 1 5 0, 3 0 7, 0 5 8 and 0 8 7; 3 0 7 and 0 8 7 lie in z = 0, 3 below vertex 4.
// 0 5 8 has the normal (-4, 4, 2) / 6, so d = |(-1, -1, -3) . n| = 1. 1 5 0 has the normal (-0.75,
// -0.5, 1) / 1.3463, so d = 1.2999.
TEST(Error, IsTheWayToTheNearestOfThem) {  // equation 4.9
  mesh::Mesh mesh = tent(3);
  moveTo(mesh, 5, 2, 1, 2);
  moveTo(mesh, 1, 1, 0, 0.75F);
  const reduce::Reduction r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.log.children[0], (Children{0, 4}));
  ASSERT_EQ(r.log.error.size(), 1u);
  EXPECT_FLOAT_EQ(r.log.error[0], 1);
}

// A ridge: vertices 5 (z = 0.625) and 6 (z = 0.875) become P at (1.5, 1, 0.75). The nearest new
// face, 1 2 P, has the normal (0, -0.75, 1) / 1.25, so both are 0.125 / 1.25 = 0.1 away from it.
// Then P is merged into 4, where all is flat: 0.1 + 0.75.
TEST(Error, GathersFromCollapseToCollapse) {  // equation 4.10
  mesh::Mesh mesh = test::grid(3, 2);
  moveTo(mesh, 5, 1, 1, 0.625F);
  moveTo(mesh, 6, 2, 1, 0.875F);
  addFeature(mesh, "order", {100, 200, 300, 400, 2.5F, 0, 1, 500, 600, 700, 800, 900});
  const reduce::Reduction r = collapseInOrder(mesh, 2);
  EXPECT_EQ(r.log.children[0], (Children{5, 6}));
  EXPECT_EQ(r.log.children[1], (Children{4, 12}));
  ASSERT_EQ(r.log.error.size(), 2u);
  EXPECT_FLOAT_EQ(r.log.error[0], 0.1F);
  EXPECT_FLOAT_EQ(r.log.error[1], 0.85F);
  EXPECT_FLOAT_EQ(r.report.error, 0.85F);
}

// Merging 5 into 4 causes an error of 0.5; merging 6 then causes none.
TEST(Error, OfTheNewVertexIsTheWorseOfTheTwo) {
  mesh::Mesh mesh = test::grid(3, 2);
  moveTo(mesh, 5, 1, 1, 0.5F);
  addFeature(mesh, "order", {100, 200, 300, 400, 0, 1, 5, 500, 600, 700, 800, 900});
  const reduce::Reduction r = collapseInOrder(mesh, 2);
  EXPECT_EQ(r.log.children[1], (Children{12, 6}));
  EXPECT_EQ(r.log.error, (Floats{0.5F, 0.5F}));
}

// A separate triangle: edge 0-1 has length 3, and after its collapse no face is left to measure
// against.
TEST(Error, IsTheWayToTheNewVertexWhereNoFaceIsLeft) {
  mesh::Mesh mesh =
      test::together(test::cube(), mesh::Mesh{{10, 0, 0, 13, 0, 0, 10, 4, 0}, {}, {0, 1, 2}});
  addFeature(mesh, "order", {100, 200, 300, 400, 500, 600, 700, 800, 0, 1, 50});
  const reduce::Reduction r = collapseInOrder(mesh, 1);
  EXPECT_EQ(r.log.children[0], (Children{8, 9}));
  EXPECT_EQ(r.log.error, (Floats{3}));
}

// The diagonal of the original's box is sqrt(4 + 4 + 0.5625) = 2.92617, of which 0.75 is 25.6 %.
TEST(Error, IsLimitedInPercentOfTheOriginalsDiagonal) {
  const mesh::Mesh mesh = tent(0.75F);
  const auto reduced = [&](double percent) {
    auto result = reduce::reduce(
        mesh,
        {.cost = "pattern", .weights = {weightOf(mesh, "order")}, .max_error_percent = percent});
    EXPECT_TRUE(result);
    return *std::move(result);
  };
  const reduce::Reduction refused = reduced(25.6), taken = reduced(25.7);
  EXPECT_STREQ(refused.report.stopped, "error");
  EXPECT_EQ(refused.log.error, Floats{});
  ASSERT_FALSE(taken.log.error.empty());
  EXPECT_EQ(taken.log.error[0], 0.75F);
}

// 0 3 6 is a degenerate triangle without a plane.
TEST(Error, IsNotMeasuredAgainstAFaceWithoutArea) {
  mesh::Mesh mesh = tent(0.75F);
  mesh.triangles.insert(mesh.triangles.end(), {0, 3, 6});
  EXPECT_EQ(collapseInOrder(mesh, 1).log.error, (Floats{0.75F}));
}

}  // namespace
}  // namespace merlin::render
