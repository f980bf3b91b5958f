// merlin config show: the settings in effect, and the origin of each.
#include "daemon/cli/config/shown_settings.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace merlin::cli {
namespace {

ShownSetting find(const std::vector<ShownSetting>& settings, const std::string& pointer) {
  const auto found = std::find_if(settings.begin(), settings.end(), [&](const ShownSetting& s) {
    return s.setting.pointer == pointer;
  });
  EXPECT_NE(found, settings.end()) << pointer;
  return found == settings.end() ? ShownSetting{} : *found;
}

std::string lineOf(const ShownSetting& setting) {
  return settingsLines(std::vector<ShownSetting>{setting});
}

TEST(ShownSettings, SayWhereEachComesFrom) {
  const auto loaded = loadSettings(
      "{\"instance\": \"merlin\",\n\"wall\": {\"rate\": {\"rate_hz\": 25}}}", "/etc/merlin");
  const auto settings = shownSettings(loaded, "m.json", nullptr);
  EXPECT_EQ(lineOf(find(settings, "/wall/rate/rate_hz")),
            "* /wall/rate/rate_hz: 25  (m.json:2; default 30)\n");
  EXPECT_EQ(lineOf(find(settings, "/instance")), "  /instance: \"merlin\"  (m.json:1)\n")
      << "in the file, as the default";
  EXPECT_EQ(lineOf(find(settings, "/run_directory")), "  /run_directory: \"\"\n");
}

TEST(ShownSettings, WhatPeopleChangedHoldsInsteadOfTheFile) {
  const auto loaded = loadSettings(R"({"wall": {"rate": {"rate_hz": 25}}})", "");
  RunTimeChanges changes{"s.json", {}};
  changes.state.rate_hz = 12.5;
  changes.state.playlist_off = true;
  changes.state.content = "/m/a.mrm";
  const auto settings = shownSettings(loaded, "m.json", &changes);
  EXPECT_EQ(lineOf(find(settings, "/wall/rate/rate_hz")),
            "* /wall/rate/rate_hz: 12.5  (changed while the wall ran: s.json; default 30)\n");
  EXPECT_EQ(changesLines(changes),
            "Also changed while the wall ran, in s.json:\n  the content that is shown: /m/a.mrm\n"
            "  the playlist is off\n");
  EXPECT_EQ(changesLines({"s.json", {}}), "");
}

TEST(ShownSettings, AnEntryOfAListIsComparedWithTheDefaultListOfThatLength) {
  const auto loaded = loadSettings(R"({"bindings": [
{"input": "posture.fist", "action": "fly"}, {"input": "ball.button.1", "action": "grab"},
{"input": "ball.button.2", "action": "reset_view"}, {"input": "panel.button", "action": "next_mode"}]})",
                                   "");
  const auto settings = shownSettings(loaded, "m.json", nullptr);
  EXPECT_EQ(lineOf(find(settings, "/bindings/1/action")),
            "* /bindings/1/action: \"grab\"  (m.json:2; default \"reset_view\")\n");
  EXPECT_EQ(lineOf(find(settings, "/bindings/3/action")),
            "  /bindings/3/action: \"next_mode\"  (m.json:3)\n");
  EXPECT_EQ(lineOf(find(settings, "/bindings/1/on")), "  /bindings/1/on: \"by_action\"\n");
}

TEST(ShownSettings, WhatAnEntryOfAListDoesNotSayIsTheDefault) {
  const auto loaded = loadSettings(R"({"devices": [
{"name": "ball", "driver": "spaceball",
 "spaceball": {"null_region": 30}}, {"name": "glove", "driver": "cyberglove"},
{"name": "tracker", "driver": "fastrak", "baud": 19200}]})",
                                   "");
  const auto settings = shownSettings(loaded, "m.json", nullptr);
  EXPECT_EQ(lineOf(find(settings, "/devices/0/spaceball/null_region")),
            "* /devices/0/spaceball/null_region: 30  (m.json:3)\n");
  EXPECT_EQ(lineOf(find(settings, "/devices/0/spaceball/cubic")),
            "  /devices/0/spaceball/cubic: true\n");
  EXPECT_EQ(lineOf(find(settings, "/devices/0/baud")), "  /devices/0/baud: 9600\n")
      << "of its driver, whatever the first of the default devices is";
  EXPECT_EQ(lineOf(find(settings, "/devices/2/baud")),
            "* /devices/2/baud: 19200  (m.json:4; default 9600)\n");
}

TEST(ShownSettings, AreJsonForPrograms) {
  const auto loaded = loadSettings(R"({"instance": "lab"})", "");
  const auto settings = shownSettings(loaded, "m.json", nullptr);
  const auto json = nlohmann::json::parse(settingsJson(settings));
  EXPECT_EQ(json[0], nlohmann::json::parse(R"({"pointer": "/instance", "value": "lab",
      "default": "merlin", "differs": true, "origin": "file", "file": "m.json", "line": 1})"));
  EXPECT_EQ(json.size(), settings.size());
}

}  // namespace
}  // namespace merlin::cli
