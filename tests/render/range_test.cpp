// Range images: geometry compared with closed forms, filters, and triangulation.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "render/mesh/borders.h"
#include "render/mesh/non_manifold.h"
#include "render/range/cells.h"
#include "render/range/colours.h"
#include "render/range/filters.h"
#include "render/range/geometry.h"
#include "render/range/triangulate.h"
#include "tests/support/range_images.h"

namespace merlin::test {
namespace {

using namespace render::range;
namespace mesh = render::mesh;

constexpr double kDeg = std::numbers::pi / 180;

std::array<float, 3> pointAt(const RangeImage& image, std::size_t row, std::size_t column) {
  const auto points = pointsOf(image, {});
  const std::size_t p = 3 * (row * image.width + column);
  return {points[p], points[p + 1], points[p + 2]};
}

TEST(RangeGeometry, OrthogonalAxesFollowA15ToA17) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
  image.geometry.horizontal_rad = 60 * kDeg;
  image.geometry.vertical_rad = 40 * kDeg;
  image.range[2] = 5;  // top right: theta 30, phi 20 degrees
  const double x = std::tan(30 * kDeg), y = std::tan(20 * kDeg), d = std::sqrt(1 + x * x + y * y);
  const auto p = pointAt(image, 0, 2);
  EXPECT_NEAR(p[0], 5 * x / d, 1e-6);
  EXPECT_NEAR(p[1], 5 * y / d, 1e-6);
  EXPECT_NEAR(p[2], -5 / d, 1e-6) << "the scene lies at negative z";
  EXPECT_NEAR(pointAt(image, 1, 1)[2], -1, 1e-6) << "the middle looks along -z";
  EXPECT_NEAR(pointAt(image, 1, 0)[0], -0.5, 1e-6) << "-sin 30 degrees: the left";
}

TEST(RangeGeometry, APinholesRangeIsADepth) {
  RangeImage image = flatImage(4, 2, Scanner::kPinhole);
  image.geometry.horizontal_rad = 90 * kDeg;
  image.geometry.vertical_rad = 53.13010235 * kDeg;  // tan of half of it is 0.5
  image.range.assign(8, 2.0F);
  const auto p = pointAt(image, 0, 3);
  EXPECT_NEAR(p[0], 2 * 0.75, 1e-6) << "the last pixel's centre, an eighth from the edge";
  EXPECT_NEAR(p[1], 2 * 0.25, 1e-6);
  EXPECT_NEAR(p[2], -2, 1e-6);
}

TEST(RangeGeometry, ASpinningScannerTurnsClockwiseFromAbove) {
  RangeImage image = flatImage(4, 2, Scanner::kSpinning);
  image.geometry.horizontal_rad = 360 * kDeg;
  image.geometry.beams = {{30 * kDeg, 0}, {0, 45 * kDeg}};
  // Columns are at -135, -45, 45 and 135 degrees; the second row adds 45.
  const auto up = pointAt(image, 0, 2);
  EXPECT_NEAR(up[0], std::cos(30 * kDeg) * std::sin(45 * kDeg), 1e-6);
  EXPECT_NEAR(up[1], 0.5, 1e-6);
  EXPECT_NEAR(up[2], -std::cos(30 * kDeg) * std::cos(45 * kDeg), 1e-6);
  const auto right = pointAt(image, 1, 2);
  EXPECT_NEAR(right[0], 1, 1e-6);
  EXPECT_NEAR(right[2], 0, 1e-6);
}

TEST(RangeGeometry, AnElevationMapHasNorthAtTheTopAndExaggeratesHeights) {
  RangeImage image = flatImage(3, 2, Scanner::kElevation);
  image.geometry.cell_x = 30;
  image.geometry.cell_y = 20;
  image.geometry.exaggeration = 50;
  image.range[1] = -2;
  const auto p = pointAt(image, 0, 1);
  EXPECT_EQ(p, (std::array<float, 3>{30, 20, -100}));
}

TEST(RangeGeometry, TheCameraTransformPlacesThePoints) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
  image.geometry.T_world_scanner = {0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30};
  image.range[5] = 2;  // middle right: x = 2 sin 45 deg
  const auto p = pointAt(image, 1, 2);
  EXPECT_NEAR(p[0], 10, 1e-5);
  EXPECT_NEAR(p[1], 20 + std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(p[2], 30 - std::sqrt(2.0), 1e-5);
}

TEST(RangeGeometry, FaultsAreNamed) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
  EXPECT_EQ(faultOf(image), "");
  image.geometry.T_world_scanner[0] = 2;
  EXPECT_NE(faultOf(image).find("not a rotation"), std::string::npos) << faultOf(image);
  image.geometry = {};
  EXPECT_NE(faultOf(image).find("--angles"), std::string::npos) << faultOf(image);
  image.geometry.horizontal_rad = image.geometry.vertical_rad = 200 * kDeg;
  EXPECT_NE(faultOf(image).find("less than 180"), std::string::npos) << faultOf(image);
  image.geometry.scanner = Scanner::kSpinning;
  EXPECT_NE(faultOf(image).find("table"), std::string::npos) << faultOf(image);
  image.geometry.beams.resize(2);
  EXPECT_NE(faultOf(image).find("2 rows, the image has 3"), std::string::npos) << faultOf(image);
}

TEST(RangeGeometry, TheStepIsTheAngleBetweenPixels) {
  RangeImage image = flatImage(101, 51, Scanner::kSpinning);
  image.geometry.horizontal_rad = 1.01;
  image.geometry.beams.resize(51);
  for (std::size_t r = 0; r < 51; ++r)
    image.geometry.beams[r].altitude_rad = 0.02 * (25 - static_cast<double>(r));
  EXPECT_NEAR(stepOf(image), 0.02, 1e-4) << "rows are farther apart than columns";
}

TEST(MedianFilter, TakesTheMiddleOfNineAndKeepsAnEdge) {
  RangeImage image = flatImage(7, 5, Scanner::kOrthogonal);
  for (std::size_t p = 0; p < image.pixels(); ++p) image.range[p] = p % 7 < 3 ? 1.0F : 9.0F;
  const auto edge = image.range;
  medianFilter(image, 3, {});
  EXPECT_EQ(image.range, edge);
  image.range[7 * 2 + 1] = 100;
  image.range[7 * 0 + 6] = -50;  // a corner, of which four pixels are in the image
  medianFilter(image, 3, {});
  EXPECT_EQ(image.range, edge);
}

TEST(MedianFilter, EveryOrderOfNineRangesHasTheSameMedian) {
  std::array<float, 9> values = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (int i = 0; i < 20000; ++i) {
    std::next_permutation(values.begin(), values.end());
    if (i % 7 == 0) std::rotate(values.begin(), values.begin() + i % 5 + 1, values.end());
    RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
    std::copy(values.begin(), values.end(), image.range.begin());
    medianFilter(image, 3, {});
    ASSERT_EQ(image.range[4], 5) << i;
  }
}

TEST(MedianFilter, PixelsWithoutReturnStaySoAndAreNotCounted) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
  image.range = {1, 2, kNoReturn, 4, 9, kNoReturn, kNoReturn, 8, 6};
  medianFilter(image, 3, {});
  EXPECT_FALSE(isReturn(image.range[2]));
  EXPECT_EQ(image.range[4], 4) << "the lower one of the middle two of 1 2 4 6 8 9";
}

TEST(MedianFilter, WiderWindowsAndFullTurnsWrapAround) {
  RangeImage image = ring(8, 3);
  for (const std::size_t p : {0U, 1U, 8U, 9U, 16U, 17U}) image.range[p] = 7;
  medianFilter(image, 5, {});
  for (const float r : image.range) EXPECT_EQ(r, 1);
}

TEST(Spikes, GoWhileEdgesWiresAndCornersStay) {
  RangeImage image = flatImage(12, 7, Scanner::kOrthogonal);
  for (std::size_t p = 0; p < image.pixels(); ++p) image.range[p] = p % 12 < 5 ? 1.0F : 3.0F;
  EXPECT_EQ(removeSpikes(image, {0.1F}, {}), 0u) << "edges, corners";
  for (std::size_t row = 0; row < 7; ++row) image.range[12 * row + 8] = 2;  // a single wire
  EXPECT_EQ(removeSpikes(image, {0.1F}, {}), 2u) << "the ends of the wire";
  image.range[12 * 2 + 10] = 5;
  image.range[12 * 5 + 2] = image.range[12 * 5 + 3] = 5;
  EXPECT_EQ(removeSpikes(image, {0.1F}, {}), 5u)
      << "one pixel alone, two side by side, and the wire's new ends";
  EXPECT_FALSE(isReturn(image.range[12 * 2 + 10]));
  EXPECT_FALSE(isReturn(image.range[12 * 5 + 2]));
  EXPECT_TRUE(isReturn(image.range[12 * 2 + 9]));
  EXPECT_TRUE(isReturn(image.range[12 * 3 + 8]));
}

TEST(Spikes, TheLimitMayBeAShareOfTheRange) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);
  image.range.assign(9, 10.0F);
  image.range[4] = 10.5F;
  Threshold limit;
  limit.per_range = 0.06F;
  EXPECT_EQ(removeSpikes(image, limit, {}), 0u);
  limit.per_range = 0.04F;
  EXPECT_EQ(removeSpikes(image, limit, {}), 1u);
}

RangeMesh meshOf(const RangeImage& image, const Threshold& limit = {}, unsigned threads = 1) {
  return triangulate(image, pointsOf(image, {}), limit, {threads});
}

TEST(Triangulation, AFullGridHasTwoTrianglesACell) {
  const RangeMesh m = meshOf(flatImage(5, 4, Scanner::kElevation));
  EXPECT_EQ(m.mesh.triangleCount(), 24u);
  EXPECT_EQ(m.mesh.vertexCount(), 20u);
  EXPECT_EQ(m.returns, 20u);
  EXPECT_EQ(m.unused + m.split + m.not_numbers, 0u);
  EXPECT_EQ(std::count(m.on_boundary.begin(), m.on_boundary.end(), 1), 14);
  for (std::size_t v = 0; v < 20; ++v) EXPECT_EQ(m.mesh.features[0].values[3 * v + 2], 1);
}

TEST(Triangulation, TakesTheShorterDiagonal) {
  RangeImage image = flatImage(2, 2, Scanner::kElevation);
  image.range = {0, 0, 3, 0};  // a b / d c
  EXPECT_EQ(meshOf(image).mesh.triangles, (std::vector<std::uint32_t>{0, 2, 3, 0, 3, 1}))
      << "d is high: a c is shorter";
  image.range = {0, 0, 0, 3};
  EXPECT_EQ(meshOf(image).mesh.triangles, (std::vector<std::uint32_t>{0, 2, 1, 1, 2, 3}))
      << "c is high: b d is shorter";
}

TEST(Triangulation, OneMissingCornerLeavesOneTriangleAndTwoLeaveNone) {
  for (std::size_t missing = 0; missing < 4; ++missing) {
    RangeImage image = flatImage(2, 2, Scanner::kElevation);
    image.range[missing] = kNoReturn;
    const RangeMesh m = meshOf(image);
    EXPECT_EQ(m.mesh.triangleCount(), 1u) << missing;
    EXPECT_EQ(m.mesh.vertexCount(), 3u);
    EXPECT_GT(m.mesh.features[0].values[2], 0.99F) << "faces the scanner, whichever is missing";
    image.range[(missing + 1) % 4] = kNoReturn;
    EXPECT_EQ(meshOf(image).mesh.triangleCount(), 0u);
    EXPECT_EQ(meshOf(image).unused, 2u);
  }
}

TEST(Triangulation, NoEdgeIsLongerThanTheThreshold) {
  RangeImage image = flatImage(4, 3, Scanner::kElevation);
  for (const std::size_t p : {2U, 3U, 6U, 7U, 10U, 11U}) image.range[p] = 5;
  EXPECT_EQ(meshOf(image, {2.0F}).mesh.triangleCount(), 8u) << "a hole at the step";
  EXPECT_EQ(meshOf(image, {6.0F}).mesh.triangleCount(), 12u);
  EXPECT_EQ(meshOf(image, {1.2F}).mesh.triangleCount(), 0u) << "the diagonals are too long";
}

TEST(Triangulation, TheThresholdMayBeAShareOfTheRange) {
  RangeImage image = flatImage(3, 3, Scanner::kOrthogonal);  // steps of 45 degrees
  for (float& r : image.range) r = 4;
  Threshold limit;
  limit.per_range = 1.0F;
  EXPECT_EQ(meshOf(image, limit).mesh.triangleCount(), 8u);
  limit.per_range = 0.5F;
  EXPECT_EQ(meshOf(image, limit).mesh.triangleCount(), 0u);
}

TEST(Triangulation, AFullTurnIsClosed) {
  const RangeMesh m = meshOf(ring(8, 3));
  EXPECT_EQ(m.mesh.triangleCount(), 32u);
  EXPECT_EQ(std::count(m.on_boundary.begin(), m.on_boundary.end(), 1), 16);
  RangeImage open = ring(8, 3);
  open.join_ends = false;
  EXPECT_EQ(meshOf(open).mesh.triangleCount(), 28u);
}

TEST(Triangulation, FacesTheScannerWhateverTheOrderOfItsColumns) {
  for (const bool mirrored : {false, true}) {
    const RangeImage image = rays(6, 5, mirrored);
    const RangeMesh m = meshOf(image);
    ASSERT_EQ(m.mesh.triangleCount(), 40u);
    for (std::size_t v = 0; v < m.mesh.vertexCount(); ++v)
      EXPECT_LT(mesh::dot(&m.mesh.features[0].values[3 * v], &m.mesh.positions[3 * v]), 0)
          << mirrored;
  }
}

// For every pattern of returns in 4 x 4 pixels, and for a pseudo-random set of long edges, the
// general repair must find nothing to change in the triangulation.
TEST(Triangulation, AnyPatternOfHolesIsManifold) {
  for (unsigned bits = 0; bits < 65536; bits += 7) {
    RangeImage image = flatImage(4, 4, Scanner::kElevation);
    for (std::size_t p = 0; p < 16; ++p) {
      image.range[p] = static_cast<float>((bits >> (p + 3) % 16 & 3) * (p % 3));
      if (bits >> p & 1) image.range[p] = kNoReturn;
    }
    RangeMesh m = meshOf(image, {2.6F});
    ASSERT_TRUE(validate(m.mesh).ok());
    mesh::Mesh repaired = m.mesh;
    const auto tidied = tidy(repaired);
    ASSERT_EQ(tidied.degenerate + tidied.duplicate + tidied.opposite + tidied.unused, 0u) << bits;
    if (repaired.triangles.empty()) continue;
    ASSERT_EQ(splitNonManifold(repaired).added, 0u) << bits;
    const std::vector<bool> border = borderVertices(m.mesh);
    for (std::size_t v = 0; v < border.size(); ++v)
      ASSERT_EQ(m.on_boundary[v] == 1, border[v]) << bits;
  }
}

TEST(Triangulation, SurfacesThatTouchInAPointGetAVertexEach) {
  RangeImage image = flatImage(3, 3, Scanner::kElevation);
  for (const std::size_t p : {2U, 3U, 5U, 6U}) image.range[p] = kNoReturn;
  const RangeMesh m = meshOf(image);
  EXPECT_EQ(m.mesh.triangleCount(), 2u) << "0 4 1 and 4 7 8";
  EXPECT_EQ(m.mesh.vertexCount(), 6u);
  EXPECT_EQ(m.split, 1u);
  EXPECT_EQ(m.pixels, (std::vector<std::uint32_t>{0, 1, 4, 4, 7, 8}));
  EXPECT_EQ(m.mesh.triangles, (std::vector<std::uint32_t>{0, 3, 1, 2, 4, 5}));
}

TEST(Triangulation, NormalsAreThoseOfEquation41) {
  const RangeImage image = bumps(40, 30);
  const RangeMesh m = meshOf(image);
  const std::vector<float> expected = mesh::vertexNormals(m.mesh);
  ASSERT_EQ(m.mesh.features[0].name, "normal");
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_NEAR(m.mesh.features[0].values[i], expected[i], 2e-6F) << i;
}

TEST(Triangulation, FeaturesTravelWithTheirPixels) {
  RangeImage image = flatImage(3, 2, Scanner::kElevation);
  image.range[0] = kNoReturn;
  image.planes = {{"heat", 1, {0, 1, 2, 3, 4, kNoReturn}}, {"pair", 2, {}}};
  for (int i = 0; i < 12; ++i) image.planes[1].values.push_back(static_cast<float>(i));
  const RangeMesh m = meshOf(image);
  EXPECT_EQ(m.pixels, (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(m.mesh.find("heat")->values, (std::vector<float>{1, 2, 3, 4, 0}));
  EXPECT_EQ(m.not_numbers, 1u);
  EXPECT_EQ(m.mesh.find("pair")->values, (std::vector<float>{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(Triangulation, TexcoordsAreThePixelsCentres) {
  const RangeImage image = flatImage(4, 2, Scanner::kElevation);
  RangeMesh m = meshOf(image);
  addTexcoords(m, image);
  const auto& uv = m.mesh.find("texcoord")->values;
  EXPECT_FLOAT_EQ(uv[0], 0.125F);
  EXPECT_FLOAT_EQ(uv[1], 0.75F) << "v is upwards";
  EXPECT_FLOAT_EQ(uv[14], 0.875F);
  EXPECT_FLOAT_EQ(uv[15], 0.25F);
}

TEST(RangeWork, ThreadsDoNotChangeTheResult) {
  RangeImage one = bumps(300, 200), four = bumps(300, 200);
  EXPECT_EQ(removeSpikes(one, {0.05F}, {1}), removeSpikes(four, {0.05F}, {4}));
  medianFilter(one, 3, {1});
  medianFilter(four, 3, {4});
  const RangeMesh a = meshOf(one, {0.5F}, 1), b = meshOf(four, {0.5F}, 4);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.features[0].values, b.mesh.features[0].values);
  EXPECT_EQ(a.on_boundary, b.on_boundary);
}

TEST(RangeWork, ProgressReachesTheEndAndNeverFalls) {
  double last = 0;
  const RangeImage image = bumps(64, 64);
  triangulate(image, pointsOf(image, {}), {}, {1, [&](double share) {
                                                 EXPECT_GE(share, last);
                                                 last = share;
                                               }});
  EXPECT_EQ(last, 1);
}

TEST(RangeColours, ConfidenceIsBlueWhereLowAndRedWhereHigh) {
  const std::vector<float> values = {0, 50, 100, 200, kNoReturn};
  const Plane plane = coloursOf(values, {0, 100}, Scale::kBlueToRed);
  EXPECT_EQ(plane.values, (std::vector<float>{0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(endsOf(values).high, 200);
  EXPECT_EQ(coloursOf(values, {7, 7}, Scale::kBlueToRed).values[1], 1) << "the middle: green";
}

}  // namespace
}  // namespace merlin::test
