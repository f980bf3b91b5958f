// The cost of collapsing each edge of a vertex, and the position of the new vertex. Private to
// render/reduce.
//
// For the edge (w, x) the quadric is A = H_w + H_x: the area-weighted squared distance to the
// planes of both stars as they are now (memoryless: P. Lindstrom and G. Turk, "Fast and memory
// efficient polygonal simplification", 1998; area instead of area squared, as H. Hoppe, "New
// quadric metric for simplifying meshes with appearance attributes", 1999). The new vertex is at
// the minimum of A, with a tiny pull to the midpoint of the edge for the directions that A does not
// determine.
//
// Channels (Hoppe 1999, 4.1): a channel s is linear on each triangle, s(p) = g p + d. The error of
// a value s at p is area times (g p + d - s)^2. A vertex keeps the sums relative to its position:
// a = sum area, b = sum area g, and G = sum area g g', which is added to H. For an edge the best s
// of each channel is a linear function of p; eliminating it (Schur complement) leaves a 3 x 3
// system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/number_table.h"
#include "render/reduce/quadric/quadric_channels.h"
#include "render/reduce/quadric/quadric_mesh.h"

namespace merlin::render::reduce {

inline constexpr float kNoEdge = 1e30F;  // the cost of a forbidden collapse
// Stars of at most this many corners are searched by comparing all pairs; larger ones with a hash
// table.
inline constexpr std::uint32_t kPairwise = 16;

struct QuadricView {
  QuadricVertex* vertices;
  Corner* corners;
  const QuadricChannels* channels;
};

// Costs of all edges of one vertex w. Arrays have one row per neighbour and room for 8 more.
// Scratch memory: one per thread.
struct EdgeCosts {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> neighbour;
  std::vector<std::uint32_t> shared;   // number of triangles with w and the neighbour
  std::vector<std::uint32_t> b, c;     // by corner of w's star: indices into `neighbour`
  std::vector<float> cost;             // kNoEdge at most
  std::vector<float> x, y, z;          // the new vertex, relative to w
  std::vector<float> rx, ry, rz;       // the neighbour, relative to w
  std::vector<float> deviation;        // squared; -1 until the reducer sets it and `witness`
  std::vector<std::uint32_t> witness;  // FartherWitness::end: w (0) or the neighbour (1)
  NumberTable numbers;                 // scratch, for stars of more than kPairwise corners
  float normal[3] = {};                // sum of the star's unit normals
  std::uint32_t cheapest = 0;          // the first row with the lowest cost

  void makeRoom(std::size_t corners) {
    const std::size_t rows = 2 * corners + 16;
    if (neighbour.size() < rows) grow(rows);
  }
  // True if the new vertex of `edge` is at the position of w.
  bool staysAt(std::uint32_t edge) const noexcept {
    return x[edge] == 0 && y[edge] == 0 && z[edge] == 0;
  }
  float least() const noexcept { return cost[cheapest]; }
  // Recomputes `cheapest` from `cost`.
  void findCheapest() noexcept;
  // Keeps the `edges` cheapest edges as candidates and sets the cost of all others to kNoEdge.
  // O(count).
  void keepCheapest(std::size_t edges);

 private:
  void grow(std::size_t rows);
};

// What to compute for a vertex w, which must have triangles.
enum class Evaluate {
  kQuadric,  // the quadric and the channel sums of w; EdgeCosts is only scratch memory
  kEdges,    // the costs of w's edges, from the quadrics that w and its neighbours have
  kBoth,
};

// With kQuadric or kEdges alone, many vertices may be evaluated in parallel: kQuadric does not read
// the kind of data of other vertices that it writes, and kEdges writes only EdgeCosts.
using EvaluateEdges = void (*)(const QuadricView&, std::uint32_t w, EdgeCosts&);

// Returns the fastest implementation for this processor. All give the same bits.
EvaluateEdges edgeEvaluator(Evaluate what = Evaluate::kBoth);

// For tests: the implementation that runs on any processor.
EvaluateEdges portableEdgeEvaluator(Evaluate what = Evaluate::kBoth);

// Weight of a border edge's quadric, relative to those of the planes of triangles.
inline constexpr float kBorderWeight = 4;

}  // namespace merlin::render::reduce
