// The cost of collapsing each edge of a vertex, and the position of the new vertex. Private to
// render/reduce.
//
// For the edge (w, x) the quadric is A = H_w + H_x: the area-weighted squared distance to the
// planes of both stars as they are now (memoryless: P. Lindstrom and G. Turk, "Fast and memory
// efficient polygonal simplification", 1998; area instead of area squared, as H. Hoppe, "New
// quadric metric for simplifying meshes with appearance attributes", 1999). The new vertex is the
// least of it, with a tiny pull to the middle of the edge where A leaves it free.
//
// Channels (Hoppe 1999, 4.1): a channel s is linear on each triangle, s(p) = g p + d. Its error is
// area times (g p + d - s)^2, its sums are kept relative to the vertex: a = sum area,
// b = sum area g, and G = sum area g g', which is added to H. For an edge the best s of each
// channel is a linear function of p and goes into A (Schur complement), so that it stays 3 x 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/number_table.h"
#include "render/reduce/quadric/quadric_mesh.h"

namespace merlin::render {

inline constexpr float kNoEdge = 1e30F;  // the cost of what must not be
// Stars of so many corners are searched by comparing each with each; larger ones by a table.
inline constexpr std::uint32_t kPairwise = 16;

// Values that cost, by vertex: one block {a, (b x, y, z, s) a channel} each. In mean edges.
class QuadricChannels {
 public:
  QuadricChannels() = default;
  QuadricChannels(std::size_t vertices, std::size_t channels)
      : count_(channels), blocks_(channels ? vertices * stride() : 0) {}

  std::size_t count() const noexcept { return count_; }
  std::size_t stride() const noexcept { return 1 + 4 * count_; }
  float* block(std::uint32_t v) const noexcept { return blocks_.data() + v * stride(); }
  // Loads the record of a vertex that will soon be read into the cache.
  void prefetch(std::uint32_t v) const noexcept {
    constexpr std::size_t kCacheLine = 64 / sizeof(float);
    const float* const first = block(v);
    for (const float* at = first; at < first + stride(); at += kCacheLine) __builtin_prefetch(at);
  }
  float& value(std::uint32_t v, std::size_t channel) const noexcept {
    return block(v)[4 + 4 * channel];
  }

 private:
  std::size_t count_ = 0;
  HugeArray<float> blocks_;
};

struct QuadricView {
  QuadricVertex* vertices;
  Corner* corners;
  const QuadricChannels* channels;
};

// Costs of all edges of one vertex. Arrays have one row per neighbour and room for 8 more. Scratch
// memory: one per thread.
struct EdgeCosts {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> neighbour;
  std::vector<std::uint32_t> shared;   // triangles that have both
  std::vector<std::uint32_t> b, c;     // of the star's corners: indices into `neighbour`
  std::vector<float> cost;             // kNoEdge at most
  std::vector<float> x, y, z;          // the new vertex, from w
  std::vector<float> rx, ry, rz;       // the neighbour, from w
  std::vector<float> deviation;        // squared; the reducer's, as the next, -1 at first
  std::vector<std::uint32_t> witness;  // whose is the farther: w's (0) or the neighbour's (1)
  NumberTable numbers;                 // scratch, for stars of more than kPairwise corners
  float normal[3] = {};                // sum of the star's unit normals
  std::uint32_t cheapest = 0;          // the first row of the least cost

  void makeRoom(std::size_t corners) {
    const std::size_t rows = 2 * corners + 16;
    if (neighbour.size() < rows) grow(rows);
  }
  // Whether w is where the new vertex of `edge` goes.
  bool staysAt(std::uint32_t edge) const noexcept {
    return x[edge] == 0 && y[edge] == 0 && z[edge] == 0;
  }
  float least() const noexcept { return cost[cheapest]; }
  // Sets `cheapest` anew.
  void findCheapest() noexcept;
  // Only so many edges, the cheapest, stay candidates; the others cost kNoEdge. O(count).
  void keepCheapest(std::size_t edges);

 private:
  void grow(std::size_t rows);
};

// How much is computed for a vertex w that has triangles.
enum class Evaluate {
  kQuadric,  // w's own quadric (and channels' sums) anew; EdgeCosts are scratch
  kEdges,    // what its edges cost, by its quadric and its neighbours' as they are
  kBoth,
};

// kQuadric reads of others what none writes, kEdges writes EdgeCosts alone: of many vertices each
// may be done at once.
using EvaluateEdges = void (*)(const QuadricView&, std::uint32_t w, EdgeCosts&);

// The fastest for this processor. All give the same bits.
EvaluateEdges edgeEvaluator(Evaluate what = Evaluate::kBoth);

// For tests: that of any processor.
EvaluateEdges portableEdgeEvaluator(Evaluate what = Evaluate::kBoth);

// Weight of a border's plane, in the planes of its triangles.
inline constexpr float kBorderWeight = 4;

}  // namespace merlin::render
