#include "render/tiles/settings.h"

#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

namespace merlin::render {
namespace {

bool overlap(const TileSettings& a, const TileSettings& b, const TilesSettings& s) {
  return std::abs(a.x - b.x) < s.tile_width && std::abs(a.y - b.y) < s.tile_height;
}

std::optional<std::string> faultOfPair(const TileSettings& a, const TileSettings& b,
                                       const TilesSettings& s) {
  if (a.name == b.name) return fmt::format("two tiles are named \"{}\"", a.name);
  if (overlap(a, b, s)) return fmt::format("tiles {} and {} overlap in the frame", a.name, b.name);
  const bool both = a.kind == TileKind::kWall && b.kind == TileKind::kWall;
  if (!both || std::abs(a.turns - b.turns) >= 1e-6) return std::nullopt;
  return fmt::format("tiles {} and {} both look {} tile widths to the left", a.name, b.name,
                     a.turns);
}

std::optional<std::string> faultOfTile(const TileSettings& t, const TilesSettings& s) {
  if (t.x < 0 || t.y < 0 || t.x > s.frame_width - s.tile_width ||
      t.y > s.frame_height - s.tile_height) {
    return fmt::format("tile {} at {}, {} does not lie in the frame of {} x {}", t.name, t.x, t.y,
                       s.frame_width, s.frame_height);
  }
  if (!std::isfinite(t.turns)) return fmt::format("tile {}: turns are {}", t.name, t.turns);
  return std::nullopt;
}

SettingFaults faultsOfFigures(const TilesSettings& s) {
  SettingFaults faults;
  if (!(s.field_of_view_deg >= 1 && s.field_of_view_deg <= 179)) {
    faults.push_back(
        {"/field_of_view_deg",
         fmt::format("a field of view of {} degrees is not 1 to 179", s.field_of_view_deg)});
  }
  if (!(s.near_m > 0 && s.far_m > s.near_m && std::isfinite(s.far_m))) {
    faults.push_back(
        {"", fmt::format("near {} m and far {} m: 0 < near < far", s.near_m, s.far_m)});
  }
  if (s.tile_width <= 0 || s.tile_height <= 0) {
    faults.push_back(
        {"", fmt::format("a tile of {} x {} pixels has no picture", s.tile_width, s.tile_height)});
  }
  if (s.tiles.empty()) faults.push_back({"/tiles", "a wall has at least one tile"});
  if (s.tiles.size() > kMostTiles) {
    faults.push_back(
        {"/tiles", fmt::format("{} tiles; a wall has {} at most", s.tiles.size(), kMostTiles)});
  }
  return faults;
}

}  // namespace

SettingFaults validate(const TilesSettings& s) {
  SettingFaults faults = faultsOfFigures(s);
  if (!faults.empty()) return faults;  // the rest would follow from these
  for (std::size_t i = 0; i < s.tiles.size(); ++i) {
    const std::string at = fmt::format("/tiles/{}", i);
    auto fault = faultOfTile(s.tiles[i], s);
    for (std::size_t j = 0; j < i && !fault; ++j) fault = faultOfPair(s.tiles[j], s.tiles[i], s);
    if (fault) faults.push_back({at, *std::move(fault)});
  }
  return faults;
}

}  // namespace merlin::render
