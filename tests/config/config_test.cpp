#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "config/writer.h"
#include "tests/support/findings.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

using test::findingsOf;
using Verdict = LoadedSettings::Verdict;

TEST(Config, AnEmptyObjectIsTheDefaults) {
  const auto loaded = loadSettings("{}", "");
  EXPECT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  EXPECT_EQ(loaded.settings.devices.list.size(), 3u);
  EXPECT_EQ(loaded.settings.devices.hands.size(), 1u);
  EXPECT_EQ(loaded.settings.wall.governor.rate_hz, 30);
  EXPECT_EQ(loaded.settings.wall.tiles.tiles.size(), 4u);
}

TEST(Config, ReadsEveryKindOfSetting) {
  const auto loaded = loadSettings(R"({
    "instance": "lab-2",
    "devices": [{"name": "glove", "driver": "cyberglove", "port": "serial:/dev/ttyUSB0", "baud": 115200,
                 "cyberglove": {"slot7": "switch", "filter": false}},
                {"driver": "spaceball", "spaceball": {"axis_map": [1, 2, 3, 4, 5, 6], "dead_zone": 20}}],
    "bindings": [{"input": "posture.fist", "action": "grab"},
                 {"input": "glove.switch", "action": "next_mode"}],
    "wall": {"model": "models/a.mrm",
             "scene": {"ball_speed_m_s": [1, 2, 3.5]},
             "tiles": {"tiles": [{"name": "only", "kind": "operator", "x": 640, "y": 0, "turns": 0.5}]}}})",
                                   "/etc/merlin");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const Settings& s = loaded.settings;
  EXPECT_EQ(s.instance, "lab-2");
  ASSERT_EQ(s.devices.list.size(), 2u) << "a list replaces the default one";
  EXPECT_EQ(s.devices.list[0].line.baud, 115200);
  EXPECT_EQ(s.devices.list[0].own.cyberglove.slot7, Slot7Rule::kSwitch);
  EXPECT_FALSE(s.devices.list[0].own.cyberglove.filter);
  EXPECT_EQ(s.devices.list[1].own.spaceball.axis_map, (std::array<int, 6>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(s.wall.model, "/etc/merlin/models/a.mrm") << "relative to the configuration's folder";
  EXPECT_EQ(s.wall.scene.ball_speed_m_s, (std::array<double, 3>{1, 2, 3.5}));
  ASSERT_EQ(s.devices.bindings.size(), 2u);
  EXPECT_EQ(s.devices.bindings[1].action, "next_mode");
  ASSERT_EQ(s.wall.tiles.tiles.size(), 1u);
  EXPECT_EQ(s.wall.tiles.tiles[0].kind, render::tiles::TileKind::kOperator);
}

TEST(Config, SaysEverythingThatIsWrongAtOnceWithLineAndPointer) {
  const auto loaded = loadSettings(R"({
  "devices": [
    {"driver": "cyberglove", "prot": "pty:/tmp/a"},
    {"driver": "spaceball", "baud": "fast"}
  ],
  "wall": {
    "rate": {
      "rate_hz": 900
    },
    "render": {"backend": "vulkan"}
  }
})",
                                   "");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
  EXPECT_EQ(
      findingsOf(loaded),
      "f.json:3: /devices/0/prot is not a known setting; did you mean \"port\"?\n"
      "f.json:4: /devices/1/baud is the string \"fast\"; allowed is a whole number\n"
      "f.json:8: /wall/rate/rate_hz is 900; allowed is 1 to 240; 240 is used\n"
      "f.json:10: /wall/render/backend is the string \"vulkan\"; allowed is one of egl, osmesa\n");
}

TEST(Config, ANumberBeyondItsRangeIsClampedAndThatAloneIsAdjusted) {
  const auto loaded = loadSettings("{\"wall\": {\"rate\": {\"rate_hz\": 0.5}}}", "");
  EXPECT_EQ(loaded.verdict(), Verdict::kAdjusted);
  EXPECT_EQ(loaded.settings.wall.governor.rate_hz, 1);
}

struct Bad {
  const char* json;
  const char* what;  // a part of the finding's text
};

class BadConfig : public testing::TestWithParam<Bad> {};

TEST_P(BadConfig, IsInvalidAndSaysWhy) {
  const auto loaded = loadSettings(GetParam().json, "");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
  EXPECT_NE(findingsOf(loaded).find(GetParam().what), std::string::npos) << findingsOf(loaded);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadConfig,
    testing::Values(
        Bad{"", "f.json:1: "}, Bad{"[]", "f.json:1: is a list of 0; allowed is an object"},
        Bad{"{\n\"wall\": {,}}", "f.json:2: "},
        Bad{"{\"wall\": 1}", "/wall is the number 1; allowed is an object"},
        Bad{"{\"wall\": {}, \n\"wall\": {}}",
            "f.json:2: duplicate key \"wall\" in one object, first on line 1"},
        Bad{"{\"wall\": {\"rate\": {\"min_triangles\": 1.5}}}",
            "is the number 1.5; allowed is a whole number"},
        Bad{"{\"wall\": {\"scene\": {\"tracker_axes\": [1, 2]}}}",
            "is a list of 2; allowed is a list of 3 numbers"},
        Bad{"{\"wall\": {\"scene\": {\"tracker_axes\": [1, 2, true]}}}",
            "/wall/scene/tracker_axes/2 is true; allowed is a number"},
        Bad{"{\"wall\": {\"scene\": {\"tracker_axes\": [1, 2.5, 3]}}}",
            "/wall/scene/tracker_axes/1 is the number 2.5; allowed is a whole number"},
        Bad{"{\"alarms\": [{\"run\": [\"mail\"]}]}",
            "/alarms/0/run/0 is \"mail\"; a program is named by an absolute path"},
        Bad{"{\"instance\": \"a/b\"}", "is \"a/b\"; allowed are 1 to 32 letters, digits, - and _"},
        Bad{"{\"wall\": {\"scene\": {\"tracker_axes\": [1, 1, 2]}}}",
            "allowed is each of 1 to 3 once"},
        Bad{"{\"bindings\": [7]}", "/bindings/0 is the number 7; allowed is an object"},
        Bad{"{\"bindings\": [{\"input\": \"x\", \"acton\": \"grab\"}]}",
            "/bindings/0/acton is not a known setting; did you mean \"action\"?"},
        Bad{"{\"wall\": {\"rate\": {\"min_triangles\": 5000, \"first_triangles\": 100}}}",
            "they must be in ascending order"},
        Bad{"{\"a~b/c\": 1}",
            "f.json:1: /a~0b~1c is not a known setting; known here are instance, run_directory, "
            "state_file, devices, hands, postures, gestures, bindings, people, gpio"},
        Bad{"{\"wall\": {\"rate\": {\"rate_hz\": 1e999}}}", "f.json:1: "}));

TEST(Config, EveryTruncationOfAFileIsInvalidAndNoCrash) {
  const std::string text = settingsText(Settings());
  ASSERT_EQ(loadSettings(text, "").verdict(), Verdict::kValid)
      << findingsOf(loadSettings(text, ""));
  for (std::size_t n = 0; n + 2 < text.size(); n += 3) {
    EXPECT_EQ(loadSettings(text.substr(0, n), "").verdict(), Verdict::kInvalid) << n;
  }
}

TEST(Config, EveryOneByteDamageIsSurvived) {
  const std::string text = settingsText(Settings());
  for (std::size_t n = 0; n < text.size(); n += 7) {
    for (const char byte : {'\0', '"', '{', '}', '9', '\xFF'}) {
      std::string damaged = text;
      damaged[n] = byte;
      (void)loadSettings(damaged, "").verdict();
    }
  }
}

TEST(Config, DeepNestingIsRefused) {
  const auto loaded = loadSettings(std::string(100'000, '['), "");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
  EXPECT_NE(findingsOf(loaded).find("more than 32 levels deep"), std::string::npos);
  EXPECT_NE(
      findingsOf(loadSettings(std::string(2 << 20, ' '), "")).find("at most 1048576 are allowed"),
      std::string::npos);
}

// The number of findings that are kept is limited, but the verdict takes all of them into account.
TEST(Config, ManyFindingsAreCounted) {
  std::string keys;
  for (int i = 0; i < 50'000; ++i) keys += fmt::format("\"key{}\": 1,\n", i);
  const auto unknown = loadSettings("{" + keys + "\"instance\": \"a\"}", "");
  EXPECT_EQ(unknown.verdict(), Verdict::kInvalid);
  EXPECT_EQ(unknown.findings.size(), LoadedSettings::kMostFindings);
  EXPECT_EQ(unknown.left_out, 50'000 - LoadedSettings::kMostFindings);
  LoadedSettings adjusted;
  for (std::size_t i = 0; i <= LoadedSettings::kMostFindings; ++i)
    adjusted.add({true, 1, "/a", "is adjusted"});
  EXPECT_EQ(adjusted.verdict(), Verdict::kAdjusted);
  adjusted.addFinding("/a", "is wrong");
  EXPECT_EQ(adjusted.verdict(), Verdict::kInvalid);
}

TEST(Config, AFindingIsOneLineThatNoTerminalFollows) {
  const Finding finding{false, 3, "/a\nb", "is \"\x1b[2J\ttext\n\""};
  EXPECT_EQ(toText("f\n.json", finding), "f\\x0a.json:3: /a\\x0ab is \"\\x1b[2J\\x09text\\x0a\"");
}

TEST(Config, AMissingFileIsOneFinding) {
  const auto loaded = loadSettingsFile("/no/such/file.json");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
  ASSERT_EQ(loaded.findings.size(), 1u);
  EXPECT_EQ(toText("/no/such/file.json", loaded.findings[0]),
            "/no/such/file.json: No such file or directory");
}

TEST(Config, WritingKeepsEveryDigit) {
  Settings settings;
  settings.wall.scene.model_distance_m = 1.23456789012345;
  settings.wall.scene.hand_noise_m = 0.1F;  // 0.10000000149 if printed as a double
  const std::string text = settingsText(settings);
  EXPECT_NE(text.find("\"model_distance_m\": 1.23456789012345"), std::string::npos);
  EXPECT_NE(text.find("\"hand_noise_m\": 0.1,"), std::string::npos);
}

TEST(Config, WritingAndReadingGivesTheSame) {
  Settings settings;
  settings.wall.scene.hand_gain = 2.5;
  settings.devices.list[1].line.port = "pty:/tmp/t";
  settings.wall.tiles.tiles.pop_back();
  const std::string text = settingsText(settings);
  const auto loaded = loadSettings(text, "/");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  EXPECT_EQ(settingsText(loaded.settings), text);
  EXPECT_EQ(loaded.settings.devices.list[0].own.cyberglove.gain,
            settings.devices.list[0].own.cyberglove.gain);
}

// The schema has to describe the items also of a list that is empty by default.
TEST(Config, TheSchemaDescribesTheItemsOfEveryList) {
  const std::string schema = settingsSchema();
  const std::size_t contents = schema.find("\"contents\"");
  ASSERT_NE(contents, std::string::npos);
  const std::size_t model = schema.find("\"model\"", contents);
  EXPECT_LT(model, schema.find("\"rate\"", contents));
  EXPECT_EQ(schema.find("\"properties\": {}"), std::string::npos);
}

// A room and these settings exclude each other, but a file need not have a room, so the schema must
// not require one.
TEST(Config, TheSchemaDescribesTilesWithoutARoom) {
  const std::string schema = settingsSchema();
  for (const char* key : {"\"frame_width\"", "\"frame_height\"", "\"frustum_deg\""})
    EXPECT_NE(schema.find(key), std::string::npos) << key;
}

TEST(Config, TheSchemaInTheRepositoryIsTheProgramsOwn) {
  EXPECT_EQ(test::readText(MERLIN_SOURCE_DIR "/config/merlin.schema.json"), settingsSchema())
      << "merlind --print-schema > config/merlin.schema.json";
}

TEST(Config, EveryShippedConfigurationIsValid) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MERLIN_SOURCE_DIR "/config")) {
    const std::string name = entry.path().filename();
    if (entry.path().extension() != ".json" || name == "merlin.schema.json" ||
        name == "postures.json" || name == "gestures.json")
      continue;
    ++files;
    const auto loaded = loadSettingsFile(entry.path());
    EXPECT_EQ(loaded.verdict(), Verdict::kValid) << name << "\n" << findingsOf(loaded);
  }
  EXPECT_GE(files, 3);
}

}  // namespace
}  // namespace merlin
