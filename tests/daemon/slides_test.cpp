// Which slide of a folder comes next, and which one is the last, while the folder changes.
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/wall/wall_contents.h"
#include "tests/support/pyramids.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

class Slides : public testing::Test {
 protected:
  void put(const std::string& name) const {
    test::writeText(dir_ / (name + ".tif"), test::pyramidBytes({.width = 8, .height = 8}));
  }
  void damage(const std::string& name) const { test::writeText(dir_ / (name + ".tif"), "damaged"); }

  Result<WallContent> read(const std::string& from, bool back = false) {
    skipped_.clear();
    const ContentEntry entry{"", "talk", dir_.path(), ContentKind::kSlides, {}};
    return readContent(entry, {}, {from.empty() ? "" : dir_ / (from + ".tif"), back}, skipped_);
  }
  // Returns the next slide as "b" or "c, the last", or the error.
  std::string next(const std::string& after) {
    const auto slide = read(after);
    if (!slide) return slide.error().what;
    return std::filesystem::path(slide->file).stem().string() +
           (slide->is_last_slide ? ", the last" : "");
  }
  // Returns the previous slide as "b" or "a, the first".
  std::string previous(const std::string& before) {
    const auto slide = read(before, true);
    if (!slide) return slide.error().what;
    return std::filesystem::path(slide->file).stem().string() +
           (slide->is_first_slide ? ", the first" : "");
  }

  test::TempDir dir_;
  std::vector<std::string> skipped_;
};

TEST_F(Slides, ComeInTheOrderOfTheirNamesAndThenFromTheBeginning) {
  for (const char* const name : {"c", "a", "b"}) put(name);
  EXPECT_EQ(next(""), "a");
  EXPECT_EQ(next("a"), "b");
  EXPECT_EQ(next("b"), "c, the last");
  EXPECT_EQ(next("c"), "a");
}

TEST_F(Slides, OneThatIsPutBetweenOrGoneIsNoticedAtTheNextTurn) {
  for (const char* const name : {"a", "c"}) put(name);
  put("b");
  EXPECT_EQ(next("a"), "b");
  std::filesystem::remove(dir_ / "b.tif");
  EXPECT_EQ(next("b"), "c, the last");
}

TEST_F(Slides, TheLastOneThatCanBeShownIsTheLast) {
  for (const char* const name : {"a", "b"}) put(name);
  for (const char* const name : {"aa", "c", "d"}) damage(name);
  EXPECT_EQ(next(""), "a");
  EXPECT_TRUE(skipped_.empty()) << "the one behind it has its turn later";
  EXPECT_EQ(next("a"), "b, the last");
  ASSERT_EQ(skipped_.size(), 3U) << "the others do not come up any more";
  EXPECT_NE(skipped_[0].find("aa.tif: is not a TIFF file"), std::string::npos) << skipped_[0];
  EXPECT_EQ(next("b"), "a") << "from the beginning";
}

TEST_F(Slides, GoBackInTheSameOrder) {
  for (const char* const name : {"c", "a", "b"}) put(name);
  EXPECT_EQ(previous("c"), "b");
  EXPECT_EQ(previous("b"), "a, the first");
  EXPECT_EQ(previous("a"), "c") << "from the end";
  EXPECT_TRUE(read("", false)->is_first_slide);
  EXPECT_TRUE(read("b", false)->is_last_slide);
  EXPECT_FALSE(read("c", true)->is_last_slide);
  put("bb");
  EXPECT_EQ(previous("c"), "bb") << "one that is put between is noticed";
}

TEST_F(Slides, TheFirstOneThatCanBeShownIsTheFirst) {
  for (const char* const name : {"c", "d"}) put(name);
  for (const char* const name : {"a", "b", "cc"}) damage(name);
  EXPECT_EQ(previous("d"), "c, the first");
  EXPECT_EQ(skipped_.size(), 3U) << "cc on the way, and those before it";
  EXPECT_EQ(previous("c"), "d");
}

TEST_F(Slides, OrdinaryPicturesAmongThemAreNamed) {
  put("a");
  EXPECT_EQ(read("")->left_out, "");
  test::writeText(dir_ / "z.jpg", "");
  test::writeText(dir_ / ".thumb.jpg", "");
  test::writeText(dir_ / "notes.txt", "");
  EXPECT_EQ(read("")->left_out, dir_.path() +
                                    ": z.jpg is no pyramid, so it is not shown: merlin "
                                    "image import z.jpg -o z.tif makes one");
  for (const char* const name : {"p.PNG", "q.jpeg", "r.webp"}) test::writeText(dir_ / name, "");
  EXPECT_EQ(read("")->left_out,
            dir_.path() +
                ": p.PNG, q.jpeg, r.webp and 1 more are no pyramids, so they are not "
                "shown: merlin image import p.PNG -o p.tif makes one");
}

TEST_F(Slides, AFolderWithoutAnyIsAnErrorThatSaysWhy) {
  EXPECT_NE(next("a").find("has no pyramid (.tif)"), std::string::npos);
  damage("a");
  EXPECT_NE(next("").find("none of its 1 pyramids can be shown: a slide is left out"),
            std::string::npos);
  std::filesystem::remove_all(dir_.path());
  EXPECT_NE(next("a").find("No such file or directory"), std::string::npos);
}

}  // namespace
}  // namespace merlin::wall
