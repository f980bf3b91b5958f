// Which slide of a folder comes next, and which one is the last, while the folder changes.
#include <filesystem>

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

  // "b" or "c, the last"; or the error.
  std::string next(const std::string& after) {
    skipped_.clear();
    const ContentEntry entry{"", "talk", dir_.path(), ContentKind::kSlides, {}};
    const auto read =
        readContent(entry, {}, after.empty() ? "" : dir_ / (after + ".tif"), skipped_);
    if (!read) return read.error().what;
    return std::filesystem::path(read->file).stem().string() +
           (read->is_last_slide ? ", the last" : "");
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
