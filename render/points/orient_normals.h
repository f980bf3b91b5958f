// Turns the normals of points alike along the surface that they lie on. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::points {

// Turns each normal or leaves it, so that those of neighbours agree: from point to point along the
// minimum spanning forest of the graph of neighbours ([HOPPE92] section 3.3; README.md has what we
// compare and which edges are cheap). In each tree the normal of the highest point (z) faces
// upwards.
//
// positions   points x 3
// neighbours  points x k indices; the point itself may be among them
// normals     points x 3, of length 1
// returns     the number of trees: parts of the graph
// cost        O(points k log(points k)); 12 bytes for each of points x k, and 30 a point
std::size_t orientAlike(std::span<const float> positions, std::span<const std::uint32_t> neighbours,
                        std::size_t k, std::span<double> normals);

}  // namespace merlin::render::points
