#include "render/out/room_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "render/tiles/plane_parts.h"

namespace merlin::render::out {
namespace {

// Ramp widths at the left, top, right and bottom border: clockwise, so that a quarter turn moves
// each by one.
using Ramps = std::array<double, 4>;

// Returns the widths of a tile's shared strips, in pixels of its picture.
Ramps rampsOf(const tiles::Tile& tile, const tiles::PlanePart& part,
              const tiles::SharedStrips& strips) {
  const auto pixels = [](double metres, double length, int size) {
    return std::round(metres / length * size);
  };
  return {pixels(strips.left, part.width, tile.width), pixels(strips.top, part.height, tile.height),
          pixels(strips.right, part.width, tile.width),
          pixels(strips.bottom, part.height, tile.height)};
}

// Converts ramps to the output's picture, in which the tile is mirrored first, then turned
// clockwise.
Ramps onOutput(Ramps ramps, const PlacedTile& placed) {
  if (placed.mirror == Mirror::kHorizontal) std::swap(ramps[0], ramps[2]);
  if (placed.mirror == Mirror::kVertical) std::swap(ramps[1], ramps[3]);
  std::rotate(ramps.begin(), ramps.end() - static_cast<int>(placed.turn), ramps.end());
  return ramps;
}

// Returns the only tile that the output shows; nothing if it shows several or none.
std::optional<PlacedTile> onlyTile(const OutputSettings& output, const tiles::TilePlan& plan) {
  if (output.tiles.size() == 1) return output.tiles[0];
  if (!output.tiles.empty() || plan.tiles.size() != 1) return std::nullopt;
  return PlacedTile{.tile = plan.tiles[0].name};
}

// Sets the ramps. Returns a sentence, and sets none, if a configured ramp has another width.
std::string setRamps(correct::BlendSettings& blend, const Ramps& ramps) {
  const std::pair<const char*, double*> all[] = {{"left", &blend.left},
                                                 {"top", &blend.top},
                                                 {"right", &blend.right},
                                                 {"bottom", &blend.bottom}};
  for (std::size_t i = 0; i < ramps.size(); ++i) {
    if (*all[i].second != 0 && *all[i].second != ramps[i])
      return fmt::format(
          "is true, and {} is {:g}, while other screens overlap by {:g} pixels: leave "
          "{} out, or set automatic to false",
          all[i].first, *all[i].second, ramps[i], all[i].first);
  }
  for (std::size_t i = 0; i < ramps.size(); ++i) *all[i].second = ramps[i];
  return {};
}

}  // namespace

SettingFaults fillBlends(std::vector<OutputSettings>& outputs, const tiles::TilesSettings& tiles) {
  SettingFaults faults;
  const auto plan = tiles::planTiles(tiles);
  if (!plan) return faults;
  const auto parts = tiles::planeParts(*plan);
  const auto strips = tiles::sharedStrips(*plan, parts);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    correct::BlendSettings& blend = outputs[i].correction.blend;
    if (!blend.automatic) continue;
    const std::string at = fmt::format("/{}/correction/blend/automatic", i);
    const auto placed = onlyTile(outputs[i], *plan);
    if (!placed) {
      faults.push_back({at,
                        "is true, and the output does not show exactly one tile: give left, "
                        "right, top and bottom instead"});
      continue;
    }
    const auto found = std::ranges::find(plan->tiles, placed->tile, &tiles::Tile::name);
    if (found == plan->tiles.end()) continue;
    const auto tile = static_cast<std::size_t>(found - plan->tiles.begin());
    if (!parts[tile]) {
      faults.push_back(
          {at, fmt::format("is true, and it is not known where the screen of the tile "
                           "{} is: describe it by /wall/room or screen_m, or give left, "
                           "right, top and bottom",
                           found->name)});
      continue;
    }
    const std::string differs =
        setRamps(blend, onOutput(rampsOf(*found, *parts[tile], strips[tile]), *placed));
    if (!differs.empty()) faults.push_back({at, differs});
  }
  return faults;
}

}  // namespace merlin::render::out
