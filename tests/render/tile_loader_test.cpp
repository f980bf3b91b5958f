// The thread that loads tiles: it loads what is asked for, the most urgent first, within its
// memory, and says what cannot be read.
#include "render/content/picture/tile_loader.h"

#include <gtest/gtest.h>

#include "tests/support/eventually.h"
#include "tests/support/pyramids.h"

namespace merlin::render::content {
namespace {

using image::TilePlace;

std::shared_ptr<const Picture> pictureOf(std::string bytes) {
  return *makePicture(*test::readPyramid(std::move(bytes)), ShowAs::kPlane);
}

std::vector<TilePlace> allOf(const Picture& picture) {
  std::vector<TilePlace> places;
  const image::PyramidLevel& finest = picture.file->levels().front();
  for (std::int32_t row = 0; row < finest.rows; ++row)
    for (std::int32_t column = 0; column < finest.columns; ++column)
      places.push_back({0, column, row});
  return places;
}

class TileLoaderTest : public testing::Test {
 protected:
  LoadedTile next() {
    std::optional<LoadedTile> tile;
    EXPECT_TRUE(test::eventually([&] { return (tile = loader_.take()).has_value(); }));
    return tile.value_or(LoadedTile{});
  }
  ThreadWatch watch_;
  TileLoader loader_{watch_};
};

TEST_F(TileLoaderTest, LoadsTheMostUrgentFirst) {
  const auto picture = pictureOf(test::pyramidBytes());
  loader_.ask(picture, std::vector<TilePlace>{{1, 0, 0}, {0, 2, 1}, {0, 0, 0}});
  EXPECT_EQ(next().place, (TilePlace{1, 0, 0}));
  EXPECT_EQ(next().place, (TilePlace{0, 2, 1}));
  const LoadedTile last = next();
  EXPECT_EQ(last.place, (TilePlace{0, 0, 0}));
  EXPECT_EQ(last.pixels.size(), image::kTileBytes);
  EXPECT_EQ(last.pixels[4 * 5], 5);
  EXPECT_FALSE(loader_.isLoading());
}

TEST_F(TileLoaderTest, HoldsNoMoreThanItsMemory) {
  const auto picture = pictureOf(test::pyramidBytes({.width = 2560, .height = 1280}));  // 50 tiles
  loader_.ask(picture, allOf(*picture));
  int taken = 0;
  EXPECT_TRUE(test::eventually([&] {
    while (loader_.take()) ++taken;
    return taken == 50;
  }));
  EXPECT_FALSE(loader_.isLoading());
  EXPECT_FALSE(loader_.hasLoaded());
}

TEST_F(TileLoaderTest, SaysOnceForAPictureWhatCannotBeReadAndTriesItNoMore) {
  std::string bytes = test::pyramidBytes();
  // The deflate streams of level 0, which begin at byte 16, become noise; the coarsest stays.
  const auto whole = pictureOf(bytes);
  for (std::size_t i = 20; i < 2000; ++i) bytes[i] = static_cast<char>(i * 31);
  const auto picture = pictureOf(bytes);
  loader_.ask(picture, std::vector<TilePlace>{{0, 0, 0}});
  EXPECT_TRUE(next().pixels.empty());
  loader_.ask(picture, std::vector<TilePlace>{{0, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(next().place, (TilePlace{1, 0, 0})) << "the broken one is not tried again";
  const auto faults = loader_.takeFaults();
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("test.tif: level 0, tile 0 of row 0"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace merlin::render::content
