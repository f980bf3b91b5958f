// A real merlind whose output shows something other than what merlind sent: the fault is found,
// reported and repaired.
#include <gtest/gtest.h>

#include "tests/system/blacken.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;

Json outputOf(Merlind& m) { return m.status()["outputs"]["shared_memory"]; }

bool pictureIs(Merlind& m, const std::string& verdict) {
  return eventually([&] { return outputOf(m)["picture"] == verdict; });
}

MerlindOptions checkedEvery(double seconds) {
  return {
      .role = "wall",
      .emulate = false,
      .also = {{"wall",
                {{"outputs", Json::array({{{"kind", "shared_memory"}, {"check_s", seconds}}})}}}}};
}

TEST(PictureChecks, ABlackPictureIsFoundSaidAndMended) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "black", checkedEvery(0.2));
  ASSERT_TRUE(m.ready()) << m.process().output();
  ASSERT_TRUE(pictureIs(m, "right")) << m.status().dump(2);
  EXPECT_GT(outputOf(m)["picture_ms"], 0);
  blacken(m.instance());
  EXPECT_TRUE(m.process().saysEventually("output shared_memory is black instead of what was meant"))
      << m.process().output();
  EXPECT_TRUE(m.process().saysEventually("output shared_memory shows what was meant again"))
      << m.process().output();
  EXPECT_TRUE(pictureIs(m, "right"));
  EXPECT_EQ(outputOf(m)["health"], "ok");
}

TEST(PictureChecks, AWallThatIsMadeBlackIsRight) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "blank", checkedEvery(0.05));
  ASSERT_TRUE(m.ready()) << m.process().output();
  ASSERT_TRUE(pictureIs(m, "right"));
  ASSERT_EQ(run({kMerlin, "blank", "--instance", m.instance()}).status, 0);
  ASSERT_TRUE(eventually([&] { return m.status()["shown"] == "blank"; })) << m.status().dump(2);
  const auto frames = outputOf(m)["frames"];
  EXPECT_GE(frames, 1);
  EXPECT_TRUE(pictureIs(m, "right"));
  EXPECT_EQ(m.process().output().find("is black"), std::string::npos) << m.process().output();
}

TEST(PictureChecks, ZeroSecondsIsNoCheck) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "unchecked", checkedEvery(0));
  ASSERT_TRUE(m.ready()) << m.process().output();
  ASSERT_TRUE(eventually([&] { return outputOf(m)["frames"] >= 1; }));
  EXPECT_EQ(outputOf(m)["picture"], "unchecked");
}

}  // namespace
}  // namespace merlin::test
