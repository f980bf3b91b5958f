// Names of a ball's six axes, as bindings and `merlin devices --watch` use them.
#pragma once

#include <string_view>

namespace merlin {

// In the order of BallSample: pushes along x, y and z, then twists about them.
inline constexpr std::string_view kAxisNames[] = {"x", "y", "z", "rx", "ry", "rz"};

}  // namespace merlin
