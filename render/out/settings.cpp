#include "render/out/settings.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::render::out {
namespace {

constexpr std::size_t kLongestName = 23;

void checkTiles(const OutputSettings& o, const tiles::TilesSettings& tiles, const std::string& at,
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
    const auto found = std::ranges::find(tiles.tiles, o.tiles[i].tile, &tiles::TileSettings::name);
    if (found == tiles.tiles.end()) {
      std::vector<std::string> names;
      for (const tiles::TileSettings& t : tiles.tiles) names.push_back(t.name);
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

// Checks the correction against the size of the picture that the output is sent.
void checkCorrection(const OutputSettings& o, const tiles::TilesSettings& tiles,
                     const std::string& at, SettingFaults& faults) {
  if (o.correction.isOff() && o.correction.mpcdi_region.empty()) return;
  if (o.kind == OutputKind::kSharedMemory) {
    faults.push_back({at + "/correction",
                      "is not a setting of kind shared_memory, which holds the uncorrected "
                      "frame"});
    return;
  }
  const auto size = pictureSize(o, tiles);
  if (!size) return;  // checkTiles() reports this
  for (const SettingFault& fault : validate(o.correction, size->width, size->height))
    faults.push_back({at + "/correction" + fault.pointer, fault.what});
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
  const bool can_be_checked = o.kind == OutputKind::kSharedMemory || o.kind == OutputKind::kKms;
  if (!can_be_checked && o.check_s != OutputSettings{}.check_s)
    faults.push_back({at + "/check_s", fmt::format("is not a setting of kind {}", nameOf(o.kind))});
  if (o.kind != OutputKind::kWindow && o.window != WindowSettings{})
    faults.push_back({at + "/window", fmt::format("is not a setting of kind {}", nameOf(o.kind))});
  for (const SettingFault& fault : validate(o.window))
    faults.push_back({at + "/window" + fault.pointer, fault.what});
  if (o.kind != OutputKind::kKms && o.kms != kms::KmsSettings{})
    faults.push_back({at + "/kms", fmt::format("is not a setting of kind {}", nameOf(o.kind))});
  for (const SettingFault& fault : kms::validate(o.kms))
    faults.push_back({at + "/kms" + fault.pointer, fault.what});
}

// Checks the outputs of kind kms against each other.
void checkDisplays(const std::vector<OutputSettings>& outputs, SettingFaults& faults) {
  std::vector<std::size_t> displays;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].kind == OutputKind::kKms) displays.push_back(i);
  }
  for (auto i = displays.begin(); i != displays.end(); ++i) {
    const kms::KmsSettings& here = outputs[*i].kms;
    const std::string at = fmt::format("/{}/kms", *i);
    if (here.card.empty() != outputs[displays.front()].kms.card.empty()) {
      faults.push_back({at + "/card",
                        "is named on some outputs of kind kms and not on others; name it on all of "
                        "them, or on none"});
    }
    const auto same_card = [&](std::size_t o) { return outputs[o].kms.card == here.card; };
    if (here.connector.empty() && std::ranges::count_if(displays, same_card) > 1) {
      faults.push_back({at,
                        "has no connector, and the wall has several outputs on this card; name the "
                        "connector of each"});
    } else if (std::any_of(displays.begin(), i, [&](std::size_t o) {
                 return same_card(o) && outputs[o].kms.connector == here.connector;
               })) {
      faults.push_back({at + "/connector",
                        fmt::format("is {}, which another output uses already", here.connector)});
    }
  }
}

// Finds a named mode that is smaller than the picture: it would otherwise be refused only once the
// display is there.
void checkMode(const OutputSettings& o, const tiles::TilesSettings& tiles, const std::string& at,
               SettingFaults& faults) {
  const auto mode = kms::parseMode(o.kms.mode);
  const auto size = pictureSize(o, tiles);
  if (o.kind != OutputKind::kKms || !mode || !size) return;
  if (size->width <= mode->width && size->height <= mode->height) return;
  faults.push_back({at + "/kms/mode",
                    fmt::format("is {}, and the output's picture has {} x {} pixels, which do not "
                                "fit; name a larger mode, or make its tiles smaller",
                                o.kms.mode, size->width, size->height)});
}

// Finds two outputs that write to the same file: each would overwrite the other's picture.
void checkFiles(const std::vector<OutputSettings>& outputs, SettingFaults& faults) {
  std::map<std::string, std::string> written;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].path.empty()) continue;
    const auto [first, is_new] = written.emplace(outputs[i].path, outputs[i].shownName());
    if (!is_new)
      faults.push_back(
          {fmt::format("/{}/path", i), fmt::format("is {}, to which the output {} writes already",
                                                   outputs[i].path, first->second)});
  }
}

}  // namespace

Rectangle placeOf(const PlacedTile& placed, const tiles::TileSettings& tile,
                  const tiles::TilesSettings& all) {
  Rectangle r{placed.x, placed.y, tile.width > 0 ? tile.width : all.tile_width,
              tile.height > 0 ? tile.height : all.tile_height};
  if (placed.turn == Turn::k90 || placed.turn == Turn::k270) std::swap(r.width, r.height);
  return r;
}

std::optional<PictureSize> pictureSize(const OutputSettings& o, const tiles::TilesSettings& tiles) {
  if (o.tiles.empty()) return PictureSize{tiles.frame_width, tiles.frame_height};
  PictureSize size;
  for (const PlacedTile& placed : o.tiles) {
    const auto found = std::ranges::find(tiles.tiles, placed.tile, &tiles::TileSettings::name);
    if (found == tiles.tiles.end()) return std::nullopt;
    const Rectangle place = placeOf(placed, *found, tiles);
    size.width = std::max(size.width, place.x + place.width);
    size.height = std::max(size.height, place.y + place.height);
  }
  return size;
}

SettingFaults validate(const std::vector<OutputSettings>& outputs,
                       const tiles::TilesSettings& tiles) {
  SettingFaults faults;
  if (outputs.empty()) faults.push_back({"", "is an empty list; a wall has at least one output"});
  if (outputs.size() > kMostOutputs) {
    faults.push_back(
        {"", fmt::format("has {} outputs; a wall has at most {}", outputs.size(), kMostOutputs)});
    return faults;
  }
  checkDisplays(outputs, faults);
  std::set<std::string> names;
  int in_shared_memory = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string at = fmt::format("/{}", i);
    checkOne(outputs[i], at, faults);
    checkTiles(outputs[i], tiles, at, faults);
    checkCorrection(outputs[i], tiles, at, faults);
    checkMode(outputs[i], tiles, at, faults);
    if (!names.insert(outputs[i].shownName()).second) {
      faults.push_back({at, fmt::format("is the second output named \"{}\"; give it a \"name\"",
                                        outputs[i].shownName())});
    }
    in_shared_memory += outputs[i].kind == OutputKind::kSharedMemory ? 1 : 0;
    if (in_shared_memory == 2 && outputs[i].kind == OutputKind::kSharedMemory)
      faults.push_back({at, "is the second output of kind shared_memory; a wall has at most one"});
  }
  checkFiles(outputs, faults);
  return faults;
}

}  // namespace merlin::render::out
