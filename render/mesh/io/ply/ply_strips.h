// Converts the triangle strips of PLY files ("element tristrips"), which the programs of some
// scanners write. Private to render/mesh/io/ply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace merlin::render::mesh::ply {

// Converts strips to triangles: each index forms a triangle with the two before it; every second
// triangle has two corners swapped, so that all face the same way. A repeated index, which strips
// use to change direction, forms no triangle.
class StripCutter {
 public:
  // Ends the strip; the next index begins a new one.
  void end() noexcept { length_ = 0; }
  // Takes the next index of the strip; appends the triangle that it completes, if any.
  void take(std::uint32_t index, std::vector<std::uint32_t>& triangles);

 private:
  std::uint32_t older_ = 0, last_ = 0;
  std::size_t length_ = 0;  // number of indices taken since the strip began
};

}  // namespace merlin::render::mesh::ply
