// The images of `merlin mesh compare`: the parts that do not need OpenGL.
#include <gtest/gtest.h>

#include "daemon/cli/mesh/edge_bands.h"
#include "render/image/picture_difference.h"
#include "render/reduce/edge_lengths.h"
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
  const render::mesh::Mesh bands = edgeBands(triangle, ranksOf(lengthsInSpace(triangle)), View{});
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
  const render::mesh::Mesh sphere = test::sphere(0);
  const render::mesh::Mesh bands = edgeBands(sphere, ranksOf(lengthsInSpace(sphere)), View{});
  const std::vector<float>& colours = bands.find("colour")->values;
  for (std::size_t t = 0; t < 8; ++t) {
    for (std::size_t v = 0; v < 12; ++v)
      EXPECT_TRUE(
          std::equal(&colours[3 * (15 * t + v)], &colours[3 * (15 * t + v) + 3], &colours[0]));
  }
}

// Returns the place of every band's edge on the scale, from the band's colour: 0 red, 1 blue,
// otherwise 0.5.
std::vector<double> placesOf(const render::mesh::Mesh& bands) {
  const std::vector<float>& colours = bands.find("colour")->values;
  std::vector<double> places;
  for (std::size_t first = 0; first < colours.size(); first += 3 * 15) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const float* rgb = &colours[first + 3 * 4 * edge];
      const bool pure = rgb[1] < 0.001F, red = pure && rgb[0] > 0.999F,
                 blue = pure && rgb[2] > 0.999F;
      places.push_back(red ? 0 : blue ? 1 : 0.5);
    }
  }
  return places;
}

// [GOURLEY98] 5.1 and figure 5.1, (4) and (1): with the boundary's weight alone, edges inside are
// red, and edges that lead to the border, which are reduced last, are blue. With the weight of
// geometry alone, the same edges have two lengths.
TEST(EdgeBands, ShowWhatAWeightDoes) {
  render::mesh::Mesh grid = test::grid(4, 4);
  render::mesh::ensureNormals(grid);
  const auto shown = [&](const render::reduce::Weights& weights) {
    return placesOf(edgeBands(grid, sizesOf(*render::reduce::edgeLengths(grid, weights)), View{}));
  };
  const auto isInside = [&](std::uint32_t v) {
    return v % 5 > 0 && v % 5 < 4 && v / 5 > 0 && v / 5 < 4;
  };
  const std::vector<double> by_boundary = shown({{"boundary", 2}}),
                            by_space = shown({{"geometry", 1}});
  ASSERT_EQ(by_boundary.size(), grid.triangles.size());
  for (std::size_t i = 0; i < grid.triangles.size(); ++i) {
    const std::uint32_t a = grid.triangles[i], b = grid.triangles[i - i % 3 + (i + 1) % 3];
    EXPECT_EQ(by_boundary[i], isInside(a) != isInside(b) ? 1 : 0) << a << " " << b;
    const bool diagonal = a / 5 != b / 5 && a % 5 != b % 5;
    EXPECT_EQ(by_space[i], diagonal ? 1 : 0) << a << " " << b;
  }
}

TEST(EdgeBands, AreColouredBySizeBetweenThePercentiles) {
  EXPECT_EQ(sizesOf(std::vector<float>{2, 3, 6}), (std::vector<float>{0, 0.25F, 1}));
  EXPECT_EQ(sizesOf(std::vector<float>{7, 7}), (std::vector<float>{0, 0}));
  EXPECT_TRUE(sizesOf({}).empty());
  std::vector<float> lengths(200, 1);  // flat parts
  lengths[0] = 9;
  EXPECT_EQ(sizesOf(lengths)[0], 1) << "one edge, above the 99th percentile, is still blue";
  EXPECT_EQ(sizesOf(lengths)[1], 0);
  for (std::size_t i = 0; i < 100; ++i) lengths[i] = 2;
  lengths[0] = 1000;
  EXPECT_EQ(sizesOf(lengths)[1], 1) << "one extreme edge does not make all others red";
}

}  // namespace
}  // namespace merlin::cli
