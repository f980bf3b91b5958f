// Where a scanner stands: its pose from a few numbers.
#pragma once

#include <array>

#include "render/mesh/mesh.h"
#include "render/range/range_image.h"

namespace merlin::render::scan {

using Point = std::array<double, 3>;  // world coordinates [units]

// At `from`, looking towards `at`, with the y axis upwards in the image; where it looks along that
// axis, the negative z axis. REQUIRES: from != at, finite.
range::Pose lookAt(const Point& from, const Point& at);

// So that the sphere around the box just fits into the smaller one of the geometry's angles, with
// the box's centre in the middle. The angles turn the box as those of `merlin mesh picture` do:
// first by the pitch about the horizontal axis, then by the yaw about the vertical axis.
range::Pose around(const mesh::Box& box, double yaw_rad, double pitch_rad,
                   const range::Geometry& geometry);

Point centreOf(const mesh::Box& box);

}  // namespace merlin::render::scan
