// Makes a small picture of a whole pyramid.
#include "render/image/overview.h"

#include <gtest/gtest.h>

#include "tests/support/pyramids.h"

namespace merlin::render::image {
namespace {

Result<Image> overviewOf(const test::PyramidSpec& spec) {
  const auto file = test::readPyramid(test::pyramidBytes(spec));
  EXPECT_TRUE(file) << file.error().what;
  return readOverview(*file);
}

TEST(Overview, IsTheCoarsestLevelThatIsLargeEnough) {
  // The levels have 3000, 1500, 750, 375 and 187 columns.
  const auto image = overviewOf({.width = 3000, .height = 200});
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_EQ(image->width, 750);
  EXPECT_EQ(image->height, 50);
}

TEST(Overview, OfASmallPictureIsThePicture) {
  const auto image = overviewOf({.width = 300, .height = 270});
  ASSERT_TRUE(image) << image.error().what;
  ASSERT_EQ(image->width, 300);
  ASSERT_EQ(image->height, 270);
  int wrong = 0;
  for (int y = 0; y < 270; ++y) {
    for (int x = 0; x < 300; ++x) {
      const std::uint8_t* const pixel =
          &image->pixels[4 * (static_cast<std::size_t>(y) * 300 + static_cast<std::size_t>(x))];
      const std::array expected{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                std::uint8_t{128}, std::uint8_t{255}};
      if (!std::equal(expected.begin(), expected.end(), pixel)) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0) << "pixels, over all four tiles";
}

TEST(Overview, OfADamagedTileIsAnErrorWithTheFilesName) {
  std::string bytes = test::pyramidBytes({.width = 300, .height = 270});
  std::fill(bytes.begin() + 16, bytes.begin() + 80, '\xFF');  // the first tile
  const auto file = test::readPyramid(bytes);
  ASSERT_TRUE(file) << file.error().what;
  const auto image = readOverview(*file);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().what.find("test.tif"), std::string::npos) << image.error().what;
}

}  // namespace
}  // namespace merlin::render::image
