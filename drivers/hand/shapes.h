// Hand shapes: the joint angles of the postures that MERLIN ships, in CyberGlove slot order.
//
// Synthetic: chosen within the joints' ranges of the default calibration, not measured on a hand.
// The emulated glove shows these shapes, and the shipped network is trained on them.
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

std::span<const Shape> shapes();                // the eight that the shipped network knows
std::span<const Shape> allShapes();             // these and others, 31 in all
const Shape* findShape(std::string_view name);  // nullptr if there is none

}  // namespace merlin::hand
