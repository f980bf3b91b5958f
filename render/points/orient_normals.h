// Orients the normals of points consistently along the surface on which they lie. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::points {

// Reverses some normals so that the normals of neighbours agree. Goes from point to point along
// the minimum spanning forest of the graph of neighbours ([HOPPE92] section 3.3; README.md
// defines the comparison and the cost of edges). In each tree the normal of the highest point (z)
// faces upwards.
//
// positions   points x 3
// neighbours  points x k indices; the point itself may be among them
// normals     points x 3, of length 1
// returns     the number of trees, i.e. of connected parts of the graph
// cost        O(points k log(points k)); 12 k + 30 bytes per point
std::size_t orientAlike(std::span<const float> positions, std::span<const std::uint32_t> neighbours,
                        std::size_t k, std::span<double> normals);

}  // namespace merlin::render::points
