// Triangle strips of PLY files ("element tristrips"), as some scanners' programs write them.
// Private to render/mesh/io/ply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace merlin::render::mesh::ply {

// Makes triangles of strips: each index makes one with the two before it, every other one with two
// corners swapped, so that all face the same way. Where an index is repeated, as strips do to turn,
// there is no triangle.
class StripCutter {
 public:
  // Ends the strip; the next index begins another one.
  void end() noexcept { length_ = 0; }
  // Appends the triangle that the index completes, if it does.
  void take(std::uint32_t index, std::vector<std::uint32_t>& triangles);

 private:
  std::uint32_t older_ = 0, last_ = 0;
  std::size_t length_ = 0;  // indices in this strip
};

}  // namespace merlin::render::mesh::ply
