// Synthetic point clouds for tests, mostly as the bytes of point cloud files.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "daemon/base/bytes.h"

namespace merlin::test {

inline void set32(std::string& bytes, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(v >> 8 * i & 0xFF);
}
inline void set16(std::string& bytes, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 2; ++i) bytes[at + i] = static_cast<char>(v >> 8 * i & 0xFF);
}
inline void setDouble(std::string& bytes, std::size_t at, double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  set32(bytes, at, static_cast<std::uint32_t>(bits));
  set32(bytes, at + 4, static_cast<std::uint32_t>(bits >> 32));
}

// Returns a LAS file: its header, then `points` records that are zero except for their raw
// coordinates: those of point p are (p, 10 p, 100 p). The scale is 0.01, the offset (500000,
// 5000000, 100). `minor`: minor version of LAS, 2, 3 or 4. `format`: point record format, 0 to 10.
inline std::string las(int minor, std::size_t format, std::uint32_t points) {
  constexpr std::size_t kRecords[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::size_t header = minor == 2 ? 227 : minor == 3 ? 235 : 375;
  const std::size_t record = kRecords[format];
  std::string bytes(header + points * record, '\0');
  bytes.replace(0, 4, "LASF");
  bytes[24] = 1;
  bytes[25] = static_cast<char>(minor);
  set16(bytes, 94, static_cast<std::uint32_t>(header));
  set32(bytes, 96, static_cast<std::uint32_t>(header));
  bytes[104] = static_cast<char>(format);
  set16(bytes, 105, static_cast<std::uint32_t>(record));
  if (minor == 4)
    set32(bytes, 247, points);
  else
    set32(bytes, 107, points);
  for (std::size_t k = 0; k < 3; ++k) setDouble(bytes, 131 + 8 * k, 0.01);
  setDouble(bytes, 155, 500'000);
  setDouble(bytes, 163, 5'000'000);
  setDouble(bytes, 171, 100);
  for (std::uint32_t p = 0; p < points; ++p) {
    const std::size_t at = header + p * record;
    set32(bytes, at, p);
    set32(bytes, at + 4, 10 * p);
    set32(bytes, at + 8, 100 * p);
  }
  return bytes;
}

// Returns an ASCII PCD file of two points with a colour, a normal and the feature "heat".
// `viewpoint`: the viewer's position, "x y z"; `points`: one line of values for each point.
inline std::string pcdCloud(const std::string& viewpoint, const std::string& points) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z heat\n"
         "SIZE 4 4 4 4 4 4 4 4\nTYPE F F F U F F F F\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
         "VIEWPOINT " +
         viewpoint + " 1 0 0 0\nPOINTS 2\nDATA ascii\n" + points;
}

// Returns one small valid file for each supported format or version, for tests that damage them.
inline std::vector<std::string> goodClouds() {
  return {las(2, 3, 4),
          las(3, 5, 2),
          las(4, 7, 3),
          pcdCloud("0 0 9", "1 1 2 16711680 0 0 1 3.5\n2 2 3 255 0 1 0 4.5\n"),
          "1 2 3 255 0 0\n4 5 6 0 0 0\n7 8 9 0 0 51\n",
          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
          "float z\nend_header\n0 0 0\n1 0 0\n"};
}

// Returns points that are spread evenly over the unit sphere by means of the golden angle.
inline std::vector<std::array<double, 3>> sphere(int points) {
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<std::array<double, 3>> made;
  for (int p = 0; p < points; ++p) {
    const double z = 1 - (2 * p + 1.0) / points, r = std::sqrt(1 - z * z);
    made.push_back({r * std::cos(turn * p), r * std::sin(turn * p), z});
  }
  return made;
}

}  // namespace merlin::test
