// Computes the cost of collapsing each edge of a vertex, and the position of the new vertex.
// Private to render/reduce.
//
// For the edge (w, x) the quadric is A = H_w + H_x: the area-weighted squared distance to the
// planes of the triangles that are now at both ends; earlier planes are forgotten (memoryless: P.
// Lindstrom and G. Turk, "Fast and memory efficient polygonal simplification", 1998; weighted by
// area instead of area squared, as in H. Hoppe, "New quadric metric for simplifying meshes with
// appearance attributes", 1999). The new vertex is placed at the minimum of A. A tiny additional
// pull towards the midpoint of the edge fixes the position in directions that A does not determine.
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
// In stars of at most this many corners, neighbours are found by comparing all pairs; in larger
// stars, with a hash table.
inline constexpr std::uint32_t kPairwise = 16;

struct QuadricView {
  QuadricVertex* vertices;
  Corner* corners;
  const QuadricChannels* channels;
};

// Costs of all edges of one vertex w. The arrays have one row per neighbour and room for 8 more
// rows. This is scratch memory: use one per thread.
struct EdgeCosts {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> neighbour;
  std::vector<std::uint32_t> shared;   // number of triangles that contain w and the neighbour
  std::vector<std::uint32_t> b, c;     // by corner of w's star: rows of its two other vertices
  std::vector<float> cost;             // cost of the collapse; kNoEdge if it is forbidden
  std::vector<float> x, y, z;          // position of the new vertex, relative to w
  std::vector<float> rx, ry, rz;       // position of the neighbour, relative to w
  std::vector<float> deviation;        // squared deviation; -1 until EdgeChoice::raise() sets it
  std::vector<std::uint32_t> witness;  // end whose witness is farther: w (0) or the neighbour (1)
  NumberTable numbers;                 // scratch, for stars of more than kPairwise corners
  float normal[3] = {};                // sum of the star's unit normals
  std::uint32_t cheapest = 0;          // the first row with the lowest cost

  void makeRoom(std::size_t corners) {
    const std::size_t rows = 2 * corners + 16;
    if (neighbour.size() < rows) grow(rows);
  }
  // Returns true if the new vertex of `edge` is at the position of w.
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

// Selects what to compute for a vertex w, which must have at least one triangle.
enum class Evaluate {
  kQuadric,  // the quadric and the channel sums of w; EdgeCosts is only scratch memory
  kEdges,    // the costs of w's edges, from the quadrics that w and its neighbours have
  kBoth,
};

// With kQuadric or kEdges, many vertices may be evaluated in parallel: kQuadric writes only the
// quadric and channel sums of w and reads those of no other vertex; kEdges writes only EdgeCosts.
using EvaluateEdges = void (*)(const QuadricView&, std::uint32_t w, EdgeCosts&);

// Returns the fastest implementation for this processor. All implementations return bit-identical
// results.
EvaluateEdges edgeEvaluator(Evaluate what = Evaluate::kBoth);

// For tests: returns the implementation that runs on any processor.
EvaluateEdges portableEdgeEvaluator(Evaluate what = Evaluate::kBoth);

// Weight of the quadric of a border edge, relative to that of a triangle's plane.
inline constexpr float kBorderWeight = 4;

}  // namespace merlin::render::reduce
