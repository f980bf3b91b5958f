#include "render/reduce/quadric/quadric_rules.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/reduce/quadric/star_lanes.h"

namespace merlin::render::reduce {
namespace {

// Maximum number of triangles in a star that a collapse may make; a larger star would be a fan of
// slivers.
constexpr std::uint32_t kMostDegree = 24;
// Minimum cosine of the angle between a face's normals before and after a collapse.
constexpr float kLeastCosine = 0.2F;

bool isIn(const Corner& corner, std::uint32_t v) { return corner.b == v || corner.c == v; }

// Returns true if the link condition holds: the ends have no common neighbours except those in the
// triangles that they share.
MERLIN_INLINE bool linkHolds(const QuadricView& view, const QuadricVertex& a,
                             const QuadricVertex& x, const EdgeCosts& costs, std::uint32_t edge) {
  const std::uint32_t shared = costs.shared[edge];
  if (shared == 2 && (a.flags & x.flags & kOpen))
    return false;  // the collapse would pinch the surface between two borders
  const Corner* star = view.corners + x.star;
  const bool open = x.flags & kOpen;
  Ints common = {};
  for (std::uint32_t first = 0; first < costs.count; first += 8) {
    const Ints ring = load(&costs.neighbour[first]);
    Ints hit = {};
    for (std::uint32_t k = 0; k < x.degree; ++k) {
      hit |= ring == all(star[k].b);
      if (open) hit |= ring == all(star[k].c);
    }
    common -= hit & (kLane < static_cast<std::int32_t>(costs.count - first));
  }
  return sum(common) == static_cast<std::int32_t>(shared);
}

// Returns true if each vertex opposite the edge keeps enough triangles after the collapse, which
// takes one from each: at least one on a border, or three in a closed fan.
MERLIN_INLINE bool sidesKeepEnough(const QuadricView& view, const QuadricVertex& a, std::uint32_t x,
                                   std::uint32_t edge) {
  const Corner* star = view.corners + a.star;
  const auto keeps = [&](std::uint32_t side) {
    const QuadricVertex& o = view.vertices[side];
    return trianglesOf(o) >= ((o.flags & kOpen) ? 2U : 4U);
  };
  // In a closed fan corner k belongs to edge k.
  if (!(a.flags & kOpen)) return keeps(star[edge].c) && keeps(star[(edge ? edge : a.degree) - 1].b);
  for (std::uint32_t k = 0; k < a.degree; ++k) {
    if (isIn(star[k], x) && !keeps(star[k].b == x ? star[k].c : star[k].b)) return false;
  }
  return true;
}

// Does what anyTurns() does, for a closed fan of up to eight triangles, which it tests all at once.
MERLIN_INLINE bool fanTurns(const QuadricView& view, const QuadricVertex& v, const float* origin,
                            const float* from, const float* to, std::uint32_t other) {
  const Ints ring = firsts(&view.corners[v.star].b, v.degree);
  std::uint32_t numbers[8];
  store(numbers, ring);
  Floats p0, p1, p2, unused;
  transpose([&](int k) { return view.vertices[numbers[k]].position; }, p0, p1, p2, unused);
  const Floats u0 = p0 - origin[0], u1 = p1 - origin[1], u2 = p2 - origin[2];
  const Floats e0 = next(p0) - p0, e1 = next(p1) - p1, e2 = next(p2) - p2;
  const Floats a0 = u0 - from[0], a1 = u1 - from[1], a2 = u2 - from[2];
  const Floats b0 = u0 - to[0], b1 = u1 - to[1], b2 = u2 - to[2];
  const Floats n0 = a1 * e2 - a2 * e1, n1 = a2 * e0 - a0 * e2, n2 = a0 * e1 - a1 * e0;
  const Floats m0 = b1 * e2 - b2 * e1, m1 = b2 * e0 - b0 * e2, m2 = b0 * e1 - b1 * e0;
  const Floats nn = n0 * n0 + n1 * n1 + n2 * n2, mm = m0 * m0 + m1 * m1 + m2 * m2;
  const Floats d = n0 * m0 + n1 * m1 + n2 * m2, size = d < 0.0F ? -d : d;
  const Ints fine = (d * size >= kLeastCosine * kLeastCosine * (nn * mm)) & ~((mm == 0) & (nn > 0));
  const Ints stays = (ring != all(other)) & (next(ring) != all(other)) &
                     (kLane < static_cast<std::int32_t>(v.degree));
  return simd::any(stays & ~fine);
}

// Returns true if a face of v's star turns too far (kLeastCosine) when v moves from `from` to `to`,
// both relative to `origin`. Ignores faces that contain `other`.
bool anyTurns(const QuadricView& view, const QuadricVertex& v, const float* origin,
              const float* from, const float* to, std::uint32_t other) {
  const Corner* star = view.corners + v.star;
  for (std::uint32_t k = 0; k < v.degree; ++k) {
    if (isIn(star[k], other)) continue;
    const float* p = view.vertices[star[k].b].position;
    const float* q = view.vertices[star[k].c].position;
    const float u0 = p[0] - origin[0], u1 = p[1] - origin[1], u2 = p[2] - origin[2];
    const float e0 = q[0] - p[0], e1 = q[1] - p[1], e2 = q[2] - p[2];
    const float a0 = u0 - from[0], a1 = u1 - from[1], a2 = u2 - from[2];
    const float b0 = u0 - to[0], b1 = u1 - to[1], b2 = u2 - to[2];
    const float n0 = a1 * e2 - a2 * e1, n1 = a2 * e0 - a0 * e2, n2 = a0 * e1 - a1 * e0;
    const float m0 = b1 * e2 - b2 * e1, m1 = b2 * e0 - b0 * e2, m2 = b0 * e1 - b1 * e0;
    const float nn = n0 * n0 + n1 * n1 + n2 * n2, mm = m0 * m0 + m1 * m1 + m2 * m2;
    const float d = n0 * m0 + n1 * m1 + n2 * m2;
    if (!(d * std::fabs(d) >= kLeastCosine * kLeastCosine * (nn * mm)) || (mm == 0 && nn > 0))
      return true;
  }
  return false;
}

MERLIN_INLINE bool turns(const QuadricView& view, const QuadricVertex& v, const float* origin,
                         const float* from, const float* to, std::uint32_t other) {
  return (v.flags & kOpen) || v.degree > 8 ? anyTurns(view, v, origin, from, to, other)
                                           : fanTurns(view, v, origin, from, to, other);
}

float segmentDistance2(const float* p, const float* a, const float* b) {
  float ee = 0, ed = 0;
  for (int k = 0; k < 3; ++k) {
    ee += (b[k] - a[k]) * (b[k] - a[k]);
    ed += (b[k] - a[k]) * (p[k] - a[k]);
  }
  const float t = ee > 0 ? std::clamp(ed / ee, 0.0F, 1.0F) : 0.0F;
  float sum = 0;
  for (int k = 0; k < 3; ++k) {
    const float d = p[k] - a[k] - t * (b[k] - a[k]);
    sum += d * d;
  }
  return sum;
}

// Does what borderNeighbours() does, for a star of more than kPairwise corners. O(corners).
std::size_t borderOfMany(const QuadricView& view, const QuadricVertex& v, std::uint32_t other,
                         std::uint32_t* found, std::size_t room, NumberTable& numbers) {
  constexpr std::uint32_t kIsB = 1, kIsC = 2;
  const std::span<const Corner> star(view.corners + v.star, v.degree);
  numbers.reset(2 * star.size());
  for (const Corner& c : star) {
    numbers[c.b] |= kIsB;
    numbers[c.c] |= kIsC;
  }
  std::size_t n = 0;
  for (const Corner& c : star) {
    if (!(numbers[c.b] & kIsC) && c.b != other && n < room) found[n++] = c.b;
    if (!(numbers[c.c] & kIsB) && c.c != other && n < room) found[n++] = c.c;
  }
  return n;
}

// Stores in `found` the neighbours of v along border edges, except `other`, at most `room` of them.
// Returns their number.
std::size_t borderNeighbours(const QuadricView& view, const QuadricVertex& v, std::uint32_t other,
                             std::uint32_t* found, std::size_t room, NumberTable& numbers) {
  if (v.degree > kPairwise) return borderOfMany(view, v, other, found, room, numbers);
  const Corner* star = view.corners + v.star;
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < v.degree; ++i) {
    bool b_again = false, c_again = false;
    for (std::uint32_t k = 0; k < v.degree; ++k) {
      b_again |= star[k].c == star[i].b;
      c_again |= star[k].b == star[i].c;
    }
    if (!b_again && star[i].b != other && n < room) found[n++] = star[i].b;
    if (!c_again && star[i].c != other && n < room) found[n++] = star[i].c;
  }
  return n;
}

// Returns true if v may be a corner of the last triangles of a component: its star is a closed fan
// of at most three triangles, or one triangle.
bool isLast(const QuadricVertex& v) {
  const std::uint32_t triangles = trianglesOf(v);
  return triangles <= 3 && !((v.flags & kOpen) && triangles > 1);
}

MERLIN_INLINE Verdict judge(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                            std::uint32_t edge, QuadricStage stage) {
  const QuadricVertex& a = view.vertices[w];
  const std::uint32_t x = costs.neighbour[edge];
  const QuadricVertex& v = view.vertices[x];
  const std::uint32_t shared = costs.shared[edge];
  const float to[] = {costs.x[edge], costs.y[edge], costs.z[edge]};
  const float here[] = {0, 0, 0}, there[] = {costs.rx[edge], costs.ry[edge], costs.rz[edge]};
  // Checks the star of a first, since it is in the cache while that of x is being loaded.
  const bool flips = stage != QuadricStage::kNoFlips && turns(view, a, a.position, here, to, x);
  for (std::uint32_t k = 0; k < v.degree; ++k)
    __builtin_prefetch(&view.vertices[view.corners[v.star + k].b]);
  if (keepsTopology(stage) && !vanishes(view, w, costs, edge)) {
    const std::uint32_t left = a.degree + v.degree - 2 * shared;
    if (shared > 2 || left < 1) return Verdict::kLink;
    if (left > kMostDegree && left > std::max(a.degree, v.degree)) return Verdict::kLink;
    if (!linkHolds(view, a, v, costs, edge) || !sidesKeepEnough(view, a, x, edge))
      return Verdict::kLink;
  }
  if (stage == QuadricStage::kNoFlips) return Verdict::kLegal;
  // Prefetches the stars that a collapse will write to.
  for (std::uint32_t k = 0; k < v.degree; ++k) {
    const QuadricVertex& ring = view.vertices[view.corners[v.star + k].b];
    __builtin_prefetch(view.corners + ring.star, 1);
  }
  return flips || turns(view, v, a.position, there, to, w) ? Verdict::kFlip : Verdict::kLegal;
}

Verdict judgePortable(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                      std::uint32_t edge, QuadricStage stage) {
  return judge(view, w, costs, edge, stage);
}

MERLIN_WIDE Verdict judgeWide(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                              std::uint32_t edge, QuadricStage stage) {
  return judge(view, w, costs, edge, stage);
}

}  // namespace

bool vanishes(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
              std::uint32_t edge) {
  const QuadricVertex &a = view.vertices[w], &x = view.vertices[costs.neighbour[edge]];
  if (a.degree + x.degree == 2 * costs.shared[edge]) return true;
  if (!isLast(a) || a.degree != 3) return false;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const QuadricVertex& o = view.vertices[view.corners[a.star + k].b];
    if (!isLast(o) || trianglesOf(o) != 3) return false;
  }
  return true;
}

float reachOf(const EdgeCosts& costs) {
  float reach = 0;
  for (std::uint32_t i = 0; i < costs.count; ++i) {
    reach = std::max(
        reach, costs.rx[i] * costs.rx[i] + costs.ry[i] * costs.ry[i] + costs.rz[i] * costs.rz[i]);
  }
  return reach;
}

JudgeEdge portableEdgeJudge() { return judgePortable; }

JudgeEdge edgeJudge() { return simd::pick(judgeWide, judgePortable); }

void stayAtLocked(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge) {
  const QuadricVertex &a = view.vertices[w], &x = view.vertices[costs.neighbour[edge]];
  if (a.flags & x.flags & kLocked) {
    costs.cost[edge] = kNoEdge;
    return;
  }
  const float r[] = {costs.rx[edge], costs.ry[edge], costs.rz[edge]};
  const bool here = a.flags & kLocked;
  const float* h = here ? x.h : a.h;  // quadric of the end that moves
  costs.x[edge] = here ? 0 : r[0];
  costs.y[edge] = here ? 0 : r[1];
  costs.z[edge] = here ? 0 : r[2];
  costs.cost[edge] = std::max(costs.cost[edge], std::min(costAt(h, r), kNoEdge));
}

void goAlongSeam(const QuadricView& view, std::uint32_t w, EdgeCosts& costs, std::uint32_t edge,
                 std::uint32_t twin, EdgeCosts& twin_costs, std::uint32_t twin_edge) {
  const float r[] = {costs.rx[edge], costs.ry[edge], costs.rz[edge]};
  const auto both = [&](std::uint32_t here, std::uint32_t there) {
    return costAt(view.vertices[here].h, r) + costAt(view.vertices[there].h, r);
  };
  const float go = both(w, twin);
  const float stay = both(costs.neighbour[edge], twin_costs.neighbour[twin_edge]);
  const float share = go < stay ? 1 : 0;
  const auto set = [&](EdgeCosts& of, std::uint32_t row) {
    of.x[row] = share * r[0];
    of.y[row] = share * r[1];
    of.z[row] = share * r[2];
    of.cost[row] = std::max(of.cost[row], std::min(std::min(go, stay), kNoEdge));
  };
  set(costs, edge);
  set(twin_costs, twin_edge);
}

float borderDeviation(const QuadricView& view, std::uint32_t w, EdgeCosts& costs,
                      std::uint32_t edge) {
  const std::uint32_t ends[] = {w, costs.neighbour[edge]};
  const float* origin = view.vertices[w].position;
  const float to[] = {origin[0] + costs.x[edge], origin[1] + costs.y[edge],
                      origin[2] + costs.z[edge]};
  std::uint32_t around[8];
  std::size_t n = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const QuadricVertex& v = view.vertices[ends[side]];
    if (v.flags & kOpen)
      n += borderNeighbours(view, v, ends[1 - side], around + n, 4, costs.numbers);
  }
  float deviation = 0;
  for (const std::uint32_t end : ends) {
    const QuadricVertex& v = view.vertices[end];
    if (!(v.flags & kOpen)) continue;
    float d = n == 0 ? segmentDistance2(v.position, to, to) : kNoEdge;
    for (std::size_t i = 0; i < n; ++i)
      d = std::min(d, segmentDistance2(v.position, to, view.vertices[around[i]].position));
    deviation = std::max(deviation, d + v.deviation);
  }
  return deviation;
}

}  // namespace merlin::render::reduce
