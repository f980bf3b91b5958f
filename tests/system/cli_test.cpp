// What `merlin` prints where all is well, for those who script it.
#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class Cli : public testing::Test {
 protected:
  TempDir dir_;
  std::string scan_ = kSource + "/config/models/ankylosaurus.ply";
};

TEST_F(Cli, ReduceInfoExportAgree) {
  const Outcome reduced = run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--json"});
  ASSERT_EQ(reduced.status, 0) << reduced.output;
  const auto report =
      nlohmann::json::parse(reduced.output.substr(reduced.output.find("{\"output\"")));
  EXPECT_EQ(report["triangles"], 69636);
  EXPECT_GT(report["collapses_per_second"], 0);
  EXPECT_NE(reduced.output.find("collapses/s"), std::string::npos)
      << "progress, also without a terminal";

  const auto info =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a.mrm", "--json"}).output);
  EXPECT_EQ(info["triangles"], 69636);
  EXPECT_EQ(info["vertices"], 34820);
  EXPECT_EQ(info["levels"], report["collapses"].get<int>() + 1);
  EXPECT_EQ(info["features"][0]["name"], "colour");
  EXPECT_EQ(info["box"]["low"].size(), 3u);

  ASSERT_EQ(
      run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--percent", "5", "-o", dir_ / "a5.ply"})
          .status,
      0);
  const auto exported =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a5.ply", "--json"}).output);
  EXPECT_LE(exported["triangles"], 3481);
  EXPECT_GE(exported["triangles"], 3478) << "exact to one collapse";
}

TEST_F(Cli, TheSameInputGivesTheSameBytes) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "b.mrm"}).status, 0);
  EXPECT_TRUE(readText(dir_ / "a.mrm") == readText(dir_ / "b.mrm"));
}

TEST_F(Cli, ReduceStopsWhereItIsTold) {
  const Outcome reduced = run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--percent",
                               "50", "--preset", "typical1998", "--preserve-topology"});
  EXPECT_NE(reduced.output.find("(percent)"), std::string::npos) << reduced.output;
}

TEST_F(Cli, PicturesModelsSideBySide) {
  ASSERT_EQ(run({kMerlin, "mesh", "export", scan_, "-o", dir_ / "a.ply"}).status, 0);
  const Outcome picture = run({kMerlin, "mesh", "picture", dir_ / "a.ply", dir_ / "a.ply", "-o",
                               dir_ / "p.png", "--width", "64", "--height", "48"});
  EXPECT_NE(picture.output.find("p.png: 128 x 48"), std::string::npos) << picture.output;
}

TEST_F(Cli, TheShippedPostureNetworkIsTestedOnHeldOutHands) {
  const auto score = nlohmann::json::parse(
      run({kMerlin, "posture", "test", "--network", kSource + "/config/postures.json", "--json"})
          .output);
  EXPECT_EQ(score["total"], 8000);
  EXPECT_GE(score["accuracy"], 0.999);
  EXPECT_EQ(score["synthetic"], true);
}

TEST_F(Cli, EachDeviceIsEmulatedOnALinkThatGoesWithIt) {
  for (const char* device : {"cyberglove", "fastrak", "spaceball"}) {
    Process emulator({kMerlin, "emulate", device, "--link", dir_ / "line", "--script", "still"});
    EXPECT_TRUE(emulator.saysEventually(fmt::format("{} on pty:{}", device, dir_ / "line")))
        << emulator.output();
    EXPECT_TRUE(std::filesystem::is_symlink(dir_ / "line"));
    EXPECT_EQ(emulator.kill(SIGTERM), 0);
    EXPECT_FALSE(std::filesystem::is_symlink(dir_ / "line"));
  }
}

TEST_F(Cli, WatchPrintsALineASecond) {
  Merlind m(dir_, makeModel(dir_, 5), "watch");
  ASSERT_TRUE(m.ready()) << m.process().output();
  const Outcome watched = run({kMerlin, "watch", "--for", "2", "--instance", m.instance()});
  EXPECT_EQ(watched.status, 0) << watched.output;
  const auto lines = std::count(watched.output.begin(), watched.output.end(), '\n');
  EXPECT_GE(lines, 2) << watched.output;
  EXPECT_LE(lines, 5) << watched.output;
  for (const char* word : {"Hz", "triangles", "% late", "posture", "glove", "tracker", "ball"}) {
    EXPECT_NE(watched.output.find(word), std::string::npos) << word;
  }
}

TEST_F(Cli, PrintConfigGivesAConfigurationThatIsValid) {
  const Outcome printed =
      run({kMerlind, "--config", kSource + "/config/wall.json", "--print-config"});
  ASSERT_EQ(printed.status, 0) << printed.output;
  writeText(dir_ / "c.json", printed.output);
  EXPECT_EQ(run({kMerlind, "--check-config", dir_ / "c.json"}).status, 0);
}

}  // namespace
}  // namespace merlin::test
