// Faces of more than three corners: which of them become triangle fans, and how the others are cut
// into triangles.
#include "render/mesh/polygon.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

// Returns twice the signed area of a triangle of the cut: positive if it is counter-clockwise in x
// and y.
double areaOf(const Floats& p, const std::uint32_t* t) {
  const auto at = [&](std::size_t k, std::size_t axis) { return double{p[3 * t[k] + axis]}; };
  return (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) -
         (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
}

// Expects triangles that all face up and whose areas add up to `area`, so that they do not overlap.
void expectCut(const Floats& polygon, double area) {
  const Indices cut = mesh::cutPolygon(polygon);
  ASSERT_EQ(cut.size(), polygon.size() - 6);
  double sum = 0;
  for (std::size_t t = 0; t < cut.size(); t += 3) {
    EXPECT_GE(areaOf(polygon, &cut[t]), 0) << t;
    sum += areaOf(polygon, &cut[t]) / 2;
  }
  EXPECT_NEAR(sum, area, 1e-5 * area);
}

TEST(CutPolygon, AConvexOneStaysAFan) {
  EXPECT_EQ(mesh::cutPolygon(Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), Indices{});
  EXPECT_EQ(mesh::cutPolygon(Floats{0, 0, 0, 1, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}), Indices{})
      << "with a flat corner";
  EXPECT_EQ(mesh::cutPolygon(Floats{0, 0, 0, 1, 0, 0.2F, 1, 1, 0, 0, 1, 0.2F}), Indices{})
      << "bent";
  EXPECT_EQ(mesh::cutPolygon(Floats{0, 0, 0, 1, 0, 0, 1, 1, 0}), Indices{}) << "a triangle";
}

TEST(CutPolygon, OneWithANotchIsCutWithinItself) {
  EXPECT_EQ(mesh::cutPolygon(Floats{2, 2, 0, 0, 1, 0, -2, 2, 0, 0, 0, 0}),
            (Indices{3, 0, 1, 1, 2, 3}));
  expectCut({0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 0, 4, 0}, 10);
  expectCut({2, 0, 0, 2, 1, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0, 0, 0, 0}, 3);
  // A square with a hole; a cut leads from the border to the hole and back.
  expectCut(
      {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 0, 0, 1, 1, 0, 1, 3, 0, 3, 3, 0, 3, 1, 0, 1, 1, 0},
      12);
}

TEST(CutPolygon, InAnyPlaneAndFarFromTheOriginToo) {
  const Floats arrow = {2, 2, 0, 0, 1, 0, -2, 2, 0, 0, 0, 0};
  const Indices cut = mesh::cutPolygon(arrow);
  for (const std::array<std::size_t, 3> axes : {std::array<std::size_t, 3>{1, 2, 0}, {2, 0, 1}}) {
    for (const float far : {0.0F, 1e6F}) {
      Floats turned(arrow.size());
      for (std::size_t i = 0; i < arrow.size(); ++i)
        turned[i / 3 * 3 + axes[i % 3]] = arrow[i] + far;
      EXPECT_EQ(mesh::cutPolygon(turned), cut);
    }
  }
}

TEST(CutPolygon, AClockwiseOneKeepsItsSense) {
  const Indices cut = mesh::cutPolygon(Floats{0, 0, 0, -2, 2, 0, 0, 1, 0, 2, 2, 0});
  EXPECT_EQ(cut, Indices{}) << "the fan around its tip is right";
  const Floats turned = {-2, 2, 0, 0, 1, 0, 2, 2, 0, 0, 0, 0};
  const Indices down = mesh::cutPolygon(turned);
  ASSERT_EQ(down.size(), 6U);
  EXPECT_LT(areaOf(turned, &down[0]), 0);
  EXPECT_LT(areaOf(turned, &down[3]), 0);
}

TEST(CutPolygon, WithoutACutStaysAFan) {
  const float nan = std::nanf("");
  EXPECT_EQ(mesh::cutPolygon(Floats{2, 2, 0, 0, 1, 0, nan, 2, 0, 0, 0, 0}), Indices{});
  EXPECT_EQ(mesh::cutPolygon(Floats{0, 0, 0, 2, 0, 0, 1, 0, 0, 3, 0, 0}), Indices{}) << "a line";
  EXPECT_EQ(mesh::cutPolygon(Floats(12, 1.0F)), Indices{}) << "a point";
  EXPECT_EQ(mesh::cutPolygon(Floats{}), Indices{});
}

// Returns a star with this many corners, half of which are concave; its centre is (0, 0).
Floats star(std::size_t corners) {
  Floats p;
  for (std::size_t k = 0; k < corners; ++k) {
    const double a = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(corners);
    const double r = k % 2 == 0 ? 2 : 1;
    p.insert(p.end(),
             {static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), 0});
  }
  return p;
}

TEST(CutPolygon, TakesAFewThousandCorners) {
  const double wedge = std::sin(2 * std::numbers::pi / 4096);  // twice the area, of 2 x 1
  expectCut(star(4096), 4096 * wedge);
  EXPECT_EQ(mesh::cutPolygon(star(4098)), Indices{}) << "more stay fans";
}

TEST(Fans, ThoseWithVerticesThatAreNotThereStay) {
  mesh::Mesh mesh{{2, 2, 0, 0, 1, 0, -2, 2, 0, 0, 0, 0}, {}, {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 9}};
  mesh::Mesh first{mesh.positions, {}, {0, 1, 2, 0, 2, 3}};
  mesh::Fans fans;
  fans.take(first, 4);
  fans.take(mesh, 4);
  std::size_t cuts = 0;
  fans.cut(mesh, [&](const mesh::Fan& fan, std::span<const std::uint32_t>) {
    ++cuts;
    EXPECT_EQ(fan.triangle, 0U);
  });
  EXPECT_EQ(cuts, 1U);
  EXPECT_EQ(mesh.triangles, (Indices{3, 0, 1, 1, 2, 3, 0, 1, 2, 0, 2, 9}));
}

}  // namespace
}  // namespace merlin::render
