// Hand shapes: the joint angles of the postures that MERLIN ships, in CyberGlove slot order.
//
// Synthetic: drawn up from what the joints can do within the spans of the shipped calibration, not
// measured on a hand. The emulator bends its glove by them, and the shipped network is trained on
// them.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "drivers/port/samples.h"

namespace merlin::hand {

struct Shape {
  const char* name;
  std::array<float, kGloveSlots> angle_rad;  // flexion positive; slot 7 is 0 (not measured)
};

std::span<const Shape> shapes();                // the eight of the shipped network
std::span<const Shape> allShapes();             // these, and others that a hand can hold: 31
const Shape* findShape(std::string_view name);  // nullptr if there is none

}  // namespace merlin::hand
