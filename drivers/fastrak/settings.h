// Settings of a Fastrak.
#pragma once

#include <array>

namespace merlin {

struct FastrakSettings {
  // For each station a vector, in the transmitter's frame, into the half of space where its
  // receiver is; {0, 0, 0} lets the unit follow it. Stations in use: what the unit reports as
  // active.
  std::array<std::array<float, 3>, 4> hemisphere = {{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}};
  // Whether the unit sends centimetres on the line, otherwise inches; samples are in metres either
  // way.
  bool centimetres = true;
  // How numbers are sent: IEEE floats, decimals, or 14-bit numbers (half the bytes, 0.4 mm and 0.02
  // degrees apart; boxes of before 2012).
  enum class Numbers { kBinary, kText, kShort };
  Numbers numbers = Numbers::kBinary;
  bool angles = false;  // azimuth, elevation, roll in place of the quaternion
  bool stylus = false;  // a stylus on station 1: its button comes with the records
  std::array<float, 3> stylus_tip_cm = {0, 0, 0};
  // For each station a point of the new origin, one on its x axis, one on its y axis, in the
  // transmitter's frame [cm]; as the unit's own at the start: (0 0 0) (200 0 0) (0 200 0).
  std::array<std::array<float, 9>, 4> alignment_cm = {kAligned, kAligned, kAligned, kAligned};
  // For each station the orientation that counts as straight ahead.
  std::array<std::array<float, 4>, 4> boresight_wxyz = {kAhead, kAhead, kAhead, kAhead};
  // The unit's own filters of positions and angles: sensitivity, low, high, factor; low and high
  // equal to 1: off.
  std::array<float, 4> position_filter = {0.2F, 0.2F, 0.8F, 0.95F};
  std::array<float, 4> angle_filter = {0.2F, 0.2F, 0.8F, 0.95F};

  static constexpr std::array<float, 9> kAligned = {0, 0, 0, 200, 0, 0, 0, 200, 0};
  static constexpr std::array<float, 4> kAhead = {1, 0, 0, 0};
};

}  // namespace merlin
