// The connected parts of a mesh: which are closed, which of those face inwards, and how to turn
// these outwards.
//
// A part is a set of triangles that are connected by vertices. Where a surface ends, coincident
// vertices count as one, so that neither the seams of a texture nor triangles that share no vertex
// end it. Triangles with two corners at one place are ignored, but count as triangles of the part
// of their first corner and turn with it.
//
// A part is closed if each of its edges is used as often in the one direction as in the other, and
// if its volume is that of a layer thicker than about 1e-7 of its box's diagonal, which is what a
// float can tell: so a sheet with two sides is not closed.
//
// A closed part faces inwards if its volume, signed by the order of the triangles' corners, is
// negative, unless it is an inner wall, as of a hollow body, which faces inwards rightly: one that
// lies in the bounding box of a closed part that has no smaller volume and faces outwards. What
// faces outwards is never an error by this rule, also not the inner wall of a body that faces
// inwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct Part {
  bool closed = false;
  bool inwards = false;       // closed, and faces inwards by the rule above
  std::size_t triangles = 0;  // of a closed part; else 0
  double volume = 0;          // signed [model units^3]; 0 if it is not closed
};

struct Parts {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<Part> parts;             // in the order of their second vertices
  std::vector<std::uint32_t> part_of;  // by vertex: its part, or kNone
};

// Finds the parts. Whether edges are used equally often in both directions is decided by sums of
// hashes of positions, of 32 bits for each vertex: an open part is taken for closed with a chance
// of 2^-64 or less, unless the positions were crafted for it. If a coordinate of a vertex where the
// surface ends is not finite, no coincident vertices are joined. Expected O(n), and O(p log p) for
// p closed parts that do not overlap along some axis, O(p^2) for others up to 10^9 comparisons of
// boxes: parts that were not examined by then count as inner walls. Memory: 12 bytes per vertex,
// and 76 per part; before that, 8 per vertex and up to 36 per vertex where surfaces end (all
// vertices, if triangles share none). REQUIRES: every index is in range.
Parts partsOf(const Mesh& mesh);

// The same, but nothing if that takes more than `most_bytes` of memory beside the mesh, which are
// never exceeded.
std::optional<Parts> partsWithin(std::size_t most_bytes, const Mesh& mesh);

// Counts of closed parts.
struct Facing {
  std::size_t closed = 0;
  std::size_t inwards = 0;    // closed parts that face inwards
  std::size_t triangles = 0;  // of the parts that face inwards
};
Facing facingOf(const Parts& parts);

// Turns the triangles of each part that faces inwards, by exchanging their second and third
// corners; values of vertices stay with their vertices. The part's "normal" values are negated if
// on the whole they point to the side to which the triangles faced. Parts that are not closed, or
// face outwards, stay as they are. REQUIRES: `parts` are those of the mesh.
void turnOutwards(const Parts& parts, Mesh& mesh);

}  // namespace merlin::render::mesh
