#include "render/reduce/quadric/quadric_evaluate.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "render/reduce/quadric/quadric_star.h"
#include "render/reduce/quadric/star_lanes.h"

namespace merlin::render::reduce {
namespace {

constexpr float kLeastCost = 1e-22F;
constexpr float kPull = 1e-5F;  // pull to the edge's midpoint, as a share of the quadric's trace

// Computes the costs of the edges of w, eight at a time. `channels`: whether there are channels.
template <bool channels>
struct Solver {
  const QuadricView& view;
  const float* wh;  // w's quadric
  const float* wc;  // w's channel block
  EdgeCosts& out;

  // One channel at eight neighbours x: the sum of area times gradient, and the value minus that at
  // w.
  struct Channel {
    Floats bx, by, bz, delta;
  };
  static constexpr std::size_t kKept = 8;  // channels whose data are kept between the two passes

  MERLIN_INLINE Channel channelOf(const std::uint32_t* x, std::size_t k) const {
    Channel c;
    transpose([&](int i) { return view.channels->block(x[i]) + 1 + 4 * k; }, c.bx, c.by, c.bz,
              c.delta);
    c.delta -= wc[4 + 4 * k];
    return c;
  }

  // Returns the sum of the areas of the triangles at each of eight neighbours x.
  MERLIN_INLINE Floats areasOf(const std::uint32_t* x) const {
    const auto at = [&](int i) { return view.channels->block(x[i])[0]; };
    return Floats{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
  }

  // Computes rows first .. first + 7 of `out` and returns their costs; rows from first + count on
  // get the cost kNoEdge. REQUIRES: room for 8 rows from `first`.
  MERLIN_INLINE Floats solve(const Neighbours<true>& at, std::uint32_t first,
                             std::uint32_t count) const {
    const std::uint32_t* x = &out.neighbour[first];
    const Floats(&h)[6] = at.h;
    const Floats &X = at.x, &Y = at.y, &Z = at.z;
    Floats A0 = h[0] + wh[0], A1 = h[1] + wh[1], A2 = h[2] + wh[2], A3 = h[3] + wh[3],
           A4 = h[4] + wh[4], A5 = h[5] + wh[5];
    const Floats pull = kPull * (A0 + A3 + A5) + kTiny;
    A0 += pull;
    A3 += pull;
    A5 += pull;
    const Floats half = pull * 0.5F;
    Floats r0 = h[0] * X + h[1] * Y + h[2] * Z + half * X;
    Floats r1 = h[1] * X + h[3] * Y + h[4] * Z + half * Y;
    Floats r2 = h[2] * X + h[4] * Y + h[5] * Z + half * Z;
    Channel kept[channels ? kKept : 1];
    const std::size_t n = channels ? view.channels->count() : 0;
    const Floats area = channels ? areasOf(x) : all(0.0F);
    const Floats s = channels ? 1.0F / (area + wc[0] + kTiny) : all(0.0F);
    // Eliminates the channel values: adds the terms of their optimum to the matrix A and to the
    // right-hand side.
    for (std::size_t k = 0; k < n; ++k) {
      const Channel c = channelOf(x, k);
      if (k < kKept) kept[k] = c;
      const float* wb = wc + 1 + 4 * k;
      const Floats b0 = c.bx + wb[0], b1 = c.by + wb[1], b2 = c.bz + wb[2];
      const Floats g = (area * c.delta - (c.bx * X + c.by * Y + c.bz * Z)) * s;
      A0 -= b0 * b0 * s;
      A1 -= b0 * b1 * s;
      A2 -= b0 * b2 * s;
      A3 -= b1 * b1 * s;
      A4 -= b1 * b2 * s;
      A5 -= b2 * b2 * s;
      r0 += g * b0 - c.delta * c.bx;
      r1 += g * b1 - c.delta * c.by;
      r2 += g * b2 - c.delta * c.bz;
    }
    // Solves A v = r by Cholesky factorisation without square roots (L D L').
    const Floats i0 = 1.0F / A0, l1 = A1 * i0, l2 = A2 * i0;
    const Floats d1 = A3 - l1 * A1, t = A4 - l1 * A2;
    const Floats i1 = 1.0F / d1, l3 = t * i1;
    const Floats d2 = A5 - l2 * A2 - l3 * t;
    const Floats y1 = r1 - l1 * r0, y2 = r2 - l2 * r0 - l3 * y1;
    const Floats z = y2 / d2, y = y1 * i1 - l3 * z, v = r0 * i0 - l1 * y - l2 * z;
    // Computes the cost as a sum of squares, to avoid cancellation.
    const Floats e0 = v - X, e1 = y - Y, e2 = z - Z;
    Floats f = v * (wh[0] * v + 2.0F * (wh[1] * y + wh[2] * z)) +
               y * (wh[3] * y + 2.0F * (wh[4] * z)) + z * z * wh[5] +
               e0 * (h[0] * e0 + 2.0F * (h[1] * e1 + h[2] * e2)) +
               e1 * (h[3] * e1 + 2.0F * (h[4] * e2)) + e2 * e2 * h[5];
    for (std::size_t k = 0; k < n; ++k) {
      const Channel c = k < kKept ? kept[k] : channelOf(x, k);
      const float* wb = wc + 1 + 4 * k;
      const Floats ofw = wb[0] * v + wb[1] * y + wb[2] * z;
      const Floats ofx = c.bx * e0 + c.by * e1 + c.bz * e2;
      const Floats best = (ofw + ofx + area * c.delta) * s;
      const Floats left = c.delta - best;
      f += best * (wc[0] * best - 2.0F * ofw) + left * (area * left + 2.0F * ofx);
    }
    f = f > kLeastCost ? f : (f == f ? all(kLeastCost) : all(kNoEdge));
    f = f < kNoEdge ? f : all(kNoEdge);
    f = kLane < static_cast<std::int32_t>(count) ? f : all(kNoEdge);
    store(&out.cost[first], f);
    store(&out.x[first], v);
    store(&out.y[first], y);
    store(&out.z[first], z);
    store(&out.deviation[first], all(-1.0F));
    return f;
  }
};

// Returns the lowest row number among the lanes with the lowest cost. rows: the row of each lane's
// cost.
MERLIN_INLINE std::uint32_t rowOfLeast(const Floats& costs, const Ints& rows) {
  const Ints cheapest = costs == simd::leastLane(costs) ? rows : all(~0U >> 1);
  return static_cast<std::uint32_t>(simd::leastLane(cheapest)[0]);
}

template <bool channels>
MERLIN_INLINE float* blockOf(const QuadricView& view, std::uint32_t vertex) {
  return channels ? view.channels->block(vertex) : nullptr;
}

// Evaluates a vertex with a closed fan of up to eight triangles.
template <bool channels, Evaluate what>
MERLIN_INLINE void evaluateFan(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  float* const block = blockOf<channels>(view, vertex);
  out.count = w.degree;
  store(out.neighbour.data(), firsts(&view.corners[w.star].b, w.degree));
  store(out.shared.data(), all(2U));
  const Neighbours<what != Evaluate::kQuadric> at(view, w, out.neighbour.data());
  if (what != Evaluate::kEdges) setOwnOfFan<channels>(view, w, at.x, at.y, at.z, out, block);
  store(out.rx.data(), at.x);
  store(out.ry.data(), at.y);
  store(out.rz.data(), at.z);
  if constexpr (what != Evaluate::kQuadric) {
    const Solver<channels> solver{view, w.h, block, out};
    out.cheapest = rowOfLeast(solver.solve(at, 0, w.degree), kLane);
  }
}

template <bool channels, Evaluate what>
MERLIN_INLINE void evaluateStar(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  float* const block = blockOf<channels>(view, vertex);
  findRing(view, w, out);
  if (what != Evaluate::kEdges) setOwn<channels>(view, w, out, block);
  if (what == Evaluate::kQuadric) return;
  const Solver<channels> solver{view, w.h, block, out};
  Floats costs = all(2 * kNoEdge);
  Ints rows = {};
  for (std::uint32_t i = 0; i < out.count; i += 8) {
    const Neighbours<true> at(view, w, &out.neighbour[i]);
    const Floats here = solver.solve(at, i, out.count - i);
    rows = here < costs ? kLane + static_cast<std::int32_t>(i) : rows;
    costs = here < costs ? here : costs;
  }
  out.cheapest = rowOfLeast(costs, rows);
}

MERLIN_INLINE bool isFan(const QuadricVertex& w) { return !(w.flags & kOpen) && w.degree <= 8; }

// Handles the cases for which evaluate() has no fast path.
template <Evaluate what>
MERLIN_INLINE void evaluateRare(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  const bool fan = isFan(view.vertices[vertex]);
  if (view.channels->count() == 0)
    evaluateStar<false, what>(view, vertex, out);
  else if (fan)
    evaluateFan<true, what>(view, vertex, out);
  else
    evaluateStar<true, what>(view, vertex, out);
}

// Evaluates a vertex. Most vertices are closed fans of up to eight triangles without channels; this
// fast path is compiled apart from the other cases (`rare`), so that it can use all registers.
template <Evaluate what>
MERLIN_INLINE void evaluate(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out,
                            EvaluateEdges rare) {
  const QuadricVertex& w = view.vertices[vertex];
  out.makeRoom(w.degree);
  if (view.channels->count() == 0 && isFan(w))
    evaluateFan<false, what>(view, vertex, out);
  else
    rare(view, vertex, out);
}

template <Evaluate what>
[[gnu::noinline]] void rarePortable(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  evaluateRare<what>(view, vertex, out);
}

template <Evaluate what>
void evaluatePortable(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  evaluate<what>(view, vertex, out, rarePortable<what>);
}

template <Evaluate what>
MERLIN_WIDE [[gnu::noinline]] void rareWide(const QuadricView& view, std::uint32_t vertex,
                                            EdgeCosts& out) {
  evaluateRare<what>(view, vertex, out);
}

template <Evaluate what>
MERLIN_WIDE void evaluateWide(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  evaluate<what>(view, vertex, out, rareWide<what>);
}

// Functions indexed by the values of Evaluate.
using Evaluators = std::array<EvaluateEdges, 3>;
constexpr Evaluators kPortable = {evaluatePortable<Evaluate::kQuadric>,
                                  evaluatePortable<Evaluate::kEdges>,
                                  evaluatePortable<Evaluate::kBoth>};
constexpr Evaluators kWide = {evaluateWide<Evaluate::kQuadric>, evaluateWide<Evaluate::kEdges>,
                              evaluateWide<Evaluate::kBoth>};

}  // namespace

void EdgeCosts::grow(std::size_t rows) {
  for (auto* list : {&neighbour, &shared, &b, &c, &witness}) list->resize(2 * rows);
  for (auto* list : {&cost, &x, &y, &z, &rx, &ry, &rz, &deviation}) list->resize(2 * rows);
}

void EdgeCosts::findCheapest() noexcept {
  cheapest = 0;
  for (std::uint32_t i = 1; i < count; ++i) {
    if (cost[i] < cost[cheapest]) cheapest = i;
  }
}

void EdgeCosts::keepCheapest(std::size_t edges) {
  if (count <= edges) return;
  std::vector<std::uint32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0U);
  const auto first_left_out = rows.begin() + static_cast<std::ptrdiff_t>(edges);
  std::nth_element(rows.begin(), first_left_out, rows.end(), [&](std::uint32_t i, std::uint32_t j) {
    return cost[i] < cost[j] || (cost[i] == cost[j] && i < j);
  });
  for (auto row = first_left_out; row != rows.end(); ++row) cost[*row] = kNoEdge;
}

EvaluateEdges portableEdgeEvaluator(Evaluate what) {
  return kPortable[static_cast<std::size_t>(what)];
}

EvaluateEdges edgeEvaluator(Evaluate what) {
  return simd::pick(&kWide, &kPortable)->at(static_cast<std::size_t>(what));
}

}  // namespace merlin::render::reduce
