#include "render/out/settings.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::render {
namespace {

constexpr std::size_t kLongestName = 23;

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  bool overlaps(const Rectangle& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

Rectangle placeOf(const PlacedTile& placed, const TileSettings& tile, const TilesSettings& all) {
  Rectangle r{placed.x, placed.y, tile.width > 0 ? tile.width : all.tile_width,
              tile.height > 0 ? tile.height : all.tile_height};
  if (placed.turn == Turn::k90 || placed.turn == Turn::k270) std::swap(r.width, r.height);
  return r;
}

void checkTiles(const OutputSettings& o, const TilesSettings& tiles, const std::string& at,
                SettingFaults& faults) {
  if (o.kind == OutputKind::kSharedMemory && !o.tiles.empty()) {
    faults.push_back({at + "/tiles",
                      "is not a setting of kind shared_memory, which holds the whole "
                      "frame"});
    return;
  }
  std::vector<Rectangle> places;
  for (std::size_t i = 0; i < o.tiles.size(); ++i) {
    const std::string here = fmt::format("{}/tiles/{}", at, i);
    const auto found = std::ranges::find(tiles.tiles, o.tiles[i].tile, &TileSettings::name);
    if (found == tiles.tiles.end()) {
      std::vector<std::string> names;
      for (const TileSettings& t : tiles.tiles) names.push_back(t.name);
      faults.push_back({here + "/tile", fmt::format("is \"{}\"; the wall's tiles are {}",
                                                    o.tiles[i].tile, fmt::join(names, ", "))});
      continue;
    }
    const Rectangle place = placeOf(o.tiles[i], *found, tiles);
    if (std::ranges::any_of(places, [&](const Rectangle& r) { return r.overlaps(place); }))
      faults.push_back({here, "overlaps another tile on this output"});
    places.push_back(place);
  }
}

void checkOne(const OutputSettings& o, const std::string& at, SettingFaults& faults) {
  if (o.shownName().size() > kLongestName) {
    faults.push_back({at + "/name", fmt::format("has {} characters; at most {} are allowed",
                                                o.shownName().size(), kLongestName)});
  }
  if (o.kind == OutputKind::kPng && o.path.empty())
    faults.push_back({at, "has no path; an output of kind png needs the name of its file"});
  if (o.kind != OutputKind::kPng && !o.path.empty())
    faults.push_back({at + "/path", fmt::format("is not a setting of kind {}", nameOf(o.kind))});
}

}  // namespace

SettingFaults validate(const std::vector<OutputSettings>& outputs, const TilesSettings& tiles) {
  SettingFaults faults;
  if (outputs.empty()) faults.push_back({"", "is an empty list; a wall has at least one output"});
  if (outputs.size() > kMostOutputs) {
    faults.push_back(
        {"", fmt::format("has {} outputs; a wall has at most {}", outputs.size(), kMostOutputs)});
    return faults;
  }
  std::set<std::string> names;
  int in_shared_memory = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string at = fmt::format("/{}", i);
    checkOne(outputs[i], at, faults);
    checkTiles(outputs[i], tiles, at, faults);
    if (!names.insert(outputs[i].shownName()).second) {
      faults.push_back({at, fmt::format("is the second output named \"{}\"; give it a \"name\"",
                                        outputs[i].shownName())});
    }
    in_shared_memory += outputs[i].kind == OutputKind::kSharedMemory ? 1 : 0;
    if (in_shared_memory == 2 && outputs[i].kind == OutputKind::kSharedMemory)
      faults.push_back({at, "is the second output of kind shared_memory; a wall has at most one"});
  }
  return faults;
}

}  // namespace merlin::render
