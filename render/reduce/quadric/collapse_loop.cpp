#include "render/reduce/quadric/collapse_loop.h"

#include <array>
#include <utility>

namespace merlin::render::reduce {

// Prefetches the data of the next five vertices in the queue, since a collapse spends most of its
// time waiting for memory. There are three stages: record, star, ring. They are two vertices apart,
// since a dead vertex takes little time. The function is always inlined, because GCC would remove a
// call that only prefetches as having no effect.
[[gnu::always_inline]] inline void CollapseLoop::prefetch(CollapseWorker& w) {
  const QuadricMesh& mesh = s_.mesh;
  const std::array<std::uint32_t, BucketQueue::kAhead>& next = w.queue.peek(s_.nextOf());
  if (next[0] == BucketQueue::kNone) return;
  const bool channels = s_.channels.count() > 0;
  for (const Corner& c : mesh.star(mesh[next[0]])) {
    __builtin_prefetch(&mesh[c.b]);
    if (channels) s_.channels.prefetch(c.b);
  }
  if (next[2] == BucketQueue::kNone) return;
  __builtin_prefetch(mesh.corners(mesh[next[2]].star));
  if (next[4] == BucketQueue::kNone) return;
  __builtin_prefetch(&mesh[next[4]]);
  __builtin_prefetch(&s_.next[next[4]]);
}

void CollapseLoop::reduceTo(CollapseWorker& w, std::size_t removed, std::size_t bucket_limit) {
  while (w.removed < removed) {
    const std::uint32_t v = w.queue.pop(bucket_limit, s_.nextOf());
    if (v == BucketQueue::kNone) return;
    prefetch(w);
    if (lives(s_.mesh[v])) tryVertex(w, v);
  }
}

void CollapseLoop::tryVertex(CollapseWorker& w, std::uint32_t v) {
  const QuadricMesh& mesh = s_.mesh;
  const CollapseRules& rules = s_.rules;
  const std::size_t bucket = w.queue.current();
  const bool last = bucket + 1 == BucketQueue::buckets();
  // A vertex with a large unordered star is not put back into the queue: evaluating the star again
  // costs more than a better order of collapses gains.
  const bool large = !rules.keepTopology() && mesh[v].degree > kManyCorners;
  const float ceiling =
      last || large ? kNoEdge : rules.tolerance() * BucketQueue::floorOf(bucket + 1);
  EdgeCosts& costs = w.costs;
  evaluate_(s_.view(), v, costs);
  w.visited += mesh[v].degree;
  if (!rules.keepTopology() || rules.most_corners > kMostCorners) choice_.leaveOut(v, costs);
  for (;; costs.findCheapest()) {
    const std::uint32_t edge = costs.cheapest;
    const float cost = costs.cost[edge];
    if (cost >= ceiling) {
      s_.enqueue(w, v, cost);
      return;
    }
    const std::uint32_t x = costs.neighbour[edge];
    __builtin_prefetch(mesh.corners(mesh[x].star));
    // For large stars the rules are checked before the cost is raised, since raise() takes longer
    // than the check.
    const bool many = mesh[v].degree + mesh[x].degree > 2 * kManyCorners;
    if (many && !seams_.isAlong(costs, v, edge) && costs.deviation[edge] < 0 &&
        !choice_.mayCollapse(w, costs, v, edge)) {
      costs.cost[edge] = kNoEdge;
      continue;
    }
    if (choice_.raise(w, v, edge)) continue;
    if (collapse(w, v, edge)) return;
    costs.cost[edge] = kNoEdge;
  }
}

// Collapses the edge if the rules allow it; if the edge is along a seam, also the coincident edge.
// Returns whether it collapsed anything. REQUIRES: raise() was called for the edge.
bool CollapseLoop::collapse(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) {
  if (seams_.isAlong(w.costs, v, edge)) return collapseSeam(w, v, edge);
  if (!choice_.mayCollapse(w, w.costs, v, edge)) return false;
  collapser_.collapse(w, v, edge);
  if (s_.mesh[v].degree > 0) s_.enqueue(w, v, w.costs.least());
  return true;
}

bool CollapseLoop::collapseSeam(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) {
  const QuadricMesh& mesh = s_.mesh;
  const std::uint32_t tv = seams_.twinOf(v), other = seams_.findTwinEdge(w, v, edge);
  if (other == kNowhere || (!w.inside_only && s_.triangles - w.removed <= 2)) return false;
  w.twin.x[other] = w.costs.x[edge];
  w.twin.y[other] = w.costs.y[edge];
  w.twin.z[other] = w.costs.z[edge];
  w.twin.cost[other] = w.costs.cost[edge];
  w.twin.deviation[other] = w.costs.deviation[edge];
  w.twin.witness[other] = w.costs.staysAt(edge);  // keep the witness of the end that moves
  if (!choice_.mayCollapse(w, w.costs, v, edge) || !choice_.mayCollapse(w, w.twin, tv, other))
    return false;
  const std::uint32_t x = w.costs.neighbour[edge], tx = w.twin.neighbour[other];
  collapser_.collapse(w, v, edge);
  if (mesh[v].degree > 0) s_.enqueue(w, v, w.costs.least());
  std::swap(w.costs, w.twin);
  collapser_.collapse(w, tv, other);
  seams_.shareNormal(tx, x);  // the normal at tx was computed after both sides had moved
  if ((mesh[tv].flags & kIdle) && mesh[tv].degree > 0) {  // otherwise it is already in the queue
    mesh[tv].flags &= static_cast<std::uint8_t>(~kIdle);
    s_.enqueue(w, tv, w.costs.least());
  }
  return true;
}

}  // namespace merlin::render::reduce
