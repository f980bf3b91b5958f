// The reader of pyramids: which files it accepts, and that no file makes it crash, loop or use much
// memory.
#include "render/image/pyramid_file.h"

#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/support/count_allocations.h"
#include "tests/support/pyramids.h"
#include "tests/support/temp_dir.h"

namespace merlin::render::image {
namespace {

using test::directoriesOf;
using test::fieldAt;
using test::numberAt;
using test::pyramidBytes;
using test::readPyramid;

std::vector<std::uint8_t> tileOf(const std::string& bytes, const TilePlace& place) {
  const auto file = readPyramid(bytes);
  EXPECT_TRUE(file) << file.error().what;
  PyramidReader reader(*file);
  std::vector<std::uint8_t> rgba(kTileBytes);
  const auto read = reader.readTile(place, rgba);
  EXPECT_TRUE(read) << read.error().what;
  return rgba;
}

std::string errorOf(std::string bytes) {
  const auto file = readPyramid(std::move(bytes));
  return file ? "" : file.error().what;
}

TEST(PyramidFile, HasTheLevelsThatWereWritten) {
  for (const bool subdirectories : {false, true}) {
    const auto file = readPyramid(pyramidBytes({.subdirectories = subdirectories}));
    ASSERT_TRUE(file) << file.error().what;
    const auto levels = (*file)->levels();
    ASSERT_EQ(levels.size(), 3U);
    EXPECT_EQ(levels[0].width, 600);
    EXPECT_EQ(levels[0].columns, 3);
    EXPECT_EQ(levels[0].rows, 2);
    EXPECT_EQ(levels[2].width, 150);
    EXPECT_EQ(levels[2].height, 75);
    EXPECT_FALSE((*file)->isPanorama());
  }
}

TEST(PyramidFile, IsAPanoramaWhereItsDescriptionSaysSo) {
  EXPECT_TRUE((*readPyramid(pyramidBytes({.description = kPanoramaMark})))->isPanorama());
}

TEST(PyramidReader, ReadsThePixelsOfATileAndRepeatsTheEdges) {
  const auto rgba = tileOf(pyramidBytes(), {0, 2, 1});  // in 88 x 44 pixels of the picture
  const auto at = [&](std::size_t x, std::size_t y) { return &rgba[4 * (256 * y + x)]; };
  EXPECT_EQ(at(0, 0)[0], 512 % 256);
  EXPECT_EQ(at(5, 7)[0], 517 % 256);
  EXPECT_EQ(at(5, 7)[1], 263 % 256);
  EXPECT_EQ(at(5, 7)[2], 128);
  EXPECT_EQ(at(5, 7)[3], 255);
  EXPECT_EQ(at(200, 7)[0], 599 % 256);
  EXPECT_EQ(at(5, 200)[1], 299 % 256);
}

TEST(PyramidReader, ReadsQuartersOfTilesOf512) {
  const std::string small = pyramidBytes(), large = pyramidBytes({.tile = 512});
  for (const TilePlace& place : {TilePlace{0, 1, 0}, TilePlace{0, 2, 1}, TilePlace{0, 0, 1}})
    EXPECT_EQ(tileOf(small, place), tileOf(large, place));
}

TEST(PyramidReader, ShowsATileThatIsLeftOutAsBlack) {
  std::string bytes = pyramidBytes();
  const std::size_t directory = directoriesOf(bytes)[0];
  const std::size_t offsets = numberAt(bytes, fieldAt(bytes, directory, 324));
  const std::size_t sizes = numberAt(bytes, fieldAt(bytes, directory, 325));
  test::detail::putAt(bytes, offsets, 0);
  test::detail::putAt(bytes, sizes, 0);
  const auto rgba = tileOf(bytes, {0, 0, 0});
  EXPECT_EQ(rgba[0], 0);
  EXPECT_EQ(rgba[3], 255);
}

TEST(PyramidFile, RefusesOtherFilesWithTheWayOut) {
  EXPECT_EQ(errorOf("\x89PNG and more"),
            "test.tif: is not a TIFF file; make a new one: merlin image import IN -o OUT.tif");
  EXPECT_NE(errorOf(std::string("II\52\0\10\0\0\0\0\0\0\0\0\0\0\0", 16)).find("not a BigTIFF"),
            std::string::npos);
  EXPECT_NE(errorOf(std::string("MM\0\53\0\10\0\0\0\0\0\0\0\0\0\0", 16)).find("little-endian"),
            std::string::npos);
  EXPECT_NE(errorOf("").find("not a TIFF"), std::string::npos);
}

TEST(PyramidFile, EndsAtALoopOfDirectories) {
  std::string bytes = pyramidBytes();
  const auto directories = directoriesOf(bytes);
  const std::size_t last = directories.back();
  test::detail::putAt(bytes, last + 8 + 20 * numberAt(bytes, last), directories[0]);
  EXPECT_NE(errorOf(bytes).find("level 3"), std::string::npos) << errorOf(bytes);
  EXPECT_NE(errorOf(bytes).find("600 x 300 pixels, which is not half of 150 x 75"),
            std::string::npos);
}

TEST(PyramidFile, EndsAtALoopOfSinglePixels) {
  std::string bytes = pyramidBytes({.width = 1, .height = 1});
  const std::size_t only = directoriesOf(bytes)[0];
  test::detail::putAt(bytes, only + 8 + 20 * numberAt(bytes, only), only);
  EXPECT_NE(errorOf(bytes).find("loop"), std::string::npos) << errorOf(bytes);
}

TEST(PyramidFile, RefusesAPictureThatLiesAboutItsSize) {
  std::string bytes = pyramidBytes({.width = 200, .height = 100});
  test::detail::putAt(bytes, fieldAt(bytes, directoriesOf(bytes)[0], 256), 1 << 20);
  EXPECT_NE(
      errorOf(bytes).find("level 0: has 1048576 x 100 pixels, which are 4096 tiles, and lists "
                          "the places of 1"),
      std::string::npos)
      << errorOf(bytes);
}

// The header declares 400,000 x 250,000 pixels, but the file does not have the tiles.
TEST(PyramidFile, RefusesAHeaderOf100GigapixelsWithFewTiles) {
  std::string bytes = pyramidBytes();
  const std::size_t directory = directoriesOf(bytes)[0];
  test::detail::putAt(bytes, fieldAt(bytes, directory, 256), 400'000);
  test::detail::putAt(bytes, fieldAt(bytes, directory, 257), 250'000);
  test::largest_allocation = 0;
  EXPECT_NE(errorOf(bytes), "");
  // Now the tables have as many entries as the header implies, and therefore extend beyond the end
  // of the file.
  for (const int tag : {324, 325})
    test::detail::putAt(bytes, fieldAt(bytes, directory, tag) - 8, 1563 * 977);
  EXPECT_NE(errorOf(bytes).find("end beyond the file's"), std::string::npos) << errorOf(bytes);
  EXPECT_LE(test::largest_allocation, bytes.size() + 1) << "the test's own copy";
}

TEST(PyramidFile, RefusesAPyramidThatStopsTooEarly) {
  std::string bytes = pyramidBytes({.width = 3000, .height = 1500});
  const std::size_t first = directoriesOf(bytes)[0];
  test::detail::putAt(bytes, first + 8 + 20 * numberAt(bytes, first), 0);
  EXPECT_NE(errorOf(bytes).find("is the coarsest, and has 3000 x 1500 pixels"), std::string::npos);
}

TEST(PyramidReader, RefusesATileThatDecodesToAnotherSize) {
  std::string bytes = pyramidBytes();
  const std::size_t directory = directoriesOf(bytes)[0];
  const std::size_t offsets = numberAt(bytes, fieldAt(bytes, directory, 324));
  std::vector<std::uint8_t> few(1000);
  uLongf size = compressBound(few.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, few.data(), few.size(), 1);
  bytes.replace(numberAt(bytes, offsets), size, packed, 0, size);
  const auto file = readPyramid(bytes);
  ASSERT_TRUE(file);
  std::vector<std::uint8_t> rgba(kTileBytes);
  const auto read = PyramidReader(*file).readTile({0, 0, 0}, rgba);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::kMalformed);
  EXPECT_NE(read.error().what.find("test.tif: level 0, tile 0 of row 0: deflate"),
            std::string::npos)
      << read.error().what;
}

// Reads everything in a file, whatever its bytes are.
void readAll(std::string bytes) {
  const auto file = readPyramid(std::move(bytes));
  if (!file) return;
  PyramidReader reader(*file);
  std::vector<std::uint8_t> rgba(kTileBytes);
  int level = 0;
  for (const PyramidLevel& l : (*file)->levels()) {
    for (const auto& [column, row] :
         {std::pair{std::int64_t{0}, std::int64_t{0}}, {l.columns - 1, l.rows - 1}}) {
      const auto read = reader.readTile(
          {level, static_cast<std::int32_t>(column), static_cast<std::int32_t>(row)}, rgba);
      static_cast<void>(read);
    }
    ++level;
  }
}

// Returns a pyramid of two levels that is small enough to damage each of its bytes: its tiles
// compress well.
std::string smallFile() {
  return pyramidBytes({.width = 300, .height = 2, .colour = [](int, int) {
                         return test::Rgb{9, 9, 9};
                       }});
}

TEST(PyramidFile, EveryPrefixIsAnErrorOrReadsAsFarAsItGoes) {
  const std::string whole = smallFile();
  for (std::size_t length = 0; length < whole.size(); ++length) readAll(whole.substr(0, length));
  // The last directory ends the file.
  EXPECT_NE(errorOf(whole.substr(0, whole.size() - 1)), "");
}

TEST(PyramidFile, EveryDamagedByteIsAnErrorOrReads) {
  const std::string whole = smallFile();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int flip : {0x01, 0xFF}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      readAll(std::move(damaged));
    }
  }
}

TEST(PyramidFile, IsReadFromAFileThatIsCutMeanwhile) {
  const test::TempDir folder;
  const std::string path = folder.path() + "/picture.tif";
  std::ofstream(path, std::ios::binary) << pyramidBytes();
  const auto file = PyramidFile::open(path);
  ASSERT_TRUE(file);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << "cut";
  std::vector<std::uint8_t> rgba(kTileBytes);
  const auto read = PyramidReader(*file).readTile({0, 0, 0}, rgba);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().what.find(path), std::string::npos) << read.error().what;
}

TEST(PyramidFile, NamesAFileThatIsNotThereOrIsAFolder) {
  const auto missing = PyramidFile::open("/nowhere/x.tif");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
  const auto folder = PyramidFile::open("/tmp");
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().what, "/tmp: is not a regular file");
}

}  // namespace
}  // namespace merlin::render::image
