// BlockCutter: cuts a mesh along a space-filling curve into pieces, each of which is a mesh of its
// own. Private to render/reduce.
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/mesh/mesh.h"

namespace merlin::render::reduce {

// A piece of a mesh as an independent mesh; it has the same features as the whole mesh.
struct Block {
  mesh::Mesh mesh;
  std::vector<std::uint32_t> vertices;  // for each vertex of the piece: its index in the whole mesh
  // for each vertex of the piece: whether it must keep its position
  std::vector<bool> locked;
};

// Describes pieces as ranges of the vertices in curve order: piece k, for k = first .. last, has
// the vertices from k * stride to k * stride + size (exclusive).
struct Pieces {
  std::size_t stride, size, first, last;
};

// Takes 4 bytes of memory per vertex, 20 during construction. The mesh and `locked` must outlive
// the cutter. Reentrant.
class BlockCutter {
 public:
  // locked[v]: whether vertex v of the mesh must keep its position; empty if none must.
  BlockCutter(const mesh::Mesh& mesh, const std::vector<bool>& locked, Threads threads);

  // Cuts out all pieces in one pass over the triangles. A triangle belongs to the piece that
  // contains two or three of its vertices. (If only triangles with all three vertices inside
  // belonged to a piece, a collapse could create an edge that already exists outside the piece.)
  // These vertices of a piece are locked: those set in `locked`, those with a neighbour outside the
  // piece, and the third vertices of triangles, which lie outside the piece themselves.
  std::vector<Block> cut(const Pieces& pieces) const;

 private:
  class Piece;

  const mesh::Mesh& mesh_;
  const std::vector<bool>& locked_;
  std::vector<std::uint32_t> place_;  // by vertex: its index along the curve
};

}  // namespace merlin::render::reduce
