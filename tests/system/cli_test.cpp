// The output of successful `merlin` commands, on which scripts rely. Mesh commands are tested in
// mesh_cli_test.
#include <algorithm>
#include <chrono>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class Cli : public testing::Test {
 protected:
  TempDir dir_;
};

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
  const auto begin = std::chrono::steady_clock::now();
  Process watching({kMerlin, "watch", "--instance", m.instance()});
  const auto lines = [&] { return std::ranges::count(watching.output(), '\n'); };
  EXPECT_TRUE(eventually([&] { return lines() >= 3; })) << watching.output();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(static_cast<double>(lines()), passed.count() + 2) << watching.output();
  for (const char* word : {"Hz", "triangles", "% late", "posture", "glove", "tracker", "ball"}) {
    EXPECT_NE(watching.output().find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run({kMerlin, "watch", "--for", "2", "--instance", m.instance()}).status, 0);
}

TEST_F(Cli, PrintConfigGivesAConfigurationThatIsValid) {
  const Outcome printed =
      run({kMerlind, "--config", kSource + "/config/wall.json", "--print-config"});
  ASSERT_EQ(printed.status, 0) << printed.output;
  writeText(dir_ / "c.json", printed.output);
  EXPECT_EQ(run({kMerlind, "--check-config", dir_ / "c.json", "--role", "devices"}).status, 0);
}

}  // namespace
}  // namespace merlin::test
