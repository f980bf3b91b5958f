// Finds the connected parts of a mesh, determines which are closed and which closed parts face
// inwards, and turns these outwards.
//
// A part is a set of triangles that are connected by vertices. Where a surface ends, coincident
// vertices count as one, so that a part continues across texture seams and between triangles that
// share no vertex. Triangles with two corners at the same position do not connect anything, but
// count as triangles of the part of their first corner and are turned with it.
//
// A part is closed if each of its edges is used as often in one direction as in the other, and if
// its volume is that of a layer thicker than about 1e-7 of the diagonal of its box, which is the
// resolution of a float; so a sheet with two sides is not closed.
//
// A closed part faces inwards if its volume, signed by the order of the triangles' corners, is
// negative and it is not an inner wall. An inner wall, as of a hollow body, faces inwards
// correctly; a part counts as one if it lies in the bounding box of a closed part that faces
// outwards and has no smaller volume. By this rule a part that faces outwards is never an error,
// not even the inner wall of a body that faces inwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct Part {
  bool closed = false;
  bool inwards = false;       // true if closed and facing inwards by the rule above
  std::size_t triangles = 0;  // number of triangles of a closed part; else 0
  double volume = 0;          // signed [model units^3]; 0 if it is not closed
};

struct Parts {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<Part> parts;             // in the order of the parts' second vertices
  std::vector<std::uint32_t> part_of;  // by vertex: index of its part; kNone if it has no part
};

// Finds the parts. To decide whether edges are used equally often in both directions, it compares
// sums of 32-bit hashes of positions, one sum per vertex: an open part is taken for closed with a
// probability of 2^-64 or less, unless the positions were crafted for it. If a vertex where the
// surface ends has a coordinate that is not finite, no coincident vertices are joined. Time:
// expected O(n), plus O(p log p) for p closed parts that do not overlap along some axis, else
// O(p^2), limited to 10^9 comparisons of boxes; parts that were not examined by then count as inner
// walls. Memory: 12 bytes per vertex and 76 per part; before that, 8 per vertex and up to 36 per
// vertex where surfaces end (all vertices, if triangles share none). REQUIRES: every index is in
// range.
Parts partsOf(const Mesh& mesh);

// Does what partsOf() does, but returns nothing if that would take more than `most_bytes` of memory
// in addition to the mesh. The limit is never exceeded.
std::optional<Parts> partsWithin(std::size_t most_bytes, const Mesh& mesh);

// Counts of closed parts.
struct Facing {
  std::size_t closed = 0;
  std::size_t inwards = 0;    // closed parts that face inwards
  std::size_t triangles = 0;  // number of triangles of the parts that face inwards
};
Facing facingOf(const Parts& parts);

// Turns each part that faces inwards: exchanges the second and third corners of its triangles. The
// values of vertices stay unchanged, except that the part's "normal" values are negated if most of
// them point to the side to which the triangles faced before. Parts that are not closed, or that
// face outwards, stay unchanged. REQUIRES: `parts` belongs to this mesh.
void turnOutwards(const Parts& parts, Mesh& mesh);

}  // namespace merlin::render::mesh
