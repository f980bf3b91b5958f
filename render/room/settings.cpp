#include "render/room/settings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/room/canvas.h"
#include "render/room/geometry.h"
#include "render/room/presets.h"

namespace merlin::render::room {
namespace {

using Fault = std::optional<std::string>;

constexpr double kLargest_m = 1000;
constexpr double kLeastSize_m = 0.01;
constexpr double kLeastDistance_m = 0.002;
constexpr double kRounding_m = 1e-4;  // tolerance for sums of sizes that a person computed
constexpr int kLargestTile_px = 8192;
constexpr double kWidestView_deg = 179;

bool within(std::span<const double> values, double low, double high) {
  return std::ranges::all_of(values, [&](double v) { return v >= low && v <= high; });
}

bool isPixels(int size) { return size >= 0 && size <= kLargestTile_px; }

Fault faultOfPixels(const std::string& of, int width, int height) {
  if (isPixels(width) && isPixels(height)) return std::nullopt;
  return fmt::format("{}: {} x {} pixels; each of the two numbers is 0 to {}", of, width, height,
                     kLargestTile_px);
}

Fault faultOfSize(const std::string& of, double width_m, double height_m) {
  if (within(std::array{width_m, height_m}, kLeastSize_m, kLargest_m)) return std::nullopt;
  return fmt::format("{}: its size is {} x {} m; width and height must be {} to {} m", of, width_m,
                     height_m, kLeastSize_m, kLargest_m);
}

Fault faultOfLength(const std::string& of, const char* setting, double length_m) {
  if (within({&length_m, 1}, 0, kLargest_m)) return std::nullopt;
  return fmt::format("{}: {} is {}; allowed is 0 to {} m", of, setting, length_m, kLargest_m);
}

Fault faultOfOverlap(const RoomPresetSettings& p) {
  if (p.overlap_m == 0) return std::nullopt;
  const bool flat = p.name == RoomPreset::kFlat, six = p.name == RoomPreset::kSix;
  if (!flat && !six) {
    return fmt::format(
        "preset {}: each projector has a panel of its own, at an angle to its neighbour's; "
        "overlap_m is a setting of presets flat and six",
        nameOf(p.name));
  }
  const double most_m = (six ? std::min(p.panel_width_m, p.panel_height_m) : p.panel_width_m) / 2;
  if (!(p.overlap_m > 0 && p.overlap_m <= most_m)) {
    return fmt::format("preset {}: overlap_m is {}; allowed is 0 to {:g} m, half of a panel",
                       nameOf(p.name), p.overlap_m, most_m);
  }
  if (p.bezel_m == 0) return std::nullopt;
  return fmt::format(
      "preset {}: displays with a frame cannot overlap: leave out overlap_m or bezel_m",
      nameOf(p.name));
}

SettingFaults faultsOfPreset(const RoomSettings& room) {
  const RoomPresetSettings& p = room.preset;
  const std::string of = fmt::format("preset {}", nameOf(p.name));
  SettingFaults faults;
  const auto add = [&](const char* at, Fault fault) {
    if (fault) faults.push_back({at, *std::move(fault)});
  };
  if (!room.panels.empty() || !room.displays.empty()) {
    add("/preset", of + " has panels and displays of its own: leave out /panels and /displays, or "
                        "leave out the preset and begin with what `merlin wall plan --panels` "
                        "prints");
  }
  if (p.panels != 0 && p.name != RoomPreset::kFlat) {
    add("/preset/panels",
        fmt::format("{} always has {} panels; their number is a setting of preset "
                    "flat alone",
                    of, panelCount(p)));
  } else if (p.panels < 0 || static_cast<std::size_t>(p.panels) > kMostPanels) {
    add("/preset/panels",
        fmt::format("{}: {} panels; a room has 1 to {}", of, p.panels, kMostPanels));
  }
  add("/preset", faultOfSize(of, p.panel_width_m, p.panel_height_m));
  add("/preset", faultOfPixels(of, p.width, p.height));
  add("/preset/distance_m", faultOfLength(of, "distance_m", p.distance_m));
  add("/preset/bezel_m", faultOfLength(of, "bezel_m", p.bezel_m));
  add("/preset/overlap_m", faultOfOverlap(p));
  return faults;
}

Fault faultOfPanel(const PanelSettings& p, bool first) {
  const std::string of = fmt::format("panel {}", p.name);
  if (p.name.empty()) return "this panel has no name";
  if (auto fault = faultOfSize(of, p.width_m, p.height_m)) return fault;
  if (!within(p.lower_left_m, -kLargest_m, kLargest_m) ||
      !within(std::array{p.yaw_deg, p.pitch_deg}, -360, 360)) {
    return fmt::format(
        "{}: lower_left_m, yaw_deg or pitch_deg is not a number, or is beyond {} m "
        "or 360 degrees",
        of, kLargest_m);
  }
  if (p.hinge_deg == 0) return std::nullopt;
  if (first) return of + " is the first: it has no panel on its left that hinge_deg could refer to";
  if (!within({&p.hinge_deg, 1}, 10, 350))
    return fmt::format("{}: hinge_deg is {}; allowed is 10 to 350 degrees", of, p.hinge_deg);
  if (p.lower_left_m != std::array<double, 3>{} || p.yaw_deg != 0 || p.pitch_deg != 0) {
    return of +
           " has hinge_deg, from which its place follows: leave out lower_left_m, yaw_deg and "
           "pitch_deg, or hinge_deg";
  }
  return std::nullopt;
}

Fault faultOfDisplay(const DisplaySettings& d, const RoomSettings& room) {
  if (d.name.empty()) return "this display has no name";
  const std::string of = fmt::format("display {}", d.name);
  if (d.name.size() > kLongestDisplayName) {
    return fmt::format("{}: its name has {} characters; at most {} are allowed", of, d.name.size(),
                       kLongestDisplayName);
  }
  if (room.hasOperator() && d.name == kOperatorTile) {
    return of +
           " has the name of the operator's tile: name it otherwise, or set operator_width "
           "and operator_height to 0";
  }
  if (panelOf(d, room.panels) == room.panels.size()) {
    std::vector<std::string> names;
    for (const PanelSettings& p : room.panels) names.push_back(p.name);
    return fmt::format("{} is on panel \"{}\"; the room's panels are {}", of, d.panel,
                       fmt::join(names, ", "));
  }
  if (!within(d.part_m, -kLargest_m, kLargest_m) || !within(d.bezel_m, 0, kLargest_m)) {
    return fmt::format(
        "{}: part_m or bezel_m contains a value that is not a number, is negative or "
        "is beyond {} m",
        of, kLargest_m);
  }
  tiles::TileSettings tile{d.name};
  tile.view = d.view;
  tile.camera = d.camera;
  if (auto fault = tiles::faultOfView(tile)) return fault;
  return faultOfPixels(of, d.width, d.height);
}

// Reports each name that occurs a second time; `what`: "panel" or "display".
template <typename T>
void checkNames(const std::vector<T>& all, const std::string& what, SettingFaults& faults) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!names.insert(all[i].name).second) {
      faults.push_back({fmt::format("/{}s/{}", what, i),
                        fmt::format("two {}s are named \"{}\"", what, all[i].name)});
    }
  }
}

SettingFaults faultsOfFigures(const RoomSettings& room) {
  SettingFaults faults;
  if (!within(room.eye_m, -kLargest_m, kLargest_m)) {
    faults.push_back({"/eye_m", fmt::format("the eye at {} is not within {} m of the room's origin",
                                            fmt::join(room.eye_m, ", "), kLargest_m)});
  }
  if (!isPixels(room.operator_width) || !isPixels(room.operator_height) ||
      (room.operator_width > 0) != (room.operator_height > 0)) {
    faults.push_back({"", fmt::format("the operator's tile of {} x {} pixels is not valid: 0 x 0 "
                                      "means no operator's tile, the largest is {} x {}",
                                      room.operator_width, room.operator_height, kLargestTile_px,
                                      kLargestTile_px)});
  }
  for (std::size_t i = 0; i < room.panels.size(); ++i) {
    if (auto fault = faultOfPanel(room.panels[i], i == 0))
      faults.push_back({fmt::format("/panels/{}", i), *std::move(fault)});
  }
  checkNames(room.panels, "panel", faults);
  for (std::size_t i = 0; i < room.displays.size(); ++i) {
    if (auto fault = faultOfDisplay(room.displays[i], room))
      faults.push_back({fmt::format("/displays/{}", i), *std::move(fault)});
  }
  checkNames(room.displays, "display", faults);
  return faults;
}

Fault faultOfPlace(const std::string& name, const Eigen::Vector3d& eye_m, const Screen& screen) {
  const double distance_m = viewFrom(eye_m, screen).distance_m;
  if (distance_m > kLeastDistance_m) return std::nullopt;
  if (distance_m < -kLeastDistance_m) {
    return fmt::format(
        "panel {} does not face the viewer: the eye is {:.3f} m behind it; check "
        "eye_m, yaw_deg and the hinges",
        name, -distance_m);
  }
  return fmt::format("panel {} does not face the viewer: the eye is in its plane", name);
}

Fault faultOfPart(const DisplaySettings& d, const PanelSettings& panel) {
  const auto& [left, lower, width, height] = d.part_m;
  const bool whole = d.part_m == std::array<double, 4>{};
  const double across = whole ? panel.width_m : width, up = whole ? panel.height_m : height;
  if (!(across >= kLeastSize_m && up >= kLeastSize_m)) {
    return fmt::format("display {}: its part of {} x {} m of the panel has no area", d.name, across,
                       up);
  }
  if (left < -kRounding_m || lower < -kRounding_m || left + across > panel.width_m + kRounding_m ||
      lower + up > panel.height_m + kRounding_m) {
    return fmt::format(
        "display {} reaches from {}, {} to {}, {} m and so exceeds panel {} of {} x {} "
        "m",
        d.name, left, lower, left + across, lower + up, panel.name, panel.width_m, panel.height_m);
  }
  if (across - d.bezel_m[0] - d.bezel_m[1] >= kLeastSize_m &&
      up - d.bezel_m[2] - d.bezel_m[3] >= kLeastSize_m)
    return std::nullopt;
  return fmt::format("display {}: its bezels of {} m leave nothing of its {} x {} m", d.name,
                     fmt::join(d.bezel_m, ", "), across, up);
}

Fault faultOfAngles(const DisplaySettings& d, const Eigen::Vector3d& eye_m, const Screen& panel) {
  const ScreenView view = viewFrom(eye_m, pictureScreen(d, panel));
  if (view.width_deg < kWidestView_deg && view.height_deg < kWidestView_deg) return std::nullopt;
  return fmt::format(
      "display {} is {:.2f} x {:.2f} degrees wide and high for an eye {:.3f} m away; "
      "each must be less than {}: move the eye back",
      d.name, view.width_deg, view.height_deg, view.distance_m, kWidestView_deg);
}

SettingFaults faultsOfPlaces(const RoomSettings& room) {
  SettingFaults faults;
  const std::vector<Screen> screens = panelScreens(room);
  const Eigen::Vector3d eye_m = pointOf(room.eye_m);
  for (std::size_t i = 0; i < screens.size(); ++i) {
    auto fault = faultOfPlace(room.panels[i].name, eye_m, screens[i]);
    for (std::size_t k = 0; k < i && !fault; ++k) {
      if ((screens[i].middle() - screens[k].middle()).norm() < kLeastSize_m) {
        fault = fmt::format(
            "panels {} and {} are at the same place: give one hinge_deg, or "
            "lower_left_m and yaw_deg of its own",
            room.panels[k].name, room.panels[i].name);
      }
    }
    if (fault) faults.push_back({fmt::format("/panels/{}", i), *std::move(fault)});
  }
  if (!faults.empty()) return faults;  // further faults would only follow from these
  for (std::size_t i = 0; i < room.displays.size(); ++i) {
    const DisplaySettings& d = room.displays[i];
    const std::size_t panel = panelOf(d, room.panels);
    auto fault = faultOfPart(d, room.panels[panel]);
    if (!fault) fault = faultOfAngles(d, eye_m, screens[panel]);
    if (fault) faults.push_back({fmt::format("/displays/{}", i), *std::move(fault)});
  }
  return faults;
}

SettingFaults faultsOfCanvas(const RoomSettings& room, const tiles::TilesSettings& tiles) {
  std::vector<tiles::TileSettings> all(room.displays.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].width = room.displays[i].width > 0 ? room.displays[i].width : tiles.tile_width;
    all[i].height = room.displays[i].height > 0 ? room.displays[i].height : tiles.tile_height;
  }
  if (room.hasOperator()) {
    all.emplace_back();
    all.back().width = room.operator_width;
    all.back().height = room.operator_height;
  }
  const CanvasSize size = placeOnCanvas(all);
  if (!size.isTooLarge()) return {};
  return {{"", fmt::format("its {} tiles need a frame of {} x {} pixels; the largest is {} x {}: "
                           "use fewer or smaller displays",
                           all.size(), size.width, size.height, tiles::kLargestFrame_px,
                           tiles::kLargestFrame_px)}};
}

SettingFaults faultsOfExplicit(const RoomSettings& room, const tiles::TilesSettings& tiles) {
  const std::size_t count = room.displays.size() + (room.hasOperator() ? 1 : 0);
  if (room.panels.size() > kMostPanels)
    return {{"/panels",
             fmt::format("{} panels; a room has {} at most", room.panels.size(), kMostPanels)}};
  if (count > tiles::kMostTiles) {
    return {{"/displays", fmt::format("{} tiles including the operator's; a wall has {} at most",
                                      count, tiles::kMostTiles)}};
  }
  SettingFaults faults = faultsOfFigures(room);
  if (faults.empty()) faults = faultsOfPlaces(room);
  if (faults.empty()) faults = faultsOfCanvas(room, tiles);
  return faults;
}

}  // namespace

SettingFaults validate(const RoomSettings& room, const tiles::TilesSettings& tiles) {
  const bool preset = room.preset.name != RoomPreset::kNone;
  if (!preset && room.panels.empty()) {
    return {{"", fmt::format("the room has no panels: list them in /panels, or choose a preset in "
                             "/preset/name ({})",
                             fmt::join(std::span(kRoomPresetNames).subspan(1), ", "))}};
  }
  if (!preset && room.preset != RoomPresetSettings{}) {
    return {{"/preset",
             "the preset has values but no name: choose one in /preset/name, or leave "
             "the preset out"}};
  }
  if (!preset) return faultsOfExplicit(withPanels(room), tiles);
  SettingFaults faults = faultsOfPreset(room);
  if (!faults.empty()) return faults;
  faults = faultsOfExplicit(withPanels(room), tiles);
  for (SettingFault& fault : faults) {  // the preset's panels are not in the configuration file
    if (fault.pointer.starts_with("/panels") || fault.pointer.starts_with("/displays"))
      fault.pointer = "/preset";
  }
  return faults;
}

}  // namespace merlin::render::room
