#include "render/mesh/mesh.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/mesh/weld_degenerate.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;
using Vec3 = std::array<float, 3>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns two triangles in z = 0, 0 1 3 and 0 3 2, with vertex 0 at the origin.
mesh::Mesh square() { return test::grid(1, 1); }

std::string fault(const mesh::Mesh& mesh) {
  const auto valid = validate(mesh);
  return valid ? "none" : valid.error().what;
}

TEST(MeshFind, GivesTheFeatureOfThatNameOrNothing) {
  mesh::Mesh mesh = square();
  mesh.features = {{"heat", 1, {1, 2, 3, 4}}, {"normal", 3, Floats(12, 0)}};
  EXPECT_EQ(mesh.find("normal"), &mesh.features[1]);
  EXPECT_EQ(std::as_const(mesh).find("heat"), &mesh.features[0]);
  EXPECT_EQ(mesh.find("hea"), nullptr);
}

TEST(MeshValidate, TakesWhateverASurfaceMayBe) {
  EXPECT_EQ(fault(mesh::Mesh{}), "none");
  mesh::Mesh mesh =
      test::together(square(), test::cube());  // a mesh with a border, and two components
  // Three triangles at an edge, and a degenerate one.
  mesh.triangles.insert(mesh.triangles.end(), {0, 3, 5, 1, 1, 2});
  mesh.features = {{"heat", 1, Floats(12, 0)}, {"flow", 2, Floats(24, 0)}};
  EXPECT_EQ(fault(mesh), "none");
}

TEST(MeshValidate, NamesTheVertexThatIsNowhere) {
  mesh::Mesh mesh = square();
  mesh.positions[11] = kNaN;
  EXPECT_EQ(fault(mesh), "vertex 3: coordinate z is nan; the limit is +-1e+18");
  mesh.positions[7] = 2e18F;
  EXPECT_EQ(fault(mesh), "vertex 2: coordinate y is 2e+18; the limit is +-1e+18");
  mesh.positions[4] = -kInfinity;  // only the first fault is reported
  EXPECT_EQ(fault(mesh), "vertex 1: coordinate y is -inf; the limit is +-1e+18");
}

TEST(MeshValidate, NamesTheTriangleThatPointsNowhere) {
  mesh::Mesh mesh = square();
  mesh.triangles[5] = 4;
  EXPECT_EQ(fault(mesh), "triangle 1: there is no vertex 4, the mesh has 4 (0 to 3)");
  mesh.triangles[0] = ~0U;
  EXPECT_EQ(fault(mesh), "triangle 0: there is no vertex 4294967295, the mesh has 4 (0 to 3)");
}

TEST(MeshValidate, RefusesHalfAVertexAndHalfATriangle) {
  mesh::Mesh mesh = square();
  mesh.triangles.push_back(0);
  EXPECT_EQ(fault(mesh), "12 coordinates, 7 corners: not multiples of 3");
  mesh.triangles.pop_back();
  mesh.positions.pop_back();
  EXPECT_EQ(fault(mesh), "11 coordinates, 6 corners: not multiples of 3");
}

TEST(MeshValidate, NamesTheFeatureOfAnotherSize) {
  mesh::Mesh mesh = square();
  mesh.features = {{"heat", 1, Floats(4, 0)}, {"flow", 2, Floats(7, 0)}};
  EXPECT_EQ(fault(mesh), "feature flow: 7 values for 4 vertices x 2");
}

TEST(MeshTidy, DropsDegenerateTrianglesAndKeepsTheOrderOfTheOthers) {
  mesh::Mesh mesh = square();
  mesh.triangles = {0, 0, 1, 0, 1, 3, 2, 1, 1, 0, 3, 2, 3, 0, 3};
  const mesh::TidyReport report = mesh::tidy(mesh);
  EXPECT_EQ(report.degenerate, 3u);
  EXPECT_EQ(report.unused, 0u);
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 3, 0, 3, 2}));
}

// Returns a square that is cut along its diagonal; a triangle without area joins the two sides of
// the cut at corner 0.
mesh::Mesh cutSquare() {
  mesh::Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, -0.0F, 0};
  mesh.features = {{"heat", 1, {7, 1, 2, 3, 7}}};
  mesh.triangles = {0, 1, 2, 4, 2, 3, 0, 2, 4};
  return mesh;
}

TEST(WeldDegenerate, ATriangleWithTwoCornersAtOnePlaceLeavesNoSlit) {
  mesh::Mesh mesh = cutSquare();
  EXPECT_EQ(mesh::weldDegenerate(mesh), 1u);
  const mesh::TidyReport report = mesh::tidy(mesh);
  EXPECT_EQ(report.degenerate, 1u);
  EXPECT_EQ(report.unused, 1u);
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(WeldDegenerate, CornersOfOtherValuesOrPlacesAndThoseOfNoCommonTriangleStayApart) {
  mesh::Mesh other = cutSquare();
  other.features[0].values[4] = 8;
  mesh::Mesh moved = cutSquare();
  moved.positions[14] = 1e-30F;
  mesh::Mesh apart = cutSquare();
  apart.triangles.resize(6);
  for (mesh::Mesh* mesh : {&other, &moved, &apart}) {
    const Indices before = mesh->triangles;
    EXPECT_EQ(mesh::weldDegenerate(*mesh), 0u);
    EXPECT_EQ(mesh->triangles, before);
  }
}

TEST(WeldDegenerate, ARowOfCopiesBecomesItsFirst) {
  // The pole of a sphere: each triangle has its own copy of the pole, joined to that of the next
  // triangle.
  mesh::Mesh fan;
  fan.positions.assign(9, 0);
  for (int i = 0; i < 4; ++i)
    fan.positions.insert(fan.positions.end(),
                         {std::cos(static_cast<float>(i)), std::sin(static_cast<float>(i)), -1});
  fan.triangles = {2, 5, 6, 1, 4, 5, 0, 3, 4, 1, 2, 5, 0, 1, 4};
  EXPECT_EQ(mesh::weldDegenerate(fan), 2u);
  EXPECT_EQ(mesh::tidy(fan).degenerate, 2u);
  EXPECT_EQ(fan.triangles, (Indices{0, 3, 4, 0, 2, 3, 0, 1, 2}));
}

TEST(MeshTidy, DropsUnusedVerticesWithTheirFeatures) {
  mesh::Mesh mesh;
  for (int v = 0; v < 5; ++v) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(10 * v + k));
  }
  mesh.features = {{"heat", 1, {0, 1, 2, 3, 4}},
                   {"flow", 2, {0, 1, 10, 11, 20, 21, 30, 31, 40, 41}}};
  // Vertex 0 is used by a degenerate triangle only, vertex 2 by no triangle.
  mesh.triangles = {4, 1, 3, 3, 3, 0};
  const mesh::TidyReport report = mesh::tidy(mesh);
  EXPECT_EQ(report.degenerate, 1u);
  EXPECT_EQ(report.unused, 2u);
  EXPECT_EQ(mesh.triangles, (Indices{2, 0, 1}));
  EXPECT_EQ(mesh.positions, (Floats{10, 11, 12, 30, 31, 32, 40, 41, 42}));
  EXPECT_EQ(mesh.features[0].values, (Floats{1, 3, 4}));
  EXPECT_EQ(mesh.features[1].values, (Floats{10, 11, 30, 31, 40, 41}));
}

TEST(MeshTidy, LeavesATidyMeshAsItIs) {
  mesh::Mesh mesh = test::cube();
  const mesh::Mesh before = mesh;
  const mesh::TidyReport report = mesh::tidy(mesh);
  EXPECT_EQ(report.degenerate + report.unused, 0u);
  EXPECT_EQ(mesh.positions, before.positions);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(BoundingBox, HoldsAllVertices) {
  const mesh::Box box = mesh::boundingBox(Floats{1, -2, 3, -1, 5, 2, 0, 0, 7});
  EXPECT_EQ(box.low, (Vec3{-1, -2, 2}));
  EXPECT_EQ(box.high, (Vec3{1, 5, 7}));
  EXPECT_FLOAT_EQ(mesh::boundingBox(Floats{0, 0, 0, 2, 3, 6}).diagonal(), 7);
}

TEST(BoundingBox, IsZeroWithoutVertices) {
  EXPECT_EQ(mesh::boundingBox({}).low, (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh::boundingBox({}).diagonal(), 0);
}

TEST(FaceNormal, FollowsTheRightHandAndHasUnitLength) {
  const float a[] = {1, 1, 5}, b[] = {4, 1, 5}, c[] = {1, 9, 5};
  EXPECT_EQ(mesh::faceNormal(a, b, c), (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh::faceNormal(a, c, b), (Vec3{0, 0, -1}));
}

TEST(FaceNormal, IsZeroWhereThereIsNoArea) {
  const float a[] = {0, 0, 0}, b[] = {1, 2, 3}, c[] = {2, 4, 6};
  EXPECT_EQ(mesh::faceNormal(a, b, c), (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh::faceNormal(a, b, b), (Vec3{0, 0, 0}));
}

TEST(FaceNormal, IsRightForTrianglesTooSmallForAProductInFloat) {
  const float a[] = {0, 0, 0}, b[] = {1e-25F, 0, 0}, c[] = {0, 0, 1e-25F};
  EXPECT_EQ(mesh::faceNormal(a, b, c), (Vec3{0, -1, 0}));
}

// Vertex 0 has a small face facing +z and a face of 100 times its area facing +y.
TEST(VertexNormals, AreTheMeanOfTheFacesWhateverTheirAreas) {  // equation 4.1
  mesh::Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 10, 0, 0, 0, 0, 10};
  mesh.triangles = {0, 1, 2, 0, 4, 3};  // facing +z; facing +y with 100 times the area
  const Floats normals = mesh::vertexNormals(mesh);
  ASSERT_EQ(normals.size(), 15u);
  const float half = std::sqrt(0.5F);
  EXPECT_FLOAT_EQ(normals[0], 0);
  EXPECT_FLOAT_EQ(normals[1], half);
  EXPECT_FLOAT_EQ(normals[2], half);
  EXPECT_EQ((Floats{normals.begin() + 3, normals.begin() + 9}), (Floats{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ((Floats{normals.begin() + 9, normals.end()}), (Floats{0, 1, 0, 0, 1, 0}));
}

// Vertex 1 of the cube has one face facing -z, one facing -y and two facing +x: (2, -1, -1) /
// sqrt(6).
TEST(VertexNormals, CountEachTriangleOnce) {
  const Floats normals = mesh::vertexNormals(test::cube());
  EXPECT_FLOAT_EQ(normals[3], 0.81649658F);
  EXPECT_FLOAT_EQ(normals[4], -0.40824829F);
  EXPECT_FLOAT_EQ(normals[5], -0.40824829F);
}

TEST(VertexNormals, AreZeroWhereFacesCancelAndWhereThereIsNone) {
  mesh::Mesh mesh = square();
  mesh.triangles = {0, 1, 3, 0, 3, 1};
  EXPECT_EQ(mesh::vertexNormals(mesh), Floats(12, 0));
}

TEST(EnsureNormals, AddsThemOnce) {
  mesh::Mesh mesh = square();
  mesh::ensureNormals(mesh);
  ASSERT_EQ(mesh.features.size(), 1u);
  EXPECT_EQ(mesh.features[0].name, "normal");
  EXPECT_EQ(mesh.features[0].dimension, 3u);
  EXPECT_EQ(mesh.features[0].values, (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  mesh::ensureNormals(mesh);
  EXPECT_EQ(mesh.features.size(), 1u);
}

// Pages of a book at these angles; each page has its own copies of the two vertices at the spine.
// The first three pages form one surface (the outer two through the middle one). The last page
// faces away from all others.
TEST(EnsureNormals, AreOneWhereSidesOfASeamAreOneSurface) {
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
  mesh::Mesh book;
  for (const double degrees : {60.0, 0.0, 120.0, 240.0}) {
    const double a = radians(degrees);
    const auto first = static_cast<std::uint32_t>(book.vertexCount());
    for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, std::cos(a), std::sin(a)})
      book.positions.push_back(static_cast<float>(x));
    for (std::uint32_t k = 0; k < 3; ++k) book.triangles.push_back(first + k);
  }
  mesh::Mesh plain = book;
  mesh::ensureNormals(plain);
  EXPECT_NEAR(plain.features[0].values[3 * 3 + 2], 1, 1e-6) << "no seam without a texture";
  book.features = {{"texcoord", 2, Floats(2 * book.vertexCount())}};
  mesh::ensureNormals(book);
  const Floats& n = book.features[1].values;
  for (const auto& [leaf, degrees] : {std::pair{0, 60.0}, {1, 60.0}, {2, 60.0}, {3, 240.0}}) {
    for (const int spine : {0, 1}) {
      const std::size_t at = 3 * static_cast<std::size_t>(3 * leaf + spine);
      EXPECT_NEAR(n[at + 1], -std::sin(radians(degrees)), 1e-6) << leaf;
      EXPECT_NEAR(n[at + 2], std::cos(radians(degrees)), 1e-6) << leaf;
    }
  }
}

// Six blades around an axis: neighbours face almost the same way, but the sum of all normals is
// zero.
TEST(EnsureNormals, AreTheirOwnWhereManySidesCancel) {
  mesh::Mesh blades;
  for (int k = 0; k < 6; ++k) {
    const double a = k * std::numbers::pi / 3;
    for (const double x : {0.0, 0.0, 0.0, std::cos(a), std::sin(a), 0.5, 0.0, 0.0, 1.0})
      blades.positions.push_back(static_cast<float>(x));
    for (int corner = 0; corner < 3; ++corner)
      blades.triangles.push_back(static_cast<std::uint32_t>(3 * k + corner));
  }
  blades.features = {{"texcoord", 2, Floats(2 * blades.vertexCount())}};
  const Floats own = mesh::vertexNormals(blades);
  mesh::ensureNormals(blades);
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_NEAR(blades.features[1].values[i], own[i], 1e-6);
}

TEST(EnsureNormals, KeepsThoseThatTheMeshCameWith) {
  mesh::Mesh mesh = square();
  const Floats own{0, 1, 0, 1, 0, 0, 0, 0.6F, 0.8F, 0, 0, -1};
  mesh.features = {{"normal", 3, own}};
  mesh::ensureNormals(mesh);
  EXPECT_EQ(mesh.features[0].values, own);
}

TEST(EnsureNormals, ReplacesThoseThatAreNone) {
  const Floats right{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  Floats long_one = right, no_number = right, two_each = right;
  long_one[11] = 1.1F;
  no_number[0] = kNaN;
  two_each.insert(two_each.end(), right.begin(), right.end());
  for (const mesh::Feature& wrong :
       {mesh::Feature{"normal", 6, two_each}, mesh::Feature{"normal", 3, long_one},
        mesh::Feature{"normal", 3, no_number}, mesh::Feature{"normal", 3, Floats(12, 0)}}) {
    mesh::Mesh mesh = square();
    mesh.features = {{"heat", 1, Floats(4, 0)}, wrong};
    mesh::ensureNormals(mesh);
    ASSERT_EQ(mesh.features.size(), 2u);
    EXPECT_EQ(mesh.features[1].dimension, 3u);
    EXPECT_EQ(mesh.features[1].values, right);
  }
}

}  // namespace
}  // namespace merlin::render
