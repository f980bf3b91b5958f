// The settings in effect: which of them differ from the defaults or between two configurations, and
// which are secret.
#include "config/effective.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "config/loader.h"

namespace merlin {
namespace {

using Changes = std::vector<SettingChange>;

Settings load(const std::string& json) {
  const LoadedSettings loaded = loadSettings(json, "/etc/merlin");
  EXPECT_EQ(loaded.verdict(), LoadedSettings::Verdict::kValid) << json;
  return loaded.settings;
}

SettingValue valueAt(const std::vector<SettingValue>& values, const std::string& pointer) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const SettingValue& v) { return v.pointer == pointer; });
  return found == values.end() ? SettingValue{} : *found;
}

TEST(Effective, TheDefaultsDoNotDifferFromThemselves) {
  EXPECT_EQ(changesFromDefaults(load("{}")), Changes{});
  for (const SettingValue& v : valuesOf(load("{}")))
    EXPECT_EQ(v.value, v.default_value) << v.pointer;
}

TEST(Effective, AChangeHasItsPointerAndBothValues) {
  EXPECT_EQ(changesFromDefaults(load(R"({"wall": {"rate": {"rate_hz": 25}}})")),
            (Changes{{"/wall/rate/rate_hz", "30", "25"}}));
  const Settings one = load(R"({"wall": {"contents": [{"model": "a.mrm"}]}})");
  EXPECT_EQ(changesBetween(one, load("{}")),
            (Changes{{"/wall/contents", "", "[]"},
                     {"/wall/contents/0/name", "\"\"", ""},
                     {"/wall/contents/0/model", "\"/etc/merlin/a.mrm\"", ""},
                     {"/wall/contents/0/picture", "\"\"", ""},
                     {"/wall/contents/0/slides", "\"\"", ""},
                     {"/wall/contents/0/show_as", "\"marked\"", ""}}));
}

TEST(Effective, AnEntryIsComparedWithANewOne) {
  const auto values = valuesOf(load(R"({"wall": {"outputs": [{"kind": "shared_memory"},
                                             {"kind": "png", "name": "p", "path": "f.png"}]}})"));
  EXPECT_EQ(valueAt(values, "/wall/outputs/1/kind").default_value, "\"shared_memory\"");
  EXPECT_EQ(valueAt(values, "/wall/outputs/1/kind").value, "\"png\"");
}

TEST(Effective, SecretsAreLeftOutAndTheirFilesAreKnown) {
  const Settings settings = load(R"({"projectors": [
      {"name": "a", "address": "h", "password_file": "a.password"}, {"name": "b", "address": "i"}]})");
  EXPECT_EQ(secretFilesOf(settings), (std::vector<std::string>{"/etc/merlin/a.password"}));
  const auto values = valuesOf(settings, Secrets::kLeftOut);
  EXPECT_EQ(valueAt(values, "/projectors/0/password_file").value, "\"(left out)\"");
  EXPECT_EQ(valueAt(values, "/projectors/1/password_file").value, "\"\"");
  EXPECT_EQ(settingsText(settings, Secrets::kLeftOut).find("a.password"), std::string::npos);
  EXPECT_NE(settingsText(settings).find("a.password"), std::string::npos);
}

TEST(Effective, EveryFileWithASecretIsDescribedAsOne) {
  Settings settings;
  settings.devices.projectors.resize(1);
  settings.devices.projectors[0].password_file = "1";
  settings.serve.samples_keys = "2";
  settings.wall.input.keys = "3";
  settings.serve.commands_keys = "4";
  auto files = secretFilesOf(settings);
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (std::vector<std::string>{"1", "2", "3", "4"}));
}

}  // namespace
}  // namespace merlin
