// Settings of stereo, and of the tracker station that says where the viewer's head is.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/out/settings.h"
#include "render/tiles/settings.h"

namespace merlin::render::stereo {

// How the pictures of the two eyes reach them. In the order of kStereoModeNames.
enum class StereoMode {
  kOff,         // both eyes see the same picture
  kSideBySide,  // the left half of the signal is the left eye's
  kTopBottom,   // the upper half of the signal is the left eye's
  kAnaglyph,    // one picture in red and cyan
  kTwoOutputs,  // one output (a projector) for each eye
};
inline constexpr const char* kStereoModeNames[] = {"off", "side_by_side", "top_bottom", "anaglyph",
                                                   "two_outputs"};
inline constexpr const char* nameOf(StereoMode mode) {
  return kStereoModeNames[static_cast<int>(mode)];
}

// Size of each eye's picture in kSideBySide and kTopBottom. In the order of kEyeSizeNames.
enum class EyeSize {
  kHalf,  // half of the tile's width or height: both together are as large as the tile
  kFull,  // as large as the tile: both together are twice as wide or high
};
inline constexpr const char* kEyeSizeNames[] = {"half", "full"};

// The head tracker: its place in the room, and the noise that does not count as motion.
struct HeadSettings {
  std::string tracker;  // name of the tracker; empty: the first tracker
  int station = 0;      // the tracker's station on the viewer's head; 0: none
  // Position of the eyes in the room when the tracker measures (0, 0, 0): that of its transmitter
  // minus the vector from the eyes to the receiver on the head [m].
  std::array<double, 3> origin_m{};
  // The room's x (right), y (up), z (towards the person) as axes of the tracker (1 x, 2 y, 3 z,
  // negative: reversed).
  std::array<int, 3> axes = {-2, -3, 1};
  double scale = 1;  // metres of the room for a metre of the tracker
  // Distance or angle by which a head at rest has to move or turn until this counts as motion.
  double dead_band_m = 0.005, dead_band_deg = 2;
};

struct StereoSettings {
  StereoMode mode = StereoMode::kOff;
  EyeSize size = EyeSize::kHalf;
  double eye_separation_m = 0.063;
  // Distance of the screens of tiles that have none; 0: the wall's distance.
  double screen_distance_m = 0;
  // Direction from the left to the right eye of a viewer who is not tracked, a vector of any length
  // (x right, y up, z towards the person). All 0: along the tile in the middle of the wall.
  std::array<double, 3> eyes_direction{};
  HeadSettings head;

  bool isOn() const { return mode != StereoMode::kOff; }
};

// Checks for: eyes further apart than their screen is away, an eye that does not see a screen from
// the front, a tile that cannot be halved or whose name has no room for the eye's, an output that
// shows a tile in a way that the mode does not have, one whose correction would move or cover parts
// of both eyes' pictures where these are not the halves of the signal, two_outputs without two
// outputs; an eye direction that is undefined, or with which the eyes are behind each other or
// swapped for every screen; axes of the tracker that are not a right-handed permutation; values
// that are not numbers. Pointers are relative to /wall: "/stereo/mode", "/outputs/0/tiles/1". Other
// faults of the resulting tiles and outputs are found by their own validate(). Pure. `tiles`: those
// of the wall without stereo, without faults. `wall_distance_m`: distance that is assumed for the
// screens of tiles that have none, unless `stereo` gives one.
SettingFaults validate(const StereoSettings& stereo, const tiles::TilesSettings& tiles,
                       const std::vector<out::OutputSettings>& outputs, double wall_distance_m);

// Reports values that can be shown, but are probably not meant: eyes at one place, and distances
// that seem to be given in centimetres or millimetres. Pointers as for validate(). Pure.
SettingFaults doubtsOf(const StereoSettings& stereo);

}  // namespace merlin::render::stereo
