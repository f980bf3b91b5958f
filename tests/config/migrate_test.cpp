// Converts configurations of earlier versions to the current form.
#include "config/migrate.h"

#include <gtest/gtest.h>

#include "config/loader.h"
#include "tests/support/findings.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

TEST(Migrate, APngGroupBecomesAnOutput) {
  const auto migrated = migrate(R"({
  "instance": "lab",
  "wall": {"png": {"path": "w.png", "interval_s": 5}, "model": "a.mrm"}
})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  EXPECT_EQ(migrated->text, R"({
  "instance": "lab",
  "wall": {
    "model": "a.mrm",
    "outputs": [
      {
        "kind": "shared_memory"
      },
      {
        "kind": "png",
        "path": "w.png",
        "interval_s": 5
      }
    ]
  }
}
)");
  ASSERT_EQ(migrated->changes.size(), 1u);
  const auto loaded = loadSettings(migrated->text, "/lab");
  EXPECT_TRUE(loaded.findings.empty()) << loaded.findings[0].what;
  ASSERT_EQ(loaded.settings.wall.outputs.size(), 2u);
  EXPECT_EQ(loaded.settings.wall.outputs[1].path, "/lab/w.png");
  EXPECT_EQ(loaded.settings.wall.outputs[1].interval_s, 5);
  EXPECT_TRUE(migrate(migrated->text)->changes.empty()) << "once is enough";
}

TEST(Migrate, AnEmptyPngGroupGoes) {
  const auto migrated = migrate(R"({"wall": {"png": {"path": ""}}})");
  ASSERT_TRUE(migrated);
  EXPECT_EQ(migrated->text, "{\n  \"wall\": {}\n}\n");
}

TEST(Migrate, BindingsGoToTheDevicesWithThePanelsButton) {
  const auto migrated = migrate(R"({"devices": {"gpio": {"chip": "gpiochip0", "button_line": 3}},
    "wall": {"scene": {"bindings": [{"input": "posture.fist", "action": "grab"}],
                       "hand_station": 2, "stale_after_s": 0.7, "posture_hold_s": 0.4}}})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  EXPECT_EQ(migrated->changes.size(), 5u) << "the last one makes the list of devices";
  const auto loaded = loadSettings(migrated->text, "");
  ASSERT_TRUE(loaded.findings.empty()) << loaded.findings[0].what;
  const DevicesSettings& d = loaded.settings.devices;
  ASSERT_EQ(d.bindings.size(), 2u);
  EXPECT_EQ(d.bindings[0].input, "posture.fist");
  EXPECT_EQ(d.bindings[1].input, "panel.button");
  EXPECT_EQ(d.bindings[1].action, "next_mode") << "the button's default";
  EXPECT_EQ(d.hands[0].station, 2);
  EXPECT_EQ(d.stale_after_s, 0.7);
  EXPECT_EQ(d.posture_hold.hold_s, 0.4) << "the longer of both times was in force";
}

TEST(Migrate, AHoldThatIsNoNumberIsLeftForTheCheck) {
  const auto migrated = migrate(R"({"wall": {"scene": {"posture_hold_s": "long"}}})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  const auto loaded = loadSettings(migrated->text, "");
  ASSERT_EQ(loaded.findings.size(), 1u);
  EXPECT_NE(loaded.findings[0].what.find("\"long\""), std::string::npos);
}

TEST(Migrate, TheButtonsCommandBecomesABinding) {
  const auto migrated = migrate(R"({"devices": {"gpio": {"chip": "gpiochip0", "projector_line": 4,
                                       "button_command": "projector_on"}}})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  const auto loaded = loadSettings(migrated->text, "");
  ASSERT_TRUE(loaded.findings.empty()) << loaded.findings[0].what;
  const auto& bindings = loaded.settings.devices.bindings;
  ASSERT_EQ(bindings.size(), 4u) << "beside those that were in force by default";
  EXPECT_EQ(bindings[3].input, "panel.button");
  EXPECT_EQ(bindings[3].action, "projector_on");
  const auto both =
      migrate(R"({"wall": {"scene": {"bindings": []}}, "devices": {"bindings": []}})");
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().what,
            "has both /wall/scene/bindings and /devices/bindings: delete the former by hand");
}

TEST(Migrate, TheDevicesBecomeAListAndWhatWasWithThemStandsBesideIt) {
  const auto migrated = migrate(R"({
  "instance": "lab",
  "devices": {
    "hand": {"station": 2},
    "ball": {"driver": "evdev", "port": "evdev:/dev/x", "evdev": {"curve": 3}},
    "glove": {"port": "serial:/dev/g", "baud": 115200, "max_bytes_s": 9000, "light": "on"},
    "tracker": {"port": "serial:/dev/t", "hemisphere1": [0, 0, 1]},
    "stale_after_s": 0.7, "postures": "p.json", "posture_hold_s": 0.2, "posture_leave_s": 0.1,
    "posture_margin": 0.5, "posture_drift": false, "script": "still", "cpu_latency_us": 5,
    "gpio": {"chip": "gpiochip0"}, "projectors": [{"name": "left", "address": "h"}],
    "projector_schedule": [{"on": "09:00", "off": "17:00"}],
    "bindings": [{"input": "ball.button.1", "action": "reset_view"}]
  },
  "wall": {"model": "a.mrm"}
})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  EXPECT_EQ(migrated->text,
            test::readText(MERLIN_SOURCE_DIR "/tests/config/migrated_devices.json"));
  EXPECT_EQ(migrated->changes.size(), 1u);
  const auto loaded = loadSettings(migrated->text, "");
  EXPECT_EQ(test::findingsOf(loaded), "");
  const DevicesSettings& d = loaded.settings.devices;
  EXPECT_EQ(d.list[0].own.cyberglove.light, CybergloveSettings::Light::kOn);
  EXPECT_EQ(d.list[2].own.evdev.curve, 3);
  EXPECT_EQ(d.posture_hold.least_margin, 0.5);
  EXPECT_FALSE(d.posture_drift);
  const auto again = migrate(migrated->text);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->text, migrated->text) << "once is enough";
  EXPECT_TRUE(again->changes.empty());
}

TEST(Migrate, SettingsOfADriverThatTheDeviceDoesNotHaveAreLeftOutAndNamed) {
  const auto migrated = migrate(R"({"devices": {"glove": {}, "tracker": {"driver": "vrpn",
      "hemisphere1": [0, 0, 1], "stylus": true, "vrpn": {"device": "Wand"}},
      "ball": {"beep": "c", "spacenav": {"dead_zone": 4}}}})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  ASSERT_EQ(migrated->changes.size(), 3u);
  EXPECT_EQ(migrated->changes[1],
            "/devices/tracker: the settings of the driver fastrak (hemisphere1, stylus) are left "
            "out, since the device's driver is vrpn");
  EXPECT_EQ(
      migrated->changes[2],
      "/devices/ball: the settings of the driver spacenav (dead_zone) are left out, since the "
      "device's driver is spaceball");
  const auto loaded = loadSettings(migrated->text, "");
  EXPECT_EQ(test::findingsOf(loaded), "");
  EXPECT_EQ(loaded.settings.devices.list[1].own.vrpn.device, "Wand");
  EXPECT_EQ(loaded.settings.devices.list[2].own.spaceball.beep, "c");
}

TEST(Migrate, DevicesThatAFileDoesNotNameStayAsTheyWereByDefault) {
  const auto one = migrate(R"({"devices": {"ball": {"port": "pty:/tmp/b"}}})");
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_EQ(loadSettings(one->text, "").settings.devices.list.size(), 3u);
  ASSERT_EQ(one->changes.size(), 2u);
  EXPECT_NE(one->changes[1].find("did not name (glove, tracker)"), std::string::npos)
      << one->changes[1];
  EXPECT_EQ(migrate(R"({"devices": {"script": "still"}})")->text,
            "{\n  \"script\": \"still\"\n}\n");
  EXPECT_EQ(migrate(R"({"devices": {}})")->text, "{}\n");
}

TEST(Migrate, WhatNoVersionKnewIsLeftForTheCheck) {
  const auto migrated = migrate(R"({"devices": {"glvoe": {}, "ball": {"driver": "bal", "bepe": "c",
      "evdev": {"curve": 3}}}})");
  ASSERT_TRUE(migrated) << migrated.error().what;
  const std::string findings = test::findingsOf(loadSettings(migrated->text, ""));
  for (const char* place : {"/devices/2/driver", "/devices/2/spaceball/bepe", "/glvoe"})
    EXPECT_NE(findings.find(place), std::string::npos) << place << "\n" << findings;
  const auto number = migrate(R"({"devices": {"ball": 7}})");
  ASSERT_FALSE(number);
  EXPECT_EQ(number.error().what, "/devices/ball is not an object");
  const auto both = migrate(R"({"devices": {"gpio": {}}, "gpio": {}})");
  ASSERT_FALSE(both);
  EXPECT_EQ(
      both.error().what,
      "has both the object /devices, from which /gpio is made, and /gpio: merge them by hand");
}

TEST(Migrate, WhatIsOfThisVersionStaysByteByByte) {
  constexpr const char* kText = "{ \"wall\" : {\"model\":\"a.mrm\"} }";
  const auto migrated = migrate(kText);
  ASSERT_TRUE(migrated);
  EXPECT_EQ(migrated->text, kText);
  EXPECT_TRUE(migrated->changes.empty());
}

TEST(Migrate, RefusesWhatItCannotRead) {
  EXPECT_EQ(migrate("[]").error().what, "line 1: is not a JSON object");
  EXPECT_EQ(migrate("{\n,").error().what.find("line 2"), 0u);
  EXPECT_EQ(migrate(R"({"wall": {"png": {"path": "a"}, "outputs": []}})").error().code,
            Errc::kInvalidArgument);
}

TEST(Migrate, TheLoaderNamesTheNewForm) {
  const auto loaded = loadSettings(R"({"wall": {"png": {"path": "w.png"}}})", ".");
  ASSERT_EQ(loaded.findings.size(), 1u);
  EXPECT_EQ(loaded.findings[0].pointer, "/wall/png");
  EXPECT_EQ(loaded.findings[0].what,
            "is a setting of an earlier version; an entry {\"kind\": \"png\", \"path\": ...} of "
            "/wall/outputs replaces it; the command merlin config migrate FILE rewrites the file");
}

}  // namespace
}  // namespace merlin
