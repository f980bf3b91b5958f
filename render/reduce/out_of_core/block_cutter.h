// Cuts a mesh along the space-filling curve into pieces that are meshes of their own. Private to
// render/reduce.
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// A piece of a mesh as a mesh of its own, with the same features.
struct Block {
  Mesh mesh;
  std::vector<std::uint32_t> vertices;  // of the whole mesh
  std::vector<bool> locked;             // those, of vertices that something outside hangs on
};

// Which pieces, by places along the curve: [k stride, k stride + size) for k = first .. last.
struct Pieces {
  std::size_t stride, size, first, last;
};

// 8 bytes a vertex; 20 while it is made. The mesh and `locked` must outlive it. Reentrant.
class BlockCutter {
 public:
  // locked: one a vertex of the mesh, or empty.
  BlockCutter(const Mesh& mesh, const std::vector<bool>& locked, Threads threads);

  // In one pass over the mesh. A piece has the triangles with two or three corners in it: those of
  // two so that it makes no edge that is there already on the other side. What has a neighbour
  // outside is locked, and so are the third corners.
  std::vector<Block> cut(const Pieces& pieces) const;

 private:
  class Piece;

  const Mesh& mesh_;
  const std::vector<bool>& locked_;
  std::vector<std::uint32_t> place_;  // along the curve
};

}  // namespace merlin::render
