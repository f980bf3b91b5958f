// The thread that loads tiles: it loads the most urgent requested tiles first, keeps within its
// memory, and reports files that it cannot read.
#include "render/content/picture/tile_loader.h"

#include <atomic>

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

// A clock that a test advances while the loader's thread reads it.
class SteppedClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return Timestamp(Duration(now_ns_.load())); }
  bool sleepUntil(Timestamp, const std::stop_token&) noexcept override { return false; }
  void advance(Duration by) { now_ns_ += by.count(); }

 private:
  std::atomic<std::int64_t> now_ns_{1'000'000'000};
};

// A file whose level 0 cannot be read while `fails` is true.
class FlakyAccess final : public image::RandomAccess {
 public:
  // `fails`: whether reading fails now; `tries`: number of attempts to read.
  FlakyAccess(std::string bytes, const std::atomic<bool>& fails, std::atomic<int>& tries)
      : whole_(std::move(bytes)), fails_(fails), tries_(tries) {}
  std::uint64_t size() const noexcept override { return whole_.size(); }
  Result<Ok> read(std::uint64_t offset, std::span<std::uint8_t> to) const override {
    const bool of_level_0 = offset >= 16 && offset < 2000;
    if (of_level_0) ++tries_;
    if (of_level_0 && fails_) return Error{Errc::kIo, "the server is away"};
    return whole_.read(offset, to);
  }

 private:
  test::MemoryAccess whole_;
  const std::atomic<bool>& fails_;
  std::atomic<int>& tries_;
};

class TileLoaderTest : public testing::Test {
 protected:
  LoadedTile next() {
    std::optional<LoadedTile> tile;
    EXPECT_TRUE(test::eventually([&] { return (tile = loader_.take()).has_value(); }));
    return tile.value_or(LoadedTile{});
  }
  ThreadWatch watch_;
  SteppedClock clock_;
  TileLoader loader_{watch_, clock_};
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

TEST_F(TileLoaderTest, SaysOnceForAPictureWhatCannotBeReadAndDoesNotTryItAtOnceAgain) {
  std::string bytes = test::pyramidBytes();
  // The compressed tiles of level 0, which begin at byte 16, are replaced by noise; the coarsest
  // level remains readable.
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

TEST_F(TileLoaderTest, TriesATileThatCannotBeReadAgainAfterTenSeconds) {
  std::atomic<bool> fails = true;
  std::atomic<int> tries = 0;
  auto file = image::PyramidFile::read(
      std::make_unique<FlakyAccess>(test::pyramidBytes(), fails, tries), "test.tif");
  const std::shared_ptr<const Picture> picture = *makePicture(*std::move(file), ShowAs::kPlane);
  loader_.ask(picture, std::vector<TilePlace>{{0, 0, 0}});
  EXPECT_TRUE(next().pixels.empty());
  EXPECT_FALSE(loader_.isLoading()) << "the wall need not wait for it";
  const int tried = tries;
  clock_.advance(TileLoader::kTryAgain);
  ASSERT_TRUE(test::eventually([&] { return tries > tried && !loader_.isLoading(); }));
  EXPECT_FALSE(loader_.hasLoaded()) << "the wall was told of it once";
  fails = false;
  clock_.advance(TileLoader::kTryAgain);
  EXPECT_EQ(next().pixels.size(), image::kTileBytes) << "nobody had to ask for it again";
  EXPECT_EQ(loader_.takeFaults().size(), 1U);
}

}  // namespace
}  // namespace merlin::render::content
