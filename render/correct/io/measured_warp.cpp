#include "render/correct/io/measured_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace merlin::render::correct {
namespace {

constexpr double kSameShare = 1e-6;  // places that differ by less are the same

// Refuses a warp that shows at most a line of the picture: a map that its tool has never filled.
Result<Ok> checkArea(const FloatMap& map, const std::string& region) {
  constexpr const char* kWayOut =
      "write the file anew with the calibration tool, or leave mpcdi out of the correction";
  constexpr float kFar = std::numeric_limits<float>::max();
  std::array<float, 2> least{kFar, kFar}, most{-kFar, -kFar};
  for (const auto& cell : map.cells) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (std::isnan(cell[i])) continue;
      least[i] = std::min(least[i], cell[i]);
      most[i] = std::max(most[i], cell[i]);
    }
  }
  const auto refused = [&](const std::string& what) {
    return Error{Errc::kMalformed,
                 fmt::format("the warp of region \"{}\" {}; {}", region, what, kWayOut)};
  };
  if (least[0] > most[0]) return refused("has NaN in every cell, so that it shows nothing");
  const auto same = [&](std::size_t i) {
    return static_cast<double>(most[i]) - static_cast<double>(least[i]) < kSameShare;
  };
  if (same(0) && same(1)) {
    return refused(fmt::format(
        "has ({:g}, {:g}) in every cell, so that every pixel shows the same point of the picture",
        least[0], least[1]));
  }
  if (same(0) || same(1)) {
    return refused(fmt::format(
        "has the {} {:g} in every cell, so that every pixel shows the same {} of the picture",
        same(0) ? "u" : "v", same(0) ? least[0] : least[1], same(0) ? "column" : "row"));
  }
  return Ok{};
}

}  // namespace

Result<MeasuredWarp> measuredWarp(const FloatMap& map, MeshInterpolation between,
                                  const std::string& region) {
  if (map.columns < 2 || map.rows < 2)
    return Error{Errc::kMalformed,
                 fmt::format("has {} x {} cells; a warp has 2 x 2 or more", map.columns, map.rows)};
  MeasuredWarp warp{map.columns, map.rows, {}, between};
  warp.places.reserve(map.cells.size());
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const auto& [u, v, error] = map.cells[i];
    const bool known = std::isfinite(u) && std::isfinite(v);
    if (!known && !(std::isnan(u) && std::isnan(v))) {
      return Error{
          Errc::kMalformed,
          fmt::format("its cell of column {}, row {} (from the top, counted from 0) is "
                      "({}, {}); a cell has two numbers, or two NaN where nothing was measured",
                      i % static_cast<std::size_t>(map.columns),
                      i / static_cast<std::size_t>(map.columns), u, v)};
    }
    warp.places.push_back({static_cast<double>(u), 1 - static_cast<double>(v)});
  }
  const auto shows = checkArea(map, region);
  if (!shows) return shows.error();
  return warp;
}

}  // namespace merlin::render::correct
