// Glove calibration: imported from other programs' files, or computed from a few poses of a person.
#include "drivers/cyberglove/calibration_files.h"

#include <cmath>

#include <gtest/gtest.h>

#include "drivers/cyberglove/calibration.h"
#include "drivers/cyberglove/guided_calibration.h"

namespace merlin::cyberglove {
namespace {

// The file from which the shipped calibration was made (asr_cyberglove, BSD-3: see
// drivers/cyberglove/CALIBRATION-LICENSE.txt).
const std::string kAsr =
    "0.300000:46.000000 -0.500000:164.000000\n0.900000:73.000000 -0.700000:181.000000\n"
    "-0.500000:216.000000 -0.200000:79.000000\n0.000000:74.000000 -0.400000:98.000000\n"
    "0.000000:111.000000 -0.900000:182.000000\n0.000000:90.000000 -0.800000:130.000000\n"
    "0.000000:117.000000 -1.500000:185.000000\n-0.200000:172.000000 0.200000:121.000000\n"
    "0.000000:69.000000 -1.700000:198.000000\n0.000000:66.000000 -1.300000:107.000000\n"
    "0.000000:93.000000 -1.500000:161.000000\n0.000000:60.000000 0.000000:144.000000\n"
    "0.000000:62.000000 -1.700000:199.000000\n0.000000:93.000000 -1.300000:129.000000\n"
    "0.000000:108.000000 -1.500000:163.000000\n0.270000:134.000000 0.000000:86.000000\n"
    "0.000000:58.000000 -1.700000:202.000000\n0.000000:73.000000 -1.300000:122.000000\n"
    "0.000000:101.000000 -1.500000:172.000000\n0.500000:139.000000 -0.200000:55.000000\n"
    "0.000000:46.000000 -1.700000:209.000000\n0.000000:91.000000 -1.300000:135.000000\n";

TEST(Import, AsrsFileIsTheShippedCalibration) {
  const auto c = importCalibration(kAsr);
  ASSERT_TRUE(c) << c.error().what;
  EXPECT_STREQ(c->format, "asr_cyberglove");
  const CybergloveSettings shipped;
  for (std::size_t slot = 0; slot < 23; ++slot) {
    // Slot 7 has no sensor, and slot 20 has no angles in the file.
    EXPECT_EQ(c->given[slot], slot != 7 && slot != 20) << slot;
    if (!c->given[slot]) continue;
    EXPECT_NEAR(c->gain[slot], shipped.gain[slot], 1e-6F) << slot;
    EXPECT_NEAR(c->offset[slot], shipped.offset[slot], 1e-3F) << slot;
  }
}

TEST(Import, TheVendorsFileHasTwentyFourSlots) {
  std::string text = "VHv1.0\n! a comment\nGLOVE CALIBRATION follows:\n";
  for (int slot = 0; slot < 24; ++slot) {
    if (slot % 4 == 0) text += "FINGER " + std::to_string(slot / 4) + ":\n";
    text += " " + std::to_string(slot % 4) + "  " + std::to_string(50 + slot) + "  0.01150   0\n";
  }
  const auto c = importCalibration(text + "! E_O_CAL\n3D HAND GEOMETRY\n 1 2 3 4\n");
  ASSERT_TRUE(c) << c.error().what;
  EXPECT_STREQ(c->format, "vendor's .cal");
  EXPECT_EQ(c->offset[22], 72.0F);
  EXPECT_FLOAT_EQ(c->gain[4], 0.0115F);
  const auto cut = importCalibration(text.substr(0, text.size() / 2));
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().what.find("where the vendor's .cal has 24"), std::string::npos);
}

TEST(Import, ShadowsTablesAreDegreesOverAShareOfTheRange) {
  // The fact sheet gives this example: raw 110 means 0 degrees, raw 167 means 90 degrees.
  for (const std::string text :
       {R"(["G_IndexMPJ", [[0.42913,0.0],[0.5,10.0],[0.65354,90.0]]])",
        R"(<Joint name="G_IndexMPJ"><calib raw_value="0.42913" calibrated_value="0.0"/>
           <calib raw_value="0.65354" calibrated_value="90.0"/></Joint>)"}) {
    const auto c = importCalibration(text);
    ASSERT_TRUE(c) << c.error().what;
    EXPECT_TRUE(c->given[4]);
    EXPECT_NEAR(c->offset[4], 110, 0.01F);
    EXPECT_NEAR((167 - c->offset[4]) * c->gain[4], 1.5708F, 0.001F);
  }
  EXPECT_EQ(importCalibration(R"(["G_Nose", [[0.1,0],[0.2,9]]])").error().what,
            "G_Nose is not a joint of a CyberGlove");
  EXPECT_EQ(importCalibration(R"(["G_IndexMPJ", [[0.1,0]]])").error().what,
            "G_IndexMPJ needs two points or more, each a raw value and an angle in degrees");
}

std::string vess(const std::string& fourth) {
  std::string text;
  for (int slot = 0; slot < 23; ++slot) text += slot == 3 ? fourth : "60 40 200\n";
  return text;
}

TEST(Import, VessHasARangeForEachSensor) {
  const auto c = importCalibration(vess("60 40 200\n"));
  ASSERT_TRUE(c) << c.error().what;
  // At the index MCP joint, 90 degrees are 160 raw counts.
  EXPECT_NEAR((220 - c->offset[4]) * c->gain[4], 1.5708F, 1e-4F);
}

TEST(Import, AFlippedRangeIsNamed) {
  EXPECT_EQ(importCalibration(vess("60 200 40\n")).error().what,
            "line 4 has a minimum of 200 and a maximum of 40: are they swapped?");
  std::string flat = kAsr;
  flat.replace(flat.find("98.0"), 4, "74.0");
  EXPECT_EQ(importCalibration(flat).error().what,
            "line 4 has two points with the same raw value, 74");
}

TEST(Import, WhatIsNoCalibrationIsSaid) {
  for (const char* text : {"", "hello", "{\"a\": 1}", "1 2\n", "nan inf 1\n"})
    EXPECT_FALSE(importCalibration(text)) << text;
  for (std::size_t n = 0; n + 20 < kAsr.size(); n += 11)
    EXPECT_FALSE(importCalibration(kAsr.substr(0, n))) << n;
}

// Returns the sample of a glove with these settings whose wearer has these joint angles.
GloveSample at(const std::array<float, 23>& angles, const CybergloveSettings& settings) {
  GloveSample s{};
  const auto raw = rawOf(angles, settings);
  for (std::size_t i = 0; i < 23; ++i) s.raw[i] = i == 7 ? 0 : raw[i];
  return s;
}

TEST(Guided, FindsTheGloveOfAnotherHand) {
  CybergloveSettings truth;
  for (std::size_t i = 0; i < 23; ++i) {
    truth.offset[i] = 60 + static_cast<float>(i);
    truth.gain[i] = i % 5 == 2 ? -0.012F : 0.014F;  // some sensors count in the other direction
    if (truth.gain[i] < 0) truth.offset[i] += 120;
  }
  GuidedCalibration guided;
  for (std::size_t pose = 0; pose < guidedPoses().size(); ++pose) {
    std::array<float, 23> angles{};
    const std::string name = guidedPoses()[pose].name;
    if (name == "fist") {
      for (const std::size_t finger : {4U, 8U, 12U, 16U}) {
        angles[finger] = 1.5F;
        angles[finger + 1] = 1.7F;
        angles[finger + 2] = 1.3F;
      }
    }
    if (name == "spread")
      angles[3] = 0.5F, angles[11] = 0.2F, angles[15] = 0.27F, angles[19] = 0.5F;
    if (name == "thumb") angles[0] = 0.4F, angles[1] = 0.9F, angles[2] = 0.8F;
    if (name == "cup") angles[20] = 0.5F;
    if (name == "wrist up") angles[21] = 0.7F;
    if (name == "wrist aside") angles[22] = 0.3F;
    guided.begin(pose);
    for (int i = 0; i < 100; ++i) guided.add(at(angles, truth));
  }
  const auto solved = guided.solve({});
  ASSERT_TRUE(solved) << solved.error().what;
  for (std::size_t i = 0; i < 23; ++i) {
    if (i == 7) continue;
    EXPECT_NEAR(solved->offset[i], truth.offset[i], 0.6F) << i;
    EXPECT_NEAR(solved->gain[i], truth.gain[i], 0.0012F) << i;
  }
}

TEST(Guided, ASensorThatDidNotMoveAndAPoseThatWasNotHeldAreNamed) {
  GuidedCalibration guided;
  const CybergloveSettings settings;
  for (std::size_t pose = 0; pose < guidedPoses().size(); ++pose) {
    guided.begin(pose);
    if (pose != 1) guided.add(at({}, settings));
  }
  EXPECT_EQ(guided.solve({}).error().what, "no record came in the pose \"fist\"");
  guided.begin(1);
  guided.add(at({}, settings));
  const auto still = guided.solve({});
  ASSERT_FALSE(still);
  EXPECT_NE(still.error().what.find("4 by 0 in \"fist\""), std::string::npos) << still.error().what;
}

}  // namespace
}  // namespace merlin::cyberglove
