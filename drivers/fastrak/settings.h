// What the configuration says of a Fastrak.
#pragma once

#include <array>

namespace merlin {

struct FastrakSettings {
  // For each station a vector, in the transmitter's frame, into the half of space where its
  // receiver is; {0, 0, 0} lets the unit follow it. Stations in use: what the unit reports as
  // active.
  std::array<std::array<float, 3>, 4> hemisphere = {{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}};
  // What the unit sends on the line, else inches; samples are in metres either way.
  bool centimetres = true;
};

}  // namespace merlin
