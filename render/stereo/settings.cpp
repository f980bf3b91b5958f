#include "render/stereo/settings.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/stereo/eye_tiles.h"

namespace merlin::render::stereo {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLongestName =
    13;  // a tile's name has 15 characters; the eye's suffix takes two
constexpr double kLargest_m = 1000;
constexpr double kMostSeparation_m = 10;

bool within(std::span<const double> values, double low, double high) {
  return std::ranges::all_of(values, [&](double v) { return v >= low && v <= high; });
}

bool isRightHanded(const std::array<int, 3>& axes) {
  Eigen::Matrix3d map = Eigen::Matrix3d::Zero();
  for (std::size_t row = 0; row < 3; ++row) {
    if (axes[row] == 0 || axes[row] < -3 || axes[row] > 3) return false;
    map(static_cast<int>(row), std::abs(axes[row]) - 1) = axes[row] > 0 ? 1 : -1;
  }
  return map.determinant() > 0.5;
}

SettingFaults faultsOfHead(const HeadSettings& h) {
  SettingFaults faults;
  if (h.station < 0 || h.station > 4)
    faults.push_back({"/stereo/head/station",
                      fmt::format("is {}; a tracker has stations 1 to 4, 0 is none", h.station)});
  if (!isRightHanded(h.axes)) {
    faults.push_back({"/stereo/head/axes",
                      fmt::format("is {}; allowed is each of 1 to 3 once, with signs that make the "
                                  "axes right-handed",
                                  fmt::join(h.axes, ", "))});
  }
  if (!within(h.origin_m, -kLargest_m, kLargest_m) || !(h.scale >= 0.01 && h.scale <= 100) ||
      !within(std::array{h.dead_band_m, h.dead_band_deg}, 0, 180)) {
    faults.push_back(
        {"/stereo/head",
         fmt::format("has a figure that is not a number or is beyond its range: "
                     "origin_m is {}, scale {}, dead_band_m {}, dead_band_deg {}",
                     fmt::join(h.origin_m, ", "), h.scale, h.dead_band_m, h.dead_band_deg)});
  }
  return faults;
}

SettingFaults faultsOfFigures(const StereoSettings& s) {
  SettingFaults faults = faultsOfHead(s.head);
  if (!(s.eye_separation_m >= 0 && s.eye_separation_m <= kMostSeparation_m)) {
    faults.push_back(
        {"/stereo/eye_separation_m",
         fmt::format("is {}; allowed is 0 to {} m", s.eye_separation_m, kMostSeparation_m)});
  }
  if (!(s.screen_distance_m >= 0 && s.screen_distance_m <= kLargest_m)) {
    faults.push_back({"/stereo/screen_distance_m",
                      fmt::format("is {}; allowed is 0 to {} m", s.screen_distance_m, kLargest_m)});
  }
  const bool none = s.eyes_direction == std::array<double, 3>{};
  if (!none && !(Vector3d(s.eyes_direction.data()).norm() > 1e-3 &&
                 within(s.eyes_direction, -kLargest_m, kLargest_m))) {
    faults.push_back(
        {"/stereo/eyes_direction",
         fmt::format("is {}, which is not a direction; give x, y and z from the left to "
                     "the right eye, such as 1, 0, 0",
                     fmt::join(s.eyes_direction, ", "))});
  }
  return faults;
}

struct Halving {
  const char* what;
  int pixels;
};

std::optional<SettingFault> faultOfTile(const StereoSettings& s, const tiles::TileSettings& t,
                                        const tiles::TilesSettings& all) {
  if (t.name.size() > kLongestName) {
    return SettingFault{"/stereo/mode",
                        fmt::format("is {}: tile {} has a name of {} characters, and at most {} "
                                    "leave room for the .L or .R that each eye's tile adds",
                                    nameOf(s.mode), t.name, t.name.size(), kLongestName)};
  }
  const bool beside = s.mode == StereoMode::kSideBySide;
  if (s.size != EyeSize::kHalf || (!beside && s.mode != StereoMode::kTopBottom))
    return std::nullopt;
  const Halving half = beside ? Halving{"width", t.width > 0 ? t.width : all.tile_width}
                              : Halving{"height", t.height > 0 ? t.height : all.tile_height};
  if (half.pixels % 2 == 0) return std::nullopt;
  return SettingFault{"/stereo/size",
                      fmt::format("is half: tile {} has a {} of {} pixels, which cannot be halved; "
                                  "use an even number, or size full",
                                  t.name, half.what, half.pixels)};
}

// Finds eyes that are further apart than their middle is from the screen; otherwise both are in
// front of the screen.
std::optional<SettingFault> faultOfEyes(const StereoSettings& s, const tiles::TileSettings& left) {
  const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(left.screen_m.data());
  const Vector3d across = corners.col(1) - corners.col(0), up = corners.col(2) - corners.col(0);
  const double distance_m = -corners.col(0).dot(across.cross(up).normalized());
  if (s.eye_separation_m < distance_m) return std::nullopt;
  return SettingFault{
      "/stereo/eye_separation_m",
      fmt::format("is {} m, and the screen of tile {} is only {:.3g} m away: the eyes cannot be as "
                  "far apart as that; people's are 0.05 to 0.075 m",
                  s.eye_separation_m, left.name.substr(0, left.name.size() - 2), distance_m)};
}

// Returns a fault if, for the viewer of every screen, one eye is behind the other or the two are
// exchanged.
std::optional<SettingFault> faultOfDirection(const StereoSettings& s, const EyeTiles& eyes) {
  constexpr double kAgainst = -0.5, kBehind = 0.99;  // cosines
  if (s.eyes_direction == std::array<double, 3>{}) return std::nullopt;
  const Vector3d direction = Vector3d(s.eyes_direction.data()).normalized();
  for (const tiles::TileSettings& t : eyes.tiles.tiles) {
    if (t.eye != tiles::Eye::kLeft) continue;
    const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(t.screen_m.data());
    const Vector3d across = (corners.col(1) - corners.col(0)).normalized(),
                   up = corners.col(2) - corners.col(0);
    const double behind = direction.dot(across.cross(up).normalized());
    if (direction.dot(across) > kAgainst && std::abs(behind) < kBehind) return std::nullopt;
  }
  return SettingFault{
      "/stereo/eyes_direction",
      fmt::format("is {}: for every screen the right eye would be behind the left one, or to the "
                  "left of it; give x, y and z from the left to the right eye, such as 1, 0, 0",
                  fmt::join(s.eyes_direction, ", "))};
}

SettingFaults faultsOfTiles(const StereoSettings& s, const tiles::TilesSettings& tiles,
                            const EyeTiles& eyes) {
  const std::string mode = fmt::format("is {}", nameOf(s.mode));
  if (std::ranges::none_of(tiles.tiles, &tiles::TileSettings::followsWall))
    return {{"/stereo/mode", mode + ", and no tile follows the wall: there is nothing to see with "
                                    "two eyes"}};
  if (eyes.tiles.tiles.size() > tiles::kMostTiles)
    return {{"/stereo/mode", fmt::format("{}, which makes {} tiles; a wall has {} at most", mode,
                                         eyes.tiles.tiles.size(), tiles::kMostTiles)}};
  if (std::max(eyes.tiles.frame_width, eyes.tiles.frame_height) > tiles::kLargestFrame_px)
    return {{"/stereo/mode",
             fmt::format("{}, which needs a frame of {} x {} pixels; the largest is {} x {}", mode,
                         eyes.tiles.frame_width, eyes.tiles.frame_height, tiles::kLargestFrame_px,
                         tiles::kLargestFrame_px)}};
  for (const tiles::TileSettings& t : tiles.tiles) {
    if (!t.followsWall()) continue;
    if (auto fault = faultOfTile(s, t, tiles)) return {*std::move(fault)};
  }
  for (const tiles::TileSettings& t : eyes.tiles.tiles) {
    if (t.eye != tiles::Eye::kLeft) continue;
    if (auto fault = faultOfEyes(s, t)) return {*std::move(fault)};
  }
  if (auto fault = faultOfDirection(s, eyes)) return {*std::move(fault)};
  return {};
}

bool isPair(const std::string& name, const EyeTiles& eyes) {
  return std::ranges::any_of(eyes.tiles.tiles, [&](const tiles::TileSettings& t) {
    return t.eye == tiles::Eye::kLeft && t.name == name + ".L";
  });
}

bool isOnItsSide(const out::PlacedTile& p) {
  return p.turn == out::Turn::k90 || p.turn == out::Turn::k270;
}

// Finds pairs of eye pictures that are rotated by 90 or 270 degrees, which would be packed along
// the wrong edge of the signal, and pairs in mode two_outputs.
SettingFaults faultsOfPlaced(const StereoSettings& s,
                             const std::vector<out::OutputSettings>& outputs,
                             const EyeTiles& eyes) {
  SettingFaults faults;
  const bool packed = s.mode == StereoMode::kSideBySide || s.mode == StereoMode::kTopBottom;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < outputs[i].tiles.size(); ++k) {
      const out::PlacedTile& p = outputs[i].tiles[k];
      if (!isPair(p.tile, eyes)) continue;
      const std::string at = fmt::format("/outputs/{}/tiles/{}", i, k);
      if (s.mode == StereoMode::kTwoOutputs) {
        faults.push_back(
            {at + "/tile", fmt::format("is \"{0}\", which has two pictures in stereo mode "
                                       "two_outputs; name one eye's: {0}.L or {0}.R",
                                       p.tile)});
      } else if (packed && isOnItsSide(p)) {
        faults.push_back(
            {at + "/turn_deg",
             fmt::format("is {1}: stereo mode {2} packs both eyes' pictures of tile "
                         "{0} for an output that is not on its side; place {0}.L and "
                         "{0}.R each on its own",
                         p.tile, out::kTurnNames[static_cast<int>(p.turn)], nameOf(s.mode))});
      }
    }
  }
  return faults;
}

// Returns whether the correction moves or covers parts of the picture, so that it depends on their
// place.
bool dependsOnPlace(const correct::CorrectionSettings& c) {
  return c.corners != decltype(c.corners){} || !c.mesh.isOff() || !c.mpcdi.empty() ||
         c.blend.hasRamp() || !c.black.isOff();
}

// Finds corrections that depend on places in the picture, on outputs where the eyes' pictures are
// not the halves of the signal: a correction applies to the whole signal or to each half of it.
SettingFaults faultsOfCorrections(const StereoSettings& s, const EyeTiles& eyes) {
  SettingFaults faults;
  for (std::size_t i = 0; i < eyes.outputs.size(); ++i) {
    const out::OutputSettings& output = eyes.outputs[i];
    if (signalParts(output, eyes.tiles) || !dependsOnPlace(output.correction)) continue;
    faults.push_back(
        {fmt::format("/outputs/{}/correction", i),
         fmt::format("has corners, a mesh, ramps or a black level, which apply to each eye's half "
                     "of the signal, and in stereo mode {} the eyes' pictures of this output are "
                     "not its halves; let it show one tile (tiles), use mode two_outputs or "
                     "anaglyph, or only colour",
                     nameOf(s.mode))});
  }
  return faults;
}

// Returns the numbers of the outputs that name the tile.
std::vector<std::size_t> outputsOf(const std::string& tile,
                                   const std::vector<out::OutputSettings>& outputs) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (std::ranges::find(outputs[i].tiles, tile, &out::PlacedTile::tile) != outputs[i].tiles.end())
      found.push_back(i);
  }
  return found;
}

SettingFaults faultsOfTwoOutputs(const tiles::TilesSettings& tiles,
                                 const std::vector<out::OutputSettings>& outputs) {
  for (const tiles::TileSettings& t : tiles.tiles) {
    if (!t.followsWall()) continue;
    const auto left = outputsOf(t.name + ".L", outputs), right = outputsOf(t.name + ".R", outputs);
    const bool two = !left.empty() && !right.empty() &&
                     (left.size() > 1 || right.size() > 1 || left.front() != right.front());
    if (two) continue;
    return {{"/stereo/mode",
             fmt::format("is two_outputs, and tile {0} has no output for each eye: let one output "
                         "show {0}.L and another one {0}.R (/wall/outputs/N/tiles)",
                         t.name)}};
  }
  return {};
}

}  // namespace

SettingFaults validate(const StereoSettings& stereo, const tiles::TilesSettings& tiles,
                       const std::vector<out::OutputSettings>& outputs, double wall_distance_m) {
  SettingFaults faults = faultsOfFigures(stereo);
  if (!faults.empty() || !stereo.isOn()) return faults;
  const EyeTiles eyes = eyeTiles(stereo, tiles, outputs, wall_distance_m);
  faults = faultsOfTiles(stereo, tiles, eyes);
  if (faults.empty()) faults = faultsOfPlaced(stereo, outputs, eyes);
  if (faults.empty()) faults = faultsOfCorrections(stereo, eyes);
  if (faults.empty() && stereo.mode == StereoMode::kTwoOutputs)
    faults = faultsOfTwoOutputs(tiles, outputs);
  return faults;
}

SettingFaults doubtsOf(const StereoSettings& s) {
  constexpr double kWideEyes_m = 0.2, kFarScreen_m = 50;
  SettingFaults doubts;
  if (s.isOn() && s.eye_separation_m == 0) {
    doubts.push_back({"/stereo/eye_separation_m",
                      fmt::format("is 0 in stereo mode {}: both eyes see the same picture, without "
                                  "depth; people's are 0.05 to 0.075 m",
                                  nameOf(s.mode))});
  }
  if (s.isOn() && s.eye_separation_m > kWideEyes_m) {
    doubts.push_back({"/stereo/eye_separation_m",
                      fmt::format("is {} m: everything has {:.3g} times the parallax of eyes that "
                                  "are 0.063 m apart; is it meant in metres?",
                                  s.eye_separation_m, s.eye_separation_m / 0.063)});
  }
  if (s.screen_distance_m > kFarScreen_m) {
    doubts.push_back({"/stereo/screen_distance_m",
                      fmt::format("is {} m: what is nearer than that appears in front of the "
                                  "screen; is it meant in metres?",
                                  s.screen_distance_m)});
  }
  return doubts;
}

}  // namespace merlin::render::stereo
