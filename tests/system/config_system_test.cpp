// merlin config show and diff, and the folder conf.d, with the real programs.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/state/state.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

class ConfigCommands : public testing::Test {
 protected:
  ConfigCommands() {
    std::filesystem::create_directory(dir_ / "conf.d");
    writeText(file_, "{\"state_file\": \"state.json\",\n\"wall\": {\"rate\": {\"rate_hz\": 25}}}");
  }
  void expectHas(const std::string& text, const std::string& part) const {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
  }

  TempDir dir_;
  std::string file_ = dir_ / "merlin.json", site_ = dir_ / "conf.d/50-site.json";
};

TEST_F(ConfigCommands, ShowSaysWhichFileAValueComesFrom) {
  writeText(site_, "{\n\"wall\": {\"playlist\": {\"after_s\": 60}}}");
  state::State state;
  state.rate_hz = 12;
  writeText(dir_ / "state.json", state::stateText(state));
  const Outcome shown = run({kMerlin, "config", "show", file_, "--changed"});
  ASSERT_EQ(shown.status, 0) << shown.output;
  expectHas(shown.output, "* /wall/playlist/after_s: 60  (" + site_ + ":2; default 0)\n");
  expectHas(shown.output, "* /wall/rate/rate_hz: 12");
  expectHas(shown.output,
            "(changed while the wall ran: " + dir_.path() + "/state.json; default 30)");
  EXPECT_EQ(shown.output.find("/instance"), std::string::npos) << "it is the default";
  // otherwise a note on the state file would be in the output too
  std::filesystem::remove(dir_ / "state.json");
  const Outcome all = run({kMerlin, "config", "show", file_, "--json"});
  const json settings = json::parse(all.output, nullptr, false);
  ASSERT_TRUE(settings.is_array()) << all.output;
  EXPECT_GT(settings.size(), 200u);
  EXPECT_EQ(settings[0]["pointer"], "/instance");
  EXPECT_EQ(settings[0]["origin"], "default");
}

TEST_F(ConfigCommands, DiffComparesWithTheDefaultsAndWithAnotherFile) {
  EXPECT_EQ(
      run({kMerlin, "config", "diff", file_}).output,
      "/state_file: \"\" -> \"" + dir_.path() + "/state.json\"\n/wall/rate/rate_hz: 30 -> 25\n");
  std::filesystem::create_directory(dir_ / "other");
  const std::string other = dir_ / "other/merlin.json";
  writeText(other, "{\"state_file\": \"../state.json\", \"instance\": \"lab\"}");
  const Outcome two = run({kMerlin, "config", "diff", file_, other});
  EXPECT_EQ(two.status, 0);
  EXPECT_EQ(two.output, "/instance: \"merlin\" -> \"lab\"\n/wall/rate/rate_hz: 25 -> 30\n");
  EXPECT_EQ(json::parse(run({kMerlin, "config", "diff", file_, other, "--json"}).output),
            json::parse(R"([{"pointer": "/instance", "before": "merlin", "after": "lab"},
                            {"pointer": "/wall/rate/rate_hz", "before": 25, "after": 30}])"));
  EXPECT_EQ(run({kMerlin, "config", "diff", file_, file_}).output, "");
}

TEST_F(ConfigCommands, InvalidOnesAreRefusedWithTheirFindings) {
  writeText(site_, "{\n\"wal\": 1}");
  for (const char* command : {"show", "diff"}) {
    const Outcome refused = run({kMerlin, "config", command, file_});
    EXPECT_EQ(refused.status, 2);
    expectHas(refused.output, site_ + ":2: /wal is not a known setting; did you mean \"wall\"?\n");
    expectHas(refused.output, file_ + ": the configuration is invalid\n");
  }
  EXPECT_EQ(run({kMerlin, "config", "show", dir_ / "no.json"}).status, 2);
}

TEST_F(ConfigCommands, MerlindReadsAndChecksConfD) {
  const auto check = [&] { return run({kMerlind, "--check-config", file_, "--role", "devices"}); };
  writeText(site_, "{\"wall\":\n{\"rate\": {\"rate_hz\": 50}}}");
  EXPECT_EQ(check().status, 0) << check().output;
  const Outcome printed = run({kMerlind, "--print-config", "--config", file_});
  EXPECT_EQ(json::parse(printed.output)["wall"]["rate"]["rate_hz"], 50);
  writeText(site_, "{\"wall\":\n{\"rate\": {\"rate_hz\": 500}}}");
  EXPECT_EQ(check().status, 1);
  expectHas(check().output, site_ + ":2: /wall/rate/rate_hz is 500; allowed is 1 to 240");
  writeText(site_, "{\"wall\":\n[");
  EXPECT_EQ(check().status, 2);
  expectHas(check().output, site_ + ":2: ");
}

TEST_F(ConfigCommands, TheStateIsNotWrittenIntoConfD) {
  writeText(site_, R"({"state_file": "conf.d/50-site.json"})");
  const Outcome checked = run({kMerlind, "--check-config", file_, "--role", "wall"});
  EXPECT_EQ(checked.status, 2);
  expectHas(checked.output, "/state_file names " + site_ + ", a file of the configuration");
}

}  // namespace
}  // namespace merlin::test
