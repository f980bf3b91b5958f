// Computes the pose of a scanner from a few parameters.
#pragma once

#include <array>

#include "render/mesh/mesh.h"
#include "render/range/range_image.h"

namespace merlin::render::scan {

using Point = std::array<double, 3>;  // world coordinates [units]

// Returns the pose of a scanner at `from` that looks towards `at`. The image's upward direction is
// the world's y axis; if the scanner looks along the y axis, it is the negative z axis. REQUIRES:
// from != at; both are finite.
range::Pose lookAt(const Point& from, const Point& at);

// Returns the pose from which the sphere around the box just fits into the smaller one of the
// geometry's angles, with the box's centre in the middle of the image. `yaw_rad` and `pitch_rad`
// turn the box as in `merlin mesh picture`: first by the pitch about the horizontal axis, then by
// the yaw about the vertical axis.
range::Pose around(const mesh::Box& box, double yaw_rad, double pitch_rad,
                   const range::Geometry& geometry);

Point centreOf(const mesh::Box& box);

}  // namespace merlin::render::scan
