// merlin show FILE: one command brings a range image with colour from the disk to the wall. Also
// tests which files a stopped command leaves, and that merlind opens no path that a client names.
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "daemon/status/client.h"
#include "render/image/image_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

// One wall serves all tests; at the beginning of each test it shows its own model.
class ShowFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    wall_ = new Merlind(*dir_, makeModel(*dir_, 2), "show",
                        MerlindOptions{.script = "still", .emulate = false});
    EXPECT_TRUE(wall_->ready()) << wall_->process().output();
  }
  static void TearDownTestSuite() {
    EXPECT_EQ(wall_->process().kill(SIGTERM), 0) << wall_->process().output();
    delete wall_;
    delete dir_;
  }
  void SetUp() override {
    for (const auto& entry : fs::directory_iterator(folder())) fs::remove_all(entry.path());
    ASSERT_EQ(run(command({"model"})).status, 0);
  }
  std::string folder() const { return *dir_ / (wall_->instance() + ".shown"); }
  std::vector<std::string> command(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {kMerlin, "show", "--instance", wall_->instance()};
    all.insert(all.end(), words.begin(), words.end());
    return all;
  }
  // Returns the names of all files in the content folder, including hidden ones.
  std::vector<std::string> there() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  shm::WallContent content() const {
    const auto wall =
        shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(wall_->instance(), "wall"));
    return wall ? (*wall)->content.read().value_or(shm::WallContent{}) : shm::WallContent{};
  }
  // Returns the mean red, green and blue of all pixels that are not background.
  std::array<double, 3> colour() const {
    const std::string path = *dir_ / "frame.png";
    run({kMerlin, "snapshot", "-o", path, "--instance", wall_->instance()});
    const auto frame = render::image::readImage(path);
    std::array<double, 3> sum{};
    double count = 0;
    for (std::size_t i = 0; frame && i + 2 < frame->pixels.size(); i += 3) {
      if (std::max({frame->pixels[i], frame->pixels[i + 1], frame->pixels[i + 2]}) < 64) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += frame->pixels[i + k];
      ++count;
    }
    for (double& s : sum) s /= std::max(count, 1.0);
    return sum;
  }
  // Returns the answer from the wall's command socket, or the error message.
  std::string asked(const std::string& name, const std::string& argument) const {
    const auto answer =
        status::ask(fmt::format("ipc://{}/{}-wall.command", dir_->path(), wall_->instance()), name,
                    std::chrono::seconds(10), argument);
    return answer ? *answer : answer.error().what;
  }
  // Writes the scan of a flat square of side x side returns of one colour.
  void writeScan(const std::string& name, int side, const std::string& rgb) const {
    const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    const std::string size = fmt::format("{0} {0}\n", side);
    std::string ranges, colours;
    for (std::size_t i = 0; i < pixels; ++i) {
      ranges += '\x08';
      // the surface is rough, so that its reduction takes some time
      ranges += static_cast<char>(i * 31 % 8);
      colours += rgb;
    }
    writeText(*dir_ / (name + ".pgm"), "P5\n" + size + "65535\n" + ranges);
    writeText(*dir_ / (name + ".ppm"), "P6\n" + size + "255\n" + colours);
  }
  std::vector<std::string> scan(const std::string& name) const {
    return command({*dir_ / (name + ".pgm"), "--geometry", "orthogonal", "--angles", "40", "40",
                    "--feature", "colour=" + *dir_ / (name + ".ppm")});
  }

  static TempDir* dir_;
  static Merlind* wall_;
};
TempDir* ShowFile::dir_ = nullptr;
Merlind* ShowFile::wall_ = nullptr;

TEST_F(ShowFile, ARangeImageWithColourIsOnTheWallAfterOneCommand) {
  writeScan("hill", 40, "\x10\x10\xF0");
  const Outcome shown = run(scan("hill"));
  EXPECT_EQ(shown.status, 0) << shown.output;
  EXPECT_NE(shown.output.find("hill.pgm: shown after "), std::string::npos) << shown.output;
  EXPECT_STREQ(content().name, "hill");
  EXPECT_STREQ(content().kind, "model");
  EXPECT_EQ(wall_->status()["content"]["detail"]["full_cost"], 2 * 39 * 39);
  EXPECT_EQ(there(), std::vector<std::string>{"hill.mrm"});
  EXPECT_EQ(fs::status(folder() + "/hill.mrm").permissions(), fs::perms(0640));
  EXPECT_TRUE(eventually([&] { return colour()[2] > 3 * colour()[0] && colour()[2] > 64; }))
      << "blue";
}

// A file that was shown can be shown again by its name as long as it is in the content folder.
TEST_F(ShowFile, AFileThatWasShownIsShownAgainByItsName) {
  writeScan("hill", 40, "\x10\x10\xF0");
  writeScan("model", 40, "\x10\x10\xF0");
  ASSERT_EQ(run(scan("hill")).status, 0);
  ASSERT_EQ(run(scan("model")).status, 0);
  ASSERT_EQ(run(command({"model"})).status, 0);
  EXPECT_EQ(wall_->status()["content"]["index"], 0) << "the configuration's comes first";
  EXPECT_EQ(wall_->status()["shown_folder"]["names"].dump(), R"(["hill"])");
  const Outcome again = run(command({"hill"}));
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_STREQ(content().name, "hill");
  const Outcome none = run(command({"valley"}));
  EXPECT_NE(none.output.find("contents are model, and of files that were shown hill"),
            std::string::npos)
      << none.output;
  fs::remove(folder() + "/hill.mrm");
  EXPECT_EQ(wall_->status()["shown_folder"]["names"].dump(), "[]");
  EXPECT_NE(run(command({"hill"})).status, 0) << "it is gone";
}

TEST_F(ShowFile, OneThatIsStoppedSaysOnTheWallHowFarItIsAndLeavesNothing) {
  writeScan("large", 1000, "abc");
  Process showing(scan("large"));
  EXPECT_TRUE(eventually([&] {
    return wall_->status()["notice"].get<std::string>().find(" large.pgm") != std::string::npos ||
           showing.ended();
  }));
  EXPECT_EQ(showing.kill(SIGINT), 1) << showing.output();
  EXPECT_NE(showing.output().find("interrupted; nothing is left behind"), std::string::npos)
      << showing.output();
  EXPECT_EQ(there(), std::vector<std::string>());
  EXPECT_STREQ(content().name, "model");
  EXPECT_TRUE(eventually([&] { return wall_->status()["notice"].get<std::string>().empty(); }));
}

TEST_F(ShowFile, MerlindOpensNoPathThatAClientNames) {
  const std::string model = *dir_ / "model.mrm";
  EXPECT_NE(asked("show", model).find("merlind opens no path that a client names"),
            std::string::npos)
      << asked("show", model);
  EXPECT_NE(asked("show_file", model).find("is not the name of a file in the content folder"),
            std::string::npos);
  EXPECT_NE(asked("show_file", "../model.mrm").find("is not the name of a file"),
            std::string::npos);
  fs::create_symlink(model, folder() + "/link.mrm");
  EXPECT_NE(asked("show_file", "link.mrm").find("link.mrm: is a link"), std::string::npos);
  EXPECT_STREQ(content().name, "model");
}

TEST_F(ShowFile, WhatCannotBeShownIsSaidHereAndOnTheWall) {
  writeText(*dir_ / "broken.mrm", "MRLN.mrm and nothing else");
  const Outcome broken = run(command({*dir_ / "broken.mrm"}));
  EXPECT_EQ(broken.status, 2) << broken.output;
  EXPECT_NE(broken.output.find("broken.mrm: "), std::string::npos) << broken.output;
  EXPECT_TRUE(eventually([&] {
    return wall_->status()["notice"].get<std::string>().starts_with("broken.mrm cannot be shown: ");
  }));
  EXPECT_EQ(there(), std::vector<std::string>()) << "it does not stay";
  const Outcome absent = run(command({*dir_ / "absent.pgm"}));
  EXPECT_EQ(absent.output, "merlin: " + (*dir_ / "absent.pgm") + ": does not exist\n");
  const Outcome alone = run({kMerlin, "show", *dir_ / "broken.mrm", "--instance", "nobody-runs"});
  EXPECT_EQ(alone.status, 1);
  EXPECT_NE(alone.output.find("no merlind runs as \"nobody-runs\""), std::string::npos)
      << alone.output;
}

TEST_F(ShowFile, ATestCardThatCoversTheContentIsNoted) {
  const auto card = [&](const std::string& name) {
    EXPECT_EQ(run({kMerlin, "wall", "testcard", name, "--instance", wall_->instance()}).status, 0);
    EXPECT_TRUE(eventually([&] { return wall_->status()["testcard"] == (name != "off"); }));
  };
  EXPECT_EQ(run(command({"model"})).output, "");
  card("grid");
  const Outcome covered = run(command({"model"}));
  EXPECT_EQ(covered.status, 0);
  EXPECT_NE(
      covered.output.find("a test card covers it; to remove the card: merlin wall testcard off"),
      std::string::npos)
      << covered.output;
  writeScan("hill", 40, "\x10\x10\xF0");
  const Outcome file = run(scan("hill"));
  EXPECT_NE(file.output.find("a test card covers it"), std::string::npos) << file.output;
  card("off");
}

TEST_F(ShowFile, AFileOrAFolderWithoutASlashIsNoted) {
  const fs::path before = fs::current_path();
  fs::current_path(dir_->path());
  fs::create_directory("holiday");
  const Outcome folder = run(command({"holiday"}));
  writeText("monday", "");
  const Outcome file = run(command({"monday"}));
  fs::current_path(before);
  EXPECT_NE(folder.output.find("a folder holiday is here: merlin show ./holiday"),
            std::string::npos)
      << folder.output;
  EXPECT_NE(file.output.find("a file monday is here: merlin show ./monday"), std::string::npos)
      << file.output;
}

TEST_F(ShowFile, PanoramaIsRefusedForWhatIsNoPictureThatIsImported) {
  if (!fs::exists(MERLIN_BIN_DIR "/merlin-import")) GTEST_SKIP() << "this build has no imports";
  writeText(*dir_ / "sky.ppm", "P6\n64 32\n255\n" + std::string(64 * 32 * 3, '\x90'));
  const std::string pyramid = *dir_ / "sky.tif", there = folder() + "/there.tif";
  ASSERT_EQ(run({kMerlin, "image", "import", *dir_ / "sky.ppm", "-o", pyramid}).status, 0);
  fs::copy(pyramid, there);
  const std::pair<std::string, std::string> refused[] = {
      {"model", "the name of a content"},
      {pyramid, "already a pyramid"},
      {there, "in the content folder already"},
      {*dir_ / "model.mrm", "a model"},
  };
  for (const auto& [what, found] : refused) {
    const Outcome shown = run(command({what, "--panorama"}));
    EXPECT_NE(shown.status, 0) << what;
    EXPECT_EQ(shown.output,
              fmt::format("merlin: {}: --panorama is only for a picture that is imported now, and "
                          "this is {}; import the picture with: merlin image import --panorama\n",
                          what, found));
  }
  EXPECT_STREQ(content().kind, "model");
  const Outcome shown = run(command({*dir_ / "sky.ppm", "--panorama"}));
  EXPECT_EQ(shown.status, 0) << shown.output;
  EXPECT_STREQ(content().kind, "panorama");
}

// The memory limit of 1 MB is too small for any picture.
TEST_F(ShowFile, ThePicturesImportHasTheMemoryThatIsGiven) {
  if (!fs::exists(MERLIN_BIN_DIR "/merlin-import")) GTEST_SKIP() << "this build has no imports";
  writeText(*dir_ / "small.ppm", "P6\n64 32\n255\n" + std::string(64 * 32 * 3, '\x90'));
// sanitizers reserve terabytes of address space, so no limit is set with them
#if !defined(MERLIN_ANY_SANITIZER)
  const Outcome shown = run(command({*dir_ / "small.ppm", "--memory", "1M"}));
  EXPECT_NE(shown.status, 0);
  EXPECT_NE(shown.output.find("needs more memory"), std::string::npos) << shown.output;
#endif
  const Outcome again = run(command({*dir_ / "small.ppm", "--memory", "2G"}));
  EXPECT_EQ(again.status, 0) << again.output;
}

}  // namespace
}  // namespace merlin::test
