// Devices and hands of a configuration: which settings the loader reads and which it refuses.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/effective.h"
#include "config/loader.h"
#include "config/manual_page.h"
#include "config/writer.h"
#include "tests/support/findings.h"

namespace merlin {
namespace {

using test::findingsOf;
using Verdict = LoadedSettings::Verdict;

std::string devicesAre(const std::string& list, const std::string& also = "") {
  return findingsOf(loadSettings("{\"devices\": [" + list + "]" + also + "}", ""));
}

std::string driverNames() {
  std::string names;
  for (const DriverEntry& entry : drivers())
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

TEST(DevicesConfig, TheDefaultOnesAreThoseOf1998WithoutPorts) {
  const DevicesSettings devices;
  ASSERT_EQ(devices.list.size(), 3u);
  const char* const expected[][2] = {
      {"glove", "cyberglove"}, {"tracker", "fastrak"}, {"ball", "spaceball"}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(devices.list[i].name, expected[i][0]);
    EXPECT_EQ(devices.list[i].line.driver, expected[i][1]);
    EXPECT_EQ(devices.list[i].line.port, "");
  }
  EXPECT_EQ(devices.list[0].line.baud, 38400);
  EXPECT_EQ(devices.list[2].line.baud, 9600);
  EXPECT_TRUE(loadSettings("{\"devices\": []}", "").settings.devices.list.empty());
}

TEST(DevicesConfig, ADriverGivesTheNameAndTheSpeedThatAreLeftOut) {
  const auto loaded = loadSettings(R"({"devices": [
      {"driver": "spaceball"}, {"driver": "vrpn", "baud": 0},
      {"name": "left", "driver": "cyberglove", "baud": 115200, "person": "ann"}]})",
                                   "");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const auto& list = loaded.settings.devices.list;
  EXPECT_EQ(list[0].name, "ball");
  EXPECT_EQ(list[0].line.baud, 9600);
  EXPECT_EQ(list[1].name, "tracker");
  EXPECT_EQ(list[1].line.baud, kUsualBaud) << "its driver has none";
  EXPECT_EQ(list[2].name, "left");
  EXPECT_EQ(list[2].line.baud, 115200);
  EXPECT_EQ(list[2].person, "ann");
}

TEST(DevicesConfig, SettingsOfAnotherDriverAreRefused) {
  EXPECT_EQ(devicesAre(R"({"driver": "evdev", "evdev": {"curve": 3}})"), "");
  EXPECT_EQ(devicesAre(R"({"driver": "spaceball", "evdev": {"curve": 3}})"),
            "f.json:1: /devices/0/evdev is for the driver evdev, and this device's driver is "
            "spaceball: leave it out or change the driver\n");
  EXPECT_EQ(devicesAre(R"({"driver": "sample", "sample": {}})"),
            "f.json:1: /devices/0/sample has no settings: leave it out\n");
  EXPECT_EQ(devicesAre(R"({"driver": "spaceball", "dead_zone": 3})"),
            "f.json:1: /devices/0/dead_zone is not a known setting; known here are name, person, "
            "driver, port, baud, max_bytes_s, " +
                driverNames() + "\n");
}

TEST(DevicesConfig, ADeviceWithoutADriverIsOneFinding) {
  EXPECT_EQ(devicesAre(R"({"port": "pty:/tmp/a", "evdev": {"curve": 3}})"),
            "f.json:1: /devices/0 has no driver: name one in \"driver\", such as cyberglove, "
            "fastrak, spaceball or evdev\n");
  EXPECT_EQ(devicesAre(R"({"driver": "spacebal", "spaceball": {"cubic": false}})"),
            "f.json:1: /devices/0/driver is the string \"spacebal\"; allowed is one of " +
                driverNames() + "\n");
}

std::string named(const std::string& name) {
  return devicesAre(R"({"driver": "spaceball", "name": ")" + name + "\"}");
}

TEST(DevicesConfig, NamesAreShortWordsOfTheirOwn) {
  EXPECT_EQ(named("b"), "");
  EXPECT_EQ(named("left_ball_00001x"), "");
  for (const char* bad :
       {"Ball", "left ball", "2nd", "_ball", "a-b", "b.button", "left_ball_00001xy"})
    EXPECT_EQ(named(bad), fmt::format("f.json:1: /devices/0/name is \"{}\"; allowed are 1 to 16 of "
                                      "a to z, 0 to 9 and _, beginning with a letter\n",
                                      bad));
  for (const char* taken : {"posture", "posture_state", "postures", "gesture", "gpio", "panel",
                            "actions", "health", "key", "now_ns", "time_utc"})
    EXPECT_EQ(named(taken), fmt::format("f.json:1: /devices/0/name is \"{}\", a name that merlind "
                                        "uses for something else; give it another name\n",
                                        taken));
  EXPECT_EQ(named("hand"),
            "f.json:1: /devices/0/name is \"hand\", the name of the hand at /hands/0; give it "
            "another name\n");
}

TEST(DevicesConfig, EachDeviceHandAndStationHasItsName) {
  const std::string ball = R"({"driver": "spaceball"})";
  EXPECT_EQ(devicesAre(ball + "," + ball),
            "f.json:1: /devices/1/name is \"ball\", the name of the device at /devices/0; give it "
            "another name\n");
  const std::string tracker = R"({"name": "t", "driver": "fastrak"})";
  EXPECT_EQ(devicesAre(tracker + R"(, {"name": "t5", "driver": "evdev"})"), "");
  EXPECT_EQ(devicesAre(tracker + R"(, {"name": "t4", "driver": "evdev"})"),
            "f.json:1: /devices/0/name is \"t\", so that its station 4 would be \"t4\", the name "
            "of the device at /devices/1; give one of them another name\n");
  EXPECT_EQ(devicesAre(tracker, R"(, "hands": [{"name": "a", "station": 1}, {"name": "a",
                                                                               "station": 2}])"),
            "f.json:1: /hands/1/name is \"a\", the name of the hand at /hands/0; give it another "
            "name\n");
}

std::string manyOf(const char* driver, int n) {
  std::string list;
  for (int i = 0; i < n; ++i)
    list += fmt::format(R"({}{{"name": "{:.1}_{}", "driver": "{}"}})", i > 0 ? ", " : "", driver, i,
                        driver);
  return list;
}

TEST(DevicesConfig, ThereAreAtMostSoManyOfEachKind) {
  EXPECT_EQ(devicesAre(manyOf("spaceball", 6) + ", " + manyOf("fastrak", 4) + ", " +
                       manyOf("cyberglove", 4)),
            "");
  EXPECT_EQ(
      devicesAre(manyOf("spaceball", 7)),
      "f.json:1: /devices has 7 devices of the kind ball; at most 6 are allowed: leave out 1\n");
  EXPECT_EQ(
      devicesAre(manyOf("vrpn", 6)),
      "f.json:1: /devices has 6 devices of the kind tracker; at most 4 are allowed: leave out 2\n");
  EXPECT_EQ(
      devicesAre(manyOf("cyberglove", 5)),
      "f.json:1: /devices has 5 devices of the kind glove; at most 4 are allowed: leave out 1\n");
  EXPECT_NE(devicesAre(manyOf("spaceball", 17)).find("/devices has 17 devices; at most 16"),
            std::string::npos);
  EXPECT_EQ(devicesAre("", R"(, "hands": [{"name": "a"}, {"name": "b"}, {"name": "c"},
                                          {"name": "d"}, {"name": "e"}])"),
            "f.json:1: /hands has 5 hands; at most 4 are allowed: leave out 1\n");
}

TEST(DevicesConfig, EachDeviceHasItsOwnPort) {
  const std::string ball = R"({"name": "a", "driver": "spaceball", "port": "serial:/dev/a"},)";
  EXPECT_EQ(devicesAre(ball + R"({"name": "b", "driver": "spaceball", "port": "serial:/dev/b"})"),
            "");
  EXPECT_EQ(devicesAre(ball + R"({"name": "b", "driver": "sample", "port": "serial:/dev/a"})"),
            "f.json:1: /devices/1/port is \"serial:/dev/a\", which is the port of the device \"a\" "
            "at /devices/0; each device needs its own\n");
}

TEST(DevicesConfig, APortIsTheSameHoweverItIsSpelt) {
  const auto both = [](const char* driver, const char* a, const char* b) {
    return devicesAre(fmt::format(R"({{"name": "a", "driver": "{0}", "port": "{1}"}},
                                     {{"name": "b", "driver": "{0}", "port": "{2}"}})",
                                  driver, a, b));
  };
  EXPECT_EQ(
      both("tuio", "udp:3333", "udp://127.0.0.1:3333"),
      "f.json:2: /devices/1/port is \"udp://127.0.0.1:3333\", which is the port of the device "
      "\"a\" at /devices/0, \"udp:3333\"; each device needs its own\n");
  for (const char* same : {"udp:03333", "udp://0.0.0.0:3333", "udp://[::]:3333",
                           "udp://[::ffff:127.0.0.1]:3333", "udp://[::ffff:7f00:1]:3333"})
    EXPECT_NE(both("tuio", "udp:3333", same), "") << same;
  for (const char* other : {"udp:3334", "udp://127.0.0.2:3333", "udp://[::1]:3333"})
    EXPECT_EQ(both("tuio", "udp:3333", other), "") << other;
  EXPECT_NE(both("tuio", "udp://[::1]:3333", "udp://[0:0::1]:3333"), "");
  EXPECT_EQ(both("tuio", "udp://[::1]:3333", "udp://0.0.0.0:3333"), "");
  EXPECT_NE(both("fastrak", "tcp://Lab:3883", "tcp://lab:3883"), "");
  EXPECT_NE(both("fastrak", "tcp://localhost:4001", "tcp://127.0.0.1:4001"), "");
  EXPECT_EQ(both("fastrak", "tcp://lab:3883", "tcp://lab2:3883"), "");
  EXPECT_NE(both("sample", "serial:/dev/ttyS0", "pty:/dev/ttyS0"), "");
  EXPECT_EQ(both("sample", "replay:a", "replay:a"), "");
}

// A VRPN server has several devices, and accepts a separate connection for each reader.
TEST(DevicesConfig, DevicesOfOneServerShareItsPort) {
  const auto with = [](const std::string& second, const char* port = "tcp://lab:3883") {
    return devicesAre(fmt::format(R"({{"name": "a", "driver": "vrpn", "port": "{0}"}},
                                     {{"name": "b", "driver": "{1}", "port": "{0}"}},
                                     {{"name": "c", "driver": "vrpn_pad", "port": "{0}"}})",
                                  port, second));
  };
  EXPECT_EQ(with("vrpn"), "");
  EXPECT_EQ(with("vrpn_pad"), "");
  EXPECT_NE(with("fastrak").find("/devices/1/port is \"tcp://lab:3883\", which is the port of the "
                                 "device \"a\" at /devices/0; each device needs its own"),
            std::string::npos);
  EXPECT_NE(with("vrpn", "pty:/tmp/a"), "") << "a line has one reader";
}

constexpr const char* kOneOfEach = R"({"name": "left", "driver": "cyberglove"},
    {"name": "eye", "driver": "vrpn"}, {"name": "pad", "driver": "evdev"})";

TEST(DevicesConfig, AHandsGloveAndTrackerAreThere) {
  const auto hand = [](const std::string& members) {
    return devicesAre(kOneOfEach, R"(, "hands": [{)" + members + "}]");
  };
  EXPECT_EQ(hand(R"("glove": "left", "tracker": "eye")"), "");
  EXPECT_EQ(hand(R"("glove": "eye")"),
            "f.json:2: /hands/0/glove is \"eye\", which is not the name of a glove; /devices has "
            "left\n");
  EXPECT_EQ(hand(R"("tracker": "nobody")"),
            "f.json:2: /hands/0/tracker is \"nobody\", which is not the name of a tracker; "
            "/devices has eye\n");
  EXPECT_EQ(devicesAre("", R"(, "hands": [{"glove": "left"}])"),
            "f.json:1: /hands/0/glove is \"left\", which is not the name of a glove; /devices has "
            "no glove: add one\n");
}

// The devices of the other machine are named in its own configuration, so they are not looked up in
// this one.
TEST(DevicesConfig, NamesOfAnotherMachinesDevicesAreNotLookedFor) {
  const std::string far = R"(, "wall": {"input": {"endpoint": "tcp://far:7401", "keys": "k",
      "server_key": ")" + std::string(40, 'k') +
                          R"("}, "stereo": {"head": {"tracker": "eyes",
      "station": 1}}})";
  EXPECT_EQ(devicesAre("", far + R"(, "hands": [{"glove": "left", "tracker": "there"}])"), "");
}

TEST(DevicesConfig, AGloveIsWornOnceAndAHandMayWearNone) {
  const std::string list = R"({"name": "left", "driver": "cyberglove", "port": "pty:/tmp/a"},
      {"name": "t", "driver": "fastrak", "port": "pty:/tmp/b"})";
  const auto hands = [&](const std::string& second) {
    return devicesAre(
        list, R"(, "hands": [{"name": "one"}, {"name": "two", "station": 2)" + second + R"(}])");
  };
  EXPECT_EQ(
      hands(""),
      "f.json:2: /hands/1/glove is left, the glove of the hand at /hands/0; name another one, "
      "or \"none\" for a hand without a glove\n");
  EXPECT_EQ(hands(R"(, "glove": "none")"), "");
}

TEST(DevicesConfig, AHandHoldsTheButtonsOfABallThatNoOtherHandHolds) {
  const std::string list =
      R"({"name": "t", "driver": "fastrak"}, {"name": "wand", "driver": "vrpn_pad",
      "port": "tcp://lab:3883"})";
  const auto hands = [&](const std::string& first, const std::string& second) {
    return devicesAre(list, R"(, "hands": [{"name": "one", "glove": "none")" + first +
                                R"(}, {"name": "two", "station": 2, "glove": "none")" + second +
                                "}]");
  };
  EXPECT_EQ(hands("", R"(, "buttons": "wand")"), "");
  EXPECT_EQ(hands(R"(, "buttons": "wand")", R"(, "buttons": "wand")"),
            "f.json:2: /hands/1/buttons is \"wand\", whose buttons the hand at /hands/0 holds; a "
            "device is in one hand\n");
  EXPECT_EQ(hands("", R"(, "buttons": "t")"),
            "f.json:2: /hands/1/buttons is \"t\", which is not the name of a ball; /devices has "
            "wand\n");
  EXPECT_EQ(hands("", R"(, "buttons": "wand", "person": "ann")"),
            "f.json:2: /hands/1/buttons is \"wand\", whose \"person\" is \"\", and the hand's is "
            "\"ann\"; give both the same\n");
}

TEST(DevicesConfig, AStationIsWornOnce) {
  const std::string trackers =
      R"({"name": "a", "driver": "fastrak"}, {"name": "b", "driver": "fastrak"})";
  const auto worn = [&](const std::string& second, const std::string& head) {
    return devicesAre(trackers, R"(, "hands": [{"name": "one", "station": 2}, {"name": "two", )" +
                                    second + R"(}], "wall": {"stereo": {"head": {)" + head + "}}}");
  };
  EXPECT_EQ(worn(R"("station": 1)", R"("station": 3)"), "");
  EXPECT_EQ(worn(R"("tracker": "b", "station": 2)", R"("tracker": "b", "station": 1)"), "");
  EXPECT_EQ(worn(R"("tracker": "a", "station": 2)", R"("station": 0)"),
            "f.json:1: /hands/1/station is 2, the station of the hand /hands/0 too; "
            "each hand needs its own station\n");
  EXPECT_EQ(worn(R"("tracker": "b", "station": 1)", R"("tracker": "b", "station": 1)"),
            "f.json:1: /wall/stereo/head/station is 1, the station of the hand "
            "/hands/1 too; the head needs its own station\n");
  EXPECT_EQ(worn(R"("station": 1)", R"("tracker": "c", "station": 3)"),
            "f.json:1: /wall/stereo/head/tracker is \"c\", which is not the name of a tracker; "
            "/devices has a, b\n");
}

TEST(DevicesConfig, AStationWhosePosesCannotComeIsFound) {
  const auto hand = [](const std::string& tracker, int station) {
    return devicesAre(tracker,
                      fmt::format(R"(, "hands": [{{"name": "one", "station": {}}}])", station));
  };
  const std::string vrpn = R"({"name": "a", "driver": "vrpn", "port": "tcp://lab:3883",
                               "vrpn": {"device": "Wand", "stations": [0, -1, -1, -1]}})";
  const std::string osc = R"({"name": "a", "driver": "osc", "port": "udp:9000",
                              "osc": {"stations": ["wand", "head"]}})";
  EXPECT_EQ(hand(vrpn, 1), "");
  EXPECT_NE(hand(vrpn, 3).find("/hands/0/station is 3, and the tracker \"a\" has no such station: "
                               "name it in /devices/0/vrpn/stations"),
            std::string::npos);
  EXPECT_EQ(hand(osc, 2), "");
  EXPECT_NE(hand(osc, 3).find("name it in /devices/0/osc/stations"), std::string::npos);
}

TEST(DevicesConfig, BindingsNameDevicesThatHaveTheInput) {
  const auto bound = [](const std::string& input) {
    return devicesAre(kOneOfEach,
                      R"(, "bindings": [{"action": "reset_view", "input": ")" + input + "\"}]");
  };
  for (const char* good :
       {"pad.button.3", "left.switch", "left.posture.fist", "button.1", "posture.fist", "switch"})
    EXPECT_EQ(bound(good), "") << good;
  EXPECT_EQ(bound("ball.button.1"),
            "f.json:2: /bindings/0/input is \"ball.button.1\", and \"ball\" is not the name of a "
            "ball; /devices has pad\n");
  EXPECT_EQ(bound("pad.switch"),
            "f.json:2: /bindings/0/input is \"pad.switch\", and \"pad\" is not the name of a "
            "glove; /devices has left\n");
  EXPECT_EQ(bound("eye.posture.fist"),
            "f.json:2: /bindings/0/input is \"eye.posture.fist\", and \"eye\" is not the name of a "
            "glove; /devices has left\n");
  EXPECT_EQ(bound(R"(pad.button.1", "with": "pad.switch)"),
            "f.json:2: /bindings/0/with is \"pad.switch\", and \"pad\" is not the name of a glove; "
            "/devices has left\nf.json:2: /bindings/0/with is \"pad.switch\", which is never held "
            "together with \"pad.button.1\", so the chord would never happen\n");
  EXPECT_EQ(devicesAre("", R"(, "bindings": [{"input": "ball.button.1", "action": "reset_view"}])"),
            "f.json:1: /bindings/0/input is \"ball.button.1\", and \"ball\" is not the name of a "
            "ball; /devices has no ball: leave the binding out, or add one\n");
}

TEST(DevicesConfig, BindingsNameDevicesWhoseKeysHaveNames) {
  const auto bound = [](const std::string& input) {
    return devicesAre(R"({"name": "pad", "driver": "evdev"}, {"name": "mouse", "driver": "touch"},
                         {"driver": "spaceball"})",
                      R"(, "bindings": [{"action": "reset_view", "input": ")" + input + "\"}]");
  };
  for (const char* good : {"pad.key.space", "mouse.button.right", "pad.button.south", "key.space"})
    EXPECT_EQ(bound(good), "") << good;
  EXPECT_EQ(bound("ball.button.south"),
            "f.json:2: /bindings/0/input is \"ball.button.south\", and \"ball\" is not the name of "
            "a device whose keys have names, which are those of the drivers evdev, touch; /devices "
            "has pad, mouse\n");
}

TEST(DevicesConfig, BindingsNameTouchSurfacesThatArePinched) {
  const auto bound = [](const std::string& input) {
    return devicesAre(R"({"name": "wall", "driver": "tuio"}, {"name": "pad", "driver": "evdev"})",
                      R"(, "bindings": [{"action": "reset_view", "input": ")" + input + "\"}]");
  };
  for (const char* good : {"wall.pinch", "wall.spread", "pinch", "spread"})
    EXPECT_EQ(bound(good), "") << good;
  EXPECT_EQ(bound("pad.pinch"),
            "f.json:1: /bindings/0/input is \"pad.pinch\", and \"pad\" is not the name of a touch "
            "surface; /devices has wall\n");
  EXPECT_NE(bound("wall.pinching").find("/bindings/0/input is \"wall.pinching\"; allowed are"),
            std::string::npos);
}

TEST(DevicesConfig, BindingsNameHandsThatMakeGestures) {
  const auto bound = [](const std::string& input, const std::string& hands) {
    return devicesAre(kOneOfEach, R"(, "hands": [)" + hands +
                                      R"(], "bindings": [{"action": "reset_view", "input": ")" +
                                      input + "\"}]");
  };
  const std::string two =
      R"({"name": "near"}, {"name": "far", "glove": "none", "station": 2, "gestures": false})";
  EXPECT_EQ(bound("gesture.push", two), "");
  EXPECT_EQ(bound("near.gesture.push", two), "");
  EXPECT_EQ(bound("eye.gesture.push", two),
            "f.json:2: /bindings/0/input is \"eye.gesture.push\", and \"eye\" is not the name of "
            "a hand; /hands has near, far\n");
  EXPECT_EQ(bound("far.gesture.push", two),
            "f.json:2: /bindings/0/input is \"far.gesture.push\", and /hands/1/gestures is false: "
            "set it to true, or leave the binding out\n");
  EXPECT_EQ(bound("hand.gesture.push", ""),
            "f.json:2: /bindings/0/input is \"hand.gesture.push\", and \"hand\" is not the name "
            "of a hand; /hands has no hand: leave the binding out, or add one\n");
}

TEST(DevicesConfig, AFileOfTheOldFormIsOneFindingWithTheNewForm) {
  EXPECT_EQ(findingsOf(loadSettings(R"({
    "devices": {"glove": {"port": "COM1", "baud": 7}, "bindings": [{"input": "x"}], "oops": 1},
    "instance": "lab"})",
                                    "")),
            "f.json:2: /devices is an object, as in an earlier version; it is a list now, "
            "[{\"name\": \"ball\", \"driver\": \"spaceball\", \"port\": ..., \"spaceball\": "
            "{...}}, ...], and hands, postures, bindings, people, gpio, projectors, "
            "projector_schedule, cpu_latency_us and script stand beside it; the command merlin "
            "config migrate FILE rewrites the file\n");
  EXPECT_EQ(findingsOf(loadSettings(R"({"devices": 7})", "")),
            "f.json:1: /devices is the number 7; allowed is a list of objects\n");
}

TEST(DevicesConfig, WhatIsPrintedHasTheDriversOwnSettingsAloneAndCanBeRead) {
  const auto loaded = loadSettings("{\"devices\": [" + std::string(kOneOfEach) + "]}", "/");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  const std::string text = settingsText(loaded.settings);
  for (const char* key : {"\"cyberglove\": {", "\"vrpn\": {", "\"evdev\": {"})
    EXPECT_NE(text.find(key), std::string::npos) << key;
  for (const char* key : {"\"fastrak\": {", "\"spaceball\": {", "\"spacenav\": {"})
    EXPECT_EQ(text.find(key), std::string::npos) << key;
  const auto again = loadSettings(text, "/");
  ASSERT_EQ(again.verdict(), Verdict::kValid) << findingsOf(again);
  EXPECT_EQ(settingsText(again.settings), text);
}

TEST(DevicesConfig, TheSchemaAndTheManualDescribeEveryDriver) {
  const std::string schema = settingsSchema(), manual = settingsManual("1");
  for (const DriverEntry& entry : drivers()) {
    if (!entry.describe) continue;
    EXPECT_NE(schema.find(fmt::format("\"{}\": {{", entry.name)), std::string::npos) << entry.name;
    EXPECT_NE(manual.find(fmt::format("/devices/0/{}", entry.name)), std::string::npos)
        << entry.name;
  }
  const std::size_t driver = schema.find("\"driver\": {");
  const std::size_t port = schema.find("\"port\": {", driver);
  EXPECT_EQ(schema.substr(driver, port - driver).find("\"default\""), std::string::npos);
}

// The default configuration's list may have fewer devices. The settings of a further device are
// then compared with the defaults of its driver.
TEST(DevicesConfig, SettingsOfAFurtherDeviceHaveTheirDriversDefaults) {
  const auto loaded = loadSettings(R"({"devices": [{"driver": "cyberglove"},
      {"name": "pad", "driver": "evdev", "evdev": {"curve": 3}}]})",
                                   "");
  std::string curve;
  for (const SettingValue& value : valuesOf(loaded.settings)) {
    if (value.pointer == "/devices/1/evdev/curve") curve = value.value + " " + value.default_value;
  }
  EXPECT_EQ(curve, "3 2");
}

TEST(DevicesConfig, AGloveFasterThanItsLineIsFound) {
  const auto at = [](const std::string& line) {
    return findingsOf(
        loadSettings("{\"devices\": [{\"driver\": \"cyberglove\", " + line + "}]}", ""));
  };
  EXPECT_EQ(
      at(R"("port": "serial:/dev/ttyS0", "cyberglove": {"dialogue": "text"})"),
      "f.json:1: /devices/0/cyberglove/rate_hz is 100, but a line of 38400 baud carries 40 records "
      "of 96 bytes per second: lower the rate or raise the speed\n");
  EXPECT_EQ(
      at(R"("port": "serial:/dev/ttyS0", "baud": 115200, "cyberglove": {"dialogue": "text"})"), "");
  EXPECT_EQ(at(R"("port": "serial:/dev/ttyS0", "cyberglove": {"dialogue": "text", "rate_hz": 40})"),
            "");
  EXPECT_EQ(at(R"("port": "tcp://server:4001", "cyberglove": {"dialogue": "text"})"), "")
      << "its line is not ours";
}

struct BadDevice {
  const char* device;
  const char* what;  // a part of the finding's text
};

class BadDevices : public testing::TestWithParam<BadDevice> {};

TEST_P(BadDevices, AreRefusedWithTheReason) {
  const auto loaded = loadSettings(
      fmt::format(
          R"({{"devices": [{{{}}}], "serve": {{"vrpn_port": 4000, "spnav_socket": "/run/a"}}}})",
          GetParam().device),
      "");
  EXPECT_EQ(loaded.verdict(), Verdict::kInvalid);
  EXPECT_NE(findingsOf(loaded).find(GetParam().what), std::string::npos) << findingsOf(loaded);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadDevices,
    testing::Values(
        BadDevice{R"("driver": "spaceball", "spaceball": {"axis_map": [1, 2, 3, 4, 5, 5]})",
                  "/devices/0/spaceball/axis_map is 1, 2, 3, 4, 5, 5; allowed is each of 1 to 6"},
        BadDevice{R"("driver": "spacenav", "spacenav": {"axis_map": [1, 2, 3, 4, 5, 5]})",
                  "/devices/0/spacenav/axis_map is"},
        BadDevice{R"("driver": "cyberglove", "baud": 31337)",
                  "/devices/0/baud is 31337; allowed are 1200, 2400, 4800"},
        BadDevice{
            R"("driver": "spaceball", "port": "evdev:/dev/input/event3")",
            "which the driver \"spaceball\" does not read; the drivers \"evdev\" and \"touch\" do"},
        BadDevice{
            R"("driver": "evdev", "evdev": {"axes": ["x", "up", "none", "none", "none", "none"]})",
            "/devices/0/evdev/axes/1 is \"up\"; allowed are the kernel's name of an axis"},
        BadDevice{
            R"("driver": "evdev", "evdev": {"axes": ["x", "x", "-x", "none", "none", "none"]})",
            "/devices/0/evdev/axes/1 is \"x\", and \"x\" before it uses that axis already"},
        BadDevice{R"("driver": "vrpn_pad", "vrpn_pad": {"axes": ["0", "1", "2", "3", "4", "1-0"]})",
                  "/devices/0/vrpn_pad/axes/5 is \"1-0\", and \"1\" before it uses that axis"},
        BadDevice{
            R"("driver": "evdev", "port": "serial:/dev/input/event5")",
            "/devices/0/port is \"serial:/dev/input/event5\", which is not an input device; the "
            "driver \"evdev\" needs evdev:/dev/input/..."},
        BadDevice{R"("driver": "spacenav", "port": "serial:/dev/ttyUSB0")",
                  "/devices/0/port is \"serial:/dev/ttyUSB0\", at which no spacenavd can be; the "
                  "driver \"spacenav\" needs unix:PATH"},
        BadDevice{R"("driver": "spacenav", "port": "unix:/run/a")",
                  "/devices/0/port is \"unix:/run/a\", the socket that merlind serves"},
        BadDevice{R"("driver": "cyberglove", "port": "/dev/ttyS0")",
                  "allowed are serial:/dev/..., pty:PATH"},
        BadDevice{R"("driver": "vrpn", "port": "unix:/x")",
                  "/devices/0/port is \"unix:/x\", at which no VRPN server can be"},
        BadDevice{R"("driver": "vrpn", "vrpn": {"device": "Wand@lab"})",
                  "/devices/0/vrpn/device is \"Wand@lab\"; needed is the name alone"},
        BadDevice{R"("driver": "vrpn", "port": "tcp://127.0.0.1:4000")",
                  "/devices/0/port is \"tcp://127.0.0.1:4000\", where merlind itself serves"},
        BadDevice{R"("driver": "vrpn_pad", "port": "tcp://localhost:4000")",
                  "/devices/0/port is \"tcp://localhost:4000\", where merlind itself serves"},
        BadDevice{R"("driver": "vrpn_pad", "vrpn_pad": {"axes": ["0", "one", "2", "3", "4", "5"]})",
                  "/devices/0/vrpn_pad/axes/1 is \"one\"; allowed are the server's number"},
        BadDevice{R"("driver": "vrpn_pad", "vrpn": {"device": "x"})", "/devices/0/vrpn"}));

}  // namespace
}  // namespace merlin
