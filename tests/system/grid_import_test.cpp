// `merlin mesh import` of range images and elevation maps in formats of other programs: FITS, and
// formats that GDAL reads. All files are synthetic; their bytes are written here.
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

std::string big32(std::uint32_t v) {
  std::string bytes;
  appendBe16(bytes, static_cast<std::uint16_t>(v >> 16));
  appendBe16(bytes, static_cast<std::uint16_t>(v & 0xFFFF));
  return bytes;
}

std::string bigFloats(const std::vector<float>& values) {
  std::string bytes;
  for (const float v : values) bytes += big32(std::bit_cast<std::uint32_t>(v));
  return bytes;
}

std::string bigDoubles(const std::vector<double>& values) {
  std::string bytes;
  for (const double v : values) {
    const auto bits = std::bit_cast<std::uint64_t>(v);
    bytes +=
        big32(static_cast<std::uint32_t>(bits >> 32)) + big32(static_cast<std::uint32_t>(bits));
  }
  return bytes;
}

// Returns a FITS file in blocks of 2880 bytes. `cards`: "KEY = value" lines that follow the cards
// of the size.
std::string fits(int bits, int width, int height, const std::vector<std::string>& cards,
                 const std::string& pixels) {
  std::vector<std::string> all = {
      "SIMPLE  =                    T", fmt::format("BITPIX  = {:20}", bits),
      "NAXIS   =                    2", fmt::format("NAXIS1  = {:20}", width),
      fmt::format("NAXIS2  = {:20}", height)};
  for (const std::string& card : cards) {
    const std::size_t equals = card.find('=');
    all.push_back(fmt::format("{:8}={}", card.substr(0, equals), card.substr(equals + 1)));
  }
  all.emplace_back("END");
  std::string bytes;
  for (const std::string& card : all) bytes += fmt::format("{:80}", card);
  bytes.resize((bytes.size() + 2879) / 2880 * 2880, ' ');
  bytes += pixels;
  bytes.resize((bytes.size() + 2879) / 2880 * 2880, '\0');
  return bytes;
}

// Makes a GeoTIFF of 16-bit heights, little-endian, in UTM zone 33 of WGS 84, with cells of 10 x 20
// m.
class Tiff {
 public:
  std::string of(std::uint32_t width, std::uint32_t height, const std::string& heights) {
    tag(256, 4, 1, width);
    tag(257, 4, 1, height);
    tag(258, 3, 1, 16);
    tag(259, 3, 1, 1);
    tag(262, 3, 1, 1);
    tag(273, 4, 1, kPixels);
    tag(277, 3, 1, 1);
    tag(278, 4, 1, height);
    tag(279, 4, 1, static_cast<std::uint32_t>(heights.size()));
    tag(339, 3, 1, 2);
    array(33550, 12, 3, doubles({10, 20, 0}));
    array(33922, 12, 6, doubles({0, 0, 0, 500000, 5300000, 0}));
    array(34735, 3, 16, shorts({1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633}));
    array(42113, 2, 6, "-9999" + std::string(1, '\0'));
    std::string bytes = "II*" + std::string(1, '\0');
    appendLe32(bytes, 8);
    bytes += shorts({static_cast<int>(count_)}) + tags_ + std::string(4, '\0');
    bytes.resize(kArrays, '\0');
    bytes += arrays_;
    bytes.resize(kPixels, '\0');
    return bytes + heights;
  }
  static std::string shorts(const std::vector<int>& values) {
    std::string bytes;
    for (const int v : values) {
      bytes.push_back(static_cast<char>(v & 0xFF));
      bytes.push_back(static_cast<char>(v >> 8 & 0xFF));
    }
    return bytes;
  }

 private:
  static constexpr std::uint32_t kArrays = 256, kPixels = 512;

  void tag(int number, int type, std::uint32_t count, std::uint32_t value) {
    tags_ += shorts({number, type});
    appendLe32(tags_, count);
    appendLe32(tags_, value);
    ++count_;
  }
  void array(int number, int type, std::uint32_t count, const std::string& bytes) {
    tag(number, type, count, static_cast<std::uint32_t>(kArrays + arrays_.size()));
    arrays_ += bytes;
  }
  static std::string doubles(const std::vector<double>& values) {
    std::string bytes;
    for (const double v : values) {
      const auto bits = std::bit_cast<std::uint64_t>(v);
      appendLe32(bytes, static_cast<std::uint32_t>(bits));
      appendLe32(bytes, static_cast<std::uint32_t>(bits >> 32));
    }
    return bytes;
  }

  std::string tags_, arrays_;
  std::size_t count_ = 0;
};

std::string fortran(double value) {
  std::string text = fmt::format("{:24.15E}", value);
  text.replace(text.find('E'), 1, "D");
  return text;
}

// Returns a USGS DEM of two profiles with three heights each, cells of 30 x 30 m, in UTM zone 10.
std::string usgsDem() {
  std::string a = fmt::format("{:144}{:6}{:6}{:6}{:6}", "SYNTHETIC", 1, 1, 1, 10);
  for (int i = 0; i < 15; ++i) a += fortran(0);
  a += fmt::format("{:6}{:6}{:6}", 2, 2, 4);
  for (const double corner :
       {500000.0, 5100000.0, 500000.0, 5100060.0, 500030.0, 5100060.0, 500030.0, 5100000.0})
    a += fortran(corner);
  a += fortran(100) + fortran(150) + fortran(0);
  a += fmt::format("{:6}0.300000E+020.300000E+020.100000E+01{:6}{:6}", 0, 1, 2);
  std::string bytes = fmt::format("{:1024}", a);
  for (int column = 0; column < 2; ++column) {
    std::string b = fmt::format("{:6}{:6}{:6}{:6}", 1, column + 1, 3, 1);
    b += fortran(500000.0 + 30 * column) + fortran(5100000) + fortran(0) + fortran(100) +
         fortran(150);
    for (int i = 0; i < 3; ++i) b += fmt::format("{:6}", 100 + 10 * i + column);
    bytes += fmt::format("{:1024}", b);
  }
  return bytes;
}

class GridImport : public testing::Test {
 protected:
  Outcome import(const std::string& name, const std::string& bytes,
                 std::vector<std::string> options = {}) {
    if (!bytes.empty()) writeText(dir_ / name, bytes);
    options.insert(options.begin(), {kMerlin, "mesh", "import", dir_ / name});
    if (std::ranges::find(options, "-o") == options.end())
      options.insert(options.end(), {"-o", ply_});
    return run(std::move(options));
  }
  nlohmann::json report(const std::string& name, const std::string& bytes,
                        std::vector<std::string> options = {}) {
    options.emplace_back("--json");
    const Outcome outcome = import(name, bytes, std::move(options));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const auto start = outcome.output.find("{\"input\"");
    return start == std::string::npos ? nlohmann::json()
                                      : nlohmann::json::parse(outcome.output.substr(start));
  }
  // Returns the bounding box of the mesh that was written: its low and its high corner.
  std::array<std::array<double, 3>, 2> box() {
    const auto info = nlohmann::json::parse(run({kMerlin, "mesh", "info", ply_, "--json"}).output);
    return {info["box"]["low"], info["box"]["high"]};
  }
  // Returns the error message. Expects that the import is refused with one line that has the file's
  // name, and that no file is left behind.
  std::string refusal(const std::string& name, const std::string& bytes,
                      std::vector<std::string> options = {}) {
    const Outcome outcome = import(name, bytes, std::move(options));
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(dir_ / name + ": "), std::string::npos) << outcome.output;
    EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1) << outcome.output;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path())) {
      const std::string left = entry.path().filename().string();
      EXPECT_FALSE(left.starts_with("out") || left.starts_with(".merlin")) << left;
    }
    return outcome.output;
  }
  void expectRefusal(const std::string& name, const std::string& bytes, const std::string& with) {
    const std::string text = refusal(name, bytes);
    EXPECT_NE(text.find(with), std::string::npos) << text;
  }

  TempDir dir_;
  std::string ply_ = dir_ / "out.ply";
};

const std::vector<std::string> kPinhole = {"GEOMETRY= 'pinhole'", "ANGLEH  = 90.0",
                                           "ANGLEV  = 90.0"};

std::vector<std::string> with(std::vector<std::string> cards, std::vector<std::string> more) {
  cards.insert(cards.end(), more.begin(), more.end());
  return cards;
}

TEST_F(GridImport, WholeNumbersOfAFitsFileAreScaledAndBlanksAreNoReturn) {
  std::string pixels;
  for (const int v : {1000, 1000, 1000, -32768}) appendBe16(pixels, static_cast<std::uint16_t>(v));
  const auto json = report("a.fits", fits(16, 2, 2,
                                          with(kPinhole, {"BSCALE  = 2.0", "BZERO   = 500.0",
                                                          "BLANK   = -32768", "BUNIT   = 'mm'"}),
                                          pixels));
  EXPECT_EQ(json["format"], "FITS");
  EXPECT_EQ(json["geometry"], "pinhole");
  EXPECT_EQ(json["returns"], 3);
  EXPECT_EQ(json["triangles"], 1);
  const auto [low, high] = box();
  EXPECT_NEAR(low[2], -2.5, 1e-6) << "500 + 2 x 1000 mm";
  EXPECT_NEAR(low[0], -1.25, 1e-5) << "90 degrees from edge to edge: the middle of a pixel is half";
  EXPECT_NEAR(high[1], 1.25, 1e-5) << "the first row is the top one; only the lower right is void";
}

TEST_F(GridImport, FloatsOfAFitsFileMayBeNotNumbersAndItsRowsMayRunUpwards) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto file = [&](const char* order) {
    return fits(-64, 2, 2, with(kPinhole, {fmt::format("ROWORDER= '{}'", order)}),
                bigDoubles({1, 1, nan, 3}));
  };
  ASSERT_EQ(report("a.fits", file("TOP-DOWN"), {"--max-edge", "none"})["returns"], 3);
  EXPECT_NEAR(box()[0][1], -1.5, 1e-5) << "the far pixel is at the bottom";
  ASSERT_EQ(report("a.fits", file("BOTTOM-UP"), {"--max-edge", "none"})["returns"], 3);
  EXPECT_NEAR(box()[1][1], 1.5, 1e-5) << "the far pixel is at the top";
}

TEST_F(GridImport, BeamsAndACameraAreCardsOfAFitsFile) {
  const std::vector<std::string> cards = {
      "GEOMETRY= 'spinning'", "ANGLEH  = 90.0", "ALT1    = 30.0", "ALT2    = 0.0", "AZI2    = 15.0",
      "CAM11   = 1",          "CAM12   = 0",    "CAM13   = 0",    "CAM14   = 100", "CAM21   = 0",
      "CAM22   = 1",          "CAM23   = 0",    "CAM24   = 200",  "CAM31   = 0",   "CAM32   = 0",
      "CAM33   = 1",          "CAM34   = 300"};
  const auto json = report("a.fits", fits(-32, 3, 2, cards, bigFloats({2, 2, 2, 2, 2, 2})),
                           {"--max-edge", "none"});
  EXPECT_EQ(json["geometry"], "spinning");
  EXPECT_EQ(json["triangles"], 4);
  const auto [low, high] = box();
  EXPECT_NEAR(low[1], 200, 1e-4);
  EXPECT_NEAR(high[1], 201, 1e-4) << "2 sin 30";
  EXPECT_NEAR(low[0], 100 - 2 * std::cos(std::numbers::pi / 6) / 2, 1e-4)
      << "the first of three columns of 30 degrees is at -30";
  EXPECT_NEAR(high[0], 100 + 2 * std::sin(std::numbers::pi / 4), 1e-4) << "30 + 15 degrees";
}

TEST_F(GridImport, WhatIsSaidOverridesTheCards) {
  const auto json = report("a.fits", fits(-32, 2, 2, kPinhole, bigFloats({10, 20, 30, -5})),
                           {"--geometry", "elevation", "--cell", "7", "--no-return", "20"});
  EXPECT_EQ(json["geometry"], "elevation");
  EXPECT_EQ(json["returns"], 3);
  EXPECT_NEAR(box()[1][0], 7, 1e-6);
  EXPECT_NEAR(box()[0][2], -5, 1e-6);
}

TEST_F(GridImport, FaultsOfAFitsFileNameTheirCard) {
  const std::string pixels = bigFloats({1, 1, 1, 1});
  expectRefusal(
      "a.fits", fits(-32, 2, 2, {"GEOMETRY= 'round'"}, pixels),
      "card GEOMETRY: found \"round\", allowed: orthogonal, spinning, pinhole, elevation");
  expectRefusal("a.fits", fits(-32, 2, 2, {"ANGLEH  = 'wide'"}, pixels), "card ANGLEH");
  expectRefusal("a.fits", fits(-32, 2, 2, with(kPinhole, {"CAM11   = 1"}), pixels),
                "card CAM12: is missing");
  expectRefusal("a.fits", fits(-32, 2, 2, {"ALT1    = 1", "GEOMETRY= 'spinning'"}, pixels),
                "card ALT2: is missing; there are 2 rows");
}

// Returns a FITS file that has a primary image without axes and two extensions.
std::string fitsOfTwo() {
  const auto extension = [](const std::string& name, int width, float range) {
    std::string bytes =
        fits(-32, width, 2, with(kPinhole, {"EXTNAME = '" + name + "'"}),
             bigFloats(std::vector<float>(static_cast<std::size_t>(2 * width), range)));
    bytes.replace(0, 30, "XTENSION= 'IMAGE   '          ");
    return bytes;
  };
  std::string primary = fits(-32, 2, 2, {}, "").substr(0, 2880);
  primary.replace(2 * 80, 80, fmt::format("{:80}", "NAXIS   =                    0"));
  primary.replace(3 * 80, 160, fmt::format("{:160}", "EXTEND  =                    T"));
  return primary + extension("NEAR", 2, 1) + extension("Far", 3, 5);
}

TEST_F(GridImport, TheImageOfAFitsFileIsChosen) {
  const std::string file = fitsOfTwo();
  const auto first = report("a.fits", file);
  EXPECT_EQ(first["width"], 2);
  EXPECT_EQ(first["notes"][0],
            "left out: 2 \"Far\" (3 x 2 pixels); image 1 \"NEAR\" (2 x 2 pixels) is read "
            "(--hdu reads another one)");
  for (const char* hdu : {"2", "FAR", "far"}) {
    const auto chosen = report("a.fits", file, {"--hdu", hdu});
    EXPECT_EQ(chosen["width"], 3) << hdu;
    EXPECT_EQ(chosen["notes"].dump().find("left out"), std::string::npos) << hdu;
  }
  std::filesystem::remove(ply_);
  EXPECT_NE(refusal("a.fits", file, {"--hdu", "0"})
                .find("has no image 0 of two axes (--hdu); there are 1 \"NEAR\" (2 x 2 pixels), 2 "
                      "\"Far\" (3 x 2 pixels)"),
            std::string::npos);
  const std::string tiff = Tiff().of(3, 2, Tiff::shorts({100, 110, -9999, 120, 130, 140}));
  EXPECT_NE(refusal("a.tif", tiff, {"--hdu", "1"}).find("--hdu is for FITS files"),
            std::string::npos);
  EXPECT_NE(refusal("a.pgm", "P5\n2 2\n255\nabcd", {"--hdu", "1"}).find("--hdu is for FITS files"),
            std::string::npos);
  const std::string about = run({kMerlin, "mesh", "info", dir_ / "a.fits", "--json"}).output;
  EXPECT_NE(about.find("note: " + (dir_ / "a.fits") + ": left out: 2"), std::string::npos) << about;
  EXPECT_NE(about.find("\"unit\":\"\""), std::string::npos) << about;
  const auto scaled = run({kMerlin, "mesh", "info", dir_ / "a.fits", "--json", "--scale", "1"});
  EXPECT_NE(scaled.output.find("\"unit\":\"m\""), std::string::npos) << scaled.output;
}

TEST_F(GridImport, AFitsFileThatIsCutOrTooLargeOrEmptyIsRefused) {
  const std::string pixels = bigFloats({1, 1, 1, 1});
  expectRefusal("a.fits", fits(-32, 2, 2, {}, pixels), "give them with --angles");
  expectRefusal("a.fits", fits(-32, 200000, 200000, kPinhole, pixels), "200000 x 200000 pixels");
  const std::string whole = fits(-32, 40, 40, kPinhole, bigFloats(std::vector<float>(1600, 1)));
  expectRefusal("a.fits", whole.substr(0, 3000), "a.fits: ");
  expectRefusal("a.fits", whole.substr(0, 500), "a.fits: ");
  expectRefusal("a.fits", fits(-32, 2, 2, kPinhole, bigFloats({0, 0, 0, 0})), "none of its 2 x 2");
}

// CFITSIO has to read what `merlin mesh scan` writes. The names of the companion images are longer
// than a FITS card, and one has a quote where its card ends.
TEST_F(GridImport, AScanAsFitsComesBackWithItsCameraAndItsModalities) {
  const std::string stem = std::string(52, 'x') + "'s scan";
  const auto scanned = [&](const std::string& ending) {
    const Outcome scan = run({kMerlin, "mesh", "scan", kSource + "/config/models/ankylosaurus.ply",
                              "--geometry", "pinhole", "--width", "40", "--height", "30", "--yaw",
                              "20", "-o", dir_ / stem + ending});
    EXPECT_EQ(scan.status, 0) << scan.output;
    const Outcome back =
        run({kMerlin, "mesh", "import", dir_ / stem + ending, "-o", ply_, "--json"});
    EXPECT_EQ(back.status, 0) << back.output;
    return nlohmann::json::parse(back.output.substr(back.output.find('{')));
  };
  const auto pgm = scanned(".pgm"), fits = scanned(".fits");
  EXPECT_EQ(fits["format"], "FITS");
  for (const char* key : {"geometry", "returns", "triangles", "features"})
    EXPECT_EQ(fits[key], pgm[key]) << key;
  EXPECT_GT(fits["triangles"], 100);
  EXPECT_NE(fits["features"].dump().find("confidence"), std::string::npos) << fits["features"];
}

TEST_F(GridImport, AGeoTiffHasItsCellsVoidsAndProjection) {
  const std::string file = Tiff().of(3, 2, Tiff::shorts({100, 110, -9999, 120, 130, 140}));
  const auto json = report("a.anything", file, {"--local"});
  EXPECT_EQ(json["format"], "GeoTIFF");
  EXPECT_EQ(json["geometry"], "elevation");
  EXPECT_EQ(json["returns"], 5);
  EXPECT_EQ(json["triangles"], 3);
  const auto [low, high] = box();
  EXPECT_NEAR(high[0], 20, 1e-5);
  EXPECT_NEAR(high[1], 20, 1e-5);
  EXPECT_NEAR(low[2], 100, 1e-5);
  EXPECT_NEAR(high[2], 140, 1e-5);
  const std::string projection = json["projection"];
  EXPECT_NE(projection.find("UTM zone 33N"), std::string::npos) << projection;
  EXPECT_EQ(json["origin"][0], 500005) << "the middle of the lower left pixel";
  EXPECT_EQ(json["origin"][1], 5300000 - 30);
  EXPECT_EQ(json["origin_added"], false);
  EXPECT_EQ(report("a.anything", file, {"-o", dir_ / "placed.obj"})["origin_added"], true);
  EXPECT_NE(readText(dir_ / "placed.obj").find("\nv 500015 5299990 110 "), std::string::npos);
}

TEST_F(GridImport, TheProjectionStaysInTheModelAndInThePgm) {
  const std::string file = Tiff().of(3, 2, Tiff::shorts({100, 110, -9999, 120, 130, 140}));
  ASSERT_EQ(import("a.tif", file, {"-o", dir_ / "out.mrm"}).status, 0);
  const auto info =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "out.mrm", "--json"}).output);
  const std::string about = info["about"];
  EXPECT_NE(about.find("map.projection=PROJCS[\"WGS 84 / UTM zone 33N\""), std::string::npos)
      << about;
  EXPECT_NE(about.find("map.origin=500005 5299970"), std::string::npos) << about;
  EXPECT_NE(about.find("mesh.origin=500005 5299970 0"), std::string::npos) << about;
  ASSERT_EQ(run({kMerlin, "mesh", "export", dir_ / "out.mrm", "-o", dir_ / "b.obj"}).status, 0);
  const std::string obj = readText(dir_ / "b.obj");
  EXPECT_NE(obj.find("\nv 500025 5299970 140 "), std::string::npos) << obj;
  const std::string degrees =
      "ncols 2\nnrows 2\nxllcenter 7.5\nyllcenter 46\ncellsize 0.01\n1 2\n3 4\n";
  ASSERT_EQ(import("b.asc", degrees, {"-o", dir_ / "out.mrm"}).status, 0);
  const Outcome said = run({kMerlin, "mesh", "export", dir_ / "out.mrm", "-o", dir_ / "c.obj"});
  EXPECT_NE(said.output.find("origin    7.5 46 (of the map) is not added"), std::string::npos)
      << said.output;
  ASSERT_EQ(import("a.tif", file, {"-o", dir_ / "out.pgm"}).status, 0);
  const auto again = report("out.pgm", "", {});
  EXPECT_NE(again["projection"].get<std::string>().find("UTM zone 33N"), std::string::npos);
  EXPECT_EQ(again["origin"][1], 5299970);
}

// Returns a netCDF file of the classic format with two variables of 2 x 3 floats: "z", filled with
// `z`, and "err", filled with 1.
std::string netcdf(float z) {
  const auto name = [](const std::string& text) {
    return big32(static_cast<std::uint32_t>(text.size())) + text +
           std::string((4 - text.size() % 4) % 4, '\0');
  };
  const std::string none = big32(0) + big32(0);
  const auto variable = [&](const std::string& text, std::uint32_t begin) {
    return name(text) + big32(2) + big32(0) + big32(1) + none + big32(5) + big32(24) + big32(begin);
  };
  const auto head = [&](std::uint32_t begin) {
    return std::string("CDF\x01", 4) + big32(0) + big32(10) + big32(2) + name("y") + big32(2) +
           name("x") + big32(3) + none + big32(11) + big32(2) + variable("z", begin) +
           variable("err", begin + 24);
  };
  const auto begin = static_cast<std::uint32_t>(head(0).size());
  return head(begin) + bigFloats({z, z, z, z, z, z}) + bigFloats({1, 1, 1, 1, 1, 1});
}

TEST_F(GridImport, OfANetCdfWithSeveralVariablesOneIsChosen) {
  const std::string file = netcdf(50);
  const std::string refused = refusal("a.nc", file, {"--cell", "10"});
  EXPECT_NE(refused.find("has several maps: 1 \"z\" ("), std::string::npos) << refused;
  EXPECT_NE(refused.find("2 \"err\" ("), std::string::npos) << refused;
  EXPECT_NE(refused.find("by --variable NAME"), std::string::npos) << refused;
  for (const char* chosen : {"z", "1", "Z"}) {
    EXPECT_EQ(report("a.nc", file, {"--cell", "10", "--variable", chosen})["returns"], 6);
    EXPECT_NEAR(box()[1][2], 50, 1e-5) << chosen;
  }
  report("a.nc", file, {"--cell", "10", "--variable", "err"});
  EXPECT_NEAR(box()[1][2], 1, 1e-5);
  std::filesystem::remove(ply_);
  EXPECT_NE(refusal("a.nc", file, {"--cell", "10", "--variable", "depth"})
                .find("has no map depth (--variable); there are 1 \"z\""),
            std::string::npos);
  const std::string tiff = Tiff().of(3, 2, Tiff::shorts({100, 110, -9999, 120, 130, 140}));
  EXPECT_NE(
      refusal("a.tif", tiff, {"--variable", "z"}).find("--variable is for files with several"),
      std::string::npos);
  EXPECT_NE(
      refusal("a.pgm", "P5\n2 2\n255\nabcd", {"--variable", "z"}).find("--variable is for netCDF"),
      std::string::npos);
}

TEST_F(GridImport, AUsgsDemIsReadFromItsProfiles) {
  const auto json = report("a.dem", usgsDem(), {"--local"});
  EXPECT_EQ(json["width"], 2);
  EXPECT_EQ(json["height"], 3);
  EXPECT_EQ(json["triangles"], 4);
  const auto [low, high] = box();
  EXPECT_NEAR(high[0], 30, 1e-5);
  EXPECT_NEAR(high[1], 60, 1e-5);
  EXPECT_NEAR(low[2], 100, 1e-5);
  EXPECT_NEAR(high[2], 121, 1e-5);
  EXPECT_EQ(json["origin"][0], 500000);
  EXPECT_EQ(json["origin"][1], 5100000);
}

// In GTOPO30, one file has the heights, and another file of the same stem describes them.
TEST_F(GridImport, GtopoIsReadWithTheHeaderBesideIt) {
  std::string heights;
  for (const int v : {10, 20, 30, 40, -9999, 60})
    appendBe16(heights, static_cast<std::uint16_t>(v));
  expectRefusal("E020N40.DEM", heights, "has a format that MERLIN does not read");
  writeText(
      dir_ / "E020N40.HDR",
      "BYTEORDER      M\nLAYOUT       BIL\nNROWS         2\nNCOLS         3\nNBANDS        1\n"
      "NBITS         16\nBANDROWBYTES         6\nTOTALROWBYTES        6\nBANDGAPBYTES        "
      "0\nNODATA        -9999\nULXMAP        20.5\nULYMAP        10.5\nXDIM          0.05\n"
      "YDIM          0.05\n");
  const auto json = report("E020N40.DEM", "");
  EXPECT_EQ(json["returns"], 5);
  EXPECT_NEAR(box()[1][0], 2 * 0.05 * 109476.4, 1) << "degrees at latitude 10.475";
  EXPECT_NEAR(box()[1][2], 60, 1e-5);
}

TEST_F(GridImport, MapsThatAreNoneAreRefused) {
  const std::string good = Tiff().of(3, 2, Tiff::shorts({100, 110, -9999, 120, 130, 140}));
  expectRefusal("a.tif", good.substr(0, 40), "a.tif: ");
  expectRefusal("a.tif", good.substr(0, good.size() - 4), "row ");
  expectRefusal("a.tif", Tiff().of(60000, 60000, "ab"), "60000 x 60000 heights; allowed are");
  expectRefusal("a.tif", "II*" + std::string(300, '\x7f'), "a.tif: ");
  expectRefusal("a.dem", usgsDem().substr(0, 1100), "a.dem: ");
}

// A map that refers to other files is refused, both by merlin, which does not read the format, and
// by merlin-import alone, which has no reader for it.
TEST_F(GridImport, AFileThatNamesOthersIsNotFollowed) {
  writeText(dir_ / "secret.tif", Tiff().of(3, 2, Tiff::shorts({100, 110, 1, 120, 130, 140})));
  const std::string vrt =
      "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Int16\" "
      "band=\"1\"><SimpleSource><SourceFilename>" +
      dir_ / "secret.tif" +
      "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
  expectRefusal("a.vrt", vrt, "has a format that MERLIN does not read");
  std::filesystem::create_directory(dir_ / "folder");
  const Outcome own =
      run({MERLIN_BIN_DIR "/merlin-import", "grid", dir_ / "a.vrt", dir_ / "folder"});
  EXPECT_NE(own.output.find("not recognized"), std::string::npos) << own.output;
  EXPECT_TRUE(std::filesystem::is_empty(dir_ / "folder"));
}

}  // namespace
}  // namespace merlin::test
