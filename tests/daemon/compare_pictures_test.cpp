// The images of `merlin mesh compare`, as far as they need no OpenGL.
#include "daemon/cli/mesh/compare_pictures.h"

#include <gtest/gtest.h>

#include "render/image/picture_difference.h"
#include "tests/support/meshes.h"

namespace merlin::cli {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<float, 3> kBlack{0, 0, 0};

TEST(Image, AppendsToTheRight) {
  render::image::Image strip;
  strip.append({1, 2, {1, 1, 1, 1, 2, 2, 2, 2}});
  strip.append({2, 2, {3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6}});
  EXPECT_EQ(strip.width, 3);
  EXPECT_EQ(strip.height, 2);
  EXPECT_EQ(strip.pixels,
            (Bytes{1, 1, 1, 1, 3, 3, 3, 3, 4, 4, 4, 4, 2, 2, 2, 2, 5, 5, 5, 5, 6, 6, 6, 6}));
}

// A channel counts as changed if it differs by more than 38.25 (15 % of 255). The last pixel is
// background in both images.
TEST(PictureDifference, CountsPixelsOfWhichAChannelHasChangedByMoreThan15Percent) {
  const render::image::Image a{
      5, 1, {100, 100, 100, 9, 100, 100, 100, 9, 0, 0, 0, 9, 50, 50, 50, 9, 0, 0, 1, 9}};
  const render::image::Image b{
      5, 1, {100, 138, 62, 8, 100, 100, 139, 9, 39, 0, 0, 9, 50, 50, 50, 9, 0, 1, 0, 9}};
  const render::image::PictureDifference d = render::image::differenceOf(a, b, kBlack);
  EXPECT_EQ(d.image.pixels,
            (Bytes{0, 0, 0, 0, 255, 255, 255, 0, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(d.changed_percent, 50) << "2 of the 4 that show something";
  EXPECT_EQ(render::image::differenceOf({1, 1, {0, 0, 0, 0}}, {1, 1, {0, 0, 0, 0}}, kBlack)
                .changed_percent,
            0);
}

TEST(EdgeBands, AreRedWhereAnEdgeIsShortAndBlueWhereItIsLong) {
  // Sides of length 3, 5 and 4.
  const render::mesh::Mesh triangle{{0, 0, 0, 3, 0, 0, 0, 4, 0}, {}, {0, 1, 2}};
  const render::mesh::Mesh bands = edgeBands(triangle, View{});
  ASSERT_EQ(bands.vertexCount(), 3 * 4 + 3u);
  ASSERT_EQ(bands.triangleCount(), 3 * 2 + 1u);
  const std::vector<float>& colours = bands.find("colour")->values;
  const auto colourOf = [&](std::size_t band) { return &colours[3 * 4 * band]; };
  EXPECT_GT(colourOf(0)[0], 0.9F) << "the shortest is red";
  EXPECT_EQ(colourOf(0)[2], 0);
  EXPECT_GT(colourOf(1)[2], 0.9F) << "the longest is blue";
  EXPECT_EQ(colourOf(1)[0], 0);
  EXPECT_EQ(colourOf(2)[1], 1) << "the middle one is green";
  EXPECT_TRUE(validate(bands));
  // Bands and interior cover the triangle once without overlap, so their areas add up to its area.
  double area = 0;
  for (std::size_t i = 0; i < bands.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return Eigen::Map<const Eigen::Vector3f>(&bands.positions[3 * bands.triangles[i + k]]);
    };
    area += double{(at(1) - at(0)).cross(at(2) - at(0)).z()} / 2;
  }
  EXPECT_NEAR(area, 6, 1e-6);
}

TEST(EdgeBands, GiveEqualEdgesOneColour) {
  const render::mesh::Mesh bands = edgeBands(test::sphere(0), View{});
  const std::vector<float>& colours = bands.find("colour")->values;
  for (std::size_t t = 0; t < 8; ++t) {
    for (std::size_t v = 0; v < 12; ++v)
      EXPECT_TRUE(
          std::equal(&colours[3 * (15 * t + v)], &colours[3 * (15 * t + v) + 3], &colours[0]));
  }
}

}  // namespace
}  // namespace merlin::cli
