#include "render/reduce/quadric/whole_reduction.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "render/reduce/quadric/quadric_refresh.h"

namespace merlin::render::reduce {
namespace {

constexpr std::size_t kProgressTriangles = 1 << 16;  // removed between two progress calls

}  // namespace

void WholeReduction::run(std::size_t keep, const Progress& progress) {
  constexpr std::uint32_t kGrowth = 4, kNoneLeftOut = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t& most = s_.rules.most_corners;
  most = s_.rules.keepTopology() ? kMostCorners : kMostUnordered;
  for (;;) {
    s_.whole.refused_star = kNoneLeftOut;
    reduceTo(keep, progress);
    const std::uint32_t left_out = smallestLeftOut();
    if (left_out == kNoneLeftOut || s_.triangles <= keep || s_.cancelled) return;
    most = std::max(left_out, kGrowth * std::min(most, kNoneLeftOut / kGrowth));
  }
}

// Recomputes the quadrics and puts all living vertices into one queue.
void WholeReduction::requeue() {
  refreshQuadrics(s_);
  // s_.next first holds the costs, which are computed in parallel, then the links of the queue.
  const EvaluateEdges edges = edgeEvaluator(Evaluate::kEdges);
  forEachLiving(s_, [&](std::uint32_t v, EdgeCosts& costs) {
    const bool hub = s_.mesh[v].flags & kHub;
    if (!hub) edges(s_.view(), v, costs);
    s_.next[v] = std::bit_cast<std::uint32_t>(hub ? kNoEdge : costs.least());
  });
  s_.whole.queue = BucketQueue();
  for (std::uint32_t v = s_.mesh.vertexCount(); v-- > 0;) {
    if (!lives(s_.mesh[v])) continue;
    s_.mesh[v].flags &= static_cast<std::uint8_t>(~kIdle);
    s_.enqueue(s_.whole, v, std::bit_cast<float>(s_.next[v]));
  }
}

// Reduces until at most `keep` triangles are left, or no collapse is allowed with the present limit
// of the star size.
void WholeReduction::reduceTo(std::size_t keep, const Progress& progress) {
  requeue();
  CollapseWorker& w = s_.whole;
  while (s_.triangles > keep && !s_.cancelled) {
    w.removed = 0;
    loop_.reduceTo(w, std::min(s_.triangles - keep, kProgressTriangles), BucketQueue::buckets());
    if (w.removed == 0) return;
    s_.triangles -= w.removed;
    w.removed = 0;
    s_.cancelled = progress && !progress({w.collapses, s_.triangles});
  }
}

// Returns the number of triangles of the smallest star that exceeded the limit: either of a hub, or
// of a star that a refused collapse would have made. Returns the largest std::uint32_t if there is
// none.
std::uint32_t WholeReduction::smallestLeftOut() const {
  std::uint32_t smallest = s_.whole.refused_star;
  for (std::uint32_t v = 0; s_.hubs && v < s_.mesh.vertexCount(); ++v) {
    if (s_.mesh[v].flags & kHub) smallest = std::min(smallest, trianglesOf(s_.mesh[v]));
  }
  return smallest;
}

}  // namespace merlin::render::reduce
