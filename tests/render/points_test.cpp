// Point clouds: their readers, damaged files, and the normals that are estimated for them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/random.h"
#include "render/points/io/cloud_file.h"
#include "render/points/orient_normals.h"
#include "render/points/point_cloud.h"
#include "render/points/surface_guess.h"
#include "tests/support/clouds.h"

namespace merlin::test {
namespace {

namespace points = render::points;

points::PointCloud cloudOf(const std::string& bytes) {
  auto cloud = points::parseCloud(bytes);
  EXPECT_TRUE(cloud) << (cloud ? "" : cloud.error().what);
  return cloud ? *std::move(cloud) : points::PointCloud{};
}

std::string faultOf(const std::string& bytes) {
  const auto cloud = points::parseCloud(bytes);
  EXPECT_FALSE(cloud);
  return cloud ? "" : cloud.error().what;
}

void expectFault(const std::string& bytes, const std::string& with) {
  const std::string fault = faultOf(bytes);
  EXPECT_NE(fault.find(with), std::string::npos) << fault;
}

TEST(PlyCloud, HasAsManyPointsAsOtherFormatsAtMost) {
  const auto withCount = [](std::size_t count) {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
        "float z\nend_header\n",
        count);
  };
  expectFault(withCount(points::kMostPoints + 1),
              "268435457 points; up to 268435456 are read; thin it with: ");
  expectFault(withCount(points::kMostPoints), "cut short");
}

std::vector<float> valuesOf(const points::PointCloud& cloud, const char* name) {
  const auto* feature = cloud.find(name);
  return feature ? feature->values : std::vector<float>{};
}

TEST(Las, EveryVersionAndPointFormatIsRead) {
  constexpr std::size_t kClassAt[] = {15, 16};
  for (const int minor : {2, 3, 4}) {
    for (std::size_t format = 0; format <= 10; ++format) {
      SCOPED_TRACE(fmt::format("1.{}, format {}", minor, format));
      std::string bytes = las(minor, format, 3);
      const std::size_t record = (bytes.size() - (minor == 2 ? 227 : minor == 3 ? 235 : 375)) / 3;
      const std::size_t last = bytes.size() - record;
      set16(bytes, last + 12, 40'000);
      bytes[last + kClassAt[format >= 6]] = 5;
      const auto cloud = cloudOf(bytes);
      ASSERT_EQ(cloud.size(), 3U);
      EXPECT_EQ(cloud.origin, (std::array<double, 3>{500'000, 5'000'000, 0}));
      EXPECT_FLOAT_EQ(cloud.positions[6], 0.02F);
      EXPECT_FLOAT_EQ(cloud.positions[7], 0.2F);
      EXPECT_FLOAT_EQ(cloud.positions[8], 102);
      EXPECT_EQ(valuesOf(cloud, "intensity"), (std::vector<float>{0, 0, 40'000}));
      EXPECT_EQ(valuesOf(cloud, "label"), (std::vector<float>{0, 0, 5}));
      EXPECT_EQ(cloud.format, fmt::format("LAS 1.{}, point format {}", minor, format));
      EXPECT_EQ(cloud.side, points::Side::kAbove);
    }
  }
}

TEST(Las, ColoursHaveSixteenBitsOrEight) {
  constexpr std::size_t kColourAt[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  for (const std::size_t format : {2U, 3U, 5U, 7U, 8U, 10U}) {
    std::string bytes = las(4, format, 2);
    const std::size_t at = bytes.size() - (bytes.size() - 375) / 2 + kColourAt[format];
    set16(bytes, at, 65'535);
    set16(bytes, at + 4, 13'107);
    EXPECT_EQ(valuesOf(cloudOf(bytes), "colour"), (std::vector<float>{0, 0, 0, 1, 0, 0.2F}));
    set16(bytes, at, 255);
    set16(bytes, at + 4, 51);
    EXPECT_EQ(valuesOf(cloudOf(bytes), "colour"), (std::vector<float>{0, 0, 0, 1, 0, 0.2F}));
  }
}

TEST(Las, WithheldPointsAndNoiseAreLeftOut) {
  std::string bytes = las(2, 0, 4);
  bytes[227 + 15] = static_cast<char>(0x80);
  bytes[247 + 15] = 7;
  const auto cloud = cloudOf(bytes);
  EXPECT_EQ(cloud.size(), 2U);
  ASSERT_EQ(cloud.notes.size(), 1U);
  EXPECT_EQ(cloud.notes[0], "left out: 1 withheld points, 1 points of noise classes");
  bytes[247 + 15] = 2;
  EXPECT_EQ(cloudOf(bytes).notes[0], "left out: 1 withheld points") << "none is of noise";
  bytes = las(4, 6, 4);
  bytes[375 + 15] = 4;
  bytes[405 + 16] = 18;
  EXPECT_EQ(cloudOf(bytes).size(), 2U);
}

// Returns a LAS file with these variable length records of the user LASF_Projection between header
// and points.
std::string withRecords(std::string bytes,
                        const std::vector<std::pair<int, std::string>>& records) {
  std::string all;
  for (const auto& [id, data] : records) {
    std::string record(54, '\0');
    record.replace(2, 15, "LASF_Projection");
    set16(record, 18, static_cast<std::uint32_t>(id));
    set16(record, 20, static_cast<std::uint32_t>(data.size()));
    all += record + data;
  }
  const std::size_t header = bytes[25] == 2 ? 227 : 375;
  set32(bytes, 96, static_cast<std::uint32_t>(header + all.size()));
  set32(bytes, 100, static_cast<std::uint32_t>(records.size()));
  return bytes.insert(header, all);
}

std::string shortsOf(const std::vector<std::uint32_t>& values) {
  std::string bytes(2 * values.size(), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) set16(bytes, 2 * i, values[i]);
  return bytes;
}

TEST(Las, TheProjectionIsOfItsRecords) {
  const auto projectionOf = [](const std::vector<std::pair<int, std::string>>& records) {
    const auto cloud = cloudOf(withRecords(las(2, 0, 3), records));
    EXPECT_EQ(cloud.size(), 3U);
    EXPECT_TRUE(cloud.notes.empty());
    return cloud.projection;
  };
  EXPECT_EQ(projectionOf({}), "");
  EXPECT_EQ(projectionOf({{2112, std::string("PROJCS[\"a\",\n...]\0", 18)}}), "PROJCS[\"a\", ...]");
  const std::string keys = shortsOf({1, 1, 0, 1, 3072, 0, 1, 32633});
  EXPECT_EQ(projectionOf({{34735, keys}}), "EPSG:32633");
  EXPECT_EQ(projectionOf({{34735, keys}, {2112, "WKT"}}), "WKT");
  EXPECT_EQ(projectionOf({{34735, keys + shortsOf({4096, 0, 1, 5773})}}), "EPSG:32633+5773");
  EXPECT_EQ(projectionOf({{34735, shortsOf({1, 1, 0, 1, 2048, 0, 1, 4326})}}), "EPSG:4326");
  EXPECT_EQ(projectionOf(
                {{34735, shortsOf({1, 1, 0, 1, 3073, 34737, 7, 5})}, {34737, "none|my map|more"}}),
            "my map");
  const auto unknown =
      cloudOf(withRecords(las(4, 6, 3), {{34735, shortsOf({1, 1, 0, 1, 3072, 0, 1, 32767})}}));
  EXPECT_EQ(unknown.projection, "");
  ASSERT_EQ(unknown.notes.size(), 1U);
  EXPECT_NE(unknown.notes[0].find("its projection is left out"), std::string::npos);
}

TEST(Las, ARecordOfTheProjectionThatIsCutIsNone) {
  std::string bytes = withRecords(las(2, 0, 3), {{2112, "WKT"}});
  set16(bytes, 227 + 20, 0xFFFF);
  EXPECT_EQ(cloudOf(bytes).projection, "");
  set32(bytes, 100, 0xFFFFFFFF);
  EXPECT_EQ(cloudOf(bytes).size(), 3U);
}

TEST(Las, WhatBecomesNoFeatureIsNamed) {
  std::string bytes = las(2, 1, 3);
  EXPECT_TRUE(cloudOf(bytes).notes.empty()) << "the time is 0 everywhere: it was not recorded";
  setDouble(bytes, 227 + 20, 1.5);
  bytes[227 + 14] = 2 << 3;
  bytes[227 + 16] = 5;
  bytes[227 + 17] = 1;
  bytes[227 + 18] = 7;
  const auto cloud = cloudOf(bytes);
  ASSERT_EQ(cloud.notes.size(), 1U);
  EXPECT_EQ(
      cloud.notes[0],
      "left out of each point, and not kept as features: GPS time, return numbers, scan angles, "
      "user data, point source IDs");
  EXPECT_EQ(cloudOf(las(4, 10, 3)).notes[0],
            "left out of each point, and not kept as features: near infrared, waveforms");
}

TEST(Las, WhatIsWrongInAHeaderIsNamed) {
  const std::string good = las(4, 6, 3);
  const auto with = [&](std::size_t at, std::uint32_t v) {
    std::string bytes = good;
    set32(bytes, at, v);
    return bytes;
  };
  const auto scaled = [&](double v) {
    std::string bytes = good;
    setDouble(bytes, 131, v);
    return bytes;
  };
  expectFault(good.substr(0, 100), "cut short");
  expectFault(good.substr(0, good.size() - 1), "3 points of 30 bytes are declared");
  expectFault(with(247, 0xFFFFFFFF), "the file ends after 3");
  expectFault(with(251, 0xFFFFFFFF), "the file ends after 3");
  std::string most = with(247, 0xFFFFFFFF);
  set32(most, 251, 0xFFFFFFFF);
  expectFault(most, "18446744073709551615 points of 30 bytes are declared");
  expectFault(with(247, 0), "0 points are declared");
  expectFault(with(94, 0xFFFF), "its length is 65535 bytes");
  expectFault(with(96, 0xFFFFFFFF), "points start at byte 4294967295");
  expectFault(with(104, 0x1D06), "a point has 29 bytes");
  expectFault(with(104, 0x1E0B), "point format 11");
  expectFault(scaled(std::numeric_limits<double>::quiet_NaN()), "x: scale nan");
  expectFault(scaled(0), "x: scale 0");
  std::string version = good;
  version[25] = 5;
  expectFault(version, "version 1.5");
}

TEST(Clouds, LazAndE57AreRefusedWithTheCommandThatConverts) {
  std::string laz = las(2, 3, 3);
  laz[104] = static_cast<char>(0x83);
  expectFault(laz, "laszip -i IN.laz -o OUT.las");
  expectFault("ASTM-E57" + std::string(40, '\0'), "pdal translate IN.e57 OUT.las");
  EXPECT_EQ(points::cloudFormatOf("ASTM-E57"), "E57");
}

TEST(PcdCloud, HasColoursNormalsAndItsViewpoint) {
  const auto cloud =
      cloudOf(pcdCloud("0 0 9", "20000 1 2 16711680 0 0 1 3.5\n20001 2 3 255 0 1 0 4.5\n"));
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.origin, (std::array<double, 3>{20'000, 0, 0}));
  EXPECT_EQ(cloud.positions, (std::vector<float>{0, 1, 2, 1, 2, 3}));
  EXPECT_EQ(valuesOf(cloud, "colour"), (std::vector<float>{1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(valuesOf(cloud, "normal"), (std::vector<float>{0, 0, 1, 0, 1, 0}));
  EXPECT_EQ(valuesOf(cloud, "heat"), (std::vector<float>{3.5F, 4.5F}));
  EXPECT_EQ(cloud.side, points::Side::kViewpoint);
  EXPECT_EQ(cloud.viewpoint, (std::array<float, 3>{-20'000, 0, 9}));
}

TEST(PcdCloud, TheDefaultViewpointIsNone) {
  const std::string two = "-1 -1 1 0 0 0 1 0\n1 1 2 0 0 0 1 0\n";
  EXPECT_EQ(cloudOf(pcdCloud("0 0 0", two)).side, points::Side::kUnknown);
  EXPECT_EQ(cloudOf(pcdCloud("0 0 0.5", two)).side, points::Side::kViewpoint);
}

TEST(PcdCloud, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  const auto cloud = cloudOf(pcdCloud("0 0 9", "nan 1 2 7 0 0 1 3\n1 2 3 7 0 0 1 nan\n"));
  EXPECT_EQ(cloud.positions, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(valuesOf(cloud, "heat"), std::vector<float>{0});
  EXPECT_EQ(cloud.notes.size(), 2U);
  expectFault(pcdCloud("0 0 9", "nan 1 2 7 0 0 1 3\n1 inf 3 7 0 0 1 0\n"), "none with finite");
}

TEST(PlyCloud, IsAFileWithoutFaces) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
      "float y\nproperty float z\nproperty uchar red\nproperty uchar "
      "green\nproperty uchar blue\n";
  const std::string body = "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n";
  const auto cloud = cloudOf(head + body);
  EXPECT_EQ(cloud.positions, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(valuesOf(cloud, "colour"), (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_TRUE(points::cloudFormatOf(head +
                                    "element face 0\nproperty list uchar int "
                                    "vertex_indices\n" +
                                    body));
  EXPECT_FALSE(points::cloudFormatOf(head +
                                     "element face 1\nproperty list uchar int "
                                     "vertex_indices\n" +
                                     body));
  EXPECT_FALSE(points::cloudFormatOf(head +
                                     "element range_grid 1\nproperty list uchar int "
                                     "vertex_indices\n" +
                                     body));
}

TEST(Xyz, HasThreeFourSixOrSevenColumns) {
  EXPECT_EQ(cloudOf("1 2 3\n4,5,6\n7;8;9\n").positions,
            (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(valuesOf(cloudOf("1 2 3 0.5\n4 5 6 7\n7 8 9 1\n"), "intensity"),
            (std::vector<float>{0.5F, 7, 1}));
  EXPECT_EQ(valuesOf(cloudOf("1 2 3 255 0 0\n4 5 6 0 0 0\n7 8 9 0 0 51\n"), "colour"),
            (std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 0.2F}));
  EXPECT_EQ(valuesOf(cloudOf("1 2 3 0.6 0.8 0\n4 5 6 0 -1 0\n7 8 9 0 0 1\n"), "normal").size(), 9U);
  const auto pts = cloudOf("3\n1 2 3 -9 255 0 0\n4 5 6 -8 0 0 0\n7 8 9 -7 0 0 255\n");
  EXPECT_EQ(valuesOf(pts, "intensity"), (std::vector<float>{-9, -8, -7}));
  EXPECT_EQ(valuesOf(pts, "colour").back(), 1);
}

TEST(Xyz, IsRecognisedWithCare) {
  EXPECT_TRUE(points::textCloudFormatOf("# a cloud\n\n1 2 3\n4 5 6\n7 8 9\n"));
  for (const char* other :
       {"1 2 3\n4 5 6\n", "1 2\n3 4\n5 6\n", "1 2 3\n4 5 6\n7 8\n", "v 1 2 3\nv 4 5 6\nv 7 8 9\n",
        "1 2 3 4 5\n1 2 3 4 5\n1 2 3 4 5\n", "", "ncols 3\n1 2 3\n1 2 3\n1 2 3\n"})
    EXPECT_FALSE(points::textCloudFormatOf(other)) << other;
}

TEST(Xyz, AFaultHasItsLine) {
  std::string text;
  for (int line = 0; line < 999; ++line) text += "1 2 3\n";
  expectFault(text + "1 2 x\n", "line 1000: \"x\"");
  expectFault(text + "1 2 3 4\n", "line 1000: has 4 numbers");
  expectFault("1 2 3 9 9 999\n1 2 3 4 5 6\n1 2 3 4 5 6\n", "neither colours");
}

TEST(Clouds, LargeCoordinatesKeepTheirDigits) {
  const auto cloud =
      cloudOf("500000.125 5000000.25 12\n500001.125 5000001.5 13\n500002 5000002 14\n");
  EXPECT_EQ(cloud.origin, (std::array<double, 3>{500'000, 5'000'000, 0}));
  EXPECT_EQ(cloud.positions[0], 0.125F);
  EXPECT_EQ(cloud.positions[4], 1.5F);
  EXPECT_EQ(cloud.positions[8], 14);
}

TEST(Clouds, ThoseOfAPlyWithDoublesToo) {
  const auto cloud = cloudOf(
      "ply\nformat ascii 1.0\ncomment first another element\nelement camera 1\nproperty list "
      "uchar double view\nelement vertex 2\nproperty double heat\nproperty double z\nproperty "
      "double x\nproperty list uchar int seen\nproperty double y\nend_header\n2 7 8\n"
      "3 100.5 500000.125 0 5000000.25\n4 101 500001.0625 2 9 9 5000001.5\n");
  EXPECT_EQ(cloud.origin, (std::array<double, 3>{500'000, 5'000'000, 0}));
  EXPECT_EQ(cloud.positions, (std::vector<float>{0.125F, 0.25F, 100.5F, 1.0625F, 1.5F, 101}));
  EXPECT_EQ(valuesOf(cloud, "heat"), (std::vector<float>{3, 4}));
}

TEST(SurfaceGuess, ACellOfTheOctreeIsAsWideAsTheSpacing) {
  const auto settings = points::guessed({}, 128, 1.1);
  EXPECT_EQ(settings.depth, 7);
  EXPECT_EQ(settings.neighbours, 16);
  EXPECT_DOUBLE_EQ(settings.trim, 4 * 1.1);
  EXPECT_EQ(points::guessed({}, 1, 1e-9).depth, 10) << "as deep as memory and time allow";
  EXPECT_DOUBLE_EQ(points::guessed({}, 1024, 1e-9).trim, 3 * 1.1) << "three cells";
  EXPECT_EQ(points::guessed({}, 1, 1).depth, 4);
}

TEST(SurfaceGuess, WhatIsSaidStays) {
  const auto settings = points::guessed({9, 30, 0}, 128, 1);
  EXPECT_EQ(settings.depth, 9);
  EXPECT_EQ(settings.neighbours, 30);
  EXPECT_EQ(settings.trim, 0);
}

TEST(SurfaceGuess, PointsInOnePlaceDoNotCountForTheSpacing) {
  EXPECT_EQ(points::medianSpacing({0, 0, 0, 3, 1, 2}), 2);
  EXPECT_EQ(points::medianSpacing({0, 0}), 0);
}

constexpr std::size_t kNeighbours = 8;

std::vector<std::uint32_t> neighboursOf(const std::vector<float>& positions) {
  const auto points = static_cast<std::uint32_t>(positions.size() / 3);
  std::vector<std::uint32_t> neighbours;
  for (std::uint32_t p = 0; p < points; ++p) {
    const auto distance = [&](std::uint32_t q) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = double{positions[3 * p + k]} - double{positions[3 * q + k]};
        sum += d * d;
      }
      return sum;
    };
    std::vector<std::uint32_t> all(points);
    std::iota(all.begin(), all.end(), 0U);
    std::ranges::nth_element(all, all.begin() + kNeighbours, {}, distance);
    neighbours.insert(neighbours.end(), all.begin(), all.begin() + kNeighbours);
  }
  return neighbours;
}

// The points and the outward normals of an ellipsoid with its centre at (x, 0, 0); its half axis in
// z is `flat`, the others are 1.
struct Ellipsoid {
  explicit Ellipsoid(double flat, double x = 0) {
    for (const auto& p : sphere(400)) {
      for (std::size_t k = 0; k < 3; ++k)
        positions.push_back(static_cast<float>(k == 0 ? p[0] + x : k == 1 ? p[1] : p[2] * flat));
      const std::array<double, 3> outward = {p[0], p[1], p[2] / flat};
      const double length = std::hypot(outward[0], outward[1], outward[2]);
      for (const double n : outward) normals.push_back(n / length);
    }
  }
  std::vector<float> positions;
  std::vector<double> normals;
};

// Turns normals about at random, and expects that the orientation restores all of them.
void expectTurnedBack(const Ellipsoid& of, std::size_t trees) {
  auto normals = of.normals;
  Random random(4);
  for (std::size_t p = 0; p < normals.size(); p += 3) {
    const double sign = random.below(2) == 0 ? 1 : -1;
    for (std::size_t k = 0; k < 3; ++k) normals[p + k] *= sign;
  }
  EXPECT_EQ(points::orientAlike(of.positions, neighboursOf(of.positions), kNeighbours, normals),
            trees);
  EXPECT_EQ(normals, of.normals);
}

TEST(Normals, OfAClosedSurfaceAllFaceOutwards) { expectTurnedBack(Ellipsoid(1), 1); }

TEST(Normals, OfThePartsOfACloudFaceOutwardsEach) {
  Ellipsoid both(1);
  const Ellipsoid other(0.5, 5);
  both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
  both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
  expectTurnedBack(both, 2);
}

TEST(Normals, OfTheTwoSidesOfAThinPartFaceAway) { expectTurnedBack(Ellipsoid(0.1), 1); }

// Expects either a cloud whose arrays have matching sizes, or an error of one sentence.
void expectSound(const std::string& bytes) {
  const auto cloud = points::parseCloud(bytes);
  if (!cloud) {
    EXPECT_TRUE(isText(cloud.error().what) && cloud.error().what.size() < 800);
    return;
  }
  EXPECT_GT(cloud->size(), 0U);
  EXPECT_LE(cloud->size(), bytes.size());
  for (const float x : cloud->positions) EXPECT_LE(std::abs(x), 1e18F);
  for (const auto& f : cloud->features) EXPECT_EQ(f.values.size(), cloud->size() * f.dimension);
}

TEST(Clouds, EveryPrefixAndEveryDamagedByteEndWell) {
  for (const std::string& good : goodClouds()) {
    for (std::size_t size = 0; size < good.size(); ++size) expectSound(good.substr(0, size));
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (const unsigned bit : {0U, 3U, 6U, 7U}) {
        std::string bytes = good;
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << bit);
        expectSound(bytes);
      }
    }
  }
}

TEST(Clouds, ThousandsOfDamagedFilesEndWell) {
  Random random(18);
  const auto good = goodClouds();
  for (int input = 0; input < 5'000; ++input) {
    std::string bytes = good[random.below(good.size())];
    for (std::uint64_t n = random.below(4) + 1; n > 0; --n) {
      const std::size_t at = random.below(bytes.size());
      switch (random.below(3)) {
        case 0: bytes[at] = static_cast<char>(random.below(256)); break;
        case 1: bytes.insert(at, bytes.substr(random.below(bytes.size()), 8)); break;
        default: bytes.erase(at, random.below(8)); break;
      }
      if (bytes.empty()) break;
    }
    expectSound(bytes);
  }
}

}  // namespace
}  // namespace merlin::test
