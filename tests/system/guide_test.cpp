// The guide "From boxes to wall": its commands exist, and its pieces of configuration are valid.
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/loader.h"
#include "tests/support/findings.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

const std::string kGuide = MERLIN_SOURCE_DIR "/systemd/from-boxes-to-wall.md";

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Returns the words of each line of the guide that runs `merlin`, without a trailing comment.
std::vector<std::vector<std::string>> commands() {
  std::vector<std::vector<std::string>> all;
  const std::regex command("    (# )?merlin ([^#]*)(#.*)?");
  for (const std::string& line : linesOf(readText(kGuide))) {
    std::smatch found;
    if (!std::regex_match(line, found, command)) continue;
    std::istringstream words(found[2]);
    auto& one = all.emplace_back();
    for (std::string word; words >> word;) one.push_back(word);
  }
  return all;
}

// Returns the text of each block of the guide between "```json" and "```".
std::vector<std::string> configurations() {
  std::vector<std::string> all;
  bool inside = false;
  for (const std::string& line : linesOf(readText(kGuide))) {
    if (line.starts_with("```")) {
      inside = line == "```json";
      if (inside) all.emplace_back();
    } else if (inside) {
      all.back() += line + "\n";
    }
  }
  return all;
}

TEST(Guide, ItsCommandsAreTaken) {
  const auto all = commands();
  EXPECT_GE(all.size(), 12u);
  for (std::vector<std::string> words : all) {
    words.insert(words.begin(), kMerlin);
    words.emplace_back("--help");
    const auto said = run(words);
    EXPECT_EQ(said.status, 0) << words[1] << ": " << said.output;
    EXPECT_NE(said.output.find("Usage:"), std::string::npos) << words[1];
  }
}

TEST(Guide, ItsConfigurationsAreValid) {
  const auto all = configurations();
  EXPECT_GE(all.size(), 4u);
  for (const std::string& json : all) {
    const LoadedSettings loaded = loadSettings(json, "/etc/merlin");
    EXPECT_EQ(findingsOf(loaded), "") << json;
  }
}

// The guide sends its readers to these files, so none may be missing.
TEST(Guide, TheFilesThatItNamesAreThere) {
  const std::regex named("`([a-z_/]+/README\\.md)`|/usr/share/merlin/([a-z0-9-]+\\.json)");
  const std::string text = readText(kGuide);
  int files = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it, ++files) {
    const std::string file =
        (*it)[1].matched ? kSource + "/" + (*it)[1].str() : kSource + "/config/" + (*it)[2].str();
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
  }
  EXPECT_GE(files, 8);
}

}  // namespace
}  // namespace merlin::test
