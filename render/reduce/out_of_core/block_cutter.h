// Cuts a mesh along the space-filling curve into pieces that are meshes of their own. Private to
// render/reduce.
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/mesh/mesh.h"

namespace merlin::render::reduce {

// A piece of a mesh, as a mesh of its own with the same features.
struct Block {
  mesh::Mesh mesh;
  std::vector<std::uint32_t> vertices;  // by vertex: its index in the whole mesh
  std::vector<bool> locked;             // by vertex: whether it must keep its position
};

// Pieces as ranges of vertices along the curve: [k stride, k stride + size) for k = first .. last.
struct Pieces {
  std::size_t stride, size, first, last;
};

// Memory: 4 bytes per vertex, 20 during construction. The mesh and `locked` must outlive it.
// Reentrant.
class BlockCutter {
 public:
  // locked: one entry per vertex of the mesh, or empty.
  BlockCutter(const mesh::Mesh& mesh, const std::vector<bool>& locked, Threads threads);

  // Cuts out all pieces in one pass over the triangles. A triangle belongs to the piece that
  // contains two or three of its vertices; with only the triangles whose three vertices are inside,
  // a collapse could create an edge that already exists outside the piece. Locks the vertices that
  // `locked` names, those with a neighbour outside the piece, and those outside the piece itself
  // (third vertices of triangles).
  std::vector<Block> cut(const Pieces& pieces) const;

 private:
  class Piece;

  const mesh::Mesh& mesh_;
  const std::vector<bool>& locked_;
  std::vector<std::uint32_t> place_;  // by vertex: its index along the curve
};

}  // namespace merlin::render::reduce
