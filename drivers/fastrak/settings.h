// Settings of a Fastrak.
#pragma once

#include <array>

namespace merlin {

class SettingsVisitor;

inline constexpr int kFastrakBaud = 38400;  // factory setting of its line

struct FastrakSettings {
  // For each station a vector, in the transmitter's frame, that points into the hemisphere in which
  // its receiver is; with {0, 0, 0}, the unit tracks the hemisphere by itself. The stations in use
  // are those that the unit reports as active.
  std::array<std::array<float, 3>, 4> hemisphere = {{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}};
  // Whether the unit sends positions in centimetres instead of inches. Samples are in metres either
  // way.
  bool centimetres = true;
  // How numbers are sent: IEEE floats, decimal text, or 14-bit numbers (half the bytes; resolution
  // 0.4 mm and 0.02 degrees; only units made before 2012).
  enum class Numbers { kBinary, kText, kShort };
  Numbers numbers = Numbers::kBinary;
  bool angles = false;  // azimuth, elevation, roll instead of the quaternion
  bool stylus = false;  // station 1 is a stylus: its records include the button
  std::array<float, 3> stylus_tip_cm = {0, 0, 0};
  // For each station three points in the transmitter's frame [cm]: the new origin, one on the new x
  // axis, one on the new y axis. Default of the unit: (0 0 0) (200 0 0) (0 200 0).
  std::array<std::array<float, 9>, 4> alignment_cm = {kAligned, kAligned, kAligned, kAligned};
  // For each station the orientation that counts as straight ahead, a unit quaternion in the
  // station's aligned frame.
  std::array<std::array<float, 4>, 4> boresight_wxyz = {kAhead, kAhead, kAhead, kAhead};
  // The unit's low-pass filters of positions and angles: sensitivity, low, high, factor. If low and
  // high are 1, the filter is off.
  std::array<float, 4> position_filter = {0.2F, 0.2F, 0.8F, 0.95F};
  std::array<float, 4> angle_filter = {0.2F, 0.2F, 0.8F, 0.95F};

  static constexpr std::array<float, 9> kAligned = {0, 0, 0, 200, 0, 0, 0, 200, 0};
  static constexpr std::array<float, 4> kAhead = {1, 0, 0, 0};
};

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(FastrakSettings& tracker, SettingsVisitor& visitor);

}  // namespace merlin
