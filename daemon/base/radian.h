// Degrees and radians.
#pragma once

#include <numbers>

namespace merlin {

// One degree, in radians.
template <typename Real>
inline constexpr Real kRadian = std::numbers::pi_v<Real> / 180;

}  // namespace merlin
