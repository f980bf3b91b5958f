// The faults that validate() finds in an output's correction, as messages.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "render/out/settings.h"

namespace merlin::render {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns the faults found for an image of 640 x 480 pixels, one on each line.
std::string faultsOf(const correct::CorrectionSettings& settings) {
  std::string text;
  for (const SettingFault& f : validate(settings, 640, 480))
    text += f.pointer + " " + f.what + "\n";
  return text;
}

// Returns a mesh of 3 x 3 points that leaves the image unchanged.
correct::CorrectionSettings meshed() {
  correct::CorrectionSettings s;
  s.mesh.columns = s.mesh.rows = 3;
  for (const double y : {0.0, 0.5, 1.0}) {
    for (const double x : {0.0, 0.5, 1.0}) s.mesh.points.push_back({x, y});
  }
  return s;
}

TEST(CorrectSettings, DefaultsAreOffAndValid) {
  const correct::CorrectionSettings s;
  EXPECT_TRUE(s.isOff());
  EXPECT_EQ(faultsOf(s), "");
  correct::CorrectionSettings gamma;
  gamma.blend.gamma = 2.4;
  EXPECT_TRUE(gamma.isOff()) << "a gamma alone changes no pixel";
}

TEST(CorrectSettings, AnythingThatChangesAPixelIsNotOff) {
  correct::CorrectionSettings corner, blend, colour, black, mpcdi;
  corner.corners[5] = 1;
  blend.blend.top = 1;
  colour.colour.gain[2] = 0.9;
  black.black.level[1] = 0.01;
  mpcdi.mpcdi = "a.mpcdi";
  for (const auto& s : {corner, blend, colour, black, mpcdi, meshed()}) EXPECT_FALSE(s.isOff());
}

TEST(CorrectSettings, CornersThatAreNotConvexOrTurnedOverAreFound) {
  correct::CorrectionSettings s;
  s.corners = {10, -20, -30, 40, 5, 6, 7, -8};
  EXPECT_EQ(faultsOf(s), "");
  s.corners = {500, 400, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(faultsOf(s),
            "/corners do not form a convex picture: at (500, 400) the upper left corner is inside "
            "the other three, or the picture is turned over; move the corners apart\n");
  s.corners = {640, 0, -640, 0, 640, 0, -640, 0};
  EXPECT_NE(faultsOf(s).find("turned over"), std::string::npos) << "mirrored";
  s.corners = {640, 480, 0, 0, 0, 0, -640, -480};
  EXPECT_NE(faultsOf(s).find("turned over"), std::string::npos)
      << "two corners have changed places";
  s.corners = {0, 0, kNaN, 0, 0, 0, 0, 0};
  EXPECT_EQ(faultsOf(s), "/corners/2 is nan; allowed is -16384 to 16384\n");
}

TEST(CorrectSettings, AMeshThatFoldsIsFoundWithItsCell) {
  correct::CorrectionSettings s = meshed();
  EXPECT_EQ(faultsOf(s), "");
  s.mesh.points[4] = {0.7, 0.4};
  EXPECT_EQ(faultsOf(s), "") << "bent, not folded";
  s.mesh.interpolation = correct::MeshInterpolation::kBilinear;
  s.mesh.points[4] = {1.1, 0.5};  // beyond the middle of the right border
  EXPECT_EQ(faultsOf(s),
            "/mesh folds: the picture is turned over or has no area in the cell of column 1, row 0 "
            "(counted from 0); move the points around it apart\n");
  for (correct::MeshPoint& p : s.mesh.points) p.x = 1 - p.x;
  EXPECT_NE(faultsOf(s).find("column 0, row 0"), std::string::npos) << "mirrored";
}

// The points are in order, but the smooth surface between them overshoots and folds over.
TEST(CorrectSettings, AMeshThatFoldsBetweenItsPointsIsFound) {
  correct::CorrectionSettings s;
  s.mesh.columns = 4;
  s.mesh.rows = 2;
  for (const double y : {0.0, 1.0}) {
    for (const double x : {0.0, 0.01, 0.02, 1.0}) s.mesh.points.push_back({x, y});
  }
  s.mesh.interpolation = correct::MeshInterpolation::kBilinear;
  EXPECT_EQ(faultsOf(s), "");
  s.mesh.interpolation = correct::MeshInterpolation::kBicubic;
  EXPECT_NE(faultsOf(s).find("/mesh folds"), std::string::npos);
}

TEST(CorrectSettings, AMeshWithoutItsPointsIsFound) {
  correct::CorrectionSettings s = meshed();
  s.mesh.points.pop_back();
  EXPECT_EQ(faultsOf(s), "/mesh/points has 8 points; 3 columns and 3 rows need 9\n");
  s.mesh.rows = 1;
  EXPECT_EQ(faultsOf(s), "/mesh/rows is 1; a mesh has 2 to 64\n");
  s = meshed();
  s.mesh.points[7].y = kNaN;
  EXPECT_EQ(faultsOf(s),
            "/mesh/points/7/y is nan; allowed is -0.5 to 1.5, in shares of the output\n");
}

TEST(CorrectSettings, RampsWiderThanThePictureAreFound) {
  correct::CorrectionSettings s;
  s.blend.left = 400;
  EXPECT_EQ(faultsOf(s), "");
  s.blend.right = 300;
  EXPECT_EQ(faultsOf(s),
            "/blend has ramps of 400 and 300 pixels at the left and right; the picture is 640 "
            "pixels wide\n");
  s.blend.right = 0;
  s.blend.top = 481;
  EXPECT_EQ(faultsOf(s), "/blend/top is 481; allowed is 0 to 480\n");
  s.blend.top = -1;
  EXPECT_EQ(faultsOf(s), "/blend/top is -1; allowed is 0 to 480\n");
}

TEST(CorrectSettings, FiguresOutOfRangeAreFoundAllAtOnce) {
  correct::CorrectionSettings s;
  s.blend = {kNaN, 0, 0, 0, 0.5};
  s.colour.matrix[4] = 9;
  s.colour.gain[0] = -1;
  s.colour.gamma[1] = 0;
  s.black.level[2] = 0.7;
  EXPECT_EQ(
      faultsOf(s),
      "/blend/left is nan; allowed is 0 to 640\n"
      "/blend/gamma is 0.5; allowed is 1 to 4\n"
      "/colour/matrix/4 is 9; allowed is -4 to 4\n"
      "/colour/gain/0 is -1; allowed is 0 to 4\n"
      "/colour/gamma/1 is 0; allowed is 0.25 to 4\n"
      "/black/level/2 is 0.7; allowed is 0 to 0.5\n"
      "/black sets a level, but blend has no ramp: black is lifted outside the overlaps, so define "
      "a ramp in blend or remove the level\n");
}

TEST(CorrectSettings, WhatContradictsAnMpcdiFileIsFound) {
  correct::CorrectionSettings s = meshed();
  s.mpcdi = "wall.mpcdi";
  s.blend.left = 64;
  s.black.level = {0.01, 0.01, 0.01};
  EXPECT_EQ(
      faultsOf(s),
      "/mesh is set together with mpcdi, whose file has a warp of its own; leave out one of the "
      "two\n"
      "/blend is set together with mpcdi, whose file has a blend of its own; leave out one of the "
      "two\n"
      "/black is set together with mpcdi, whose file has a black level of its own; leave out one "
      "of the two\n");
  correct::CorrectionSettings region;
  region.mpcdi_region = "a";
  EXPECT_EQ(faultsOf(region), "/mpcdi_region names a region, but mpcdi names no file\n");
}

// The image has the size of the output's tiles, not that of the frame.
TEST(CorrectSettings, AnOutputsCorrectionIsCheckedAgainstItsPicture) {
  out::OutputSettings png{out::OutputKind::kPng, "", "a.png"};
  png.tiles = {{"left", 0, 0}};
  png.correction.blend = {400, 300};
  const auto faults = [&](const out::OutputSettings& output) {
    std::string text;
    for (const SettingFault& f : out::validate({output}, {}))
      text += f.pointer + " " + f.what + "\n";
    return text;
  };
  EXPECT_EQ(faults(png),
            "/0/correction/blend has ramps of 400 and 300 pixels at the left and right; the "
            "picture is 640 pixels wide\n");
  png.tiles.push_back({"centre", 640, 0});
  EXPECT_EQ(faults(png), "");
  out::OutputSettings shared;
  shared.correction.corners[0] = 3;
  EXPECT_EQ(faults(shared),
            "/0/correction is not a setting of kind shared_memory, which holds the uncorrected "
            "frame\n");
}

}  // namespace
}  // namespace merlin::render
