// merlind --last-good with a configuration file that was damaged while merlind was not running.
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/page_process.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class LastGood : public testing::Test {
 protected:
  LastGood() {
    fs::create_directories(state_);
    writeText(config_, valid(7).dump());
  }
  json valid(int rate_hz) const {
    return {{"instance", instance_},
            {"run_directory", dir_.path()},
            {"wall", {{"model", model_}, {"rate", {{"rate_hz", rate_hz}}}}}};
  }
  std::unique_ptr<Process> start(const std::vector<std::string>& more = {"--last-good"}) {
    std::vector<std::string> arguments = {kMerlind, "--config", config_, "--role", "wall"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<Process>(
        arguments, std::map<std::string, std::string>{{"STATE_DIRECTORY", state_}});
  }
  // Returns the last good settings that a process has stored; empty if there are none.
  std::string kept() const {
    for (const auto& entry : fs::directory_iterator(state_))
      if (entry.path().extension() == ".last-good") return readText(entry.path());
    return {};
  }
  bool keeps(const std::string& setting) const {
    return eventually([&] { return kept().find(setting) != std::string::npos; });
  }
  json status() const {
    return json::parse(run({kMerlin, "status", "--json", "--instance", instance_}).output, nullptr,
                       false);
  }

  TempDir dir_;
  std::string instance_ = privateName("last-good"), state_ = dir_ / "state";
  std::string config_ = dir_ / "wall.json", model_ = makeModel(dir_, 5);
};

// The settings cannot be stored at first, as when the disk is full when merlind starts.
TEST_F(LastGood, IsKeptAsSoonAsItCanBeWritten) {
  fs::remove_all(state_);
  writeText(state_, "a file in the folder's place");
  const auto wall = start();
  EXPECT_TRUE(wall->saysEventually("the last good configuration is not kept: ")) << wall->output();
  fs::remove(state_);
  fs::create_directories(state_);
  EXPECT_TRUE(keeps("\"rate_hz\": 7")) << wall->output();
  EXPECT_EQ(wall->kill(SIGTERM), 0);
}

TEST_F(LastGood, IsStartedWithSaidAndLeftByTheNextReload) {
  auto wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(keeps("\"rate_hz\": 7")) << kept();
  EXPECT_EQ(wall->kill(SIGTERM), 0);

  writeText(config_, "{\"instance\": \"" + instance_ + "\", \"wall\": {\"rate\": 9}}");
  wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(wall->saysEventually("merlind runs with the last valid configuration"));
  json now = status();
  EXPECT_EQ(now["rate_asked"], 7);
  EXPECT_EQ(now["services"]["configuration"]["health"], "failed");
  const std::string why = now["services"]["configuration"]["reason"];
  EXPECT_EQ(why.find(config_ + ":1: /wall/rate"), 0U) << "the first finding begins it: " << why;
  EXPECT_NE(kept().find("\"rate_hz\": 7"), std::string::npos) << "a broken one is not kept";

  writeText(config_, valid(12).dump());
  const Outcome reloaded = run({kMerlin, "reload", "--instance", instance_});
  EXPECT_EQ(reloaded.status, 0) << reloaded.output;
  EXPECT_TRUE(eventually([&] { return (now = status())["rate_asked"] == 12; })) << now;
  EXPECT_EQ(now["services"]["configuration"]["health"], "ok");
  EXPECT_TRUE(keeps("\"rate_hz\": 12")) << kept();
  EXPECT_EQ(wall->kill(SIGTERM), 0);
}

// The file is damaged, and the page is the place where people learn this.
TEST_F(LastGood, OfTheWallIsWhatThePageStartsWith) {
  json config = valid(7);
  config["page"] = {{"port", freePagePort()}};
  writeText(config_, config.dump());
  const auto wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(keeps("\"rate_hz\": 7"));
  writeText(config_, "{");
  const std::vector<std::string> page = {kMerlind, "--config", config_, "--role", "page"};
  EXPECT_EQ(run(page).status, 2);
  std::vector<std::string> with = page;
  with.emplace_back("--last-good");
  Process served(with, {{"STATE_DIRECTORY", state_}});
  EXPECT_TRUE(served.saysEventually("ready")) << served.output();
  EXPECT_EQ(served.kill(SIGTERM), 0) << served.output();
  EXPECT_EQ(wall->kill(SIGTERM), 0);
}

// The last good settings are stored in another folder than the configuration, but must name the
// same files.
TEST_F(LastGood, NamesFilesThatTheConfigurationNamesFromItsFolder) {
  json config = valid(7);
  config["wall"]["model"] = fs::path(model_).filename();
  writeText(config_, config.dump());
  config_ = fs::relative(config_).string();
  auto wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(keeps("\"rate_hz\": 7"));
  EXPECT_EQ(wall->kill(SIGTERM), 0);
  writeText(config_, "{");
  wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(wall->saysEventually("merlind runs with the last valid configuration"));
  writeText(config_, config.dump());
  EXPECT_EQ(run({kMerlin, "reload", "--instance", instance_}).output, "nothing changed\n");
  EXPECT_EQ(wall->kill(SIGTERM), 0);
}

// The stored settings may contain a token among the arguments of an alarm's program.
TEST_F(LastGood, IsReadableByNoMoreThanEachFileOfTheConfiguration) {
  const std::string more = dir_ / "conf.d/more.json";
  fs::create_directories(dir_ / "conf.d");
  writeText(more, "{}");
  const auto kept_mode = [&](fs::perms of_file, fs::perms of_more) {
    fs::permissions(config_, of_file);
    fs::permissions(more, of_more);
    const auto wall = start();
    EXPECT_TRUE(wall->saysEventually("ready")) << wall->output();
    EXPECT_EQ(wall->kill(SIGTERM), 0);
    for (const auto& entry : fs::directory_iterator(state_))
      if (entry.path().extension() == ".last-good") return entry.status().permissions();
    return fs::perms::none;
  };
  EXPECT_EQ(kept_mode(fs::perms{0600}, fs::perms{0644}), fs::perms{0600});
  EXPECT_EQ(kept_mode(fs::perms{0644}, fs::perms{0644}), fs::perms{0640});
  EXPECT_EQ(kept_mode(fs::perms{0644}, fs::perms{0400}), fs::perms{0600});
}

TEST_F(LastGood, IsNoHelpWhereThereIsNoneOrNobodyAsked) {
  writeText(config_, "{");
  EXPECT_EQ(start()->wait(), 2);
  writeText(config_, valid(7).dump());
  const auto wall = start();
  ASSERT_TRUE(wall->saysEventually("ready")) << wall->output();
  EXPECT_TRUE(keeps("\"rate_hz\": 7"));
  EXPECT_EQ(wall->kill(SIGTERM), 0);
  writeText(config_, "{");
  EXPECT_EQ(start({})->wait(), 2) << "a person at a terminal wants to hear of it";
  // The model that the configuration names is missing as well, so the wall runs without content.
  fs::remove(model_);
  const auto bare = start();
  EXPECT_TRUE(bare->saysEventually("ready")) << bare->output();
  EXPECT_EQ(bare->kill(SIGTERM), 0);
}

}  // namespace
}  // namespace merlin::test
