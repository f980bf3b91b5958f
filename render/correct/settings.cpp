#include "render/correct/settings.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "render/correct/warp.h"

namespace merlin::render::correct {
namespace {

// Adds a fault for each value that is not a number in that range.
template <std::size_t N>
void checkRange(const std::array<double, N>& values, double low, double high, const std::string& at,
                SettingFaults& faults) {
  for (std::size_t i = 0; i < N; ++i) {
    if (values[i] >= low && values[i] <= high) continue;
    faults.push_back({N == 1 ? at : fmt::format("{}/{}", at, i),
                      fmt::format("is {}; allowed is {} to {}", values[i], low, high)});
  }
}

// Returns whether the corners are valid; adds a fault if not.
bool checkCorners(const CorrectionSettings& s, int width, int height, SettingFaults& faults) {
  const std::size_t before = faults.size();
  checkRange(s.corners, -kMostCornerOffset, kMostCornerOffset, "/corners", faults);
  if (faults.size() > before) return false;
  constexpr const char* kNames[] = {"upper left", "upper right", "lower left", "lower right"};
  constexpr int kRound[] = {0, 1, 3, 2};
  const auto corners = pinnedCorners(s, width, height);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = [&](std::size_t k) { return corners[static_cast<std::size_t>(kRound[k % 4])]; };
    const Point before_it = at(i + 3), it = at(i), after = at(i + 1);
    const double twice =
        (it.x - before_it.x) * (after.y - it.y) - (it.y - before_it.y) * (after.x - it.x);
    if (twice > 1) continue;  // [px^2]
    faults.push_back(
        {"/corners",
         fmt::format("do not form a convex picture: at ({}, {}) the {} corner is inside the other "
                     "three, or the picture is turned over; move the corners apart",
                     it.x, it.y, kNames[kRound[i]])});
    return false;
  }
  return true;
}

bool checkMesh(const MeshSettings& m, SettingFaults& faults) {
  for (const auto& [key, count] : {std::pair{"columns", m.columns}, std::pair{"rows", m.rows}}) {
    if (count >= 2 && count <= kMostMeshSide) continue;
    faults.push_back({fmt::format("/mesh/{}", key),
                      fmt::format("is {}; a mesh has 2 to {}", count, kMostMeshSide)});
    return false;
  }
  const auto expected = static_cast<std::size_t>(m.columns) * static_cast<std::size_t>(m.rows);
  if (m.points.size() != expected) {
    faults.push_back({"/mesh/points", fmt::format("has {} points; {} columns and {} rows need {}",
                                                  m.points.size(), m.columns, m.rows, expected)});
    return false;
  }
  for (std::size_t i = 0; i < m.points.size(); ++i) {
    for (const auto& [key, place] :
         {std::pair{"x", m.points[i].x}, std::pair{"y", m.points[i].y}}) {
      if (place >= kLeastMeshPlace && place <= kMostMeshPlace) continue;
      faults.push_back({fmt::format("/mesh/points/{}/{}", i, key),
                        fmt::format("is {}; allowed is {} to {}, in shares of the output", place,
                                    kLeastMeshPlace, kMostMeshPlace)});
      return false;
    }
  }
  return true;
}

void checkBlend(const BlendSettings& b, int width, int height, SettingFaults& faults) {
  const std::size_t before = faults.size();
  for (const auto& [key, ramp, most] :
       {std::tuple{"left", b.left, width}, std::tuple{"right", b.right, width},
        std::tuple{"top", b.top, height}, std::tuple{"bottom", b.bottom, height}})
    checkRange(std::array{ramp}, 0, most, fmt::format("/blend/{}", key), faults);
  checkRange(std::array{b.gamma}, kLeastGamma, kMostGamma, "/blend/gamma", faults);
  if (faults.size() > before) return;
  if (b.left + b.right > width) {
    faults.push_back({"/blend", fmt::format("has ramps of {} and {} pixels at the left and right; "
                                            "the picture is {} pixels wide",
                                            b.left, b.right, width)});
  }
  if (b.top + b.bottom > height) {
    faults.push_back({"/blend", fmt::format("has ramps of {} and {} pixels at the top and bottom; "
                                            "the picture is {} pixels high",
                                            b.top, b.bottom, height)});
  }
}

// An MPCDI file contains a warp, a blend and a black level; settings of these would contradict it.
void checkMpcdi(const CorrectionSettings& s, SettingFaults& faults) {
  if (s.mpcdi.empty()) {
    if (!s.mpcdi_region.empty())
      faults.push_back({"/mpcdi_region", "names a region, but mpcdi names no file"});
    return;
  }
  const auto both = [&](bool there, const char* key, const char* what) {
    if (there)
      faults.push_back({key, fmt::format("is set together with mpcdi, whose file has {}; leave "
                                         "out one of the two",
                                         what)});
  };
  both(!s.mesh.isOff(), "/mesh", "a warp of its own");
  both(s.blend.hasRamp(), "/blend", "a blend of its own");
  both(!s.black.isOff(), "/black", "a black level of its own");
}

}  // namespace

bool ColourSettings::isOff() const {
  const ColourSettings neutral;
  return matrix == neutral.matrix && gain == neutral.gain && gamma == neutral.gamma;
}

bool CorrectionSettings::isOff() const {
  return corners == std::array<double, 8>{} && mesh.isOff() && mpcdi.empty() && !blend.hasRamp() &&
         colour.isOff() && black.isOff();
}

void moveCorner(CorrectionSettings& settings, std::size_t corner, double right_px, double down_px) {
  settings.corners[2 * corner] += right_px;
  settings.corners[2 * corner + 1] += down_px;
}

void moveMeshPoint(MeshSettings& mesh, int column, int row, const MeshPoint& by) {
  const auto in_row = static_cast<std::size_t>(mesh.columns);
  MeshPoint& point =
      mesh.points[static_cast<std::size_t>(row) * in_row + static_cast<std::size_t>(column)];
  point.x += by.x;
  point.y += by.y;
}

SettingFaults validate(const CorrectionSettings& s, int width, int height) {
  SettingFaults faults;
  const bool pinned = checkCorners(s, width, height, faults);
  const bool meshed = s.mesh.isOff() || checkMesh(s.mesh, faults);
  checkBlend(s.blend, width, height, faults);
  checkRange(s.colour.matrix, -kMostColour, kMostColour, "/colour/matrix", faults);
  checkRange(s.colour.gain, 0, kMostColour, "/colour/gain", faults);
  checkRange(s.colour.gamma, kLeastChannelGamma, kMostChannelGamma, "/colour/gamma", faults);
  checkRange(s.black.level, 0, kMostBlack, "/black/level", faults);
  if (!s.black.isOff() && s.mpcdi.empty() && !s.blend.hasRamp()) {
    faults.push_back(
        {"/black",
         "sets a level, but blend has no ramp: black is lifted outside the overlaps, so "
         "define a ramp in blend or remove the level"});
  }
  checkMpcdi(s, faults);
  if (!pinned || !meshed) return faults;
  if (const auto cell = Warp(s, width, height).fold()) {
    faults.push_back({"/mesh", fmt::format("folds: the picture is turned over or has no area in "
                                           "the cell of column {}, row {} (counted from 0); move "
                                           "the points around it apart",
                                           cell->column, cell->row)});
  }
  return faults;
}

}  // namespace merlin::render::correct
