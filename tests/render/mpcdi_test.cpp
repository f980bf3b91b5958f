// MPCDI files: MERLIN reads what it has written and files of other programs, and reports damage.
#include "render/correct/io/mpcdi.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/base/files.h"
#include "render/correct/io/archive.h"
#include "render/correct/io/pfm.h"
#include "render/correct/output_correction.h"
#include "render/image/png_levels.h"
#include "render/image/png_writer.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using merlin::test::TempDir;

constexpr int kWidth = 160, kHeight = 120;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

correct::CorrectionSettings everything() {
  correct::CorrectionSettings s;
  s.corners = {9, 4, -6, 3, 2, -5, -8, -11};
  s.mesh.columns = 5;
  s.mesh.rows = 4;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i)
      s.mesh.points.push_back({i / 4.0 + 0.03 * std::sin(j), j / 3.0 + 0.02 * std::sin(i)});
  }
  s.blend = {40, 20, 0, 30, 2.4};
  s.black.level = {0.02, 0.02, 0.02};
  EXPECT_TRUE(validate(s, kWidth, kHeight).empty());
  return s;
}

std::string written(const correct::CorrectionSettings& s,
                    const correct::MeasuredCorrection* measured = nullptr) {
  return *correct::mpcdiBytes({correct::mpcdiOutput("left", s, kWidth, kHeight, measured, 1)},
                              "2026-01-02 03:04:05");
}

std::vector<std::uint8_t> shown(const correct::CorrectionSettings& s,
                                const correct::MeasuredCorrection* measured) {
  std::vector<std::uint8_t> picture(4 * kWidth * kHeight);
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture[i] = static_cast<std::uint8_t>(128 + 120 * std::sin(static_cast<double>(i) * 0.01));
  correct::OutputCorrection correction(correct::makeCorrectionMap(s, kWidth, kHeight, measured, 1),
                                       1);
  const out::Signal signal = correction.apply({kWidth, kHeight, picture});
  return {signal.pixels.begin(), signal.pixels.end()};
}

// Returns settings that take their correction from a file, which was written with the settings `s`.
correct::CorrectionSettings using_file(const correct::CorrectionSettings& s) {
  correct::CorrectionSettings with;
  with.mpcdi = "wall.mpcdi";
  with.blend.gamma = s.blend.gamma;
  return with;
}

// --- out, in, out
// ----------------------------------------------------------------------------------

// Result of writing, reading and writing a correction again: the largest distance [px] by which a
// point of the warp has moved; infinite if a point that was shown no longer is, or the other way
// round.
struct RoundTrip {
  double most_px = 0;
  std::size_t points = 0;
};
// Returns whether a pixel shows more than a trace of the picture.
bool shows(const correct::Place& p, int width, int height) {
  const auto within = [](float share, int size) {
    const double at = static_cast<double>(share) * size;
    return at >= -0.5 && at <= size + 0.5;
  };
  return within(p.u, width) && within(p.v, height);
}

RoundTrip outInOut(const correct::CorrectionSettings& s, int width, int height) {
  const auto fileOf = [&](const correct::CorrectionSettings& settings,
                          const correct::MeasuredCorrection* measured) {
    return *correct::mpcdiBytes(
        {correct::mpcdiOutput("left", settings, width, height, measured, 1)},
        "2026-01-02 03:04:05");
  };
  const auto before = correct::Warp(s, width, height).places(1);
  const std::string first = fileOf(s, nullptr);
  const auto once = *correct::Mpcdi::open(bytesOf(first))->measured("");
  const std::string second = fileOf(using_file(s), &once);
  const auto twice = *correct::Mpcdi::open(bytesOf(second))->measured("left");
  const auto after = correct::Warp(using_file(s), width, height, &twice.warp).places(1);
  RoundTrip trip;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (shows(before[i], width, height) == std::isnan(after[i].u))
      trip.most_px = std::numeric_limits<double>::infinity();
    if (std::isnan(after[i].u)) continue;
    ++trip.points;
    const double right = static_cast<double>(before[i].u - after[i].u) * width;
    const double down = static_cast<double>(before[i].v - after[i].v) * height;
    trip.most_px = std::max(trip.most_px, std::hypot(right, down));
  }
  return trip;
}

TEST(Mpcdi, OutInOutMovesNothingByATenthOfAPixel) {
  for (const auto& [width, height] : {std::pair{kWidth, kHeight}, {640, 480}}) {
    const RoundTrip trip = outInOut(everything(), width, height);
    fmt::print("MPCDI out, in, out, {} x {}: {} points of the warp moved by at most {:.6f} px\n",
               width, height, trip.points, trip.most_px);
    EXPECT_LT(trip.most_px, 0.1);
    EXPECT_GT(trip.points, static_cast<std::size_t>(width * height / 2));
  }
}

TEST(Mpcdi, AFileShowsWhatItsSettingsShow) {
  const correct::CorrectionSettings s = everything();
  const std::string file = written(s);
  const auto opened = correct::Mpcdi::open(bytesOf(file));
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_NEAR(opened->regions()[0].gamma, 2.4, 1e-9);
  const auto measured = *opened->measured("");
  const auto a = shown(s, nullptr), b = shown(using_file(s), &measured);
  int lit = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(a[i], b[i], 1) << i / 4 % kWidth << " " << i / 4 / kWidth;
    lit += a[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(lit, kWidth * kHeight * 2);
}

// As in the OpenSpace issue 399, a measured correction still needs an adjustment by hand, here of
// the corners. Outside the picture, other readers would repeat the picture's edge and raise the
// black level.
TEST(Mpcdi, PixelsOutsideThePictureShowNothing) {
  correct::CorrectionSettings s;
  s.corners = {20, 10, 0, 0, 0, 0, 0, 0};
  s.blend.right = 30;
  s.black.level = {0.02, 0.02, 0.02};
  const auto file = written(s);
  const auto read = *correct::Mpcdi::open(bytesOf(file))->measured("");
  EXPECT_TRUE(std::isnan(read.warp.places[0].x)) << "the corner moved inwards";
  EXPECT_EQ(read.alpha->shares[0], 0);
  EXPECT_EQ(read.beta->shares[0], 0);
  const std::size_t middle = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_FALSE(std::isnan(read.warp.places[middle].x));
  EXPECT_NEAR(read.alpha->shares[middle], 1, 1e-3);
}

TEST(Mpcdi, CornersMoveWhatWasMeasured) {
  correct::CorrectionSettings plain;
  plain.blend.left = 20;
  const std::string file = written(plain);
  const auto measured = *correct::Mpcdi::open(bytesOf(file))->measured("");
  correct::CorrectionSettings moved = using_file(plain);
  moved.corners = {5, 3, 5, 3, 5, 3, 5, 3};
  const correct::CorrectionMap map =
      correct::makeCorrectionMap(moved, kWidth, kHeight, &measured, 1);
  const auto entry = static_cast<std::size_t>(60 * map.stride + 80);
  EXPECT_EQ(map.source_x[entry], 75 * 256);
  EXPECT_EQ(map.source_y[entry], 57 * 256);
  const auto in_ramp = static_cast<std::size_t>(60 * map.stride + 15);  // column 10 of the image
  EXPECT_NEAR(std::pow(map.gain[in_ramp] / 65535.0, 2),
              0.5 - 0.5 * std::cos(3.14159265 * 10.5 / 20), 1e-3);
}

TEST(Mpcdi, TheSameSettingsGiveTheSameBytes) {
  EXPECT_EQ(written(everything()), written(everything()));
}

TEST(Mpcdi, ManyOutputsAreAsManyRegions) {
  const auto output = [](const char* name, int width) {
    return correct::mpcdiOutput(name, {}, width, 20, nullptr, 1);
  };
  const std::string file = *correct::mpcdiBytes({output("a", 30), output("b <&> \"c\"", 40)}, "");
  const auto opened = correct::Mpcdi::open(bytesOf(file));
  ASSERT_TRUE(opened) << opened.error().what;
  ASSERT_EQ(opened->regions().size(), 2U);
  EXPECT_EQ(opened->regions()[1].id, "b <&> \"c\"");
  EXPECT_EQ(opened->measured("b <&> \"c\"")->warp.columns, 40);
  EXPECT_EQ(opened->measured("").error().what,
            "has the regions a, b <&> \"c\"; set mpcdi_region to the output's region");
  EXPECT_EQ(opened->measured("d").error().what,
            "has no region \"d\"; its regions are a, b <&> \"c\"");
}

// --- what others write
// -----------------------------------------------------------------------------

std::string pfm(int columns, int rows, const std::vector<std::array<float, 3>>& cells) {
  return correct::pfmBytes({columns, rows, cells});
}

// Returns a warp of 2 x 2 cells that maps each point to itself.
std::string identity() {
  return pfm(
      2, 2,
      {{0.25F, 0.75F, kNaN}, {0.75F, 0.75F, kNaN}, {0.25F, 0.25F, kNaN}, {0.75F, 0.25F, kNaN}});
}

std::string greyPng(int width, int height, const std::vector<std::uint16_t>& values) {
  return *image::encodeLevels({width, height, 1, values});
}

// The parts of a file with one region; each test changes one part.
struct Parts {
  std::string version = "version=\"2.0\"", profile = "2d", interpolation = "linear";
  std::string warp = identity(), alpha = greyPng(2, 2, {0, 65535, 32768, 13107});
  std::string beta{}, alpha_tags = "<gammaEmbedded>1.0</gammaEmbedded>", xml{}, region{};
  std::string place = R"(x="0.0" y="0.0" xsize="1.0" ysize="1.0")";
  std::map<std::string, std::string> extra{};

  std::string bytes() const {
    const std::string beta_map =
        beta.empty() ? "" : "<betaMap><bitDepth>8</bitDepth><path>b.png</path></betaMap>";
    const std::string text = fmt::format(
        R"(<?xml version="1.0" encoding="utf-8"?>
<MPCDI profile="{}" level="1" date="2015-01-01 10:00:00" {}>
 <display><buffer id="d" Xresolution="160" Yresolution="120">
  <region id="r" Xresolution="160" Yresolution="120" {}>{}</region>
 </buffer></display>
 <files><fileset region="r">
  <geometryWarpFile><path> w.pfm </path><interpolation>{}</interpolation></geometryWarpFile>
  <alphaMap><componentDepth>1</componentDepth><path>a.png</path>{}</alphaMap>{}
 </fileset></files>
</MPCDI>)",
        profile, version, place, region, interpolation, alpha_tags, beta_map);
    std::vector<std::pair<std::string, std::string>> entries = {
        {"mpcdi.xml", xml.empty() ? text : xml}, {"w.pfm", warp}, {"a.png", alpha}};
    if (!beta.empty()) entries.emplace_back("b.png", beta);
    entries.insert(entries.end(), extra.begin(), extra.end());
    return *correct::zipBytes(entries);
  }
};

correct::MeasuredCorrection measuredOf(const Parts& parts) {
  const std::string bytes = parts.bytes();
  const auto opened = correct::Mpcdi::open(bytesOf(bytes));
  if (!opened) {
    ADD_FAILURE() << opened.error().what;
    return {};
  }
  auto measured = opened->measured("");
  EXPECT_TRUE(measured) << measured.error().what;
  return measured ? *measured : correct::MeasuredCorrection{};
}

// The grid covers the image: the centres of its cells lie half a cell inside, and the outermost
// cells are extrapolated to the border ([MPCDI] 3.6).
TEST(Mpcdi, ACoarseGridReachesTheBorder) {
  Parts version1;
  version1.version = "version=\"1.0\"";
  const auto measured = measuredOf(version1);
  const correct::CorrectionSettings s = using_file({});
  const auto places = correct::Warp(s, kWidth, kHeight, &measured.warp).places(1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const correct::Place p = places[static_cast<std::size_t>(y * kWidth + x)];
      ASSERT_NEAR(p.u * kWidth, x + 0.5, 1e-4);
      ASSERT_NEAR(p.v * kHeight, y + 0.5, 1e-4);
    }
  }
}

TEST(Mpcdi, TheLowestRowIsFirstAndVGoesUp) {
  // A grid that enlarges the image's lower left quarter; the file's first row is the lowest.
  std::string bytes = "PF 2 2\t-1.0\n";
  const auto add = [&](float value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const auto& [u, v] : {std::pair{0.1F, 0.2F}, {0.3F, 0.2F}, {0.1F, 0.4F}, {0.3F, 0.4F}}) {
    add(u);
    add(v);
    add(0);
  }
  Parts parts;
  parts.warp = bytes;
  const auto& places = measuredOf(parts).warp.places;
  EXPECT_NEAR(places[0].x, 0.1, 1e-6) << "upper left";
  EXPECT_NEAR(places[0].y, 0.6, 1e-6);
  EXPECT_NEAR(places[3].x, 0.3, 1e-6) << "lower right";
  EXPECT_NEAR(places[3].y, 0.8, 1e-6);
}

TEST(Mpcdi, BigEndianFloatsAreRead) {
  std::string bytes = "PF\n2 2\n1.0\n";
  const std::string half("\x3f\x00\x00\x00", 4), one("\x3f\x80\x00\x00", 4);
  for (const std::string& v : {half, one}) {
    for (const std::string& u : {half, one}) bytes += u + v + half;
  }
  Parts parts;
  parts.warp = bytes;
  EXPECT_EQ(measuredOf(parts).warp.places[2].x, 0.5);
}

TEST(Mpcdi, WhatWasNotMeasuredIsBlack) {
  Parts parts;
  parts.warp =
      pfm(2, 2, {{0.25F, 0.75F, 0}, {kNaN, kNaN, 1}, {0.25F, 0.25F, 0}, {0.75F, 0.25F, 0}});
  const auto measured = measuredOf(parts);
  const auto places = correct::Warp(using_file({}), kWidth, kHeight, &measured.warp).places(1);
  EXPECT_TRUE(std::isnan(places[20 * kWidth + 100].u)) << "between known and unknown cells";
}

TEST(Mpcdi, AnAlphaMapsGammaIsTakenOut) {
  Parts parts;
  parts.alpha_tags = "<GAMMAEMBEDDED>2.0</GAMMAEMBEDDED>";
  const auto measured = measuredOf(parts);
  ASSERT_TRUE(measured.alpha);
  EXPECT_NEAR(measured.alpha->shares[1], 1, 1e-6);
  EXPECT_NEAR(measured.alpha->shares[2], 0.25, 1e-4);
  EXPECT_NEAR(measured.alpha->shares[3], 0.04, 1e-4);
}

// Many tools write beta maps with 8 bits and three channels.
TEST(Mpcdi, ABetaMapMayHaveOneColour) {
  const TempDir dir;
  const auto png = [&](const std::vector<std::uint8_t>& pixels) {
    EXPECT_TRUE(image::writePng(dir / "b.png", 2, 1, pixels));
    return std::string(FileCopy::read(dir / "b.png")->text());
  };
  Parts parts;
  parts.beta = png({10, 20, 40, 0, 5, 10, 20, 0});
  const auto measured = measuredOf(parts);
  ASSERT_TRUE(measured.beta);
  EXPECT_NEAR(measured.beta_level[0], 10 / 255.0, 1e-6);
  EXPECT_NEAR(measured.beta_level[2], 40 / 255.0, 1e-6);
  EXPECT_NEAR(measured.beta->shares[0], 1, 1e-6);
  EXPECT_NEAR(measured.beta->shares[1], 0.5, 1e-6);
  parts.beta = png({10, 20, 40, 0, 40, 20, 10, 0});
  const std::string bytes = parts.bytes();
  EXPECT_EQ(correct::Mpcdi::open(bytesOf(bytes))->measured("").error().what,
            "b.png: its pixel 0, 0 has another colour than the rest of the map; only one share for "
            "all three channels is supported");
}

// --- hostile
// ---------------------------------------------------------------------------------------

// Returns the message about a file; empty if the file can be used.
std::string faultOf(const std::string& bytes) {
  const auto opened = correct::Mpcdi::open(bytesOf(bytes));
  if (!opened) return opened.error().what;
  const auto measured = opened->measured("");
  return measured ? "" : measured.error().what;
}
std::string faultWith(const std::function<void(Parts&)>& change) {
  Parts parts;
  change(parts);
  return faultOf(parts.bytes());
}

TEST(Mpcdi, AnEntryThatClimbsOutIsRefused) {
  for (const char* name :
       {"../evil.pfm", "/etc/passwd", "a/b.pfm", "..\\evil.pfm", "c:evil", ".."}) {
    EXPECT_EQ(
        faultWith([&](Parts& p) { p.extra[name] = "x"; }),
        fmt::format("has an entry \"{}\"; the files of an MPCDI archive have no folders", name));
  }
}

TEST(Mpcdi, EveryCutArchiveIsRefused) {
  const std::string whole = Parts{}.bytes();
  EXPECT_EQ(faultOf(whole), "");
  EXPECT_EQ(faultOf(""), "is empty; an MPCDI file is a zip archive");
  EXPECT_TRUE(faultOf(whole.substr(0, 60)).starts_with("is not a complete zip archive ("));
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_NE(faultOf(whole.substr(0, size)), "") << size << " of " << whole.size() << " bytes";
}

TEST(Mpcdi, EveryDamagedByteIsSaidOrHarmless) {
  Parts parts;
  parts.beta = greyPng(2, 2, {0, 1000, 2000, 3000});
  const std::string whole = parts.bytes();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int mask : {0xFF, 0x01, 0x80}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ mask);
      faultOf(damaged);
    }
  }
}

// The damage is such that checksums do not detect it.
TEST(Mpcdi, EveryDamagedByteOfAPartIsSaidOrHarmless) {
  const Parts whole;
  for (std::string Parts::*part : {&Parts::warp, &Parts::alpha}) {
    for (std::size_t i = 0; i < (whole.*part).size(); ++i) {
      for (const int mask : {0xFF, 0x01, 0x80}) {
        Parts damaged;
        (damaged.*part)[i] = static_cast<char>((damaged.*part)[i] ^ mask);
        faultOf(damaged.bytes());
      }
    }
  }
}

TEST(Mpcdi, ABrokenWarpIsSaid) {
  const auto warp = [&](const std::string& bytes) {
    return faultWith([&](Parts& p) { p.warp = bytes; });
  };
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(
      warp(pfm(2, 2, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, kNaN, 0}})),
      "w.pfm: its cell of column 1, row 1 (from the top, counted from 0) is (0, nan); a cell has "
      "two numbers, or two NaN where nothing was measured");
  EXPECT_NE(warp(pfm(2, 2, {{inf, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}})), "");
  EXPECT_EQ(warp(pfm(2, 2, std::vector(4, std::array{kNaN, kNaN, 1.0F}))),
            "w.pfm: the warp of region \"r\" has NaN in every cell, so that it shows nothing; "
            "write the file anew with the calibration tool, or leave mpcdi out of the correction");
  EXPECT_EQ(warp("PF\n100000 100000\n-1.0\n"),
            "w.pfm: has 100000 x 100000 cells; the maximum is 16777216");
  EXPECT_EQ(warp("PF\n2 2\n-1.0\nabc"), "w.pfm: has 3 bytes of floats; 2 x 2 cells need 48");
  EXPECT_EQ(warp("PF\n1 3\n-1.0\n" + std::string(36, '\0')),
            "w.pfm: has 1 x 3 cells; a warp has 2 x 2 or more");
  EXPECT_EQ(warp("Pf\n2 2\n-1.0\n" + std::string(16, '\0')),
            "w.pfm: is a PFM with one float a cell (Pf); a warp has three (PF)");
  for (const char* head :
       {"", "PF", "PF 2", "PF -2 2 -1 ", "PF 2 2 nan ", "PF 2 2 0 ", "P6 2 2 1 "})
    EXPECT_EQ(
        warp(head),
        "w.pfm: is not a PFM: it does not begin with PF, columns, rows and a scale that is not 0")
        << head;
}

// A warp without an area shows one point of the picture everywhere; the tool that wrote it never
// filled it.
TEST(Mpcdi, AWarpWithoutAnAreaIsSaidWithItsRegion) {
  const auto warp = [&](const std::vector<std::array<float, 3>>& cells) {
    return faultWith([&](Parts& p) { p.warp = pfm(2, 2, cells); });
  };
  const std::string way_out =
      "; write the file anew with the calibration tool, or leave mpcdi out of the correction";
  EXPECT_EQ(warp(std::vector(4, std::array{0.0F, 0.0F, 0.0F})),
            "w.pfm: the warp of region \"r\" has (0, 0) in every cell, so that every pixel shows "
            "the same point of the picture" +
                way_out);
  EXPECT_EQ(warp({{kNaN, kNaN, 1}, {0.5F, 0.25F, 0}, {kNaN, kNaN, 1}, {0.5F, 0.25F, 0}}),
            "w.pfm: the warp of region \"r\" has (0.5, 0.25) in every cell, so that every pixel "
            "shows the same point of the picture" +
                way_out);
  EXPECT_EQ(warp({{0, 0.75F, 0}, {0, 0.75F, 0}, {0, 0.25F, 0}, {0, 0.25F, 0}}),
            "w.pfm: the warp of region \"r\" has the u 0 in every cell, so that every pixel shows "
            "the same column of the picture" +
                way_out);
  EXPECT_EQ(
      warp({{0, 0.75F, 0}, {1, 0.75F, 0}, {0, 0.75F, 0}, {1, 0.75F, 0}}),
      "w.pfm: the warp of region \"r\" has the v 0.75 in every cell, so that every pixel shows "
      "the same row of the picture" +
          way_out);
}

TEST(Mpcdi, ARegionsPartOfItsBufferIsKnown) {
  const auto partOf = [](const std::string& place) {
    Parts parts;
    parts.place = place;
    const std::string bytes = parts.bytes();
    const auto opened = correct::Mpcdi::open(bytesOf(bytes));
    return opened ? opened->regions()[0].part : opened.error().what;
  };
  for (const char* whole : {"", "x='0' y='0' xSize='1' ySize='1'", "xsize='1.0000001'"})
    EXPECT_EQ(partOf(whole), "") << whole;
  EXPECT_EQ(partOf("x='0.5' y='0.0' xsize='0.50' ysize='1.0'"), "x 0.5, y 0, xSize 0.5, ySize 1");
  EXPECT_EQ(partOf("xSize='half'"), "x 0, y 0, xSize \"half\", ySize 1");
}

TEST(Mpcdi, ABrokenBlendMapIsSaid) {
  EXPECT_EQ(faultWith([](Parts& p) { p.alpha = p.alpha.substr(0, 40); }),
            "a.png: PNG: the file is cut off");
  EXPECT_EQ(faultWith([](Parts& p) { p.alpha = "no picture"; }), "a.png: PNG: Not a PNG file");
  EXPECT_EQ(faultWith([](Parts& p) { p.alpha_tags = "<gammaEmbedded>nan</gammaEmbedded>"; }),
            "mpcdi.xml: the alphaMap of region \"r\" has the gamma \"nan\"; allowed is 0.1 to 10");
}

TEST(Mpcdi, ABrokenDescriptionIsSaid) {
  EXPECT_EQ(faultWith([](Parts& p) { p.profile = "a3"; }),
            "is of profile \"a3\"; only profile 2d is supported, whose warp does not depend "
            "on the content");
  EXPECT_EQ(faultWith([](Parts& p) { p.version = "version=\"3.0\""; }),
            "is of version \"3.0\"; only 1.x and 2.x are supported");
  EXPECT_EQ(
      faultWith([](Parts& p) { p.interpolation = "keystone"; }),
      "w.pfm: its interpolation is \"keystone\"; only \"linear\", \"smooth\" and \"unknown\" are "
      "supported");
  EXPECT_EQ(faultWith([](Parts& p) { p.xml = "<a>"; }),
            "mpcdi.xml: Start-end tags mismatch at byte 2");
  EXPECT_EQ(faultWith([](Parts& p) { p.xml = "<a/>"; }), "mpcdi.xml: has no element MPCDI");
  EXPECT_EQ(faultWith([](Parts& p) { p.xml = "<MPCDI profile='2d' version='2.0'/>"; }),
            "mpcdi.xml: has no region");
  EXPECT_EQ(faultWith([](Parts& p) { p.xml = std::string(2 << 20, ' '); }),
            "mpcdi.xml: has 2097152 bytes; the maximum is 1048576; an MPCDI file has it");
  EXPECT_EQ(faultOf(*correct::zipBytes({{"w.pfm", identity()}})),
            "\"mpcdi.xml\" is not in the archive; an MPCDI file has it");
  const auto region = [](const std::string& attributes) {
    return faultWith([&](Parts& p) {
      p.xml = "<MPCDI profile='2d' version='2.0'><display><buffer id='b'><region " + attributes +
              "/></buffer></display></MPCDI>";
    });
  };
  EXPECT_EQ(region("xResolution='2' yResolution='2'"),
            "mpcdi.xml: a region's id is \"\"; allowed are 1 to 64 characters");
  for (const char* height : {"-2", "2.5", "0", "65537", "2px", ""}) {
    EXPECT_EQ(region(fmt::format("id='r' xResolution='2' yResolution='{}'", height)),
              fmt::format("mpcdi.xml: region \"r\" has the size \"2\" x \"{}\"; xResolution and "
                          "yResolution are whole numbers of 1 to 65536 pixels",
                          height));
  }
  EXPECT_EQ(region("id='r' xResolution='2.0' yResolution='2'"),
            "mpcdi.xml: region \"r\" has no fileset with a geometryWarpFile");
  EXPECT_EQ(region("id='r' xResolution='2' yResolution='2'"),
            "mpcdi.xml: region \"r\" has no fileset with a geometryWarpFile");
}

// In the gamma of a region's colours, a missing value is not the same as a wrong one.
TEST(Mpcdi, ABrokenDecodeGammaIsSaid) {
  const auto with = [](const std::string& colour) {
    Parts parts;
    parts.region = colour;
    return parts.bytes();
  };
  for (const char* gamma : {"nan", "2,2", "-2.2", "0", "5", "1e400", ""}) {
    EXPECT_EQ(faultOf(with(fmt::format("<color><decode gamma='{}'/></color>", gamma))),
              fmt::format("mpcdi.xml: region \"r\" has the decode gamma \"{}\"; allowed is 1 to 4",
                          gamma));
  }
  for (const char* absent : {"", "<color/>", "<color><decode/></color>"}) {
    const std::string bytes = with(absent);
    const auto opened = correct::Mpcdi::open(bytesOf(bytes));
    ASSERT_TRUE(opened) << absent << opened.error().what;
    EXPECT_EQ(opened->regions()[0].gamma, 0) << absent;
  }
  EXPECT_EQ(faultOf(with("<color><decode gamma='2.2'/></color>")), "");
}

TEST(Mpcdi, TenThousandLevelsOfXmlAreNoDanger) {
  std::string deep;
  for (int i = 0; i < 10'000; ++i) deep += "<a>";
  EXPECT_NE(faultWith([&](Parts& p) { p.xml = deep; }), "");
  for (int i = 0; i < 10'000; ++i) deep += "</a>";
  EXPECT_EQ(faultWith([&](Parts& p) { p.xml = deep; }), "mpcdi.xml: has no element MPCDI");
}

TEST(Mpcdi, AFileThatIsNotThereIsNamed) {
  const auto missing = correct::readMeasured("/nonexistent/a.mpcdi", "");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("/nonexistent/a.mpcdi"), std::string::npos);
}

}  // namespace
}  // namespace merlin::render
