#include "render/reduce/quadric/edge_collapser.h"

#include <algorithm>
#include <cstring>

#include "daemon/base/simd.h"
#include "render/reduce/quadric/quadric_witness.h"

namespace merlin::render::reduce {
namespace {

using TwoCorners = simd::Vector<std::uint32_t, 16>;

// Copies the corners of `star` to `to`, except those that contain `other`. Starts at the edge to
// `other`, so that the two fans of a collapse become one. Returns the end of the output. REQUIRES:
// room for all corners of the star.
Corner* appendStar(Corner* to, std::span<const Corner> star, std::uint32_t other) {
  std::size_t first = 0;
  while (first < star.size() && star[first].b != other) ++first;
  if (first == star.size()) {
    first = 0;
    while (first < star.size() && star[first].c != other) ++first;
  }
  const auto append = [&](std::span<const Corner> corners) {
    for (const Corner& c : corners) {
      *to = c;
      to += c.b != other && c.c != other;
    }
  };
  append(star.subspan(first));
  append(star.first(first));
  return to;
}

// Replaces x by v in a star. Processes whole lines, since entries after the last corner have no
// meaning.
void rename(Corner* star, std::uint32_t degree, std::uint32_t x, std::uint32_t v) {
  const TwoCorners old = {x, x, x, x}, change = TwoCorners{v, v, v, v} ^ old;
  for (std::uint32_t line = 0; line < degree; line += kLine) {
    for (std::uint32_t i = line; i < line + kLine; i += 2) {
      TwoCorners corners;
      std::memcpy(&corners, star + i, sizeof corners);
      corners ^= reinterpret_cast<TwoCorners>(corners == old) & change;
      std::memcpy(static_cast<void*>(star + i), &corners, sizeof corners);
    }
  }
}

}  // namespace

void EdgeCollapser::collapse(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t x = w.costs.neighbour[edge];
  QuadricVertex &a = s_.mesh[v], &b = s_.mesh[x];
  const float cost = w.costs.cost[edge];
  const std::uint32_t shared = w.costs.shared[edge];
  const float error = errorOf(a, b, cost);
  if (s_.channels.count() > 0) {
    const float p[] = {w.costs.x[edge], w.costs.y[edge], w.costs.z[edge]};
    const float q[] = {p[0] - w.costs.rx[edge], p[1] - w.costs.ry[edge], p[2] - w.costs.rz[edge]};
    // Vertex x dies; it keeps a copy of the values, for the new node in the log.
    s_.channels.mix(v, x, p, q);
  }
  mergeStars(w, v, x);
  NodeRecord record = mergeVertices(w.costs, v, edge);
  record.error = error;
  w.log[w.collapses++] = x;
  w.removed += shared;
  wakeRing(w, v, cost);
  if (a.degree > 0) {
    evaluate_(s_.view(), v, w.costs);
    std::copy_n(w.costs.normal, 3, record.normal);
    if (s_.rules.keepTopology() && seams_.twinOf(v) != kNowhere)
      seams_.addTwinNormal(v, record.normal);
  }
  setNodeRecord(b, record);
  if (!w.revived.empty()) reviveHubs(w, cost);
}

// Moves v to the new position; the neighbour in row `edge` dies and passes its flags, seam and
// witness on to v as far as they still apply. Returns the record of the new node, without error and
// normal.
NodeRecord EdgeCollapser::mergeVertices(const EdgeCosts& costs, std::uint32_t v,
                                        std::uint32_t edge) {
  const std::uint32_t x = costs.neighbour[edge];
  QuadricVertex &a = s_.mesh[v], &b = s_.mesh[x];
  const bool stays = (a.flags & kLocked) && costs.staysAt(edge);
  const bool to_b = (b.flags & kLocked) && s_.rules.keepTopology() && !stays;
  seams_.merge(v, x);
  a.flags |= b.flags & (kOpen | kLocked);
  if (!s_.rules.keepTopology()) a.flags |= kOpen;
  b.flags |= kDead;
  mergedInto(b) = v;
  const float border = (a.flags & kOpen) ? std::max(a.deviation, b.deviation) : 0;
  a.deviation = std::max(border, costs.deviation[edge]);
  const float step[] = {costs.x[edge], costs.y[edge], costs.z[edge]};
  float to[3];
  for (int k = 0; k < 3; ++k) to[k] = to_b ? b.position[k] : a.position[k] + step[k];
  if (!s_.rules.fast) keepWitness(a, costs.witness[edge] ? b : a, to);
  std::copy_n(to, 3, a.position);
  const NodeRecord record{{a.node, b.node}, {to[0], to[1], to[2]}, 0, {0, 0, 0}};
  a.node = s_.mesh.vertexCount() + x;
  return record;
}

// If vertex o is a hub, decrements its number of triangles. If the hub has become small, adds it to
// w.revived.
void EdgeCollapser::loseTriangle(CollapseWorker& w, std::uint32_t o) {
  QuadricVertex& hub = s_.mesh[o];
  if (!(hub.flags & kHub)) return;
  const std::uint32_t left = hubRecordOf(hub).triangles - 1;
  setHub(hub, left);
  if (left == s_.rules.most_corners / 2 && (!w.inside_only || (hub.flags & kInside)))
    w.revived.push_back(o);
}

// Turns the hubs in w.revived back into normal vertices and queues them.
void EdgeCollapser::reviveHubs(CollapseWorker& w, float cost) {
  const EvaluateEdges set = edgeEvaluator(Evaluate::kQuadric);
  for (const std::uint32_t hub : w.revived) {
    s_.mesh.tidyHub(hub);
    s_.mesh[hub].flags &= static_cast<std::uint8_t>(~(kHub | kIdle));
    set(s_.view(), hub, w.hub);
    w.queue.push(hub, cost, s_.nextOf());
  }
  w.revived.clear();
}

void EdgeCollapser::mergeStars(CollapseWorker& w, std::uint32_t v, std::uint32_t x) {
  QuadricVertex& b = s_.mesh[x];
  const std::span<Corner> sa = s_.mesh.star(s_.mesh[v]), sb = s_.mesh.star(b);
  if (w.merged.size() < sa.size() + sb.size()) w.merged.resize(2 * (sa.size() + sb.size()));
  Corner* const merged = w.merged.data();
  const Corner* const end = appendStar(appendStar(merged, sa, x), sb, v);
  const bool open = b.flags & kOpen;
  std::uint32_t before = open ? v : sb.back().b;
  for (const Corner& c : sb) {
    if (s_.hubs && (c.b == v || c.c == v)) loseTriangle(w, c.b == v ? c.c : c.b);
    // In a closed fan, the two vertices before and after v are adjacent to both ends of the edge.
    if (c.b != v) renameInRing(w, c.b, v, x, open || before == v || c.c == v);
    if (open && c.c != v) renameInRing(w, c.c, v, x, true);
    before = c.b;
  }
  storeStar(w, v, x, static_cast<std::uint32_t>(end - merged));
}

// Stores the first `corners` corners of w.merged as the star of v. Reuses the room of v or x if one
// of them is large enough.
void EdgeCollapser::storeStar(CollapseWorker& w, std::uint32_t v, std::uint32_t x,
                              std::uint32_t corners) {
  QuadricVertex &a = s_.mesh[v], &b = s_.mesh[x];
  if (corners <= a.capacity) {
    w.room.give(b.star, b.capacity);
  } else if (corners <= b.capacity) {
    w.room.give(a.star, a.capacity);
    a.star = b.star;
    a.capacity = b.capacity;
  } else {
    const QuadricVertex old_a = a;
    a.star = w.room.take(corners, a.capacity);
    w.room.give(old_a.star, old_a.capacity);
    w.room.give(b.star, b.capacity);
  }
  std::copy_n(w.merged.data(), corners, s_.mesh.corners(a.star));
  a.degree = corners;
  b.degree = 0;
}

// Replaces x by v in the star of o, a neighbour of x. If o is adjacent to both ends (`beside`),
// also removes the triangles that contained both.
void EdgeCollapser::renameInRing(CollapseWorker& w, std::uint32_t o, std::uint32_t v,
                                 std::uint32_t x, bool beside) {
  QuadricVertex& ring = s_.mesh[o];
  if (!s_.rules.keepTopology()) ring.flags |= kOpen;
  if (ring.flags & kHub) return;
  w.visited += ring.degree;
  Corner* star = s_.mesh.corners(ring.star);
  rename(star, ring.degree, x, v);
  if (!beside) return;
  const Corner* const end = star + ring.degree;
  Corner* to = star;
  for (const Corner* from = star; from < end; ++from) {
    const std::uint32_t b = from->b, c = from->c;
    *to = {b, c};
    to += b != c;
  }
  ring.degree = static_cast<std::uint32_t>(to - star);
}

// Puts neighbours of v that had no legal edge back into the queue with the key `cost`, as they may
// have a legal edge now.
void EdgeCollapser::wakeRing(CollapseWorker& w, std::uint32_t v, float cost) {
  const auto wake = [&](std::uint32_t o) {
    QuadricVertex& ring = s_.mesh[o];
    if ((ring.flags & (kIdle | kHub)) != kIdle) return;
    // A vertex with a large star is requeued only after some of the collapses, since evaluating it
    // visits all of its corners.
    const std::uint32_t rarely = ring.degree / kMostCorners;
    if (rarely > 0 && w.collapses % rarely != 0) return;
    ring.flags &= static_cast<std::uint8_t>(~kIdle);
    w.queue.push(o, cost, s_.nextOf());
  };
  for (const Corner& c : s_.mesh.star(s_.mesh[v])) {
    wake(c.b);
    if (s_.mesh[v].flags & kOpen) wake(c.c);
  }
}

}  // namespace merlin::render::reduce
