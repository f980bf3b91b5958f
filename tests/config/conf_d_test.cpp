// conf.d: a folder beside a configuration; its files are merged over the configuration.
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "config/sources.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

using test::writeText;
using Verdict = LoadedSettings::Verdict;

class ConfD : public testing::Test {
 protected:
  ConfD() { std::filesystem::create_directory(dir_ / "conf.d"); }
  void put(const std::string& name, const std::string& text) const { writeText(dir_ / name, text); }
  LoadedSettings load() const { return loadSettingsFile(dir_ / "merlin.json"); }
  // Returns all findings, with names of files relative to the folder.
  std::string findings() const {
    std::string text;
    const LoadedSettings loaded = load();
    for (const Finding& f : loaded.findings) text += toText("merlin.json", f) + "\n";
    const std::string folder = dir_.path() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
      text.erase(at, folder.size());
    return text;
  }

  test::TempDir dir_;
};

TEST_F(ConfD, FilesAreMergedInTheOrderOfTheirNames) {
  put("merlin.json", R"({"instance": "lab", "wall": {"model": "a.mrm", "rate": {"rate_hz": 25}}})");
  put("conf.d/20-b.json", R"({"$schema": "s", "wall": {"rate": {"rate_hz": 50}}})");
  put("conf.d/10-a.json", R"({"wall": {"rate": {"rate_hz": 40}, "model": "b.mrm"}})");
  const auto loaded = load();
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findings();
  EXPECT_EQ(loaded.settings.instance, "lab");
  EXPECT_EQ(loaded.settings.wall.governor.rate_hz, 50);
  EXPECT_EQ(loaded.settings.wall.model, dir_ / "b.mrm") << "relative to the configuration's folder";
}

TEST_F(ConfD, ListsReplaceListsAndWhateverIsNoObjectReplaces) {
  put("merlin.json", R"({"bindings": [{"input": "posture.fist", "action": "grab"},
                                      {"input": "glove.switch", "action": "next_mode"}]})");
  put("conf.d/a.json", R"({"bindings": [{"input": "posture.fist", "action": "fly"}]})");
  const auto loaded = load();
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findings();
  ASSERT_EQ(loaded.settings.devices.bindings.size(), 1u);
  EXPECT_EQ(loaded.settings.devices.bindings[0].action, "fly");
  put("conf.d/b.json", R"({"gpio": 7})");
  EXPECT_EQ(findings(), "conf.d/b.json:1: /gpio is the number 7; allowed is an object\n");
}

TEST_F(ConfD, FindingsNameTheFileAndItsLine) {
  put("merlin.json", "{\n\"wall\": {\"rate\": {\"rate_hz\": 900}},\n\"insatnce\": \"x\"}\n");
  put("conf.d/a.json", "{\n\n\"wall\": {\"modle\": \"a.mrm\"}}");
  put("conf.d/b.json", "{\"wall\":\n{\"rate\": {\"rate_hz\": 901}}}");
  EXPECT_EQ(findings(),
            "merlin.json:3: /insatnce is not a known setting; did you mean \"instance\"?\n"
            "conf.d/a.json:3: /wall/modle is not a known setting; did you mean \"model\"?\n"
            "conf.d/b.json:2: /wall/rate/rate_hz is 901; allowed is 1 to 240; 240 is used\n");
}

TEST_F(ConfD, FaultsOfCheckedValuesNameTheFileToo) {
  put("merlin.json", R"({"bindings": [{"input": "left.switch", "action": "grab"}]})");
  put("conf.d/a.json", "{\"hands\":\n[{\"glove\": \"left\"}]}");
  EXPECT_EQ(findings(),
            "merlin.json:1: /bindings/0/input is \"left.switch\", and \"left\" is not the name of "
            "a glove; /devices has glove\n"
            "conf.d/a.json:2: /hands/0/glove is \"left\", which is not the name of a glove; "
            "/devices has glove\n");
  const auto loaded = load();
  EXPECT_EQ(loaded.placeText("/bindings/0/input"), "line 1");
  EXPECT_EQ(loaded.placeText("/hands/0/glove"), dir_ / "conf.d/a.json:2");
}

TEST_F(ConfD, SyntaxErrorsOfAllFilesAreFound) {
  put("merlin.json", "{\n\"instance\": }");
  put("conf.d/a.json", "[1]");
  put("conf.d/b.json", "{\"a\": 1,\n\"a\": 2}");
  const auto loaded = load();
  EXPECT_FALSE(loaded.parsed);
  ASSERT_EQ(loaded.findings.size(), 3u);
  EXPECT_EQ(loaded.findings[0].line, 2);
  EXPECT_EQ(loaded.findings[0].file, "");
  EXPECT_EQ(loaded.findings[1].file, dir_ / "conf.d/a.json");
  EXPECT_EQ(loaded.findings[1].what, "is a list of 1; allowed is an object");
  EXPECT_EQ(loaded.findings[2].file, dir_ / "conf.d/b.json");
  EXPECT_EQ(loaded.findings[2].line, 2);
  for (const Finding& finding : loaded.findings) EXPECT_TRUE(finding.quotes) << finding.what;
}

TEST_F(ConfD, AFaultyFileAloneLeavesTheDefaults) {
  put("merlin.json", R"({"instance": "lab"})");
  put("conf.d/a.json", "{");
  const auto loaded = load();
  EXPECT_FALSE(loaded.parsed);
  EXPECT_EQ(loaded.settings.instance, "merlin");
}

TEST_F(ConfD, OtherFilesAreNotRead) {
  put("merlin.json", R"({"instance": "lab"})");
  put("conf.d/a.json~", "no JSON");
  put("conf.d/.hidden.json", "no JSON");
  put("conf.d/README", "no JSON");
  EXPECT_EQ(findings(), "");
  put("conf.d/a.json", "{}");
  EXPECT_EQ(load().sources.size(), 2u);
}

TEST_F(ConfD, WhatCannotBeReadIsAFinding) {
  put("merlin.json", "{}");
  std::filesystem::create_directory(dir_ / "conf.d/folder.json");
  EXPECT_EQ(findings(), "conf.d/folder.json: is not a regular file\n");
  std::filesystem::remove_all(dir_ / "conf.d");
  EXPECT_EQ(findings(), "") << "there is no conf.d";
  put("conf.d", "a file");
  EXPECT_EQ(findings(), "conf.d: Not a directory\n");
}

TEST_F(ConfD, NumberAndSizeOfFilesHaveLimits) {
  put("merlin.json", "{}");
  for (std::size_t i = 0; i < kMostConfDFiles; ++i) put(fmt::format("conf.d/{:03}.json", i), "{}");
  EXPECT_EQ(findings(), "");
  put("conf.d/x.json", "{}");
  EXPECT_EQ(findings(), "conf.d: has 65 files whose names end in .json; at most 64 are allowed\n");
  std::filesystem::remove_all(dir_ / "conf.d");
  std::filesystem::create_directory(dir_ / "conf.d");
  const std::string blanks(kMostJsonBytes / 2, ' ');
  put("conf.d/1.json", "{}" + blanks);
  EXPECT_EQ(findings(), "");
  put("conf.d/2.json", "{}" + blanks);
  EXPECT_EQ(findings(), fmt::format("conf.d/2.json: with the files before it there are {} bytes; a "
                                    "configuration has at most {}\n",
                                    kMostJsonBytes + 6, kMostJsonBytes));
}

TEST_F(ConfD, ADeepFileIsRefused) {
  put("merlin.json", "{}");
  put("conf.d/a.json", "{\"a\":" + std::string(40, '[') + std::string(40, ']') + "}");
  EXPECT_NE(findings().find("conf.d/a.json:1: "), std::string::npos);
}

}  // namespace
}  // namespace merlin
