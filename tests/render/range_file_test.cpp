// Range files: what MERLIN's own readers return for valid, damaged and hostile bytes. All files are
// synthetic.
#include "render/range/io/range_file.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "daemon/base/files.h"
#include "render/image/png_levels.h"
#include "render/range/geometry.h"
#include "render/range/io/angle_table.h"
#include "render/range/io/elevation.h"
#include "render/range/io/grid_file.h"
#include "render/range/io/lzf.h"
#include "render/range/io/netpbm.h"
#include "render/range/io/pcd.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_grid.h"
#include "render/range/map_origin.h"
#include "tests/support/range_images.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

using namespace render::range;

class RangeFile : public testing::Test {
 protected:
  // Reads `bytes` as a file with this name.
  Result<LoadedRange> read(const std::string& bytes, const RangeOptions& options = {},
                           const std::string& name = "a.pgm") {
    writeText(dir_ / name, bytes);
    return readRange(dir_ / name, options);
  }
  // Returns the error's text without the folder's path.
  std::string fault(const std::string& bytes, const RangeOptions& options = {},
                    const std::string& name = "a.pgm") {
    const auto loaded = read(bytes, options, name);
    if (loaded) return "no fault";
    EXPECT_TRUE(loaded.error().what.starts_with(dir_.path() + "/")) << loaded.error().what;
    return loaded.error().what.substr(dir_.path().size() + 1);
  }

  TempDir dir_;
};

const std::string kHeader = "P5\n# geometry: pinhole\n# angles: 60 40\n";

std::string big16(std::initializer_list<int> values) {
  std::string bytes;
  for (const int v : values) appendBe16(bytes, static_cast<std::uint16_t>(v));
  return bytes;
}

TEST_F(RangeFile, APgmsCommentsCarryTheGeometry) {
  const auto loaded =
      read("P5 # scale: 0.001\n#unit: m\n # camera: 1 0 0 5  0 1 0 6  0 0 1 7\n" +
           kHeader.substr(3) + "2 2 # a comment\n65535\n" + big16({1000, 0, 2000, 3000}));
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->format, "PGM");
  const Geometry& g = loaded->image.geometry;
  EXPECT_EQ(g.scanner, Scanner::kPinhole);
  EXPECT_NEAR(g.horizontal_rad, std::numbers::pi / 3, 1e-12);
  EXPECT_EQ(g.T_world_scanner[7], 6);
  EXPECT_EQ(loaded->image.range[0], 1.0F);
  EXPECT_FALSE(isReturn(loaded->image.range[1]));
  EXPECT_EQ(loaded->image.range[3], 3.0F);
}

TEST_F(RangeFile, MinimumAndMaximumScaleTheStoredValues) {
  const auto loaded = read(kHeader + "# minimum: 10\n# maximum: 61\n# scale: 0.1\n2 2\n255\n" +
                           "\x05\x0a\xff" + std::string(1, '\0'));
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_FLOAT_EQ(loaded->image.range[0], 1.1F);
  EXPECT_FLOAT_EQ(loaded->image.range[2], 6.1F);
  EXPECT_FALSE(isReturn(loaded->image.range[3])) << "0 is no return";
}

TEST_F(RangeFile, AnOptionOverridesTheHeader) {
  RangeOptions options;
  options.scanner = Scanner::kOrthogonal;
  options.angles_deg = {90, 30};
  options.scale = 2;
  options.no_return = 7;
  const auto loaded = read(kHeader + "2 2\n255\n\x07\x08\x09\x0a", options);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.geometry.scanner, Scanner::kOrthogonal);
  EXPECT_NEAR(loaded->image.geometry.vertical_rad, std::numbers::pi / 6, 1e-12);
  EXPECT_FALSE(isReturn(loaded->image.range[0]));
  EXPECT_EQ(loaded->image.range[1], 16);
}

TEST_F(RangeFile, TextPgmsAreReadAsWell) {
  const auto loaded = read("P2\n# angles: 60 40\n2 2 9\n1 2\n3\n 9 ");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.range, (std::vector<float>{1, 2, 3, 9}));
}

TEST_F(RangeFile, WhatIsWrittenIsReadAgainWithinHalfAStep) {
  RangeImage image = bumps(31, 17);
  image.geometry.T_world_scanner = {0, -1, 0, 1.5, 1, 0, 0, 2, 0, 0, 1, -3};
  ASSERT_TRUE(writeRange(dir_ / "b.pgm", image).ok());
  const auto again = readRange(dir_ / "b.pgm", {});
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->image.geometry.scanner, Scanner::kOrthogonal);
  EXPECT_NEAR(again->image.geometry.horizontal_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(again->image.geometry.T_world_scanner, image.geometry.T_world_scanner);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    ASSERT_EQ(isReturn(image.range[p]), isReturn(again->image.range[p])) << p;
    const float off = image.range[p] - again->image.range[p];
    ASSERT_FALSE(std::abs(off) > 2.0 / 65534 / 2 + 1e-6) << p;
  }
}

TEST_F(RangeFile, ASpinningScannersBeamsAreWrittenToo) {
  RangeImage image = ring(8, 3);
  image.geometry.beams[1] = {0.1, -0.05};
  ASSERT_TRUE(writeRange(dir_ / "b.pgm", image).ok());
  const auto again = readRange(dir_ / "b.pgm", {});
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_EQ(again->image.geometry.beams.size(), 3u);
  EXPECT_NEAR(again->image.geometry.beams[1].azimuth_rad, -0.05, 1e-12);
  EXPECT_TRUE(again->image.wraps());
}

TEST_F(RangeFile, RefusalsNameFilePlaceAndWhatIsAllowed) {
  EXPECT_EQ(fault("P5\n2 2\n255\nabcd"),
            "a.pgm: the angles of the image are not known; give them with --angles HORIZONTAL "
            "VERTICAL (degrees)");
  EXPECT_EQ(fault(kHeader + "4 4\n255\nabc"), "a.pgm: has 3 bytes of pixels; 4 x 4 pixels take 16");
  EXPECT_EQ(fault(kHeader + "2 2\n255\n" + std::string(4, '\0')),
            "a.pgm: none of its 2 x 2 pixels has a return: each is the value that means no "
            "return (--no-return), is not a number, is not positive, or is beyond 1e+09");
  EXPECT_EQ(fault("P5\n# angles: sixty\n2 2\n255\nabcd"),
            "a.pgm: line 2: angles: found \"sixty\", allowed: one or two numbers (degrees: "
            "horizontal, vertical)");
  EXPECT_EQ(fault("P5\n# geometry: round\n2 2\n255\nabcd"),
            "a.pgm: line 2: geometry: found \"round\", allowed: orthogonal, spinning, pinhole, "
            "elevation");
  EXPECT_EQ(fault(kHeader + "two 2\n255\n"),
            "a.pgm: line 4: the width is \"two\"; allowed are 1 to 268435456");
  EXPECT_EQ(fault(kHeader + "99999 99999\n255\n"),
            "a.pgm: line 5: 99999 x 99999 pixels; allowed are 268435456");
  EXPECT_EQ(fault(kHeader + "1 2\n255\nab"),
            "a.pgm: the image has 1 x 2 pixels; triangles need 2 x 2 at least");
  EXPECT_EQ(fault("P6\n2 2\n255\n"),
            "a.pgm: is not a range image; supported are " + readableRanges());
}

RangeOptions raw(const std::string& layout) {
  RangeOptions options;
  options.raw = *parseRawLayout(layout);
  options.angles_deg = {60, 40};
  return options;
}

TEST_F(RangeFile, RawPlanesAreReadByTheirDescription) {
  auto options = raw("2x2:-=u8,range=u16be,confidence=f32le");
  options.raw->header_bytes = 3;
  std::string confidence;
  for (const float c : {0.5F, 1.0F, 0.25F, 0.0F}) appendLeFloat(confidence, c);
  const std::string bytes = "HDRskip" + big16({1, 2, 3, 0}) + confidence;
  const auto loaded = read(bytes, options);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.range[2], 3);
  ASSERT_EQ(loaded->image.planes.size(), 1u);
  EXPECT_EQ(loaded->image.planes[0].values, (std::vector<float>{0.5F, 1, 0.25F, 0}));
  EXPECT_EQ(fault(bytes.substr(0, 20), options),
            "a.pgm: has 17 bytes after a header of 3; 2 x 2 pixels of 7 bytes take 28");
  options.raw->interleaved = true;
  options.raw->header_bytes = 0;
  const auto mixed =
      read(std::string("x\0\1\0\0\0\0y\0\2\0\0\0\0z\0\3\0\0\0\0w\0\4\0\0\0\0", 28), options);
  ASSERT_TRUE(mixed) << mixed.error().what;
  EXPECT_EQ(mixed->image.range, (std::vector<float>{1, 2, 3, 4}));
}

TEST_F(RangeFile, NotANumberEverywhereIsRefused) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) appendLeFloat(bytes, std::numeric_limits<float>::quiet_NaN());
  EXPECT_NE(fault(bytes, raw("2x2:range=f32le")).find("none of its 2 x 2 pixels"),
            std::string::npos);
}

TEST_F(RangeFile, RawTypesHaveTheirSignAndOrder) {
  const auto first = [&](const std::string& type, std::string bytes) {
    bytes.resize(32, '\1');
    const auto loaded = read(bytes, raw("2x2:range=" + type));
    return loaded ? loaded->image.range[0] : -1.0F;
  };
  EXPECT_EQ(first("u8", "\xC8"), 200);
  EXPECT_TRUE(std::isnan(first("i8", "\xC8"))) << "negative: no return";
  EXPECT_EQ(first("i16le", std::string("\x34\x12", 2)), 0x1234);
  EXPECT_EQ(first("i16be", std::string("\x12\x34", 2)), 0x1234);
  EXPECT_EQ(first("u32be", std::string("\0\1\0\0", 4)), 65536);
  EXPECT_EQ(first("f32be", std::string("\x40\x20\0\0", 4)), 2.5F);
  EXPECT_EQ(first("f64le", std::string("\0\0\0\0\0\0\x04\x40", 8)), 2.5F);
}

TEST(PlaneFile, WholeNumbersWithinARangeStayWholeAndTheRangeStays) {
  const TempDir dir;
  RangeImage image;
  image.width = 47;
  image.height = 2;
  image.range.assign(94, 1.0F);
  Plane plane{"label", 1, {}, "class", 0, 46};
  for (int p = 0; p < 94; ++p) plane.values.push_back(static_cast<float>(p % 47));
  ASSERT_TRUE(writePlane(dir / "a.pgm", plane, image).ok());
  const auto again = readPlane("label", dir / "a.pgm", image);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->values, plane.values);
  EXPECT_EQ(again->unit, "class");
  EXPECT_EQ(again->low, 0);
  EXPECT_EQ(again->high, 46);
}

TEST(RawLayout, FaultsNameWhatIsAllowed) {
  for (const char* text :
       {"", "3:range=u8", "2x2:", "2x2:depth=u8", "2x2:range=u9", "2x2:range=u8,range=u8",
        "2x2:range", "0x2:range=u8", "99999x99999:range=u8", "2x2x2:range=u8", "2x2:=u8"}) {
    const auto layout = parseRawLayout(text);
    ASSERT_FALSE(layout) << text;
    EXPECT_NE(layout.error().what.find("335x181:range=u16be"), std::string::npos)
        << layout.error().what;
  }
}

TEST(RawLayout, HasAtMost64Planes) {
  std::string text = "2x2:range=u8";
  for (int skipped = 0; skipped < 63; ++skipped) text += ",-=u8";
  EXPECT_TRUE(parseRawLayout(text).ok());
  const auto layout = parseRawLayout(text + ",-=u8");
  ASSERT_FALSE(layout);
  EXPECT_NE(layout.error().what.find("\": more than 64 planes NAME=TYPE are given; allowed: "),
            std::string::npos)
      << layout.error().what;
}

TEST(AngleTable, RowsHaveAltitudeAndAzimuth) {
  ImageHeader header;
  ASSERT_TRUE(parseAngleTable("# row altitude\n0 10 4.5\n1 -5.5 -4.5 # last\n\n", header).ok());
  ASSERT_EQ(header.beams.size(), 2u);
  EXPECT_NEAR(header.beams[1].altitude_rad, -5.5 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(header.beams[0].azimuth_rad, 4.5 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ((*header.angles_deg)[0], 360);
  EXPECT_FALSE(header.columns);
}

TEST(AngleTable, WithoutATurnOfItsOwnTheImagesStays) {
  ImageHeader header;
  header.angles_deg = {90, 0};
  ASSERT_TRUE(parseAngleTable("10\n-10\n", header).ok());
  EXPECT_EQ((*header.angles_deg)[0], 90);
  ASSERT_TRUE(parseAngleTable("# columns: 8 over 60 deg\n10\n-10\n", header).ok());
  EXPECT_EQ((*header.angles_deg)[0], 60) << "the table's own goes first";
}

TEST(AngleTable, OfRowsThatWereShiftedByColumnsTheRestIsAdded) {
  ImageHeader header;
  ASSERT_TRUE(
      parseAngleTable("# columns: 100 over 50 deg, after destagger\n0 1 4.1\n", header).ok());
  EXPECT_NEAR(header.beams[0].azimuth_rad, 0.1 * std::numbers::pi / 180, 1e-9);
  EXPECT_EQ(header.columns, 100u);
  EXPECT_EQ((*header.angles_deg)[0], 50);
}

TEST(AngleTable, FaultsNameTheLine) {
  for (const char* text :
       {"", "# nothing\n", "0 1 2\n2 1 2\n", "0 1 2\nx\n", "1 2 3 4\n",
        "# columns: many over 360 deg\n0 1\n", "# columns: 4 over 900 deg\n1\n"}) {
    ImageHeader header;
    const auto parsed = parseAngleTable(text, header);
    ASSERT_FALSE(parsed) << text;
  }
  ImageHeader header;
  EXPECT_NE(parseAngleTable("0 1 2\n2 1 2\n", header).error().what.find("line 2"),
            std::string::npos);
}

const std::string kPcdHeader =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 2\nTYPE F F F F U\n"
    "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 4\n";

std::string pcdPoint(float x, float y, float z, std::uint32_t rgb, unsigned label) {
  std::string bytes;
  for (const float v : {x, y, z}) appendLeFloat(bytes, v);
  appendLe32(bytes, rgb);
  bytes.push_back(static_cast<char>(label & 0xFF));
  bytes.push_back(static_cast<char>(label >> 8));
  return bytes;
}
std::string pcdBinary() {
  return kPcdHeader + "DATA binary\n" + pcdPoint(0, 0, -1, 0xFF8000, 7) +
         pcdPoint(1, 0, -1, 0, 300) + pcdPoint(0, -1, -1, 0, 0) +
         pcdPoint(std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 0);
}

void expectPcd(const Result<LoadedRange>& loaded) {
  ASSERT_TRUE(loaded) << loaded.error().what;
  const RangeImage& image = loaded->image;
  EXPECT_EQ(loaded->format, "PCD");
  EXPECT_FLOAT_EQ(image.range[0], 2) << "from the viewpoint, 1 above the origin";
  EXPECT_FALSE(isReturn(image.range[3]));
  const auto points = pointsOf(image, {});
  EXPECT_NEAR(points[3], 1, 1e-6);
  EXPECT_NEAR(points[5], -1, 1e-6);
  EXPECT_EQ(image.find("label")->values, (std::vector<float>{7, 300, 0, 0}));
  EXPECT_FLOAT_EQ(image.find("colour")->values[1], 128.0F / 255);
  EXPECT_FLOAT_EQ(image.find("colour")->values[0], 1);
}

TEST_F(RangeFile, OrganisedPointsAreReadFromBinaryPcd) { expectPcd(read(pcdBinary())); }

TEST_F(RangeFile, AndFromAsciiPcd) {
  const float packed = std::bit_cast<float>(0xFF8000U);
  expectPcd(read(kPcdHeader + "DATA ascii\n0 0 -1 " + fmt::format("{}", packed) +
                 " 7\n1 0 -1 0 300\n0 -1 -1 0 0\nnan 0 0 0 0\n"));
  EXPECT_EQ(fault(kPcdHeader + "DATA ascii\n0 0 -1.000000 0 7\n1 0 -1.000000 0 300\n0 -1 -1 0 0\n"),
            "a.pgm: the file ends after 3 of 4 points");
}

// The points have the coordinates of a map. Relative to 0 0 0, a float would have no digits for
// details below half a metre.
TEST_F(RangeFile, OrganisedPointsOfAMapKeepTheirDigits) {
  const auto header = [](const std::string& viewpoint) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
           "HEIGHT 2\nVIEWPOINT " +
           viewpoint + " 1 0 0 0\nPOINTS 4\nDATA ascii\n";
  };
  const std::string body =
      "500000.125 5200001.25 400\n500001.375 5200001.25 400.5\nnan nan nan\n"
      "500001.375 5200000.0625 401\n";
  const auto positions = [&](const LoadedRange& loaded) {
    RangeImage image = loaded.image;  // from which mesh import takes the origin
    const std::array<double, 3> origin = {500'000, 5'200'000, 0};
    for (std::size_t k = 0; k < 3; ++k) image.geometry.T_world_scanner[4 * k + 3] -= origin[k];
    return pointsOf(image, {});
  };
  const auto far = read(header("0 0 0") + body);
  ASSERT_TRUE(far) << far.error().what;
  ASSERT_EQ(far->notes.size(), 1U);
  EXPECT_NE(far->notes[0].find("the viewpoint 0, 0, 0 is too far away"), std::string::npos)
      << far->notes[0];
  const auto near = read(header("500010 5200000 402") + body);
  ASSERT_TRUE(near) << near.error().what;
  EXPECT_TRUE(near->notes.empty());
  EXPECT_EQ(near->image.geometry.T_world_scanner[3], 500'010);
  const float expected[] = {0.125F, 1.25F, 400, 1.375F, 1.25F, 400.5F};
  for (const auto* loaded : {&*far, &*near}) {
    const auto points = positions(*loaded);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(points[i], expected[i], 1e-4) << i;
    EXPECT_NEAR(points[10], 0.0625, 1e-5);
    EXPECT_FALSE(isReturn(loaded->image.range[2]));
  }
  EXPECT_FALSE(isMirrored(far->image)) << "seen from above, the first row is the northern one";
}

// Compresses to literal runs only, which the format allows.
std::string packed(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::size_t n = std::min<std::size_t>(32, bytes.size() - at);
    out.push_back(static_cast<char>(n - 1));
    out += bytes.substr(at, n);
  }
  return out;
}
std::string pcdCompressed() {
  const std::string rows = pcdBinary().substr(kPcdHeader.size() + 12);
  std::string columns;
  for (const auto& [start, size] : {std::pair(0, 4), {4, 4}, {8, 4}, {12, 4}, {16, 2}}) {
    for (std::size_t p = 0; p < 4; ++p)
      columns +=
          rows.substr(18 * p + static_cast<std::size_t>(start), static_cast<std::size_t>(size));
  }
  const std::string small = packed(columns);
  std::string bytes = kPcdHeader + "DATA binary_compressed\n";
  appendLe32(bytes, static_cast<std::uint32_t>(small.size()));
  appendLe32(bytes, static_cast<std::uint32_t>(columns.size()));
  return bytes + small;
}

TEST_F(RangeFile, AndFromCompressedPcd) { expectPcd(read(pcdCompressed())); }

TEST(Lzf, LiteralsAndReferences) {
  // these bytes are abc, abc, then c twelve times
  const std::uint8_t bytes[] = {2, 'a', 'b', 'c', 0x20, 2, 0xE0, 3, 0};
  const auto text = unpackLzf(bytes, 18);
  ASSERT_TRUE(text);
  EXPECT_EQ(std::string(text->begin(), text->end()), "abcabccccccccccccc");
  EXPECT_FALSE(unpackLzf(bytes, 17)) << "more than expected";
  EXPECT_FALSE(unpackLzf(bytes, 19)) << "less";
  const std::uint8_t before[] = {0, 'a', 0x20, 1};
  EXPECT_FALSE(unpackLzf(before, 4)) << "refers to before the beginning";
  EXPECT_FALSE(unpackLzf(bytes, std::size_t{1} << 40)) << "and takes no memory";
}

TEST_F(RangeFile, PcdRefusals) {
  std::string line = kPcdHeader + "DATA ascii\n0 0 0 0 0\n";
  EXPECT_EQ(fault(line), "a.pgm: has 10 bytes of points; 2 x 2 points take 39 at least");
  line = pcdBinary();
  line.replace(line.find("HEIGHT 2"), 8, "HEIGHT 1").replace(line.find("POINTS 4"), 8, "POINTS 2");
  EXPECT_NE(fault(line).find("not organised"), std::string::npos);
  line = pcdBinary();
  EXPECT_EQ(fault(line.replace(line.find("SIZE 4 4 4 4 2"), 14, "SIZE 4 4 4 4 3")),
            "a.pgm: line 4: SIZE: found \"4 4 4 4 3\", allowed: 1, 2, 4 or 8 for each field");
  line = pcdBinary();
  EXPECT_EQ(fault(line.replace(line.find("POINTS 4"), 8, "POINTS 5")),
            "a.pgm: POINTS is 5, WIDTH x HEIGHT is 4");
  RangeOptions options;
  options.angles_deg = {1, 1};
  EXPECT_NE(fault(pcdBinary(), options).find("leave --geometry, --angles"), std::string::npos);
}

const std::string kGrid =
    "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 30\nNODATA_value -9999\n";

TEST_F(RangeFile, EsriGridsHaveVoids) {
  const auto loaded = read(kGrid + "1 2.5 -9999\n -4 5e1 6\n", {}, "a.asc");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const RangeImage& image = loaded->image;
  EXPECT_EQ(image.geometry.scanner, Scanner::kElevation);
  EXPECT_EQ(image.geometry.cell_x, 30);
  EXPECT_EQ(image.range[4], 50);
  EXPECT_EQ(image.range[3], -4) << "a height may be negative";
  EXPECT_FALSE(isReturn(image.range[2]));
  EXPECT_EQ(fault(kGrid + "1 2 3 4 5 six", {}, "a.asc"),
            "a.asc: row 1, column 2: \"six\" is not a height");
  EXPECT_EQ(fault(kGrid + "1 2 3 4 5 ", {}, "a.asc"), "a.asc: ends after 5 of 6 heights");
  EXPECT_NE(fault("ncols 3\nrows 2\n", {}, "a.asc").find("line 2: \"rows 2\""), std::string::npos);
}

TEST_F(RangeFile, AnEsriGridMayBeginWithAByteOrderMark) {
  const auto loaded = read("\xEF\xBB\xBF" + kGrid + "1 2 3 4 5 6\n", {}, "a.asc");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.range[5], 6);
}

TEST_F(RangeFile, ARawFileMayBeginWithTheBytesOfAByteOrderMark) {
  const auto loaded = read("\xEF\xBB\xBF\x01", raw("2x2:range=u8"), "a.raw");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.range[0], 0xEF);
}

// Many programs write the least float, which has more digits than a float holds; others write nan.
TEST_F(RangeFile, TheValueOfAnEsriGridsVoidsMayBeAnyNumber) {
  const auto withVoid = [](const std::string& word) {
    return "ncols 2\nnrows 2\ncellsize 30\nNODATA_value " + word + "\n1 2 3 ";
  };
  for (const char* word : {"-3.4028234663852886e+38", "-3.40282347e+38", "-1.7e308", "1e31", "nan",
                           "NaN", "-nan", "-inf"}) {
    const auto loaded = read(withVoid(word) + word + "\n", {}, "a.asc");
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->image.range[2], 3) << word;
    EXPECT_FALSE(isReturn(loaded->image.range[3])) << word;
  }
  EXPECT_NE(fault(withVoid("none") + "4", {}, "a.asc").find("line 4: \"NODATA_value none\""),
            std::string::npos);
  EXPECT_NE(fault("ncols 2\nnrows 2\ncellsize 1e39\n1 2 3 4", {}, "a.asc").find("line 3"),
            std::string::npos);
}

TEST_F(RangeFile, CellsInDegreesBecomeMetres) {
  const std::string text =
      "NCOLS 2\nNROWS 2\nXLLCENTER -72\nYLLCENTER 44\nCELLSIZE 0.01\n1 2 3 4\n";
  const auto guessed = read(text, {}, "a.asc");
  ASSERT_TRUE(guessed) << guessed.error().what;
  EXPECT_NEAR(guessed->image.geometry.cell_y, 1111.14, 0.1);
  EXPECT_NEAR(guessed->image.geometry.cell_x, 802, 0.5);
  ASSERT_EQ(guessed->notes.size(), 1u);
  writeText(dir_ / "a.prj", "PROJCS[\"UTM\"]");
  const auto projected = read(text, {}, "a.asc");
  EXPECT_EQ(projected->image.geometry.cell_y, 0.01);
  EXPECT_EQ(projected->notes[0], "projection: PROJCS[\"UTM\"]");
}

TEST_F(RangeFile, AnEsriGridLiesAtTheMiddleOfItsLowerLeftCell) {
  using Origin = std::array<double, 2>;
  EXPECT_EQ(read(kGrid + "1 2 3 4 5 6\n", {}, "a.asc")->image.geometry.origin,
            Origin({500'015, 4'000'015}));
  EXPECT_EQ(
      read("ncols 2\nnrows 2\nxllcenter 7000\nyllcorner 90\ndx 4\ndy 2\n1 2 3 4\n", {}, "a.asc")
          ->image.geometry.origin,
      Origin({7000, 91}));
  EXPECT_FALSE(read("ncols 2\nnrows 2\ncellsize 1\n1 2 3 4\n", {}, "a.asc")->image.geometry.origin);
}

TEST(MapOrigin, IsThatOfTheMeshWhereBothAreInMetres) {
  const auto originOf = [](const std::string& projection, double east = 500'015) {
    Geometry map;
    map.scanner = Scanner::kElevation;
    map.projection = projection;
    map.origin = {east, 60.5};
    return mapOrigin(map);
  };
  using Origin = render::mesh::Origin;
  const std::string geographic =
      "GEOGCS[\"WGS 84\",DATUM[\"W\",SPHEROID[\"WGS 84\",6378137,298.2]],UNIT[\"degree\",0.0174]]";
  const auto projected = [&](const std::string& unit) {
    return "PROJCS[\"a [b], c\"," + geographic + ",PARAMETER[\"false_easting\",500000]," + unit +
           ",AXIS[\"E\",EAST]]";
  };
  const Origin there = {500'015, 60.5, 0};
  EXPECT_EQ(originOf(projected("UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]")), there);
  EXPECT_EQ(originOf(projected("UNIT[\"Meter\",1.0]")), there);
  EXPECT_EQ(originOf(projected("UNIT[\"US survey foot\",0.3048006096012192]")), Origin{});
  EXPECT_EQ(originOf(projected("AXIS[\"N\",NORTH]")), Origin{}) << "no unit of its own";
  EXPECT_EQ(originOf("COMPD_CS[\"x\"," + projected("UNIT[\"foot\",0.3048]") +
                     ",VERT_CS[\"h\",UNIT[\"metre\",1]]]"),
            Origin{})
      << "the metres are those of the heights";
  const std::string wkt2 =
      "PROJCRS[\"x\",BASEGEOGCRS[\"b\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298,"
      "LENGTHUNIT[\"metre\",1]]]],CONVERSION[\"c\",PARAMETER[\"p\",0,"
      "LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],AXIS[\"(E)\",east,";
  EXPECT_EQ(originOf(wkt2 + "LENGTHUNIT[\"metre\",1]]]"), there);
  EXPECT_EQ(originOf(wkt2 + "LENGTHUNIT[\"foot\",0.3048]]]"), Origin{});
  EXPECT_EQ(originOf("Projection UTM Zone 33 Datum WGS84 Units METERS"), there);
  EXPECT_EQ(originOf("Projection STATEPLANE Units FEET"), Origin{});
  for (const std::string& other : {geographic, std::string("EPSG:4326"), std::string("PROJCS[\"x"),
                                   std::string("PROJCS[\"x\"]]]UNIT[\"metre\",1]")})
    EXPECT_EQ(originOf(other), Origin{}) << other;
  EXPECT_EQ(originOf(""), there) << "too large for degrees";
  EXPECT_EQ(originOf("", 12.5), Origin{}) << "may be degrees";
  EXPECT_EQ(mapOrigin(Geometry{}), Origin{});
}

TEST_F(RangeFile, APrjFileSaysDegreesInWktOrInArcInfosLines) {
  const std::string text = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 40\ncellsize 0.5\n1 2 3 4\n";
  const auto cell = [&](const std::string& projection) {
    writeText(dir_ / "a.prj", projection);
    const auto loaded = read(text, {}, "a.asc");
    EXPECT_TRUE(loaded);
    EXPECT_EQ(loaded->notes.size(), loaded->image.geometry.cell_y > 1 ? 2U : 1U) << projection;
    return loaded->image.geometry.cell_y;
  };
  for (const char* metres :
       {"Projection    UTM\nZone          10\nDatum         NAD83\nUnits         METERS\n",
        "PROJCS[\"a\",GEOGCS[\"b\"]]", "PROJCRS[\"a\",BASEGEOGCRS[\"b\"]]", "LOCAL_CS[\"c\"]"})
    EXPECT_EQ(cell(metres), 0.5) << metres;
  writeText(dir_ / "a.prj", "Projection    UTM\r\nZone\t10\r\n");
  EXPECT_EQ(read(text, {}, "a.asc")->image.geometry.projection, "Projection UTM Zone 10");
  for (const char* degrees :
       {"GEOGCS[\"WGS 84\"]", "GEOGCRS[\"WGS 84\"]", "Projection GEOGRAPHIC\r\nUnits SECONDS\r\n",
        "projection albers\nunits dd\n"})
    EXPECT_NEAR(cell(degrees), 55'520, 20) << degrees;
}

TEST_F(RangeFile, ATileOfHeightsLiesWhereItsNameSays) {
  std::string bytes;
  bytes.reserve(2 * 1201 * 1201);
  for (int i = 0; i < 1201 * 1201; ++i) appendBe16(bytes, i == 5 ? 0x8000 : 0xFFFE);
  const auto loaded = read(bytes, {}, "S01E010.hgt");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.range[0], -2);
  EXPECT_FALSE(isReturn(loaded->image.range[5]));
  EXPECT_NEAR(loaded->image.geometry.cell_y, 92.146, 0.01) << "110,574 m / 1200";
  EXPECT_NEAR(loaded->image.geometry.cell_x, 92.762, 0.01);
  EXPECT_EQ(loaded->image.geometry.origin, (std::array<double, 2>{10, -1}));
  EXPECT_TRUE(loaded->image.geometry.projection.starts_with("GEOGCS[\"WGS 84\""));
  EXPECT_TRUE(loaded->image.geometry.projection.ends_with("AUTHORITY[\"EPSG\",\"4326\"]]"));
  EXPECT_NE(fault(bytes, {}, "any.hgt").find("--cell"), std::string::npos);
  EXPECT_NE(fault(bytes.substr(1), {}, "S01E010.hgt").find("has 2884801 bytes"), std::string::npos);
}

TEST_F(RangeFile, FeaturesHaveTheImagesSizeAndTheirScale) {
  const RangeImage image = flatImage(2, 2, Scanner::kOrthogonal);
  writeText(dir_ / "t.pgm",
            "P5\n# minimum: -20\n# maximum: 31\n# unit: degC\n2 2\n255\n\x0a\x14\x1e" +
                std::string("\0", 1));
  const auto thermal = readPlane("thermal", dir_ / "t.pgm", image);
  ASSERT_TRUE(thermal) << thermal.error().what;
  EXPECT_EQ(thermal->unit, "degC");
  EXPECT_NEAR(thermal->values[0], -18, 1e-5);
  EXPECT_EQ(thermal->low, -20);
  writeText(dir_ / "c.ppm", "P6\n2 2\n255\n" + std::string(12, '\xff'));
  EXPECT_EQ(readPlane("colour", dir_ / "c.ppm", image)->values[11], 1);
  EXPECT_EQ(readPlane("colour", dir_ / "t.pgm", image)->dimension, 3u) << "grey";
  writeText(dir_ / "s.pgm", "P5\n3 2\n255\nabcdef");
  const auto other = readPlane("x", dir_ / "s.pgm", image);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().what, dir_ / "s.pgm" + ": has 3 x 2 pixels; the range image has 2 x 2");
}

TEST_F(RangeFile, AFeatureOfAPngOfSixteenBitsHasTheFiguresOfTheFile) {
  const RangeImage image = flatImage(2, 2, Scanner::kOrthogonal);
  const auto png = render::image::encodeLevels({2, 2, 1, {20'000, 20'010, 0, 65'535}});
  ASSERT_TRUE(png);
  writeText(dir_ / "t.png", *png);
  const auto plane = readPlane("thermal", dir_ / "t.png", image);
  ASSERT_TRUE(plane) << plane.error().what;
  EXPECT_EQ(plane->dimension, 1U);
  EXPECT_EQ(plane->values, (std::vector<float>{20'000, 20'010, 0, 65'535}));
  const auto colour = readPlane("colour", dir_ / "t.png", image);
  ASSERT_TRUE(colour);
  EXPECT_EQ(colour->dimension, 3U);
  EXPECT_EQ(colour->values[11], 1);
  const auto other = readPlane("x", dir_ / "t.png", flatImage(3, 2, Scanner::kOrthogonal));
  EXPECT_EQ(other.error().what, dir_ / "t.png" + ": has 2 x 2 pixels; the range image has 3 x 2");
  writeText(dir_ / "cut.png", png->substr(0, png->size() - 30));
  const auto cut = readPlane("x", dir_ / "cut.png", image);
  ASSERT_FALSE(cut);
  EXPECT_TRUE(cut.error().what.starts_with(dir_ / "cut.png" + ": PNG: ")) << cut.error().what;
}

TEST_F(RangeFile, ItsRangesAreMetresWhereSomethingSaysSo) {
  const auto inMetres = [&](const std::string& comments, const RangeOptions& options = {}) {
    const auto loaded = read("P5\n# angles: 20 20\n" + comments + "2 2\n255\nabcd", options);
    EXPECT_TRUE(loaded);
    return loaded && loaded->in_metres;
  };
  EXPECT_FALSE(inMetres(""));
  EXPECT_FALSE(inMetres("# maximum: 4\n"));
  EXPECT_TRUE(inMetres("# minimum: 0\n# maximum: 4\n"));
  EXPECT_TRUE(inMetres("# scale: 0.001\n"));
  EXPECT_TRUE(inMetres("# geometry: elevation\n# cell: 30 30\n"));
  RangeOptions options;
  options.scale = 0.01;
  EXPECT_TRUE(inMetres("", options));
}

// A file as the Stanford 3D Scanning Repository has it: seen from far away along z, rows from the
// bottom. It has 3 x 2 pixels; the fifth one has no vertex.
const std::string kStanford =
    "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 2\nelement vertex 5\nproperty "
    "float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\nproperty float confidence\nelement range_grid 6\nproperty list "
    "uchar int vertex_indices\nend_header\n";
const std::string kStanfordBody =
    "0 1 0.5 255 0 0 0.25\n1 1 0.9 0 255 0 0.5\n2 1 -0.7 0 0 255 1\n0 2 0 9 9 9 0\n2 2 0 9 9 9 0\n"
    "1 0\n1 1\n1 2\n1 3\n0\n1 4\n";

TEST_F(RangeFile, PointsOnAGridOfAPlyAreWhereTheFileSays) {
  const auto loaded = read(kStanford + kStanfordBody, {}, "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->format, "PLY with a range_grid");
  const RangeImage& image = loaded->image;
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_FALSE(isReturn(image.range[4]));
  const auto points = pointsOf(image, {});
  const float expected[] = {0, 1, 0.5F, 1, 1, 0.9F, 2, 1, -0.7F};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(points[i], expected[i], 1e-5) << i;
  EXPECT_GT(image.geometry.T_world_scanner[11], 10) << "far along z";
  EXPECT_TRUE(isMirrored(image)) << "its rows run upwards";
  ASSERT_EQ(image.planes.size(), 2u);
  EXPECT_EQ(image.find("colour")->values[4], 1) << "green of the second pixel, 255";
  EXPECT_EQ(image.find("confidence")->values[2], 1);
  EXPECT_EQ(image.find("confidence")->values[5], 0);
  ASSERT_EQ(loaded->notes.size(), 1u);
  EXPECT_NE(loaded->notes[0].find("far away in the direction of z"), std::string::npos);
}

TEST_F(RangeFile, AGridAtEvenAnglesIsSeenFromTheOrigin) {
  std::string body;
  const std::size_t end = kStanford.find("property uchar red");
  const std::string header = kStanford.substr(0, end) + kStanford.substr(kStanford.find("element "
                                                                                        "range"));
  for (const int i : {-1, 0, 1, -1, 1}) {
    const double a = 0.5 * i;
    body += fmt::format("{} 0.{} {}\n", (3 + i) * std::sin(a), i + 1, -(3 + i) * std::cos(a));
  }
  const auto loaded = read(header + body + "1 0\n1 1\n1 2\n1 3\n0\n1 4\n", {}, "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->image.geometry.T_world_scanner, kIdentity);
  EXPECT_NEAR(loaded->image.range[1], 3, 0.01);
}

TEST_F(RangeFile, AGridWithTheCoordinatesOfAMapKeepsItsDigits) {
  std::string header = kStanford;
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string property = fmt::format("float {}\n", axis);
    header.replace(header.find(property), property.size(), fmt::format("double {}\n", axis));
  }
  const std::string body =
      "500000.125 5200001 0.5 255 0 0 0.25\n500001.25 5200001 0.9 0 255 0 0.5\n"
      "500002.5 5200001 -0.7 0 0 255 1\n500000.125 5200002 0 9 9 9 0\n"
      "500002.5 5200002.0625 0 9 9 9 0\n1 0\n1 1\n1 2\n1 3\n0\n1 4\n";
  auto loaded = read(header + body, {}, "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  RangeImage& image = loaded->image;
  EXPECT_NEAR(image.geometry.T_world_scanner[3], 500'001.3125, 1e-3);
  image.geometry.T_world_scanner[3] -= 500'000;
  image.geometry.T_world_scanner[7] -= 5'200'000;
  const auto points = pointsOf(image, {});
  EXPECT_NEAR(points[0], 0.125, 1e-5);
  EXPECT_NEAR(points[3], 1.25, 1e-5);
  EXPECT_NEAR(points[16], 2.0625, 1e-5);
}

TEST_F(RangeFile, FaultsOfAGridNameThePixelOrTheVertex) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string good = kStanford + kStanfordBody;
  EXPECT_EQ(fault(with(good, "obj_info num_cols 3\n", ""), {}, "a.ply").substr(0, 40),
            "a.ply: has a range_grid without its num_");
  EXPECT_EQ(fault(with(good, "num_cols 3", "num_cols 4"), {}, "a.ply"),
            "a.ply: range_grid has 6 pixels; num_cols x num_rows is 4 x 2");
  EXPECT_EQ(fault(with(good, "num_cols 3", "num_cols x"), {}, "a.ply"),
            "a.ply: line 3: num_cols is \"x\"; allowed are 1 to 268435456");
  EXPECT_EQ(fault(with(good, "1 4\n", "1 5\n"), {}, "a.ply"),
            "a.ply: pixel 5 has vertex 5; there are 5");
  EXPECT_EQ(fault(with(good, "1 4\n", "1 -1\n"), {}, "a.ply"),
            "a.ply: pixel 5 has vertex -1, which is not a vertex's number");
  EXPECT_EQ(fault(with(good, "1 4\n", "2 4 0\n"), {}, "a.ply"),
            "a.ply: pixel 5 has 2 vertices; allowed are 0 and 1");
  EXPECT_EQ(fault(with(good, "1 4\n", ""), {}, "a.ply"), "a.ply: ends at range_grid 5 of 6");
  EXPECT_EQ(fault(with(good, "0 255 0 0.5", "0 red 0 0.5"), {}, "a.ply"),
            "a.ply: vertex 1: \"red\" is not a number it may have");
  EXPECT_EQ(fault(with(good, "element vertex 5", "element vertex 999999999"), {}, "a.ply"),
            "a.ply: the header says 999999999 elements vertex, more than the file has bytes for");
  EXPECT_EQ(fault(with(good, "obj_info num_r", "\xd1 num_r"), {}, "a.ply"),
            "a.ply: line 4: \"\\xd1\" is not a keyword of a PLY header");
  EXPECT_EQ(fault(with(good, "float z", "float w"), {}, "a.ply"),
            "a.ply: the vertices have no property z");
}

// Returns a file as merlin-import writes it: 3 x 2 heights, cells of 0.5 x 0.25 degrees at latitude
// 60.
std::string gridOf(const GridHead& head) {
  std::string bytes;
  EXPECT_TRUE(writeGrid(
      head,
      [&](std::span<const std::byte> some) {
        bytes.append(reinterpret_cast<const char*>(some.data()), some.size());
        return true;
      },
      [](std::size_t row, std::span<float> values) {
        for (std::size_t i = 0; i < values.size(); ++i)
          values[i] = static_cast<float>(10 * row + i);
        if (row == 1) values[1] = kNoReturn;
        return true;
      }));
  return bytes;
}

GridHead gridHead() {
  GridHead head{3, 2, "GTOPO30", {}, 60, {"a note\nof two lines"}};
  head.header.scanner = Scanner::kElevation;
  head.header.cell = {0.5, 0.25};
  head.header.projection = "GEOGCS[\"WGS 84\"]";
  head.header.origin = {20.25, 59.5};
  return head;
}

TEST_F(RangeFile, WhatMerlinImportWritesIsReadUnderTheNameOfTheFile) {
  writeText(dir_ / "made", gridOf(gridHead()));
  const auto loaded = readGrid(dir_ / "made", "E020N90.DEM", {});
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->format, "GTOPO30");
  const RangeImage& image = loaded->image;
  EXPECT_EQ(image.geometry.scanner, Scanner::kElevation);
  EXPECT_EQ(image.range[2], 2);
  EXPECT_EQ(image.range[5], 12);
  EXPECT_FALSE(isReturn(image.range[4]));
  EXPECT_NEAR(image.geometry.cell_x, 0.5 * 55800.5, 1) << "a degree at latitude 60 is 55.8 km";
  EXPECT_NEAR(image.geometry.cell_y, 0.25 * 111412.0, 1);
  EXPECT_EQ(image.geometry.projection, "GEOGCS[\"WGS 84\"]");
  EXPECT_EQ((*image.geometry.origin)[1], 59.5);
  ASSERT_EQ(loaded->notes.size(), 2u);
  EXPECT_EQ(loaded->notes[0], "a note\\x0aof two lines");
  RangeOptions options;
  options.scale = 0.5;
  EXPECT_EQ(readGrid(dir_ / "made", "x", options)->image.range[2], 1);
  ASSERT_TRUE(writeRange(dir_ / "b.pgm", image).ok());
  const auto again = readRange(dir_ / "b.pgm", {});
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->image.geometry.projection, image.geometry.projection);
  EXPECT_EQ(again->image.geometry.origin, image.geometry.origin);
}

TEST_F(RangeFile, DamageToWhatMerlinImportWritesIsSaid) {
  const std::string good = gridOf(gridHead());
  const auto refused = [&](const std::string& bytes) {
    writeText(dir_ / "made", bytes);
    const auto loaded = readGrid(dir_ / "made", "a.dem", {});
    return loaded ? std::string() : loaded.error().what;
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refused(good.substr(0, good.size() - 1)),
            "a.dem: has 23 bytes of values; 3 x 2 take 24");
  EXPECT_EQ(refused(good + "x"), "a.dem: has 25 bytes of values; 3 x 2 take 24");
  EXPECT_EQ(refused(with("size: 3 2", "size: 3 0")), "a.dem: line 2: size: found \"3 0\"");
  EXPECT_EQ(refused(with("size: 3 2", "size: 99999 99999")),
            "a.dem: line 2: size: found \"99999 99999\"");
  EXPECT_EQ(refused(with("latitude: 60", "latitude: 91")), "a.dem: line 8: latitude: found \"91\"");
  EXPECT_EQ(refused(with("latitude: 60", "feature: a=../passwd")),
            "a.dem: line 8: feature: found \"a=../passwd\", allowed: NAME=FILE, a file in the same "
            "folder");
  EXPECT_EQ(refused(with("size", "sise")), "a.dem: has no line size");
  EXPECT_EQ(refused(with("values\n", "")).substr(0, 15), "a.dem: has no l");
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_TRUE(refused(good.substr(0, n)).starts_with("a.dem: ")) << n;
    std::string bad = good;
    bad[n] = static_cast<char>(static_cast<unsigned char>(bad[n]) ^ 0x80U);
    const auto parsed = parseGrid(bad);
    EXPECT_TRUE(parsed ? parsed->image.values.size() == 6 : parsed.error().what.size() > 10) << n;
  }
}

void expectGoodEnd(const Result<LoadedRange>& loaded) {
  const std::string text = loaded ? faultOf(loaded->image) : loaded.error().what;
  EXPECT_EQ(text.empty(), loaded.ok()) << text;
  EXPECT_EQ(text.find("a.pgm: ") != std::string::npos, !loaded.ok()) << text;
}

// Reads the bytes with the reader for their format; expects that they are parsed, or refused with
// one sentence.
void expectParsed(const std::string& bytes) {
  const auto expectSentence = [&](const auto& parsed, std::size_t pixels) {
    EXPECT_TRUE(parsed ? pixels > 0 : parsed.error().what.size() > 10) << bytes;
  };
  if (isPcd(bytes)) {
    const auto pcd = parsePcd(bytes);
    expectSentence(pcd, pcd ? pcd->image.range.size() : 0);
  } else {
    const auto stored = isEsriGrid(bytes) ? parseEsriGrid(bytes, "") : parseNetpbm(bytes);
    expectSentence(stored, stored ? stored->values.size() : 0);
  }
}

// Whatever the bytes are, reading ends either with an image that has a return, or with a sentence
// that names the file.
TEST_F(RangeFile, EveryPrefixAndEveryDamagedByteEndsWell) {
  const std::string files[] = {
      kHeader + "# beam: 1 2\n# cell: 3\n# minimum: 1\n# maximum: 9\n2 2\n65535\n" +
          big16({1, 2, 3, 4}),
      "P2\n# angles: 9 9\n2 2 99\n1 2 3 4\n",
      pcdBinary(),
      pcdCompressed(),
      kPcdHeader + "DATA ascii\n0 0 -1 0 7\n1 0 -1 0 300\n0 -1 -1 0 0\nnan 0 0 0 0\n",
      kGrid + "1 2.5 -9999\n -4 5e1 6\n"};
  for (const std::string& good : files) {
    ASSERT_TRUE(read(good)) << read(good).error().what;
    for (std::size_t n = 0; n < good.size(); ++n) {
      const auto loaded = read(good.substr(0, n));
      expectGoodEnd(loaded);
    }
    for (std::size_t n = 0; n < good.size(); ++n) {
      for (const unsigned flip : {1U, 0x10U, 0x80U, 0xFFU}) {
        std::string bad = good;
        bad[n] = static_cast<char>(static_cast<unsigned char>(bad[n]) ^ flip);
        expectParsed(bad);
      }
    }
  }
}

TEST(RangeGrid, EveryPrefixAndEveryDamagedByteEndsWell) {
  const auto expectGood = [](const Result<RangeGrid>& grid, std::size_t n) {
    EXPECT_TRUE(grid ? grid->image.range.size() > 0 : grid.error().what.size() > 10) << n;
  };
  const std::string good = kStanford + kStanfordBody;
  for (std::size_t n = 0; n < good.size(); ++n) {
    expectGood(parseRangeGrid(good.substr(0, n)), n);
    for (const unsigned flip : {1U, 0x10U, 0x80U, 0xFFU}) {
      std::string bad = good;
      bad[n] = static_cast<char>(static_cast<unsigned char>(bad[n]) ^ flip);
      expectGood(parseRangeGrid(bad), n);
    }
  }
}

}  // namespace
}  // namespace merlin::test
