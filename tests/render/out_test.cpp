// Outputs: the frame in shared memory as another process reads it, and PNG files as libpng reads
// them.
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>
#include <tuple>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "daemon/base/random.h"
#include "render/image/png_writer.h"
#include "render/out/png_output.h"
#include "render/out/shared_frame.h"
#include "tests/support/eventually.h"
#include "tests/support/pictures.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using test::Image;
using Pixels = std::vector<std::uint8_t>;

tiles::TilePlan smallPlan() {
  tiles::TilesSettings s;
  s.tile_width = 64;
  s.tile_height = 48;
  s.frame_width = 128;
  s.frame_height = 96;
  for (tiles::TileSettings& t : s.tiles) {
    t.x /= 10;
    t.y /= 10;
  }
  return *tiles::planTiles(s);
}

constexpr std::size_t kFrameBytes = 4 * 128 * 96;
const SystemClock kClock;

// Presents a frame that has the size of smallPlan().
void present(out::Output& output, const Pixels& pixels, const out::FrameInfo& info) {
  EXPECT_TRUE(output.present({128, 96, pixels}, info));
}

// Returns frame n, in which every byte is n, except for the first byte of each row, which is the
// row's number.
Pixels frameOf(std::uint64_t n) {
  Pixels pixels(kFrameBytes, static_cast<std::uint8_t>(n));
  for (std::size_t y = 0; y < 96; ++y) pixels[y * 4 * 128] = static_cast<std::uint8_t>(y);
  return pixels;
}

Pixels noise(std::size_t bytes, std::uint64_t seed) {
  Random random(seed);
  Pixels pixels(bytes);
  for (std::uint8_t& b : pixels) b = static_cast<std::uint8_t>(random.next());
  for (std::size_t i = 3; i < bytes; i += 4) pixels[i] = 255;
  return pixels;
}

Image readPng(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&png, path.c_str())) << png.message;
  png.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.resize(PNG_IMAGE_SIZE(png));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr)) << png.message;
  return image;
}

std::string name(const std::string& what) { return "/" + test::privateName(what); }

TEST(Framebuffer, GivesTheNewestFrameWithWhatIsKnownOfIt) {
  const auto sink = out::SharedFrameOutput::make(name("fb"), smallPlan(), 1, kClock);
  ASSERT_TRUE(sink) << sink.error().what;
  EXPECT_EQ(out::captureFrame(name("fb")).error().code, Errc::kTimeout);  // no frame yet
  for (std::uint64_t n = 1; n <= 8; ++n) {
    present(**sink, frameOf(n),
            {n, fromNanoseconds(1000), static_cast<std::uint32_t>(10 * n), n == 7});
    const auto frame = out::captureFrame(name("fb"));
    ASSERT_TRUE(frame) << frame.error().what;
    EXPECT_EQ(frame->pixels, frameOf(n));
    EXPECT_EQ(frame->info.sequence, n);
    EXPECT_EQ(frame->info.cost, 10 * n);
    EXPECT_EQ(frame->info.full_detail, n == 7);
    EXPECT_EQ(toNanoseconds(frame->info.finished), 1000);
  }
}

TEST(Framebuffer, ReadsBackWhatOthersRead) {
  const auto sink = out::SharedFrameOutput::make(name("back"), smallPlan(), 7, kClock);
  ASSERT_TRUE(sink) << sink.error().what;
  EXPECT_FALSE((*sink)->readBack()) << "no frame yet";
  const Pixels pixels = noise(kFrameBytes, 3);
  present(**sink, pixels, {1, {}, 1, true});
  const auto read = (*sink)->readBack();
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ(read->at(0).found.kind, out::FoundPicture::Kind::kPixels);
  EXPECT_EQ(read->at(0).found.digest, out::digestOf({128, 96, pixels, 512}));
}

// The other generation may be that of a second daemon with the same name.
TEST(Framebuffer, AnotherGenerationUnderItsNameIsForeign) {
  const auto sink = out::SharedFrameOutput::make(name("mine"), smallPlan(), 7, kClock);
  ASSERT_TRUE(sink) << sink.error().what;
  present(**sink, noise(kFrameBytes, 3), {1, {}, 1, true});
  const int file = ::shm_open(name("mine").c_str(), O_RDWR, 0);
  ASSERT_GE(file, 0);
  void* const at = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  ASSERT_NE(at, MAP_FAILED);
  static_cast<out::framebuffer::Header*>(at)->generation = 8;
  ::munmap(at, 4096);
  EXPECT_EQ((*sink)->readBack()->at(0).found.kind, out::FoundPicture::Kind::kForeign);
}

TEST(Framebuffer, WallIsItsTilesSideBySideWithoutTheOperators) {
  const auto sink = out::SharedFrameOutput::make(name("wall"), smallPlan(), 1, kClock);
  const Pixels pixels = noise(kFrameBytes, 3);
  present(**sink, pixels, {1, {}, 1, true});
  const Image frame{128, 96, pixels};
  const out::CapturedFrame captured = out::wallPicture(*out::captureFrame(name("wall")));
  const Image wall{captured.width, captured.height, captured.pixels};
  ASSERT_EQ(wall.width, 3 * 64);
  ASSERT_EQ(wall.height, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(wall.at(x, y), frame.at(x, y));            // left tile: upper left of the frame
      ASSERT_EQ(wall.at(64 + x, y), frame.at(64 + x, y));  // centre tile: upper right of the frame
      ASSERT_EQ(wall.at(128 + x, y), frame.at(x, 48 + y));
    }
  }
}

TEST(Framebuffer, WallHasRowsAndColumns) {
  tiles::TilePlan plan = smallPlan();
  const std::pair<int, int> places[] = {{0, 48}, {64, 0}, {64, 48}, {-1, -1}};
  for (std::size_t i = 0; i < 4; ++i)
    std::tie(plan.tiles[i].wall_x, plan.tiles[i].wall_y) = places[i];
  plan.wall_width = 128;
  plan.wall_height = 96;
  const auto sink = out::SharedFrameOutput::make(name("rows"), plan, 1, kClock);
  const Pixels pixels = noise(kFrameBytes, 3);
  present(**sink, pixels, {1, {}, 1, true});
  const Image frame{128, 96, pixels};
  const out::CapturedFrame captured = out::wallPicture(*out::captureFrame(name("rows")));
  const Image wall{captured.width, captured.height, captured.pixels};
  ASSERT_EQ(wall.width, 128);
  ASSERT_EQ(wall.height, 96);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(wall.at(x, y), test::Rgba{}) << "no tile";
      ASSERT_EQ(wall.at(x, 48 + y), frame.at(x, y));
      ASSERT_EQ(wall.at(64 + x, y), frame.at(64 + x, y));
      ASSERT_EQ(wall.at(64 + x, 48 + y), frame.at(x, 48 + y));
    }
  }
}

TEST(Framebuffer, SaysWhichEyeATileIsDrawnFor) {
  tiles::TilePlan plan = smallPlan();
  plan.tiles[1].eye = tiles::Eye::kLeft;
  plan.tiles[2].eye = tiles::Eye::kRight;
  const auto sink = out::SharedFrameOutput::make(name("eyes"), plan, 1, kClock);
  present(**sink, noise(kFrameBytes, 3), {1, {}, 1, true});
  const auto frame = out::captureFrame(name("eyes"));
  ASSERT_TRUE(frame);
  const std::uint32_t expected[] = {0, 1, 2, 0};
  ASSERT_EQ(frame->tiles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(frame->tiles[i].eye, expected[i]) << i;
}

TEST(Framebuffer, ReaderNeverSeesTwoFramesInOne) {
  const auto sink = out::SharedFrameOutput::make(name("torn"), smallPlan(), 1, kClock);
  present(**sink, frameOf(1), {1, {}, 1, false});
  std::jthread writer([&](const std::stop_token& stop) {
    for (std::uint64_t n = 2; !stop.stop_requested(); ++n)
      present(**sink, frameOf(n), {n, {}, 1, false});
  });
  int seen = 0;
  for (int i = 0; i < 20000 && seen < 300; ++i) {
    const auto frame = out::captureFrame(name("torn"));
    if (!frame) continue;  // the writer overtook the reader
    ++seen;
    ASSERT_EQ(frame->pixels, frameOf(frame->info.sequence));
  }
  EXPECT_GT(seen, 0);
}

TEST(Framebuffer, IsGoneWithItsWriterAndThereCanBeOnlyOne) {
  {
    const auto sink = out::SharedFrameOutput::make(name("one"), smallPlan(), 1, kClock);
    const auto second = out::SharedFrameOutput::make(name("one"), smallPlan(), 2, kClock);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, Errc::kBusy);
  }
  EXPECT_EQ(out::captureFrame(name("one")).error().code, Errc::kNotFound);
}

// Reads a framebuffer as a malicious program might leave it, a valid header changed by `damage`;
// returns the error.
template <typename Damage>
Error captureDamaged(Damage damage) {
  const std::string at = name("bad");
  const std::size_t size = 4096 + 3 * kFrameBytes;
  auto memory = SharedMemory::create(at, size);
  auto& h = *new (memory->data()) out::framebuffer::Header{};
  h.magic = out::framebuffer::kMagic;
  h.version = out::framebuffer::kVersion;
  h.size = size;
  h.width = h.wall_width = 128;
  h.height = h.wall_height = 96;
  h.stride = 4 * 128;
  h.format = out::framebuffer::kFormatRgba8;
  h.tile_count = 1;
  h.tiles[0] = {"a", 0, 0, 0, 128, 96, 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    h.buffers[i].offset = 4096 + i * kFrameBytes;
    h.buffers[i].sequence = 1;
  }
  damage(h);
  const auto frame = out::captureFrame(at);
  return frame ? Error{Errc::kIo, "none"} : frame.error();
}

// The Python reader knows only the table of fields, and nothing specific to this segment.
TEST(Framebuffer, DescribesItself) {
  const auto sink = out::SharedFrameOutput::make(name("table"), smallPlan(), 1, kClock);
  ASSERT_TRUE(sink);
  present(**sink, frameOf(7), {7, {}, 5, true});
  const auto out = test::run({"python3", "-B", MERLIN_SOURCE_DIR "/daemon/shm/read_merlin.py",
                              name("table").substr(1), "frame.width", "frame.stride",
                              "buffer.sequence", "buffer.offset", "tile.wall_x", "tile.name"});
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_EQ(out.output.find("frame.width [128] px\n"), 0u) << out.output;
  EXPECT_NE(out.output.find("frame.stride [512] B\n"), std::string::npos);
  EXPECT_NE(out.output.find("buffer.sequence [7, 0, 0]"), std::string::npos) << out.output;
  EXPECT_NE(out.output.find("tile.name ['" + smallPlan().tiles[0].name + "'"), std::string::npos)
      << out.output;
}

// Another program of the same user has overwritten the segment.
TEST(Framebuffer, RubbishOverTheHeaderDoesNotLeadTheWriterAstray) {
  const auto sink = out::SharedFrameOutput::make(name("rubbish"), smallPlan(), 1, kClock);
  ASSERT_TRUE(sink);
  const UniqueFd other(::shm_open(name("rubbish").c_str(), O_RDWR | O_CLOEXEC, 0));
  ASSERT_TRUE(other.valid());
  const std::vector<char> rubbish(sizeof(out::framebuffer::Header), '\xa5');
  ASSERT_EQ(::pwrite(other.get(), rubbish.data(), rubbish.size(), 0),
            static_cast<ssize_t>(rubbish.size()));
  for (std::uint64_t n = 1; n <= 3; ++n) present(**sink, frameOf(n), {n, {}, 1, false});
  const auto memory = SharedMemory::open(name("rubbish"));
  const auto pixels = frameOf(3);
  EXPECT_EQ(std::memcmp(memory->data() + memory->size() - kFrameBytes, pixels.data(), kFrameBytes),
            0)
      << "the third frame lies in the third buffer";
}

TEST(Framebuffer, DamagedHeadersAreRefused) {
  using Header = out::framebuffer::Header;
  EXPECT_EQ(captureDamaged([](Header&) {}).what, "none");
  EXPECT_EQ(captureDamaged([](Header& h) { h.magic = 1; }).code, Errc::kMalformed);
  const Error version = captureDamaged([](Header& h) { h.version = 9; });
  EXPECT_EQ(version.code, Errc::kUnsupported);
  EXPECT_NE(version.what.find("is version 9, but this program reads version 4"), std::string::npos);
  const std::vector<void (*)(Header&)> damages = {
      [](Header& h) { h.format = 2; },
      [](Header& h) { h.stride = 4; },
      [](Header& h) {
        h.width = 0x40000000;
        h.stride = 0;
      },
      [](Header& h) { h.height = 97; },
      [](Header& h) { h.tile_count = 33; },
      [](Header& h) { h.buffers[2].offset += 1; },
      [](Header& h) { h.buffers[0].offset = ~std::uint64_t{0}; },
      [](Header& h) { h.tiles[0].width = 129; },
      [](Header& h) { h.tiles[0].x = -1; },
      [](Header& h) { h.tiles[0].height = -5; },
      [](Header& h) { h.tiles[0].wall_x = 1; },
      [](Header& h) { h.tiles[0].wall_y = 1; },
      [](Header& h) { h.tiles[0].wall_x = -1; },
      [](Header& h) { h.tiles[0].wall_y = -1; },
      [](Header& h) { h.tiles[0].wall_x = h.tiles[0].wall_y = -2; },
      [](Header& h) { h.wall_width = 0x80000000; },
      [](Header& h) { h.wall_height = 0x80000000; },
      [](Header& h) { h.tiles[0].x = 0x7fffffff; },
  };
  for (std::size_t i = 0; i < damages.size(); ++i)
    EXPECT_EQ(captureDamaged(damages[i]).code, Errc::kMalformed) << i;
}

TEST(Png, KeepsEachPixelAndIsTheSameBytesEachTime) {
  const test::TempDir folder;
  const Pixels pixels = noise(std::size_t{4} * 37 * 21, 1);
  ASSERT_TRUE(image::writePng(folder / "a.png", 37, 21, pixels));
  ASSERT_TRUE(image::writePng(folder / "b.png", 37, 21, pixels));
  const Image image = readPng(folder / "a.png");
  EXPECT_EQ(image.width, 37);
  EXPECT_EQ(image.height, 21);
  EXPECT_EQ(image.pixels, pixels);
  EXPECT_EQ(test::readText(folder / "a.png"), test::readText(folder / "b.png"));
}

TEST(Png, NamesTheFileThatCannotBeWritten) {
  const auto written = image::writePng("/nowhere/at/all.png", 1, 1, Pixels(4));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kNotFound);
  EXPECT_NE(written.error().what.find("/nowhere/at/all.png"), std::string::npos);
}

// A limit of 2 kB on the size of a file simulates a full disk.
TEST(Png, FullDiskLeavesNothingHalfWritten) {
  const test::TempDir folder;
  ASSERT_NE(::signal(SIGXFSZ, SIG_IGN), SIG_ERR);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit little{2000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &little), 0);
  const auto written =
      image::writePng(folder / "a.png", 64, 64, noise(std::size_t{4} * 64 * 64, 2));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kIo);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Destroying the output waits until the last accepted frame is written.
TEST(PngOutput, WritesNoMoreOftenThanAsked) {
  const test::TempDir folder;
  const std::string path = folder / "frame.png";
  ThreadWatch watch;
  const auto present = [](out::PngOutput& output, std::uint8_t n, int seconds) {
    const Pixels pixels(std::size_t{4} * 16 * 16, n);
    return output.present({16, 16, pixels}, {n, Timestamp{std::chrono::seconds(seconds)}, 1, true});
  };
  const auto red = [&] { return readPng(path).at(0, 0).red; };
  {
    out::PngOutput output(path, 60, watch);
    EXPECT_EQ(*present(output, 1, 1000), Timestamp{std::chrono::seconds(1000)});
    ASSERT_TRUE(test::eventually([&] { return std::filesystem::exists(path); }));
    EXPECT_EQ(*present(output, 2, 1059), std::nullopt) << "left out";
  }
  EXPECT_EQ(red(), 1);
  out::PngOutput output(path, 60, watch);
  ASSERT_TRUE(present(output, 3, 1000));
  // A frame is skipped while the encoder works, so present later frames until one is accepted.
  int seconds = 1060;
  EXPECT_TRUE(test::eventually([&] { return present(output, 4, seconds += 60) && red() == 4; }));
}

// Otherwise, if a motion ended within the interval, the file would keep a frame of the motion.
TEST(PngOutput, WantsAFrameOnceItMayTakeOneIfItLeftOutTheLast) {
  const test::TempDir folder;
  ThreadWatch watch;
  std::atomic<int> written = 0;
  out::PngOutput output(folder / "frame.png", 60, watch,
                        [&](const std::string&, int, int, std::span<const std::uint8_t>) {
                          ++written;
                          return Result<Ok>(Ok{});
                        });
  const auto at = [](int seconds) { return Timestamp{std::chrono::seconds(seconds)}; };
  const Pixels pixels(std::size_t{4} * 16 * 16);
  ASSERT_TRUE(output.present({16, 16, pixels}, {1, at(1000), 1, true}));
  EXPECT_FALSE(output.wantsFrame(at(1100))) << "it has the newest";
  ASSERT_TRUE(output.present({16, 16, pixels}, {2, at(1030), 1, true}));
  EXPECT_FALSE(output.wantsFrame(at(1059)));
  EXPECT_TRUE(output.wantsFrame(at(1060)));
  EXPECT_TRUE(test::eventually([&] { return written == 1; }));
  ASSERT_TRUE(output.present({16, 16, pixels}, {2, at(1060), 1, true}));
  EXPECT_FALSE(output.wantsFrame(at(2000)));
}

TEST(PngOutput, SaysWhatWentWrongUntilAFileIsWrittenAgain) {
  const test::TempDir folder;
  const std::string path = folder / "made/frame.png";
  ThreadWatch watch;
  out::PngOutput output(path, 0, watch);
  const Pixels pixels(std::size_t{4} * 16 * 16);
  std::uint64_t n = 0;
  const auto present = [&] {
    return output.present({16, 16, pixels}, {++n, fromNanoseconds(static_cast<int>(n)), 1, true});
  };
  EXPECT_TRUE(present()) << "nothing is known of the file yet";
  ASSERT_TRUE(test::eventually([&] { return !present(); }));
  EXPECT_NE(present().error().what.find(path), std::string::npos);
  std::filesystem::create_directory(folder / "made");
  EXPECT_TRUE(test::eventually([&] { return bool{present()}; }));
}

}  // namespace
}  // namespace merlin::render
