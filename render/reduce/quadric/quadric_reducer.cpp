#include "render/reduce/quadric/quadric_reducer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "daemon/base/blocks.h"

namespace merlin::render::reduce {
namespace {

// Number of edges, the cheapest ones, that a vertex with a large star tries (leaveOut()).
constexpr std::size_t kMostCandidates = 8;

using TwoCorners = std::uint32_t __attribute__((vector_size(16)));

float trace(const float* h) { return h[0] + h[3] + h[5]; }

// Appends the corners of `star` without `other`, starting at the edge to `other`, so that two fans
// become one. Returns the end. REQUIRES: room for all corners.
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

}  // namespace

QuadricReducer::QuadricReducer(const mesh::Mesh& mesh, std::size_t channels, Threads threads)
    : mesh_(mesh, threads),
      input_positions_(mesh.positions.data()),
      channels_(mesh.vertexCount(), channels),
      given_(channels),
      ranges_(channels),
      evaluate_(edgeEvaluator()),
      judge_(edgeJudge()),
      farther_(fartherWitness()),
      log_(mesh.vertexCount()),
      next_(mesh.vertexCount()),
      triangles_(mesh.triangleCount()),
      threads_(threads) {}

void QuadricReducer::setChannel(std::size_t channel, const float* values, std::size_t stride,
                                float scale) {
  const auto weighted = [&](float value) { return value * scale * mesh_.scale(); };
  Range given{values[0], values[0]};
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
    given = {std::min(given.low, values[v * stride]), std::max(given.high, values[v * stride])};
  forEach(threads_, mesh_.vertexCount(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    channels_.value(v, channel) = weighted(values[mesh_.inputOf(v) * stride]);
  });
  given_[channel] = given;
  ranges_[channel] = {weighted(given.low), weighted(given.high)};
}

void QuadricReducer::setLabels(const float* values) {
  labels_.resize(mesh_.vertexCount());
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v) labels_[v] = values[mesh_.inputOf(v)];
}

void QuadricReducer::lock(const std::vector<bool>& locked) {
  pinned_.assign(2 * std::size_t{mesh_.vertexCount()}, kNowhere);
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v) {
    if (!locked[mesh_.inputOf(v)]) continue;
    mesh_[v].flags |= kLocked;
    pinned_[mesh_.inputOf(v)] = mesh_.inputOf(v);
  }
}

void QuadricReducer::enqueue(Worker& w, std::uint32_t v, float cost) {
  if (cost >= kNoEdge)
    mesh_[v].flags |= kIdle;
  else
    w.queue.push(v, cost, nextOf());
}

// Most of the time is spent waiting for memory. So the data of the next five vertices are
// prefetched in stages: record, star, ring; each stage is two vertices ahead of the next, since a
// dead vertex takes little time. Always inlined: GCC would drop a call that only prefetches as
// having no effect.
[[gnu::always_inline]] inline void QuadricReducer::prefetch(Worker& w) const {
  const std::array<std::uint32_t, BucketQueue::kAhead>& next = w.queue.peek(nextOf());
  if (next[0] == BucketQueue::kNone) return;
  const bool channels = channels_.count() > 0;
  for (const Corner& c : mesh_.star(mesh_[next[0]])) {
    __builtin_prefetch(&mesh_[c.b]);
    if (channels) channels_.prefetch(c.b);
  }
  if (next[2] == BucketQueue::kNone) return;
  __builtin_prefetch(mesh_.corners(mesh_[next[2]].star));
  if (next[4] == BucketQueue::kNone) return;
  __builtin_prefetch(&mesh_[next[4]]);
  __builtin_prefetch(&next_[next[4]]);
}

void QuadricReducer::reduceTo(Worker& w, std::size_t removed, std::size_t bucket_limit) {
  while (w.removed < removed) {
    const std::uint32_t v = w.queue.pop(bucket_limit, nextOf());
    if (v == BucketQueue::kNone) return;
    prefetch(w);
    if (lives(mesh_[v])) tryVertex(w, v);
  }
}

// Returns the squared distance of the farther of the edge's two witnesses from the surface. If an
// estimate from the planes of each end's star would not raise the cost, returns that estimate; not
// for sharp vertices, where planes miss what a thin tip loses.
float QuadricReducer::witnessDeviation(Worker& w, std::uint32_t v, std::uint32_t edge) const {
  const QuadricVertex &a = mesh_[v], &x = mesh_[w.costs.neighbour[edge]];
  const EdgeCosts& c = w.costs;
  const float step[] = {c.x[edge], c.y[edge], c.z[edge]};
  const float back[] = {step[0] - c.rx[edge], step[1] - c.ry[edge], step[2] - c.rz[edge]};
  const float of_a = a.deviation + costAt(a.h, step) / trace(a.h);
  const float of_x = x.deviation + costAt(x.h, back) / trace(x.h);
  FartherWitness farther{std::max(of_a, of_x), of_x > of_a};
  if (((a.flags | x.flags) & kSharp) || !(deviationCost(farther.distance2) <= c.cost[edge]))
    farther = farther_(view(), v, w.costs, edge);
  w.costs.witness[edge] = farther.end;
  return farther.distance2;
}

// Raises the edge's cost, once, where the quadric underestimates the loss: at borders, seams,
// locked vertices, distant witnesses and vanishing components. Returns whether the cost has risen.
bool QuadricReducer::guard(Worker& w, std::uint32_t v, std::uint32_t edge) {
  float& deviation = w.costs.deviation[edge];
  if (deviation >= 0) return false;
  deviation = 0;
  const QuadricVertex &a = mesh_[v], &x = mesh_[w.costs.neighbour[edge]];
  w.visited += a.degree + x.degree;
  const std::uint8_t flags = a.flags | x.flags;
  const float before = w.costs.cost[edge];
  if (isAlongSeam(w.costs, v, edge))
    stayOnSeam(w, v, edge);
  else if ((flags & kLocked) && keepsTopology(stage_))
    stayAtLocked(view(), v, w.costs, edge);
  if (w.costs.cost[edge] >= kNoEdge) return before < kNoEdge;
  // The borders of a large unordered star do not describe a shape.
  const bool unordered = !keepsTopology(stage_) && a.degree + x.degree > 2 * kManyCorners;
  if ((flags & kOpen) && !unordered) deviation = borderDeviation(view(), v, w.costs, edge);
  if (!fast_) deviation = std::max(deviation, witnessDeviation(w, v, edge));
  if (keepsTopology(stage_) && vanishes(view(), v, w.costs, edge))
    deviation = std::max(deviation, reachOf(w.costs) + std::max(a.deviation, x.deviation));
  const float least = deviationCost(deviation);
  w.costs.cost[edge] = std::max(w.costs.cost[edge], least);
  return w.costs.cost[edge] > before;
}

void QuadricReducer::tryVertex(Worker& w, std::uint32_t v) {
  const std::size_t bucket = w.queue.current();
  const bool last = bucket + 1 == BucketQueue::buckets();
  // Evaluating a large unordered star again costs more than a better order of collapses gains.
  const bool large = !keepsTopology(stage_) && mesh_[v].degree > kManyCorners;
  const float ceiling = last || large ? kNoEdge : tolerance() * BucketQueue::floorOf(bucket + 1);
  evaluate(w, v);
  w.visited += mesh_[v].degree;
  EdgeCosts& costs = w.costs;
  if (!keepsTopology(stage_) || most_corners_ > kMostCorners) leaveOut(v, costs);
  for (;; costs.findCheapest()) {
    const std::uint32_t edge = costs.cheapest;
    const float cost = costs.cost[edge];
    if (cost >= kNoEdge) {
      mesh_[v].flags |= kIdle;
      return;
    }
    if (cost >= ceiling) {
      w.queue.push(v, cost, nextOf());
      return;
    }
    const std::uint32_t x = costs.neighbour[edge];
    __builtin_prefetch(mesh_.corners(mesh_[x].star));
    // For large stars the rules are checked first, since measuring takes longer.
    const bool many = mesh_[v].degree + mesh_[x].degree > 2 * kManyCorners;
    if (many && !isAlongSeam(costs, v, edge) && costs.deviation[edge] < 0 &&
        !mayCollapse(w, costs, v, edge)) {
      costs.cost[edge] = kNoEdge;
      continue;
    }
    if (guard(w, v, edge)) continue;
    if (isAlongSeam(costs, v, edge)) {
      if (collapseSeam(w, v, edge)) return;
    } else if (mayCollapse(w, costs, v, edge)) {
      collapse(w, v, edge);
      if (mesh_[v].degree > 0) enqueue(w, v, costs.least());
      return;
    }
    costs.cost[edge] = kNoEdge;
  }
}

// Trying an edge looks at both of its stars. To avoid O(n^2) for n corners, a large star tries only
// a few of its edges, and no vertex tries an edge to a larger vertex above the limit.
void QuadricReducer::leaveOut(std::uint32_t v, EdgeCosts& costs) const {
  for (std::uint32_t i = 0; most_corners_ > kMostCorners && i < costs.count; ++i) {
    const std::uint32_t there = mesh_[costs.neighbour[i]].degree;
    if (there > kMostCorners && there > mesh_[v].degree) costs.cost[i] = kNoEdge;
  }
  if (mesh_[v].degree > (keepsTopology(stage_) ? kMostCorners : kManyCorners))
    costs.keepCheapest(kMostCandidates);
  costs.findCheapest();
}

bool QuadricReducer::mayCollapse(Worker& w, const EdgeCosts& costs, std::uint32_t v,
                                 std::uint32_t edge) {
  if (w.inside_only && !(mesh_[costs.neighbour[edge]].flags & kInside)) return false;
  // At least one triangle stays. (A part needs no check: the rules of the first stage keep some.)
  if (!w.inside_only && costs.shared[edge] >= triangles_ - w.removed) return false;
  const bool locked = stage_ == QuadricStage::kAll && !labels_.empty() &&
                      labels_[v] != labels_[costs.neighbour[edge]];
  if (locked || (keep_components_ && keepsTopology(stage_) && vanishes(view(), v, costs, edge))) {
    ++w.links;
    return false;
  }
  const std::uint32_t star =
      mesh_[v].degree + mesh_[costs.neighbour[edge]].degree - 2 * costs.shared[edge];
  if (star > most_corners_) {
    w.refused_star = std::min(w.refused_star, star);
    ++w.links;
    return false;
  }
  const Verdict verdict = judge_(view(), v, costs, edge, stage_);
  if (verdict != Verdict::kLegal) {
    ++(verdict == Verdict::kFlip ? w.flips : w.links);
    return false;
  }
  if (!(errorOf(costs, v, edge) > max_error_)) return true;
  w.too_coarse = true;
  return false;
}

// Root mean square distance to the planes of both stars; unit: mean edge length.
float QuadricReducer::errorOf(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge) const {
  const float area = trace(mesh_[v].h) + trace(mesh_[costs.neighbour[edge]].h);
  return area > 0 ? std::sqrt(costs.cost[edge] / area) : 0;
}

void QuadricReducer::collapse(Worker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t x = w.costs.neighbour[edge];
  const float cost = w.costs.cost[edge];
  const std::uint32_t shared = w.costs.shared[edge];
  const float error = errorOf(w.costs, v, edge);
  if (channels_.count() > 0) mixChannels(v, x, w.costs, edge);
  mergeStars(w, v, x);
  QuadricVertex &a = mesh_[v], &b = mesh_[x];
  const bool stays = (a.flags & kLocked) && w.costs.staysAt(edge);
  const bool to_b = (b.flags & kLocked) && keepsTopology(stage_) && !stays;
  if (!twins_.empty() && !(a.flags & kLocked) && twins_[x] != kNowhere) {
    twins_[v] = twins_[x];
    twins_[twins_[v]] = v;
  }
  a.flags |= b.flags & (kOpen | kLocked);
  if (!keepsTopology(stage_)) a.flags |= kOpen;
  b.flags |= kDead;
  mergedInto(b) = v;
  const float border = (a.flags & kOpen) ? std::max(a.deviation, b.deviation) : 0;
  a.deviation = std::max(border, w.costs.deviation[edge]);
  const float step[] = {w.costs.x[edge], w.costs.y[edge], w.costs.z[edge]};
  float to[3];
  for (int k = 0; k < 3; ++k) to[k] = to_b ? b.position[k] : a.position[k] + step[k];
  if (!fast_) keepWitness(a, w.costs.witness[edge] ? b : a, to);
  std::copy_n(to, 3, a.position);
  NodeRecord record{
      {a.node, b.node}, {a.position[0], a.position[1], a.position[2]}, error, {0, 0, 0}};
  a.node = mesh_.vertexCount() + x;
  w.log[w.collapses++] = x;
  w.removed += shared;
  wakeRing(w, v, cost);
  if (a.degree > 0) {
    evaluate(w, v);
    std::copy_n(w.costs.normal, 3, record.normal);
    const bool seam = !twins_.empty() && twins_[v] != kNowhere && keepsTopology(stage_);
    if (seam) addNormalOf(twins_[v], record.normal);
  }
  std::memcpy(static_cast<void*>(b.position), &record, sizeof record);
  if (!w.revived.empty()) reviveHubs(w, cost);
}

// If o is a hub, decrements its number of triangles; a hub that has become small will be revived.
void QuadricReducer::loseTriangle(Worker& w, std::uint32_t o) {
  QuadricVertex& hub = mesh_[o];
  if (!(hub.flags & kHub)) return;
  const std::uint32_t left = hubRecordOf(hub).triangles - 1;
  setHub(hub, left);
  if (left == most_corners_ / 2 && (!w.inside_only || (hub.flags & kInside)))
    w.revived.push_back(o);
}

// Lets hubs that have become small take part again.
void QuadricReducer::reviveHubs(Worker& w, float cost) {
  const EvaluateEdges set = edgeEvaluator(Evaluate::kQuadric);
  for (const std::uint32_t hub : w.revived) {
    mesh_.tidyHub(hub);
    mesh_[hub].flags &= static_cast<std::uint8_t>(~(kHub | kIdle));
    set(view(), hub, w.hub);
    w.queue.push(hub, cost, nextOf());
  }
  w.revived.clear();
}

void QuadricReducer::mergeStars(Worker& w, std::uint32_t v, std::uint32_t x) {
  QuadricVertex &a = mesh_[v], &b = mesh_[x];
  const std::span<Corner> sa = mesh_.star(a), sb = mesh_.star(b);
  if (w.merged.size() < sa.size() + sb.size()) w.merged.resize(2 * (sa.size() + sb.size()));
  Corner* const merged = w.merged.data();
  const Corner* const end = appendStar(appendStar(merged, sa, x), sb, v);
  const bool open = b.flags & kOpen;
  std::uint32_t before = open ? v : sb.back().b;
  for (const Corner& c : sb) {
    if (hubs_ && (c.b == v || c.c == v)) loseTriangle(w, c.b == v ? c.c : c.b);
    // In a closed fan two vertices are adjacent to both ends: those before and after v.
    if (c.b != v) renameInRing(w, c.b, v, x, open || before == v || c.c == v);
    if (open && c.c != v) renameInRing(w, c.c, v, x, true);
    before = c.b;
  }
  const auto n = static_cast<std::uint32_t>(end - merged);
  if (n <= a.capacity) {
    w.room.give(b.star, b.capacity);
  } else if (n <= b.capacity) {
    w.room.give(a.star, a.capacity);
    a.star = b.star;
    a.capacity = b.capacity;
  } else {
    const QuadricVertex old_a = a;
    a.star = w.room.take(n, a.capacity);
    w.room.give(old_a.star, old_a.capacity);
    w.room.give(b.star, b.capacity);
  }
  std::copy_n(merged, n, mesh_.corners(a.star));
  a.degree = n;
  b.degree = 0;
}

// Replaces x by v in the star of o, a neighbour of x. If o is adjacent to both ends (`beside`),
// also removes the triangles that contained both.
void QuadricReducer::renameInRing(Worker& w, std::uint32_t o, std::uint32_t v, std::uint32_t x,
                                  bool beside) {
  QuadricVertex& ring = mesh_[o];
  if (ring.flags & kHub) {
    if (!keepsTopology(stage_)) ring.flags |= kOpen;
    return;
  }
  w.visited += ring.degree;
  Corner* star = mesh_.corners(ring.star);
  // Processes whole lines; entries after the last corner have no meaning.
  for (std::uint32_t line = 0; line < ring.degree; line += kLine) {
    for (std::uint32_t i = line; i < line + kLine; i += 2) {
      TwoCorners corners;
      std::memcpy(&corners, star + i, sizeof corners);
      corners ^= (corners == x) & (v ^ x);
      std::memcpy(static_cast<void*>(star + i), &corners, sizeof corners);
    }
  }
  if (!keepsTopology(stage_)) ring.flags |= kOpen;
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

// Puts neighbours that had no legal edge back into the queue, as they may have one now.
void QuadricReducer::wakeRing(Worker& w, std::uint32_t v, float cost) {
  const auto wake = [&](std::uint32_t o) {
    if ((mesh_[o].flags & (kIdle | kHub)) != kIdle) return;
    // A large star is not requeued at each change, since it would look at all its corners each
    // time.
    const std::uint32_t rarely = mesh_[o].degree / kMostCorners;
    if (rarely > 0 && w.collapses % rarely != 0) return;
    mesh_[o].flags &= static_cast<std::uint8_t>(~kIdle);
    w.queue.push(o, cost, nextOf());
  };
  for (const Corner& c : mesh_.star(mesh_[v])) {
    wake(c.b);
    if (mesh_[v].flags & kOpen) wake(c.c);
  }
}

// Sets the channels' values to the best ones for the new vertex. The dead vertex x keeps a copy, as
// the values of the node.
void QuadricReducer::mixChannels(std::uint32_t v, std::uint32_t x, const EdgeCosts& costs,
                                 std::uint32_t edge) {
  float *of_v = channels_.block(v), *of_x = channels_.block(x);
  const float p[] = {costs.x[edge], costs.y[edge], costs.z[edge]};
  const float q[] = {p[0] - costs.rx[edge], p[1] - costs.ry[edge], p[2] - costs.rz[edge]};
  const float area = of_v[0] + of_x[0];
  for (std::size_t k = 0; k < channels_.count(); ++k) {
    const float *b = of_v + 1 + 4 * k, *c = of_x + 1 + 4 * k;
    const float delta = c[3] - b[3];
    float s = area > 0 ? (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + c[0] * q[0] + c[1] * q[1] +
                          c[2] * q[2] + of_x[0] * delta) /
                             area
                       : delta / 2;
    if (!std::isfinite(s)) s = delta / 2;
    const float value = std::clamp(b[3] + s, ranges_[k].low, ranges_[k].high);
    channels_.value(v, k) = channels_.value(x, k) = value;
  }
}

}  // namespace merlin::render::reduce
