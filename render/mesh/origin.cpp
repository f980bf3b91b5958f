#include "render/mesh/origin.h"

#include <cmath>
#include <cstddef>

namespace merlin::render::mesh {

Origin originNear(const std::array<double, 3>& point) noexcept {
  constexpr double kNear = 1e4, kFar = 1e15;
  Origin origin{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = std::abs(point[k]);  // both comparisons are false for NaN
    if (size >= kNear && size <= kFar) origin[k] = std::floor(point[k]);
  }
  return origin;
}

}  // namespace merlin::render::mesh
