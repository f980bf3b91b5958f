// Converts configurations of earlier versions to the current form.
#include "config/migrate.h"

#include <gtest/gtest.h>

#include "config/loader.h"

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
  EXPECT_EQ(migrated->changes.size(), 4u);
  const auto loaded = loadSettings(migrated->text, "");
  ASSERT_TRUE(loaded.findings.empty()) << loaded.findings[0].what;
  const DevicesSettings& d = loaded.settings.devices;
  ASSERT_EQ(d.bindings.size(), 2u);
  EXPECT_EQ(d.bindings[0].input, "posture.fist");
  EXPECT_EQ(d.bindings[1].input, "panel.button");
  EXPECT_EQ(d.bindings[1].action, "next_mode") << "the button's default";
  EXPECT_EQ(d.hand.station, 2);
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
