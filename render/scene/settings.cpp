#include "render/scene/settings.h"

#include <cstdlib>

#include <fmt/format.h>

namespace merlin::render::scene {
namespace {

// Returns the handedness (+1 or -1) of a signed permutation of x, y, z; 0 if it is not a
// permutation.
int handedness(const std::array<int, 3>& axes) {
  int sign = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes[i] == 0 || axes[i] < -3 || axes[i] > 3) return 0;  // else abs() may overflow
    if (axes[i] < 0) sign = -sign;
    for (std::size_t j = 0; j < i; ++j) {
      const int a = std::abs(axes[j]), b = std::abs(axes[i]);
      if (a == b) return 0;
      if (a > b) sign = -sign;
    }
  }
  return sign;
}

}  // namespace

SettingFaults validate(const SceneSettings& s) {
  const std::array<int, 3>& axes = s.tracker_axes;
  if (handedness(axes) == 1) return {};
  return {
      {"/tracker_axes",
       fmt::format("tracker_axes {}, {}, {}: allowed is each of 1 to 3 once, with signs that make "
                   "the axes right-handed",
                   axes[0], axes[1], axes[2])}};
}

}  // namespace merlin::render::scene
