#include "render/mesh/mesh.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;
using Vec3 = std::array<float, 3>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Two triangles in z = 0: 0 1 3 and 0 3 2, vertex 0 at the origin.
Mesh square() { return test::grid(1, 1); }

std::string fault(const Mesh& mesh) {
  const auto valid = validate(mesh);
  return valid ? "none" : valid.error().what;
}

TEST(MeshFind, GivesTheFeatureOfThatNameOrNothing) {
  Mesh mesh = square();
  mesh.features = {{"heat", 1, {1, 2, 3, 4}}, {"normal", 3, Floats(12, 0)}};
  EXPECT_EQ(mesh.find("normal"), &mesh.features[1]);
  EXPECT_EQ(std::as_const(mesh).find("heat"), &mesh.features[0]);
  EXPECT_EQ(mesh.find("hea"), nullptr);
}

TEST(MeshValidate, TakesWhateverASurfaceMayBe) {
  EXPECT_EQ(fault(Mesh{}), "none");
  Mesh mesh = test::together(square(), test::cube());               // a border, two components
  mesh.triangles.insert(mesh.triangles.end(), {0, 3, 5, 1, 1, 2});  // three at an edge; degenerate
  mesh.features = {{"heat", 1, Floats(12, 0)}, {"flow", 2, Floats(24, 0)}};
  EXPECT_EQ(fault(mesh), "none");
}

TEST(MeshValidate, NamesTheVertexThatIsNowhere) {
  Mesh mesh = square();
  mesh.positions[11] = kNaN;
  EXPECT_EQ(fault(mesh), "vertex 3: coordinate z is nan; 1e+18 is the farthest");
  mesh.positions[7] = 2e18F;
  EXPECT_EQ(fault(mesh), "vertex 2: coordinate y is 2e+18; 1e+18 is the farthest");
  mesh.positions[4] = -kInfinity;  // the first offender is told
  EXPECT_EQ(fault(mesh), "vertex 1: coordinate y is -inf; 1e+18 is the farthest");
}

TEST(MeshValidate, NamesTheTriangleThatPointsNowhere) {
  Mesh mesh = square();
  mesh.triangles[5] = 4;
  EXPECT_EQ(fault(mesh), "triangle 1: vertex 4 of 4 (0 to 3 exist)");
  mesh.triangles[0] = ~0U;
  EXPECT_EQ(fault(mesh), "triangle 0: vertex 4294967295 of 4 (0 to 3 exist)");
}

TEST(MeshValidate, RefusesHalfAVertexAndHalfATriangle) {
  Mesh mesh = square();
  mesh.triangles.push_back(0);
  EXPECT_EQ(fault(mesh), "12 coordinates, 7 corners: no triples");
  mesh.triangles.pop_back();
  mesh.positions.pop_back();
  EXPECT_EQ(fault(mesh), "11 coordinates, 6 corners: no triples");
}

TEST(MeshValidate, NamesTheFeatureOfAnotherSize) {
  Mesh mesh = square();
  mesh.features = {{"heat", 1, Floats(4, 0)}, {"flow", 2, Floats(7, 0)}};
  EXPECT_EQ(fault(mesh), "feature flow: 7 values for 4 vertices x 2");
}

TEST(MeshTidy, DropsDegenerateTrianglesAndKeepsTheOrderOfTheOthers) {
  Mesh mesh = square();
  mesh.triangles = {0, 0, 1, 0, 1, 3, 2, 1, 1, 0, 3, 2, 3, 0, 3};
  const TidyReport report = tidy(mesh);
  EXPECT_EQ(report.degenerate, 3u);
  EXPECT_EQ(report.unused, 0u);
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 3, 0, 3, 2}));
}

TEST(MeshTidy, DropsUnusedVerticesWithTheirFeatures) {
  Mesh mesh;
  for (int v = 0; v < 5; ++v) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(10 * v + k));
  }
  mesh.features = {{"heat", 1, {0, 1, 2, 3, 4}},
                   {"flow", 2, {0, 1, 10, 11, 20, 21, 30, 31, 40, 41}}};
  mesh.triangles = {4, 1, 3, 3, 3, 0};  // 0 is of a degenerate triangle alone, 2 of none
  const TidyReport report = tidy(mesh);
  EXPECT_EQ(report.degenerate, 1u);
  EXPECT_EQ(report.unused, 2u);
  EXPECT_EQ(mesh.triangles, (Indices{2, 0, 1}));
  EXPECT_EQ(mesh.positions, (Floats{10, 11, 12, 30, 31, 32, 40, 41, 42}));
  EXPECT_EQ(mesh.features[0].values, (Floats{1, 3, 4}));
  EXPECT_EQ(mesh.features[1].values, (Floats{10, 11, 30, 31, 40, 41}));
}

TEST(MeshTidy, LeavesATidyMeshAsItIs) {
  Mesh mesh = test::cube();
  const Mesh before = mesh;
  const TidyReport report = tidy(mesh);
  EXPECT_EQ(report.degenerate + report.unused, 0u);
  EXPECT_EQ(mesh.positions, before.positions);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(BoundingBox, HoldsAllVertices) {
  const Box box = boundingBox(Floats{1, -2, 3, -1, 5, 2, 0, 0, 7});
  EXPECT_EQ(box.low, (Vec3{-1, -2, 2}));
  EXPECT_EQ(box.high, (Vec3{1, 5, 7}));
  EXPECT_FLOAT_EQ(boundingBox(Floats{0, 0, 0, 2, 3, 6}).diagonal(), 7);
}

TEST(BoundingBox, IsZeroWithoutVertices) {
  EXPECT_EQ(boundingBox({}).low, (Vec3{0, 0, 0}));
  EXPECT_EQ(boundingBox({}).diagonal(), 0);
}

TEST(FaceNormal, FollowsTheRightHandAndHasUnitLength) {
  const float a[] = {1, 1, 5}, b[] = {4, 1, 5}, c[] = {1, 9, 5};
  EXPECT_EQ(faceNormal(a, b, c), (Vec3{0, 0, 1}));
  EXPECT_EQ(faceNormal(a, c, b), (Vec3{0, 0, -1}));
}

TEST(FaceNormal, IsZeroWhereThereIsNoArea) {
  const float a[] = {0, 0, 0}, b[] = {1, 2, 3}, c[] = {2, 4, 6};
  EXPECT_EQ(faceNormal(a, b, c), (Vec3{0, 0, 0}));
  EXPECT_EQ(faceNormal(a, b, b), (Vec3{0, 0, 0}));
}

TEST(FaceNormal, IsRightForTrianglesTooSmallForAProductInFloat) {
  const float a[] = {0, 0, 0}, b[] = {1e-25F, 0, 0}, c[] = {0, 0, 1e-25F};
  EXPECT_EQ(faceNormal(a, b, c), (Vec3{0, -1, 0}));
}

// Vertex 0 has a small face that looks along +z and one of 100 times its area that looks along +y.
TEST(VertexNormals, AreTheMeanOfTheFacesWhateverTheirAreas) {  // equation 4.1
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 10, 0, 0, 0, 0, 10};
  mesh.triangles = {0, 1, 2, 0, 4, 3};  // along +z; along +y, 100 times the area
  const Floats normals = vertexNormals(mesh);
  ASSERT_EQ(normals.size(), 15u);
  const float half = std::sqrt(0.5F);
  EXPECT_FLOAT_EQ(normals[0], 0);
  EXPECT_FLOAT_EQ(normals[1], half);
  EXPECT_FLOAT_EQ(normals[2], half);
  EXPECT_EQ((Floats{normals.begin() + 3, normals.begin() + 9}), (Floats{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ((Floats{normals.begin() + 9, normals.end()}), (Floats{0, 1, 0, 0, 1, 0}));
}

// Vertex 1 of the cube has one face along -z, one along -y, two along +x: (2, -1, -1) / sqrt(6).
TEST(VertexNormals, CountEachTriangleOnce) {
  const Floats normals = vertexNormals(test::cube());
  EXPECT_FLOAT_EQ(normals[3], 0.81649658F);
  EXPECT_FLOAT_EQ(normals[4], -0.40824829F);
  EXPECT_FLOAT_EQ(normals[5], -0.40824829F);
}

TEST(VertexNormals, AreZeroWhereFacesCancelAndWhereThereIsNone) {
  Mesh mesh = square();
  mesh.triangles = {0, 1, 3, 0, 3, 1};
  EXPECT_EQ(vertexNormals(mesh), Floats(12, 0));
}

TEST(EnsureNormals, AddsThemOnce) {
  Mesh mesh = square();
  ensureNormals(mesh);
  ASSERT_EQ(mesh.features.size(), 1u);
  EXPECT_EQ(mesh.features[0].name, "normal");
  EXPECT_EQ(mesh.features[0].dimension, 3u);
  EXPECT_EQ(mesh.features[0].values, (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  ensureNormals(mesh);
  EXPECT_EQ(mesh.features.size(), 1u);
}

// Leaves of a book that share its spine's place, opened to these angles. The first three are one
// surface, two of them by the third; the last faces away from all.
TEST(EnsureNormals, AreOneWhereSidesOfASeamAreOneSurface) {
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
  Mesh book;
  for (const double degrees : {60.0, 0.0, 120.0, 240.0}) {
    const double a = radians(degrees);
    const auto first = static_cast<std::uint32_t>(book.vertexCount());
    for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, std::cos(a), std::sin(a)})
      book.positions.push_back(static_cast<float>(x));
    for (std::uint32_t k = 0; k < 3; ++k) book.triangles.push_back(first + k);
  }
  Mesh plain = book;
  ensureNormals(plain);
  EXPECT_NEAR(plain.features[0].values[3 * 3 + 2], 1, 1e-6) << "no seam without a texture";
  book.features = {{"texcoord", 2, Floats(2 * book.vertexCount())}};
  ensureNormals(book);
  const Floats& n = book.features[1].values;
  for (const auto& [leaf, degrees] : {std::pair{0, 60.0}, {1, 60.0}, {2, 60.0}, {3, 240.0}}) {
    for (const int spine : {0, 1}) {
      const std::size_t at = 3 * static_cast<std::size_t>(3 * leaf + spine);
      EXPECT_NEAR(n[at + 1], -std::sin(radians(degrees)), 1e-6) << leaf;
      EXPECT_NEAR(n[at + 2], std::cos(radians(degrees)), 1e-6) << leaf;
    }
  }
}

// Six blades about an axis: each faces the next one's way, and all of them together none.
TEST(EnsureNormals, AreTheirOwnWhereManySidesCancel) {
  Mesh blades;
  for (int k = 0; k < 6; ++k) {
    const double a = k * std::numbers::pi / 3;
    for (const double x : {0.0, 0.0, 0.0, std::cos(a), std::sin(a), 0.5, 0.0, 0.0, 1.0})
      blades.positions.push_back(static_cast<float>(x));
    for (int corner = 0; corner < 3; ++corner)
      blades.triangles.push_back(static_cast<std::uint32_t>(3 * k + corner));
  }
  blades.features = {{"texcoord", 2, Floats(2 * blades.vertexCount())}};
  const Floats own = vertexNormals(blades);
  ensureNormals(blades);
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_NEAR(blades.features[1].values[i], own[i], 1e-6);
}

TEST(EnsureNormals, KeepsThoseThatTheMeshCameWith) {
  Mesh mesh = square();
  const Floats own{0, 1, 0, 1, 0, 0, 0, 0.6F, 0.8F, 0, 0, -1};
  mesh.features = {{"normal", 3, own}};
  ensureNormals(mesh);
  EXPECT_EQ(mesh.features[0].values, own);
}

TEST(EnsureNormals, ReplacesThoseThatAreNone) {
  const Floats right{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  Floats long_one = right, no_number = right, two_each = right;
  long_one[11] = 1.1F;
  no_number[0] = kNaN;
  two_each.insert(two_each.end(), right.begin(), right.end());
  for (const Feature& wrong :
       {Feature{"normal", 6, two_each}, Feature{"normal", 3, long_one},
        Feature{"normal", 3, no_number}, Feature{"normal", 3, Floats(12, 0)}}) {
    Mesh mesh = square();
    mesh.features = {{"heat", 1, Floats(4, 0)}, wrong};
    ensureNormals(mesh);
    ASSERT_EQ(mesh.features.size(), 2u);
    EXPECT_EQ(mesh.features[1].dimension, 3u);
    EXPECT_EQ(mesh.features[1].values, right);
  }
}

}  // namespace
}  // namespace merlin::render
