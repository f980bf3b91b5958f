// Pictures from the file to the wall: import, show, slides, and files that are damaged, change or
// vanish.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "render/image/image_file.h"
#include "render/image/pyramid_file.h"
#include "tests/support/picture_files.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

// Writes a binary PPM file with the colours that `colour` computes.
template <typename Colour>
void writePpm(const std::string& path, int width, int height, const Colour& colour) {
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << width << " " << height << "\n255\n";
  std::string row;
  for (int y = 0; y < height; ++y) {
    row.clear();
    for (int x = 0; x < width; ++x) {
      for (const int c : colour(x, y)) row.push_back(static_cast<char>(c));
    }
    out << row;
  }
}

std::array<int, 3> plain(int red, int green, int blue) { return {red, green, blue}; }

Outcome import(const std::string& in, const std::string& out, std::vector<std::string> more = {}) {
  std::vector<std::string> command = {kMerlin, "image", "import", in, "-o", out};
  command.insert(command.end(), more.begin(), more.end());
  return run(command);
}

// Returns the number of files in the folder, including hidden ones.
std::size_t filesIn(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(ImageImport, MakesAPyramidOfAPictureAsLargeAsThoseOf1998) {
  const TempDir dir;
  writePpm(dir / "in.ppm", 7000, 4000, [](int x, int y) { return plain(x / 28, y / 16, 90); });
  const Outcome made = import(dir / "in.ppm", dir / "out.tif", {"--json"});
  ASSERT_EQ(made.status, 0) << made.output;
  const auto json = nlohmann::json::parse(made.output.substr(made.output.rfind("{\"")));
  EXPECT_EQ(json["width"], 7000);
  EXPECT_EQ(json["height"], 4000);
  EXPECT_EQ(json["levels"], 6);
  EXPECT_EQ(json["kind"], "picture");
  EXPECT_GT(json["pixels_per_s"], 0);
  EXPECT_GT(json["peak_memory_bytes"], 1'000'000);
  EXPECT_EQ(filesIn(dir.path()), 2U) << "nothing else is left";
  const Outcome info = run({kMerlin, "image", "info", dir / "out.tif"});
  EXPECT_EQ(info.status, 0);
  EXPECT_NE(info.output.find("picture of 7000 x 4000 pixels"), std::string::npos) << info.output;
}

TEST(ImageImport, MarksAPanoramaAndIsLosslessWhereAsked) {
  const TempDir dir;
  writePpm(dir / "in.ppm", 800, 400, [](int x, int y) { return plain(x % 256, y % 256, 7); });
  ASSERT_EQ(import(dir / "in.ppm", dir / "a.tif", {"--panorama", "--quality", "0"}).status, 0);
  const Outcome info = run({kMerlin, "image", "info", dir / "a.tif", "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.output)["kind"], "panorama");
}

// Returns a FITS image of one row of 16-bit numbers.
std::string fits16(const std::vector<std::int16_t>& values) {
  std::string file;
  const auto card = [&](std::string text) {
    text.resize(80, ' ');
    file += text;
  };
  card("SIMPLE  =                    T");
  card("BITPIX  =                   16");
  card("NAXIS   =                    2");
  card(fmt::format("NAXIS1  = {:20}", values.size()));
  card("NAXIS2  =                    1");
  card("END");
  file.resize(2880, ' ');
  for (const std::int16_t v : values) {
    file += static_cast<char>(v >> 8);
    file += static_cast<char>(v & 0xFF);
  }
  file.resize(2 * 2880, '\0');
  return file;
}

// Returns a binary PGM image of one row of 16-bit values.
std::string pgm16(const std::vector<int>& values) {
  std::string file = fmt::format("P5\n{} 1\n65535\n", values.size());
  for (const int v : values) {
    file += static_cast<char>(v >> 8);
    file += static_cast<char>(v & 0xFF);
  }
  return file;
}

TEST(ImageImport, MeasuredValuesAreShownByTheirRangeWhichIsSaid) {
  const TempDir dir;
  const std::string in = dir / "in", out = dir / "out.tif";
  const auto shades = [&](const std::string& file, std::vector<std::string> more = {}) {
    writeText(in, file);
    more.insert(more.end(), {"--quality", "0", "--json"});
    const Outcome made = import(in, out, more);
    EXPECT_EQ(made.status, 0) << made.output;
    const auto json = nlohmann::json::parse(made.output.substr(made.output.rfind("{\"file")));
    const auto pyramid = render::image::PyramidFile::open(out);
    EXPECT_TRUE(pyramid) << pyramid.error().what;
    std::vector<std::uint8_t> rgba(render::image::kTileBytes);
    EXPECT_TRUE(render::image::PyramidReader(*pyramid).readTile({}, rgba));
    std::vector<int> first;  // size of each pixel
    for (int x = 0; x < json["width"]; ++x) first.push_back(rgba[4 * static_cast<std::size_t>(x)]);
    return std::pair(first, json["notes"].dump());
  };
  using Shades = std::vector<int>;
  const auto [found, note] = shades(fits16({-100, 0, 400, 900}));
  EXPECT_EQ(found, (Shades{0, 26, 128, 255}));
  EXPECT_NE(note.find("values from -100 (black) to 900 (white) are shown"), std::string::npos)
      << note;
  const auto [given, no_note] = shades(fits16({-100, 0, 400, 900}), {"--range", "0", "800"});
  EXPECT_EQ(given, (Shades{0, 0, 128, 255}));
  EXPECT_EQ(no_note, "[]");
  EXPECT_EQ(shades(pgm16({0, 1000, 4000})).first, (Shades{0, 64, 255})) << "12 bits of 16";
  EXPECT_EQ(shades(pgm16({0, 1000, 65535})).first, (Shades{0, 3, 255})) << "grey as it is";
  const Outcome refused = import(in, out, {"--range", "5", "5"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("--range 5 5: the first value"), std::string::npos)
      << refused.output;
}

TEST(ImageImport, SaysWhatIsWrongAndLeavesNothing) {
  const TempDir dir;
  const std::string out = dir / "out.tif";
  const auto expectRefused = [&](const std::string& in, int status, const std::string& what,
                                 const std::vector<std::string>& more = {}) {
    const Outcome refused = import(in, out, more);
    EXPECT_EQ(refused.status, status) << in << ": " << refused.output;
    EXPECT_NE(refused.output.find(what), std::string::npos) << refused.output;
    EXPECT_FALSE(fs::exists(out));
  };
  writeText(dir / "text.jpg", "this is no picture");
  expectRefused(dir / "text.jpg", 2, "cannot be read as a picture");
  expectRefused(dir / "nothing.jpg", 2, "does not exist");
  expectRefused(dir.path(), 2, "is a folder; merlin show FOLDER shows its pictures as slides");
  writeText(dir / "film.mp4", std::string("\0\0\0\x18", 4) + "ftypisom" + std::string(500, 'x'));
  expectRefused(dir / "film.mp4", 2, "film.mp4: is a video; MERLIN shows models, pictures");
  writeText(dir / "cut.tif", std::string("II\x2b\0\x08\0\0\0", 8));
  expectRefused(dir / "cut.tif", 2, "cut.tif: cannot be read as a picture: it is damaged or cut");
  // The header declares 10^10 pixels, but the file contains very few.
  writeText(dir / "lies.ppm", "P6\n100000 100000\n255\n" + std::string(1000, 'x'));
  expectRefused(dir / "lies.ppm", 2, "it is cut short: it has fewer bytes than its header says");
  writePpm(dir / "good.ppm", 600, 400, [](int x, int) { return plain(x % 256, 0, 0); });
// The address sanitizer reserves terabytes of address space, so no limit can be set with it.
#if !defined(MERLIN_ADDRESS_SANITIZER)
  expectRefused(dir / "good.ppm", 2, "", {"--memory", "30M"});
#endif
  EXPECT_EQ(import(dir / "good.ppm", dir / "out.png").status, 2) << "it must end in .tif";
  EXPECT_EQ(import(dir / "good.ppm", dir / "no/out.tif").status, 2);
  EXPECT_EQ(import(dir / "good.ppm", out, {"--quality", "101"}).status, 2);
  EXPECT_EQ(filesIn(dir.path()), 5U);
}

TEST(ImageImport, APictureThatIsTooThinForAPyramidIsRefusedBeforeTheWork) {
  const TempDir dir;
  writePpm(dir / "thin.ppm", 9000, 2, [](int x, int) { return plain(x % 256, 0, 0); });
  const Outcome refused = import(dir / "thin.ppm", dir / "o.tif");
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("thin.ppm: 9000 x 2 pixels are too thin for a pyramid"),
            std::string::npos)
      << refused.output;
  EXPECT_NE(refused.output.find("the shorter side needs 4 pixels"), std::string::npos);
  writePpm(dir / "four.ppm", 9000, 4, [](int x, int) { return plain(x % 256, 0, 0); });
  const Outcome made = import(dir / "four.ppm", dir / "o.tif");
  EXPECT_EQ(made.status, 0) << made.output;
}

TEST(ImageImport, CtrlCLeavesNoHalfFile) {
  const TempDir dir;
  writePpm(dir / "in.ppm", 9000, 6000,
           [](int x, int y) { return plain((x * y) % 256, (x ^ y) % 256, x % 256); });
  Process importing(
      {kMerlin, "image", "import", dir / "in.ppm", "-o", dir / "out.tif", "--quality", "0"});
  EXPECT_TRUE(eventually([&] { return filesIn(dir.path()) > 1 || importing.ended(); }));
  EXPECT_EQ(importing.kill(SIGINT), 1) << importing.output();
  EXPECT_NE(importing.output().find("was stopped"), std::string::npos) << importing.output();
  EXPECT_EQ(filesIn(dir.path()), 1U) << "the input";
}

// A wall that shows the `contents` of the configuration.
class PictureWall : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    fs::create_directory(*dir_ / "slides");
    const auto make = [](const std::string& name, int width, int height,
                         const std::array<int, 3>& colour, std::vector<std::string> more = {}) {
      writePpm(*dir_ / "in.ppm", width, height, [&](int, int) { return colour; });
      const Outcome made = import(*dir_ / "in.ppm", *dir_ / name, std::move(more));
      EXPECT_EQ(made.status, 0) << made.output;
    };
    make("red.tif", 2000, 1500, {250, 0, 0});
    make("sky.tif", 1600, 800, {0, 0, 250}, {"--panorama"});
    make("slides/1-green.tif", 900, 600, {0, 250, 0});
    make("slides/2-grey.tif", 900, 600, {120, 120, 120});
    make("other.tif", 7000, 4000, {250, 250, 0});
  }
  static void TearDownTestSuite() { delete dir_; }

  void SetUp() override { start(); }
  void start() {
    m_.reset();
    nlohmann::json wall = {{"model", ""},
                           {"contents",
                            {{{"picture", *dir_ / "red.tif"}},
                             {{"picture", *dir_ / "sky.tif"}, {"name", "the sky"}},
                             {{"slides", *dir_ / "slides"}}}}};
    m_ = std::make_unique<Merlind>(*dir_, "", "pictures",
                                   MerlindOptions{.script = "still", .also = {{"wall", wall}}});
    ASSERT_TRUE(m_->ready()) << m_->process().output();
  }
  Outcome show(const std::string& what) {
    return run({kMerlin, "show", what, "--instance", m_->instance()});
  }
  // The path of a file in the content folder.
  std::string shared(const std::string& name) const {
    return *dir_ / (m_->instance() + ".shown/" + name);
  }
  Outcome next() { return run({kMerlin, "next_content", "--instance", m_->instance()}); }
  Outcome previous() { return run({kMerlin, "previous_content", "--instance", m_->instance()}); }
  bool isShown(const std::string& name, const std::string& kind, const std::string& slide = "") {
    return eventually([&] {
      const auto content = m_->status()["content"];
      return content["name"] == name && content["kind"] == kind && content["slide"] == slide;
    });
  }
  // Waits until the wall shows full detail and the middle of its middle tile has this colour; false
  // if that never happens.
  bool isColoured(const std::array<int, 3>& rgb) {
    return eventually([&] {
      if (!m_->status()["full_detail"]) return false;
      const std::string path = *dir_ / "frame.png";
      run({kMerlin, "snapshot", "-o", path, "--instance", m_->instance()});
      const auto frame = render::image::readImage(path);
      if (!frame) return false;
      const std::size_t middle = 3 * (std::size_t{240} * 1280 + 960);
      for (std::size_t k = 0; k < 3; ++k) {
        if (std::abs(frame->pixels[middle + k] - rgb[k]) > 6) return false;
      }
      return true;
    });
  }

  static TempDir* dir_;
  std::unique_ptr<Merlind> m_;
};
TempDir* PictureWall::dir_ = nullptr;

TEST_F(PictureWall, ShowsPicturesPanoramasSlidesAndFilesByName) {
  EXPECT_TRUE(isShown("red", "picture"));
  EXPECT_TRUE(isColoured({250, 0, 0}));
  EXPECT_EQ(m_->status()["content"]["detail"]["unit"], "kilotexels");
  EXPECT_EQ(show("the sky").status, 0);
  EXPECT_TRUE(isShown("the sky", "panorama"));
  EXPECT_TRUE(isColoured({0, 0, 250}));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "1-green"));
  EXPECT_TRUE(isColoured({0, 250, 0}));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "2-grey"));
  EXPECT_TRUE(isColoured({120, 120, 120}));
  EXPECT_EQ(previous().status, 0);
  EXPECT_TRUE(isShown("slides", "picture", "1-green"));
  EXPECT_TRUE(isColoured({0, 250, 0}));
  previous();
  EXPECT_TRUE(isShown("the sky", "panorama"));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "1-green"));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "2-grey"));
  next();
  EXPECT_TRUE(isShown("red", "picture"));
  const Outcome other = show(*dir_ / "other.tif");
  EXPECT_EQ(other.status, 0) << other.output;
  EXPECT_TRUE(isShown("other", "picture"));
  EXPECT_TRUE(isColoured({250, 250, 0}));
  next();
  EXPECT_TRUE(isShown("the sky", "panorama")) << "the list goes on where it was";
}

TEST_F(PictureWall, ShowsAModelThatIsNotInTheConfiguration) {
  const std::string model = makeModel(*dir_, 5);
  const Outcome shown = show(model);
  EXPECT_EQ(shown.status, 0) << shown.output;
  EXPECT_TRUE(isShown("model", "model"));
  EXPECT_EQ(m_->status()["content"]["detail"]["unit"], "triangles");
  EXPECT_EQ(show("red").status, 0);
  EXPECT_TRUE(isShown("red", "picture"));
}

// merlin image import writes its results into the content folder, and the wall shows them.
TEST_F(PictureWall, ShowsPicturesOfAnyFormatAndFoldersOfThemAsSlides) {
  writePpm(*dir_ / "violet.ppm", 300, 200, [](int, int) { return plain(140, 0, 250); });
  const Outcome picture = show(*dir_ / "violet.ppm");
  EXPECT_EQ(picture.status, 0) << picture.output;
  EXPECT_TRUE(isShown("violet", "picture"));
  EXPECT_TRUE(isColoured({140, 0, 250}));
  EXPECT_TRUE(fs::exists(shared("violet.tif")));

  const std::string talk = *dir_ / "talk";
  fs::create_directory(talk);
  fs::copy_file(*dir_ / "violet.ppm", talk + "/2.ppm");
  fs::copy_file(*dir_ / "red.tif", talk + "/1.tif");
  fs::copy_file(*dir_ / "slides/1-green.tif", talk + "/2.tif");
  writeText(talk + "/notes.txt", "what I want to say");
  const Outcome slides = show(talk + "/");
  EXPECT_EQ(slides.status, 0) << slides.output;
  EXPECT_NE(slides.output.find("notes.txt: "), std::string::npos) << slides.output;
  EXPECT_TRUE(isShown("talk", "picture", "1"));
  next();
  EXPECT_TRUE(isShown("talk", "picture", "2"));
  EXPECT_TRUE(isColoured({140, 0, 250}));
  next();
  EXPECT_TRUE(isShown("talk", "picture", "2.tif")) << "two names that differ by their ending";
  EXPECT_EQ(filesIn(shared("")), 2U) << "no work folder is left";
}

TEST_F(PictureWall, RefusesWhatItCannotShowAndStays) {
  const auto expectRefused = [&](const std::string& what, const std::string& why) {
    const Outcome refused = show(what);
    EXPECT_EQ(refused.status, 2) << what << ": " << refused.output;
    EXPECT_NE(refused.output.find(why), std::string::npos) << refused.output;
  };
  expectRefused("blue", "contents are red, the sky, slides");
  expectRefused(*dir_ / "missing.tif", "missing.tif: does not exist");
  writeText(*dir_ / "text.tif", "this is no picture");
  expectRefused(*dir_ / "text.tif", "text.tif: cannot be read as a picture");
  writeText(*dir_ / "text.mrm", "this is no model");
  expectRefused(*dir_ / "text.mrm", "text.mrm");
  fs::create_directory(*dir_ / "empty");
  expectRefused(*dir_ / "empty", "empty: has no picture");
  EXPECT_EQ(filesIn(shared("")), 0U) << "what cannot be shown does not stay";
  EXPECT_TRUE(isShown("red", "picture"));
  EXPECT_TRUE(isColoured({250, 0, 0}));
}

TEST_F(PictureWall, OpensAPictureOf100Gigapixels) {
  const std::string huge = *dir_ / "huge.tif";
  const Outcome made = run(
      {"python3", "-B", kSource + "/tests/support/sparse_pyramid.py", "400000", "250000", huge});
  ASSERT_EQ(made.status, 0) << made.output;
  const Outcome info = run({kMerlin, "image", "info", huge, "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.output)["height"], 250000);
  const Outcome shown = show(huge);
  EXPECT_EQ(shown.status, 0) << shown.output;
  EXPECT_TRUE(isShown("huge", "picture"));
  // At the limit of the zoom, one pixel of the picture covers eight by eight pixels of the wall.
  run({kMerlin, "wall", "--move=0 0 10 0 0 0", "--instance", m_->instance()});
  EXPECT_TRUE(eventually([&] { return m_->status()["full_detail"] == true; }));
}

TEST_F(PictureWall, FilesThatChangeOrVanishAreSaidAndTheWallStaysUp) {
  const std::string live = shared("live.tif"), going = shared("going");
  fs::copy_file(*dir_ / "other.tif", live, fs::copy_options::overwrite_existing);
  ASSERT_EQ(show(live).status, 0);
  EXPECT_TRUE(isColoured({250, 250, 0}));
  fs::copy_file(*dir_ / "slides/1-green.tif", live + ".new");
  fs::rename(live + ".new", live);
  EXPECT_TRUE(m_->process().saysEventually("picture " + live + " was replaced and is shown"));
  EXPECT_TRUE(isColoured({0, 250, 0}));
  writeText(live, "no picture");
  EXPECT_TRUE(m_->process().saysEventually("was replaced by one that cannot be shown"));
  fs::remove(live);
  EXPECT_TRUE(m_->process().saysEventually("is gone or is no longer a regular file"));
  EXPECT_TRUE(isColoured({0, 250, 0})) << "what was read stays";
  // This folder of slides vanishes while one of them is shown.
  fs::create_directory(going);
  fs::copy_file(*dir_ / "red.tif", going + "/a.tif");
  fs::copy_file(*dir_ / "sky.tif", going + "/b.tif");
  ASSERT_EQ(show(going).status, 0);
  EXPECT_TRUE(isShown("going", "picture", "a"));
  fs::remove_all(going);
  next();
  EXPECT_TRUE(m_->process().saysEventually("going: No such file or directory"));
  EXPECT_FALSE(m_->process().ended());
  EXPECT_TRUE(isShown("the sky", "panorama")) << "no further slide: the next content";
}

// The files appear after the start, as on a file server that is mounted later than the wall starts.
TEST_F(PictureWall, WhatIsNotThereAtTheStartIsLeftOutUntilItIs) {
  const auto hide = [](const char* name) { fs::rename(*dir_ / name, *dir_ / name + ".away"); };
  const auto bring = [](const char* name) { fs::rename(*dir_ / name + ".away", *dir_ / name); };
  EXPECT_EQ(show("the sky").status, 0);
  EXPECT_TRUE(isShown("the sky", "panorama"));
  ASSERT_EQ(m_->process().kill(SIGTERM), 0) << "the state has it";
  hide("sky.tif");
  hide("slides");
  start();
  EXPECT_TRUE(isShown("red", "picture"));
  EXPECT_TRUE(m_->process().saysEventually("sky.tif is left out until it can be read"));
  const Outcome early = show("the sky");
  EXPECT_EQ(early.status, 2) << early.output;
  EXPECT_NE(early.output.find("the sky cannot be shown until its file can be read"),
            std::string::npos)
      << early.output;
  next();
  EXPECT_TRUE(isShown("red", "picture")) << "there is no other";
  ASSERT_EQ(m_->process().kill(SIGTERM), 0);
  start();  // the content that was shown last is nevertheless remembered
  bring("sky.tif");
  bring("slides");
  EXPECT_TRUE(m_->process().saysEventually("sky.tif can be read now"));
  EXPECT_TRUE(m_->process().saysEventually("slides can be read now"));
  next();
  EXPECT_TRUE(isShown("the sky", "panorama"));
  EXPECT_TRUE(isColoured({0, 0, 250}));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "1-green"));
  EXPECT_TRUE(isColoured({0, 250, 0}));
  next();
  EXPECT_TRUE(isShown("slides", "picture", "2-grey"));
}

}  // namespace
}  // namespace merlin::test
