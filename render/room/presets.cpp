#include "render/room/presets.h"

#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/radian.h"

namespace merlin::render::room {
namespace {

constexpr const char* kThree[] = {"left", "centre", "right"};
constexpr const char* kUpper[] = {"upper_left", "upper_centre", "upper_right"};
constexpr const char* kLower[] = {"lower_left", "lower_centre", "lower_right"};
constexpr const char* kAround[] = {"rear_left",   "front_left", "front",
                                   "front_right", "rear_right", "rear"};

constexpr std::size_t kArcFrames = 6;

// A row of equal panels, each hinged at the same angle to its left neighbour.
struct Chain {
  std::vector<std::string> names;
  double hinge_deg;
  double front;  // index of the panel straight ahead; k + 0.5: the seam after panel k
};

std::vector<std::string> listOf(std::span<const char* const> names) {
  return {names.begin(), names.end()};
}

Chain flatRow(std::size_t count) {
  Chain chain{{}, 180, static_cast<double>(count - 1) / 2};
  for (std::size_t i = 0; i < count; ++i) chain.names.push_back(fmt::format("panel_{}", i + 1));
  return chain;
}

// Returns the distance between the viewer and the front panel [m] at which all panels of a bent
// chain are equally far away. `hinge_deg`: angle between neighbouring panels.
double distanceOfMiddle(double width, double hinge_deg) {
  return width / 2 / std::tan((180 - hinge_deg) / 2 * kRadian<double>);
}

// Returns the viewer's distance from the seam at the front of a bent chain [m] at which all panels
// are equally far away.
double distanceOfSeam(double width, double hinge_deg) {
  return width / 2 / std::sin((180 - hinge_deg) / 2 * kRadian<double>);
}

// Returns the angle [degrees] between `count` equal panels that fill `view_deg` of the view of
// somebody who is equally far from all of them.
double hingeOfArc(std::size_t count, double view_deg) {
  return 180 - view_deg / static_cast<double>(count);
}

// Adds the panels; the front one is `distance` ahead, with its lower edge at height `bottom` [m].
void addChain(const Chain& chain, const RoomPresetSettings& p, double distance, double bottom,
              std::vector<PanelSettings>& panels) {
  const double turn_deg = 180 - chain.hinge_deg;
  // Walks from the middle of the front along the lower edges to the chain's left end. Left of a
  // seam at the front, half of the turn lies on either side.
  const bool seam = std::fmod(chain.front, 1.0) > 0;
  double x = 0, z = -distance, yaw_deg = seam ? turn_deg / 2 : 0;
  for (double left = chain.front + 0.5; left > 0;) {
    const double part = std::fmod(left, 1.0) > 0 ? std::fmod(left, 1.0) : 1.0;
    x -= part * p.panel_width_m * std::cos(yaw_deg * kRadian<double>);
    z += part * p.panel_width_m * std::sin(yaw_deg * kRadian<double>);
    left -= part;
    if (left > 0) yaw_deg += turn_deg;
  }
  for (const std::string& name : chain.names) {
    PanelSettings panel{name, p.panel_width_m, p.panel_height_m};
    if (&name == &chain.names.front()) {
      panel.lower_left_m = {x, bottom, z};
      panel.yaw_deg = yaw_deg;
    } else {
      panel.hinge_deg = chain.hinge_deg;
    }
    panels.push_back(std::move(panel));
  }
}

std::vector<PanelSettings> panelsOf(const RoomPresetSettings& p) {
  std::vector<PanelSettings> panels;
  const auto add = [&](const Chain& chain, double suggested_m, double bottom) {
    addChain(chain, p, p.distance_m > 0 ? p.distance_m : suggested_m, bottom, panels);
  };
  const auto count = static_cast<double>(panelCount(p));
  const double width = p.panel_width_m, bottom = -p.panel_height_m / 2;
  switch (p.name) {
    case RoomPreset::kNone: break;
    case RoomPreset::kFlat: add(flatRow(panelCount(p)), count * width, bottom); break;
    case RoomPreset::kThree160:
      add({listOf(kThree), 160, 1}, distanceOfMiddle(width, 160), bottom);
      break;
    case RoomPreset::kThree120:
      add({listOf(kThree), 120, 1}, distanceOfMiddle(width, 120), bottom);
      break;
    case RoomPreset::kSix:
      add({listOf(kUpper), 180, 1}, 3 * width, 0);
      add({listOf(kLower), 180, 1}, 3 * width, -p.panel_height_m);
      break;
    case RoomPreset::kHexagon:
      add({listOf(kAround), 120, 2}, distanceOfMiddle(width, 120), bottom);
      break;
    case RoomPreset::kArc160: {
      const double hinge_deg = hingeOfArc(panelCount(p), 160);
      add({listOf(kThree), hinge_deg, 1}, distanceOfMiddle(width, hinge_deg), bottom);
      break;
    }
    case RoomPreset::kArc120: {
      Chain chain = flatRow(panelCount(p));
      chain.hinge_deg = hingeOfArc(panelCount(p), 120);
      add(chain, distanceOfSeam(width, chain.hinge_deg), bottom);
      break;
    }
  }
  return panels;
}

// A part of a length. stretchOf() returns the part that the i-th of `count` equal, overlapping
// pictures covers.
struct Stretch {
  double begin, length;
};
Stretch stretchOf(std::size_t i, std::size_t count, double whole, double overlap) {
  const auto n = static_cast<double>(count);
  const double length = (whole + (n - 1) * overlap) / n;
  return {static_cast<double>(i) * (length - overlap), length};
}

// Adds projectors whose pictures overlap on one flat screen, which is as large as the panels
// together.
void addOverlapping(const RoomPresetSettings& p, RoomSettings& room) {
  const std::vector<PanelSettings> panels = panelsOf(p);
  const std::size_t rows = p.name == RoomPreset::kSix ? 2 : 1, columns = panels.size() / rows;
  const double width = static_cast<double>(columns) * p.panel_width_m;
  const double height = static_cast<double>(rows) * p.panel_height_m;
  // The lowest panel on the left begins the last row.
  PanelSettings screen{"screen", width, height};
  screen.lower_left_m = panels[(rows - 1) * columns].lower_left_m;
  room.panels = {std::move(screen)};
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Stretch across = stretchOf(i % columns, columns, width, p.overlap_m);
    const Stretch up = stretchOf(rows - 1 - i / columns, rows, height, p.overlap_m);
    DisplaySettings display{panels[i].name, room.panels[0].name};
    display.part_m = {across.begin, up.begin, across.length, up.length};
    display.width = p.width;
    display.height = p.height;
    room.displays.push_back(std::move(display));
  }
}

}  // namespace

std::size_t panelCount(const RoomPresetSettings& preset) {
  switch (preset.name) {
    case RoomPreset::kNone: return 0;
    case RoomPreset::kFlat:
      return preset.panels > 0 ? static_cast<std::size_t>(preset.panels) : std::size(kThree);
    case RoomPreset::kThree160:
    case RoomPreset::kThree120:
    case RoomPreset::kArc160: return std::size(kThree);
    case RoomPreset::kSix: return std::size(kUpper) + std::size(kLower);
    case RoomPreset::kHexagon: return std::size(kAround);
    case RoomPreset::kArc120: return kArcFrames;
  }
  return 0;
}

RoomSettings withPanels(const RoomSettings& room) {
  RoomSettings explicit_room = room;
  const RoomPresetSettings& p = room.preset;
  if (p.name != RoomPreset::kNone) explicit_room.panels = panelsOf(p);
  explicit_room.preset = {};
  if (!explicit_room.displays.empty()) return explicit_room;
  if (p.name != RoomPreset::kNone && p.overlap_m > 0) {
    addOverlapping(p, explicit_room);
    return explicit_room;
  }
  for (const PanelSettings& panel : explicit_room.panels) {
    DisplaySettings display{panel.name, panel.name};
    if (p.name != RoomPreset::kNone) {
      display.width = p.width;
      display.height = p.height;
      display.bezel_m.fill(p.bezel_m);
    }
    explicit_room.displays.push_back(std::move(display));
  }
  return explicit_room;
}

}  // namespace merlin::render::room
