// The origin of a file's coordinates: positions are floats, which keep seven digits, and
// coordinates of maps have nine. Readers subtract an origin from them while they are still doubles.
// Pure.
#pragma once

#include <array>

namespace merlin::render::mesh {

// Where the mesh's (0, 0, 0) lies in the coordinates of its file [the file's unit]; 0 0 0 where
// nothing was subtracted.
using Origin = std::array<double, 3>;

// The origin for a mesh, a cloud or a scan with this point: a coordinate of 10^4 to 10^15, in
// either direction, is moved by its whole part; any other axis keeps its zero.
Origin originNear(const std::array<double, 3>& point) noexcept;

}  // namespace merlin::render::mesh
