#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/drawn_wall.h"
#include "config/loader.h"
#include "config/writer.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

using Verdict = LoadedSettings::Verdict;

std::string all(const LoadedSettings& loaded) {
  std::string text;
  for (const Finding& f : loaded.findings) text += toText("f.json", f) + "\n";
  return text;
}

TEST(Config, AnEmptyObjectIsTheDefaults) {
  const auto loaded = loadSettings("{}", "");
  EXPECT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  EXPECT_EQ(loaded.settings.devices.glove_line.baud, 38400);
  EXPECT_EQ(loaded.settings.devices.tracker_line.baud, 38400);
  EXPECT_EQ(loaded.settings.devices.ball_line.baud, 9600);
  EXPECT_EQ(loaded.settings.wall.governor.rate_hz, 30);
  EXPECT_EQ(loaded.settings.wall.tiles.tiles.size(), 4u);
}

TEST(Config, ReadsEveryKindOfSetting) {
  const auto loaded = loadSettings(R"({
    "instance": "lab-2",
    "devices": {"glove": {"port": "serial:/dev/ttyUSB0", "baud": 115200, "slot7": "switch", "filter": false},
                "ball": {"axis_map": [1, 2, 3, 4, 5, 6], "dead_zone": 20},
                "bindings": [{"input": "posture.fist", "action": "grab"},
                             {"input": "glove.switch", "action": "next_mode"}]},
    "wall": {"model": "models/a.mrm",
             "scene": {"ball_speed_m_s": [1, 2, 3.5]},
             "tiles": {"tiles": [{"name": "only", "kind": "operator", "x": 640, "y": 0, "turns": 0.5}]}}})",
                                   "/etc/merlin");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  const Settings& s = loaded.settings;
  EXPECT_EQ(s.instance, "lab-2");
  EXPECT_EQ(s.devices.glove_line.baud, 115200);
  EXPECT_EQ(s.devices.glove.slot7, Slot7Rule::kSwitch);
  EXPECT_FALSE(s.devices.glove.filter);
  EXPECT_EQ(s.devices.ball.axis_map, (std::array<int, 6>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(s.wall.model, "/etc/merlin/models/a.mrm") << "relative to the configuration's folder";
  EXPECT_EQ(s.wall.scene.ball_speed_m_s, (std::array<double, 3>{1, 2, 3.5}));
  ASSERT_EQ(s.devices.bindings.size(), 2u) << "a list replaces the default one";
  EXPECT_EQ(s.devices.bindings[1].action, "next_mode");
  ASSERT_EQ(s.wall.tiles.tiles.size(), 1u);
  EXPECT_EQ(s.wall.tiles.tiles[0].kind, render::tiles::TileKind::kOperator);
}

std::string bindingsAre(const std::string& list) {
  return all(loadSettings("{\"devices\": {\"bindings\": [" + list + "]}}", ""));
}

TEST(Config, BindingsThatConflictAreNamedBoth) {
  const std::string fist = R"({"input": "posture.fist", "action": "grab"})";
  EXPECT_EQ(bindingsAre(fist), "");
  EXPECT_EQ(bindingsAre(fist + "," + fist),
            "f.json:1: /devices/bindings/1 conflicts with /devices/bindings/0 (line 1): "
            "\"posture.fist\" would grab twice when held\n");
  EXPECT_EQ(bindingsAre(fist + ",\n" + R"({"input": "posture.fist", "action": "fly"})"),
            "f.json:2: /devices/bindings/1 conflicts with /devices/bindings/0 (line 1): "
            "\"posture.fist\" would both grab and fly when held, which exclude each other\n");
  const std::string fist_left =
      R"({"input": "posture.fist", "action": "reset_view", "on": "leave"})";
  EXPECT_EQ(bindingsAre(fist + "," + fist_left), "");
  EXPECT_EQ(bindingsAre(fist_left + "," + fist_left),
            "f.json:1: /devices/bindings/1 conflicts with /devices/bindings/0 (line 1): "
            "\"posture.fist\" would reset_view twice when left\n");
}

TEST(Config, ActionsThatNothingCouldDoAreFound) {
  const std::string bindings =
      R"("bindings": [{"input": "posture.a", "action": "snapshot"},
                      {"input": "posture.b", "action": "lamp_slow"},
                      {"input": "posture.c", "action": "next_content"}])";
  EXPECT_EQ(all(loadSettings("{\"devices\": {" + bindings + "}}", "")),
            "f.json:1: /devices/bindings/0/action is snapshot, which needs a folder: "
            "/wall/snapshots names none\n"
            "f.json:2: /devices/bindings/1/action is lamp_slow, which needs a lamp: "
            "/devices/gpio has no chip with a lamp_line\n"
            "f.json:3: /devices/bindings/2/action is next_content, and there is one content only: "
            "/wall/contents names none\n");
  EXPECT_EQ(all(loadSettings(R"({"wall": {"snapshots": "taken", "contents": [{"model": "b.mrm"}]},
                                "devices": {"gpio": {"chip": "gpiochip0", "lamp_line": 5}, )" +
                                 bindings + "}}",
                             "")),
            "");
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "lamp_on"},
                          {"input": "posture.a", "action": "lamp_off"})")
                .find("\"posture.a\" would both lamp_on and lamp_off when entered"),
            std::string::npos);
}

TEST(Config, ProjectorsAndTheirScheduleAreChecked) {
  const auto loaded = loadSettings(R"({"devices": {
      "projectors": [{"name": "left", "address": "10.0.0.7", "password_file": "p", "warm_up_s": 60}],
      "projector_schedule": [{"days": ["mon", "sun"], "on": "09:00", "off": "17:30"}]}})",
                                   "/etc/merlin");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  EXPECT_EQ(loaded.settings.devices.projectors[0].password_file, "/etc/merlin/p");
  EXPECT_EQ(loaded.settings.devices.projector_schedule[0].days,
            (std::vector<std::string>{"mon", "sun"}));
  EXPECT_EQ(all(loadSettings(R"({"devices": {
      "projector_schedule": [{"days": ["monday"], "on": "09:00", "off": "17:30"}]}})",
                             "")),
            "f.json:2: /devices/projector_schedule/0/days/0 is \"monday\"; allowed are mon, tue, "
            "wed, thu, fri, sat, sun\n"
            "f.json:2: /devices/projector_schedule needs projectors: /devices/projectors is empty, "
            "and /devices/gpio has no chip with a projector_line\n");
  EXPECT_EQ(bindingsAre(R"({"input": "posture.a", "action": "projector_on"})"),
            "f.json:1: /devices/bindings/0/action is projector_on, which needs projectors: "
            "/devices/projectors is empty, and /devices/gpio has no chip with a projector_line\n");
}

TEST(Config, AContentIsOneFileAndItsNameIsItsOwn) {
  const auto contents = [](const std::string& list) {
    return all(loadSettings("{\"wall\": {\"contents\": [" + list + "]}}", ""));
  };
  EXPECT_EQ(contents(R"({"model": "a.mrm"}, {"picture": "b.tif", "show_as": "panorama"},
                        {"slides": "c", "name": "talk"})"),
            "");
  EXPECT_EQ(
      contents(R"({"model": "a.mrm", "picture": "b.tif"})"),
      "f.json:1: /wall/contents/0 names more than one file; give it one of model, picture and "
      "slides\n");
  EXPECT_EQ(contents(R"({"picture": "a.tif", "name": "sky"}, {"picture": "b.tif", "name": "sky"})"),
            "f.json:1: /wall/contents/1/name is \"sky\", the name of another content\n");
}

TEST(Config, AGloveFasterThanItsLineIsFound) {
  const auto at = [](const std::string& line) {
    return all(
        loadSettings("{\"devices\": {\"glove\": {\"dialogue\": \"text\", " + line + "}}}", ""));
  };
  EXPECT_EQ(at(R"("port": "serial:/dev/ttyS0")"),
            "f.json:1: /devices/glove/rate_hz is 100, but a line of 38400 baud carries 40 records "
            "of 96 bytes per second: lower the rate or raise the speed\n");
  EXPECT_EQ(at(R"("port": "serial:/dev/ttyS0", "baud": 115200)"), "");
  EXPECT_EQ(at(R"("port": "serial:/dev/ttyS0", "rate_hz": 40)"), "");
  EXPECT_EQ(at(R"("port": "tcp://server:4001")"), "") << "its line is not ours";
}

TEST(Config, BindingsThatNameNothingAreFound) {
  EXPECT_NE(bindingsAre(R"({"input": "ball.button.13", "action": "grab"})")
                .find("allowed are ball.button.1 to ball.button.12"),
            std::string::npos);
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "grab", "on": "leave"})")
                .find("/devices/bindings/0/on is leave, but grab lasts as long as its input is "
                      "held: set hold"),
            std::string::npos);
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "dance"})").find("fly"),
            std::string::npos)
      << "the list of what exists";
}

TEST(Config, SaysEverythingThatIsWrongAtOnceWithLineAndPointer) {
  const auto loaded = loadSettings(R"({
  "devices": {
    "glove": {"prot": "pty:/tmp/a"},
    "ball": {"baud": "fast"}
  },
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
      all(loaded),
      "f.json:3: /devices/glove/prot is not a known setting; did you mean \"port\"?\n"
      "f.json:4: /devices/ball/baud is the string \"fast\"; allowed is a whole number\n"
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
  EXPECT_NE(all(loaded).find(GetParam().what), std::string::npos) << all(loaded);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadConfig,
    testing::Values(
        Bad{"", "f.json:1: "}, Bad{"[]", "f.json:1: is a list of 0; allowed is an object"},
        Bad{"{\n\"wall\": {,}}", "f.json:2: "},
        Bad{"{\"wall\": 1}", "/wall is the number 1; allowed is an object"},
        Bad{"{\"wall\": {}, \n\"wall\": {}}",
            "f.json:2: duplicate key \"wall\" in one object, first on line 1"},
        Bad{"{\"devices\": {\"ball\": {\"dead_zone\": 1.5}}}",
            "is the number 1.5; allowed is a whole number"},
        Bad{"{\"devices\": {\"ball\": {\"axis_map\": [1, 2]}}}",
            "is a list of 2; allowed is a list of 6 numbers"},
        Bad{"{\"devices\": {\"ball\": {\"axis_map\": [1, 2, 3, 4, 5, true]}}}",
            "/devices/ball/axis_map/5 is true; allowed is a number"},
        Bad{"{\"devices\": {\"ball\": {\"axis_map\": [1, 2, 3, 4, 5, 5]}}}",
            "allowed is each of 1 to 6 once"},
        Bad{"{\"devices\": {\"glove\": {\"baud\": 31337}}}",
            "is 31337; allowed are 1200, 2400, 4800"},
        Bad{"{\"devices\": {\"ball\": {\"port\": \"evdev:/dev/input/event3\"}}}",
            "which the driver \"spaceball\" does not read; set \"driver\": \"evdev\""},
        Bad{"{\"devices\": {\"ball\": {\"evdev\": {\"axes\": [\"x\", \"up\", \"none\", \"none\", "
            "\"none\", \"none\"]}}}}",
            "/devices/ball/evdev/axes/1 is \"up\"; allowed are the kernel's name of an axis"},
        Bad{"{\"serve\": {\"spnav_socket\": \"/run/a.sock\"}, \"devices\": {\"ball\": {\"driver\": "
            "\"spacenav\", \"port\": \"unix:/run/a.sock\"}}}",
            "/devices/ball/port is \"unix:/run/a.sock\", the socket that merlind serves"},
        Bad{"{\"alarms\": [{\"run\": [\"mail\"]}]}",
            "/alarms/0/run/0 is \"mail\"; a program is named by an absolute path"},
        Bad{"{\"devices\": {\"glove\": {\"port\": \"/dev/ttyS0\"}}}",
            "allowed are serial:/dev/..., pty:PATH"},
        Bad{"{\"devices\": {\"tracker\": {\"driver\": \"vrpn\", \"port\": \"unix:/x\"}}}",
            "/devices/tracker/port is \"unix:/x\", at which no VRPN server can be"},
        Bad{"{\"devices\": {\"tracker\": {\"vrpn\": {\"device\": \"Wand@lab\"}}}}",
            "/devices/tracker/vrpn/device is \"Wand@lab\"; needed is the name alone"},
        Bad{"{\"serve\": {\"vrpn_port\": 4000}, \"devices\": {\"tracker\": {\"driver\": \"vrpn\", "
            "\"port\": \"tcp://127.0.0.1:4000\"}}}",
            "/devices/tracker/port is \"tcp://127.0.0.1:4000\", where merlind itself serves"},
        Bad{"{\"instance\": \"a/b\"}", "is \"a/b\"; allowed are 1 to 32 letters, digits, - and _"},
        Bad{"{\"wall\": {\"scene\": {\"tracker_axes\": [1, 1, 2]}}}",
            "allowed is each of 1 to 3 once"},
        Bad{"{\"devices\": {\"bindings\": [7]}}",
            "/devices/bindings/0 is the number 7; allowed is an object"},
        Bad{"{\"devices\": {\"bindings\": [{\"input\": \"x\", \"acton\": \"grab\"}]}}",
            "/devices/bindings/0/acton is not a known setting; did you mean \"action\"?"},
        Bad{"{\"wall\": {\"rate\": {\"min_triangles\": 5000, \"first_triangles\": 100}}}",
            "they must be in ascending order"},
        Bad{"{\"a~b/c\": 1}",
            "f.json:1: /a~0b~1c is not a known setting; known here are instance, run_directory, "
            "state_file, devices, wall"},
        Bad{"{\"wall\": {\"rate\": {\"rate_hz\": 1e999}}}", "f.json:1: "}));

TEST(Config, EveryTruncationOfAFileIsInvalidAndNoCrash) {
  const std::string text = settingsText(Settings());
  ASSERT_EQ(loadSettings(text, "").verdict(), Verdict::kValid) << all(loadSettings(text, ""));
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
  EXPECT_NE(all(loaded).find("more than 32 levels deep"), std::string::npos);
  EXPECT_NE(all(loadSettings(std::string(2 << 20, ' '), "")).find("at most 1048576 are allowed"),
            std::string::npos);
}

// The number of findings kept is limited; the verdict takes all of them into account.
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
  settings.devices.tracker_line.port = "pty:/tmp/t";
  settings.wall.tiles.tiles.pop_back();
  const std::string text = settingsText(settings);
  const auto loaded = loadSettings(text, "/");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  EXPECT_EQ(settingsText(loaded.settings), text);
  EXPECT_EQ(loaded.settings.devices.glove.gain, settings.devices.glove.gain);
}

std::string wallIs(const std::string& members) {
  return all(loadSettings("{\"wall\": {" + members + "}}", ""));
}

TEST(Config, ARoomReplacesTheTiles) {
  const auto loaded = loadSettings(R"({"wall": {
    "room": {"preset": {"name": "three_120", "width": 800, "height": 600}, "eye_m": [0.1, 0, 0]},
    "tiles": {"near_m": 0.1},
    "outputs": [{"kind": "png", "path": "a.png", "tiles": [{"tile": "right"}]}]}})",
                                   "/");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  const render::tiles::TilesSettings& tiles = loaded.settings.wall.tiles;
  ASSERT_EQ(tiles.tiles.size(), 4u);
  EXPECT_EQ(tiles.tiles[2].name, "right");
  EXPECT_EQ(tiles.tiles[2].width, 800);
  EXPECT_EQ(tiles.near_m, 0.1);
  EXPECT_EQ(tiles.frame_width, 1600);
  EXPECT_EQ(tiles.frame_height, 1200);
  const std::string text = settingsText(loaded.settings);
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << all(again);
  EXPECT_EQ(settingsText(again.settings), text) << "what is printed can be read";
  EXPECT_EQ(again.settings.wall.tiles.tiles[2].screen_m, tiles.tiles[2].screen_m);
}

TEST(Config, ARoomAndTilesByHandExcludeEachOther) {
  const std::string room = R"("room": {"preset": {"name": "flat"}})";
  EXPECT_EQ(wallIs(room), "");
  EXPECT_EQ(wallIs(room + R"(, "tiles": {"tile_width": 320})"), "");
  EXPECT_EQ(wallIs("\n" + room + ",\n" + R"("tiles": {"frame_width": 1280,
                   "tiles": [{"name": "a"}]})"),
            "f.json:3: /wall/tiles/frame_width is given together with /wall/room, from which it is "
            "computed: leave out one of the two\n"
            "f.json:4: /wall/tiles/tiles is given together with /wall/room, from which it is "
            "computed: leave out one of the two\n");
}

TEST(Config, WhatIsWrongWithARoomIsSaidOnce) {
  EXPECT_EQ(wallIs("\n\"room\": {\"panels\": [\n"
                   R"({"name": "a", "width_m": 2, "height_m": 1, "lower_left_m": [-1, 0, 1]}]},
                   "outputs": [{"kind": "png", "path": "a.png", "tiles": [{"tile": "a"}]}])"),
            "f.json:3: /wall/room/panels/0 cannot be used: panel a does not face the viewer: the "
            "eye is 1.000 m behind it; check eye_m, yaw_deg and the hinges\n");
  EXPECT_EQ(wallIs(R"("room": {"eye_m": [0, 1, 0]})"),
            "f.json:1: /wall/room cannot be used: the room has no panels: list them in /panels, or "
            "choose a preset in /preset/name (flat, three_160, three_120, six, hexagon)\n");
  EXPECT_EQ(wallIs(R"("room": {"preset": {"name": "cave"}})"),
            "f.json:1: /wall/room/preset/name is the string \"cave\"; allowed is one of none, "
            "flat, three_160, three_120, six, hexagon\n");
}

// The schema describes the items also of a list that is empty by default.
TEST(Config, TheSchemaDescribesTheItemsOfEveryList) {
  const std::string schema = settingsSchema();
  const std::size_t contents = schema.find("\"contents\"");
  ASSERT_NE(contents, std::string::npos);
  const std::size_t model = schema.find("\"model\"", contents);
  EXPECT_LT(model, schema.find("\"rate\"", contents));
  EXPECT_EQ(schema.find("\"properties\": {}"), std::string::npos);
}

// A room excludes them, and a file need not have a room.
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
        name == "postures.json")
      continue;
    ++files;
    const auto loaded = loadSettingsFile(entry.path());
    EXPECT_EQ(loaded.verdict(), Verdict::kValid) << name << "\n" << all(loaded);
  }
  EXPECT_GE(files, 3);
}

// Three projectors on a hinged screen. The measured figures are rounded, so they are symmetric only
// within that.
TEST(Config, TheShippedRoomIsThreePanelsAroundTheViewer) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-three-160.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  const auto& tiles = loaded.settings.wall.tiles.tiles;
  ASSERT_EQ(tiles.size(), 4u);
  const auto& left = tiles[0].screen_m;
  const auto& right = tiles[2].screen_m;
  EXPECT_NEAR(left[0], -right[3], 0.004) << "symmetric";
  EXPECT_NEAR(left[2], right[5], 0.004);
  EXPECT_NEAR(left[3], tiles[1].screen_m[0], 1e-12) << "hinged";
}

TEST(Config, TheShippedStereoWallHasTwoPicturesOnEachProjector) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-stereo.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  EXPECT_EQ(loaded.settings.wall.tiles.tiles.size(), 4u) << "what is set";
  const WallSettings drawn = drawnWall(loaded.settings.wall);
  EXPECT_EQ(drawn.tiles.tiles.size(), 7u) << "what is drawn";
  ASSERT_EQ(drawn.outputs[2].tiles.size(), 2u);
  EXPECT_EQ(drawn.outputs[2].tiles[0].tile, "centre.L");
  EXPECT_EQ(drawn.outputs[2].tiles[1].tile, "centre.R");
  const std::string text = settingsText(loaded.settings);
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << all(again);
  EXPECT_EQ(settingsText(again.settings), text) << "what is printed can be read";
}

TEST(Config, TheShippedWallWithoutADesktopHasFourDisplays) {
  const auto loaded = loadSettingsFile(MERLIN_SOURCE_DIR "/config/wall-kms-four.json");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << all(loaded);
  const auto& outputs = loaded.settings.wall.outputs;
  ASSERT_EQ(outputs.size(), 5u);
  EXPECT_EQ(outputs[3].kind, render::out::OutputKind::kKms);
  EXPECT_EQ(outputs[3].kms.connector, "DP-1");
  EXPECT_EQ(outputs[3].kms.mode, "1024x768@60");
  EXPECT_EQ(outputs[3].tiles[0].tile, "right");
}

TEST(Config, ViewsOfTilesAndDisplaysAreChecked) {
  EXPECT_EQ(wallIs(R"("tiles": {"tiles": [{"name": "a", "view": "side"},
                     {"name": "b", "x": 640, "view": "free",
                      "camera": {"eye_m": [0, 3, -2], "up": [0, 0, -1]}}]})"),
            "");
  EXPECT_EQ(wallIs("\n"
                   R"("tiles": {"tiles": [{"name": "a", "turns": 1, "view": "top"}]})"),
            "f.json:2: /wall/tiles/tiles/0 cannot be used: tile a has view top, a camera of its "
            "own: leave "
            "out turns, direction_deg, frustum_deg and screen_m, or set view to wall\n");
  const std::string panel = R"("room": {"panels": [{"name": "p", "width_m": 2, "height_m": 1,
                                        "lower_left_m": [-1, -0.5, -2]}], "displays": [)";
  EXPECT_EQ(wallIs(panel + R"({"name": "d", "view": "top"}]})"), "");
  EXPECT_EQ(
      wallIs(panel + R"({"name": "d", "view": "free", "camera": {"look_at_m": [0, 0, 0]}}]})"),
      "f.json:2: /wall/room/displays/0 cannot be used: tile d: camera: eye_m and look_at_m are the "
      "same place; the camera looks from the first to the second\n");
}

TEST(Config, StereoIsCheckedWithTheRestOfTheWall) {
  const std::string room = R"("room": {"preset": {"name": "flat"}})";
  EXPECT_EQ(wallIs(room + R"(, "stereo": {"mode": "anaglyph"})"), "");
  EXPECT_EQ(
      wallIs(room + ",\n"
                    R"("stereo": {"mode": "anaglyph", "screen_distance_m": 2})"),
      "f.json:2: /wall/stereo/screen_distance_m is given together with /wall/room, which says how "
      "far away each screen is: leave out one of the two\n");
  EXPECT_EQ(wallIs("\n"
                   R"("stereo": {"mode": "two_outputs"})"),
            "f.json:2: /wall/stereo/mode is two_outputs, and tile left has no output for each eye: "
            "let one "
            "output show left.L and another one left.R (/wall/outputs/N/tiles)\n");
  EXPECT_EQ(wallIs("\n"
                   R"("stereo": {"head": {"station": 1}})"),
            "f.json:2: /wall/stereo/head/station is 1, the station that is worn on the hand "
            "(/devices/hand/station); the head needs its own\n");
}

TEST(Config, APanelNeedsAnOperatorsTileWithRoom) {
  EXPECT_EQ(wallIs(R"("operator": {"panel": true})"), "");
  EXPECT_EQ(wallIs(R"("operator": {"panel": true}, "tiles": {"tile_width": 319})"),
            "f.json:1: /wall/operator/panel needs a tile of kind operator of at least 320 x 240 "
            "pixels; the wall has none\n");
  const std::string ball = R"({"input": "ball.button.3", "action": "operator_panel"})";
  EXPECT_EQ(bindingsAre(ball),
            "f.json:1: /devices/bindings/0/action is operator_panel, which needs the panel: "
            "/wall/operator/panel is off\n");
}

// The pair of "left" is two placed tiles; the finding is at the one of the file.
TEST(Config, AFaultOfAnOutputInStereoIsWhereTheFileHasIt) {
  EXPECT_EQ(
      wallIs(R"("stereo": {"mode": "side_by_side"}, "outputs": [
    {"kind": "png", "path": "a.png", "tiles": [
      {"tile": "left"},
      {"tile": "nobody", "x": 700}]}])"),
      "f.json:4: /wall/outputs/0/tiles/1/tile is \"nobody\"; the wall's tiles are left.L, left.R, "
      "centre.L, centre.R, right.L, right.R, operator\n");
}

}  // namespace
}  // namespace merlin
