#include "render/mesh/io/ply/ply_strips.h"

namespace merlin::render::mesh::ply {

void StripCutter::take(std::uint32_t index, std::vector<std::uint32_t>& triangles) {
  const bool complete = length_ >= 2 && older_ != last_ && last_ != index && older_ != index;
  if (complete && length_ % 2 == 0) triangles.insert(triangles.end(), {older_, last_, index});
  if (complete && length_ % 2 == 1) triangles.insert(triangles.end(), {last_, older_, index});
  older_ = last_;
  last_ = index;
  ++length_;
}

}  // namespace merlin::render::mesh::ply
