// Which content the wall begins with: the one that was shown last, however its path was spelled.
#include "daemon/wall/last_content.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace merlin::wall {
namespace {

// The folder of the contents is spelled as in the option --config, for example "c.json" or
// "folder/c.json".
TEST(LastContent, IsFoundHoweverItsPathIsSpelled) {
  const std::string here = std::filesystem::current_path().string();
  const auto entries = [](const std::string& folder) {
    return std::vector<ContentEntry>{{"/wall/contents/0", "a", folder + "a.mrm"},
                                     {"/wall/contents/1", "b", folder + "b.mrm"},
                                     {"/wall/contents/2", "c", folder + "c.mrm"}};
  };
  const MissingContents missing(std::vector<std::string>(3));
  ThreadWatch watch;
  state::StateKeeper keeper(nullptr, watch);
  (void)keeper.takeNotices();
  const std::string folders[] = {"", here + "/", "./", here + "/x/../"};
  for (const std::string& kept : folders) {
    for (const std::string& then : folders) {
      const auto before = entries(kept), after = entries(then);
      LastContent(before, missing, keeper).keep(2);
      EXPECT_EQ(keeper.state().content, here + "/c.mrm");
      EXPECT_EQ(LastContent(after, missing, keeper).first(), 2u) << kept << " " << then;
    }
  }
  EXPECT_TRUE(keeper.takeNotices().empty());
  const auto elsewhere = entries("/elsewhere/");
  EXPECT_EQ(LastContent(elsewhere, missing, keeper).first(), 0u);
  EXPECT_EQ(keeper.takeNotices().size(), 1u);
}

// An earlier version stored the path as it was spelled.
TEST(LastContent, OfAnEarlierVersionIsFound) {
  const std::vector<ContentEntry> entries = {{"/wall/contents/0", "a", "/walls/hall/a.mrm"},
                                             {"/wall/contents/1", "aa", "/walls/hall/aa.mrm"},
                                             {"/wall/contents/2", "b", "/walls/models/a.mrm"}};
  const MissingContents missing(std::vector<std::string>(3));
  ThreadWatch watch;
  state::StateKeeper keeper(nullptr, watch);
  (void)keeper.takeNotices();
  const auto first = [&](const char* kept) {
    keeper.change([&](state::State& state) { state.content = kept; });
    return LastContent(entries, missing, keeper).first();
  };
  EXPECT_EQ(first("aa.mrm"), 1u);
  EXPECT_EQ(first("hall/aa.mrm"), 1u);
  EXPECT_EQ(first("../models/a.mrm"), 2u);
  EXPECT_EQ(first("./aa.mrm"), 1u);
  EXPECT_EQ(first("/walls/hall/../models/a.mrm"), 2u);
  EXPECT_TRUE(keeper.takeNotices().empty());
  EXPECT_EQ(first("other/aa.mrm"), 0u);
  EXPECT_EQ(first("/walls/aa.mrm"), 0u);
  EXPECT_EQ(keeper.takeNotices().size(), 2u);
}

}  // namespace
}  // namespace merlin::wall
