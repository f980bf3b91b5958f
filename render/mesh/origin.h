// Chooses the origin that readers subtract from a file's coordinates while these are still doubles.
// Positions in MERLIN are floats with seven digits, but map coordinates have nine. Pure.
#pragma once

#include <array>

namespace merlin::render::mesh {

// The position of the mesh's (0, 0, 0) in the coordinates of its file [the file's unit]; 0 0 0 if
// nothing was subtracted.
using Origin = std::array<double, 3>;

// Returns the origin for a mesh, a cloud or a scan that contains this point. On an axis where the
// magnitude of the point's coordinate is 10^4 to 10^15, the origin is the coordinate's integer
// part; on any other axis it is 0.
Origin originNear(const std::array<double, 3>& point) noexcept;

}  // namespace merlin::render::mesh
