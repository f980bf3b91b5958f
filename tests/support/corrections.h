// Pictures and settings for tests of an output's correction.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "render/correct/settings.h"

namespace merlin::test {

inline constexpr int kWidth = 320, kHeight = 200;

// Returns an RGBA image of random bytes; every call with the same size returns the same image.
inline std::vector<std::uint8_t> noise(int width, int height) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * width * height));
  for (std::uint8_t& p : pixels) p = static_cast<std::uint8_t>(random());
  return pixels;
}

inline std::vector<std::uint8_t> grey(int width, int height, std::uint8_t level) {
  return std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height), level);
}

// Returns settings with moved corners (a keystone) and a mesh with barrel distortion, valid for an
// output of kWidth x kHeight pixels.
inline render::correct::CorrectionSettings bent(render::correct::MeshInterpolation between,
                                                int columns = 5, int rows = 4) {
  render::correct::CorrectionSettings s;
  s.corners = {12, 7, -20, 3, 5, -9, -2, -30};
  s.mesh.columns = columns;
  s.mesh.rows = rows;
  s.mesh.interpolation = between;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double u = static_cast<double>(i) / (columns - 1);
      const double v = static_cast<double>(j) / (rows - 1);
      s.mesh.points.push_back({u + 0.05 * std::sin(6 * v), v + 0.04 * std::sin(3 * u)});
    }
  }
  EXPECT_TRUE(validate(s, kWidth, kHeight).empty());
  return s;
}

// Returns settings in which every correction is active: corners, mesh, blending, colour and black
// level.
inline render::correct::CorrectionSettings everything() {
  render::correct::CorrectionSettings s = bent(render::correct::MeshInterpolation::kBicubic);
  s.blend = {60, 40, 0, 30, 2.3};
  s.colour.matrix = {0.9, 0.1, 0, 0.05, 1, -0.05, 0, 0.1, 0.85};
  s.colour.gain = {1, 0.9, 1.2};
  s.colour.gamma = {1.1, 1, 0.9};
  s.black.level = {0.02, 0.015, 0.03};
  EXPECT_TRUE(validate(s, kWidth, kHeight).empty());
  return s;
}

}  // namespace merlin::test
