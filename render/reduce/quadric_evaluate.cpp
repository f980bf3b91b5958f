#include "render/reduce/quadric_evaluate.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/reduce/lanes.h"

namespace merlin::render {
namespace {

constexpr float kTiny = 1e-30F;
constexpr float kLeastCost = 1e-22F;
// Of a sharp vertex the mean of its faces' normals is shorter. A cone's is the sine of the angle
// between its axis and its side.
constexpr float kSharpMean = 0.6F;
constexpr float kPull = 1e-5F;  // to the middle of the edge, in the quadric's trace

MERLIN_INLINE Lanes inverseRoot(const Lanes& v) {
  Lanes r;
  for (int k = 0; k < 8; ++k) r[k] = __builtin_sqrtf(v[k]);
  return 1.0F / r;
}

// The quadric and the unit normals of up to eight triangles (0, u, v); nothing where they have no
// area.
struct Planes {
  Lanes h[6], normal[3];

  MERLIN_INLINE Planes(const Lanes& ux, const Lanes& uy, const Lanes& uz, const Lanes& vx,
                       const Lanes& vy, const Lanes& vz) {
    const Lanes x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const Lanes inverse = inverseRoot(x * x + y * y + z * z + kTiny);
    normal[0] = x * inverse;
    normal[1] = y * inverse;
    normal[2] = z * inverse;
    h[0] = normal[0] * x;
    h[1] = normal[0] * y;
    h[2] = normal[0] * z;
    h[3] = normal[1] * y;
    h[4] = normal[1] * z;
    h[5] = normal[2] * z;
  }
};

// The plane through the border's edge e that is as upright as can be: |e|^2 I - e e'.
MERLIN_INLINE void addBorder(float h[6], float x, float y, float z) {
  const float l = x * x + y * y + z * z;
  h[0] += kBorderWeight * (l - x * x);
  h[1] -= kBorderWeight * (x * y);
  h[2] -= kBorderWeight * (x * z);
  h[3] += kBorderWeight * (l - y * y);
  h[4] -= kBorderWeight * (y * z);
  h[5] += kBorderWeight * (l - z * z);
}

// Eight neighbours, one a lane: from w, and their `quadrics`.
template <bool quadrics>
struct Neighbours {
  Lanes x, y, z, h[6];

  MERLIN_INLINE Neighbours(const QuadricView& view, const QuadricVertex& w,
                           const std::uint32_t* numbers) {
    const auto at = [&](int k) -> const QuadricVertex& { return view.vertices[numbers[k]]; };
    gather<quadrics ? 4 : 3>([&](int k) { return at(k).position; }, x, y, z, h[0]);
    if (quadrics) {
      gather([&](int k) { return &at(k).h[1]; }, h[1], h[2], h[3], h[4]);
      h[5] = Lanes{at(0).h[5], at(1).h[5], at(2).h[5], at(3).h[5],
                   at(4).h[5], at(5).h[5], at(6).h[5], at(7).h[5]};
    }
    x -= w.position[0];
    y -= w.position[1];
    z -= w.position[2];
  }
};

// Eight edges at a time. `channels`: whether there are any.
template <bool channels>
struct Solver {
  const QuadricView& view;
  const float* wh;  // w's quadric
  const float* wc;  // and its channels' block
  EdgeCosts& out;

  // Of x: sum area g of a channel; its value less w's.
  struct Channel {
    Lanes bx, by, bz, delta;
  };
  static constexpr std::size_t kKept = 8;  // channels that are read once for both passes

  MERLIN_INLINE Channel channelOf(const std::uint32_t* x, std::size_t k) const {
    Channel c;
    gather([&](int i) { return view.channels->block(x[i]) + 1 + 4 * k; }, c.bx, c.by, c.bz,
           c.delta);
    c.delta -= wc[4 + 4 * k];
    return c;
  }

  // Of x: sum area.
  MERLIN_INLINE Lanes areasOf(const std::uint32_t* x) const {
    const auto at = [&](int i) { return view.channels->block(x[i])[0]; };
    return Lanes{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
  }

  // REQUIRES: room for 8 rows from `first`; count rows count. Returns their costs.
  MERLIN_INLINE Lanes solve(const Neighbours<true>& at, std::uint32_t first,
                            std::uint32_t count) const {
    const std::uint32_t* x = &out.neighbour[first];
    const Lanes(&h)[6] = at.h;
    const Lanes &X = at.x, &Y = at.y, &Z = at.z;
    Lanes A0 = h[0] + wh[0], A1 = h[1] + wh[1], A2 = h[2] + wh[2], A3 = h[3] + wh[3],
          A4 = h[4] + wh[4], A5 = h[5] + wh[5];
    const Lanes pull = kPull * (A0 + A3 + A5) + kTiny;
    A0 += pull;
    A3 += pull;
    A5 += pull;
    const Lanes half = pull * 0.5F;
    Lanes r0 = h[0] * X + h[1] * Y + h[2] * Z + half * X;
    Lanes r1 = h[1] * X + h[3] * Y + h[4] * Z + half * Y;
    Lanes r2 = h[2] * X + h[4] * Y + h[5] * Z + half * Z;
    Channel kept[channels ? kKept : 1];
    const std::size_t n = channels ? view.channels->count() : 0;
    const Lanes area = channels ? areasOf(x) : all(0.0F);
    const Lanes s = channels ? 1.0F / (area + wc[0] + kTiny) : all(0.0F);
    // The sums that A and the right side get once the channels' best values are put in.
    for (std::size_t k = 0; k < n; ++k) {
      const Channel c = channelOf(x, k);
      if (k < kKept) kept[k] = c;
      const float* wb = wc + 1 + 4 * k;
      const Lanes b0 = c.bx + wb[0], b1 = c.by + wb[1], b2 = c.bz + wb[2];
      const Lanes g = (area * c.delta - (c.bx * X + c.by * Y + c.bz * Z)) * s;
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
    // A v = r by Cholesky's method without roots.
    const Lanes i0 = 1.0F / A0, l1 = A1 * i0, l2 = A2 * i0;
    const Lanes d1 = A3 - l1 * A1, t = A4 - l1 * A2;
    const Lanes i1 = 1.0F / d1, l3 = t * i1;
    const Lanes d2 = A5 - l2 * A2 - l3 * t;
    const Lanes y1 = r1 - l1 * r0, y2 = r2 - l2 * r0 - l3 * y1;
    const Lanes z = y2 / d2, y = y1 * i1 - l3 * z, v = r0 * i0 - l1 * y - l2 * z;
    // The cost as a sum of squares: no difference of large numbers.
    const Lanes e0 = v - X, e1 = y - Y, e2 = z - Z;
    Lanes f = v * (wh[0] * v + 2.0F * (wh[1] * y + wh[2] * z)) +
              y * (wh[3] * y + 2.0F * (wh[4] * z)) + z * z * wh[5] +
              e0 * (h[0] * e0 + 2.0F * (h[1] * e1 + h[2] * e2)) +
              e1 * (h[3] * e1 + 2.0F * (h[4] * e2)) + e2 * e2 * h[5];
    for (std::size_t k = 0; k < n; ++k) {
      const Channel c = k < kKept ? kept[k] : channelOf(x, k);
      const float* wb = wc + 1 + 4 * k;
      const Lanes ofw = wb[0] * v + wb[1] * y + wb[2] * z;
      const Lanes ofx = c.bx * e0 + c.by * e1 + c.bz * e2;
      const Lanes best = (ofw + ofx + area * c.delta) * s;
      const Lanes left = c.delta - best;
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

// Sums over the planes of a star's triangles.
struct Sums {
  Lanes most = {};  // h, the normal's x and y
  float z = 0;      // the normal's

  Sums() = default;
  MERLIN_INLINE explicit Sums(const Planes& p)
      : most(sums({p.h[0], p.h[1], p.h[2], p.h[3], p.h[4], p.h[5], p.normal[0], p.normal[1]})),
        z(sum(p.normal[2])) {}

  MERLIN_INLINE void add(const Sums& other) {
    most += other.most;
    z += other.z;
  }
  // By pieces that registers hold: the quadric is read again at once.
  MERLIN_INLINE void store(QuadricVertex& w, EdgeCosts& out) const {
    const auto first = __builtin_shufflevector(most, most, 0, 1, 2, 3);
    const auto then = __builtin_shufflevector(most, most, 4, 5);
    const auto normal = __builtin_shufflevector(most, most, 6, 7);
    std::memcpy(w.h, &first, sizeof first);
    std::memcpy(w.h + 4, &then, sizeof then);
    std::memcpy(out.normal, &normal, sizeof normal);
    out.normal[2] = z;
  }
};

// A closed fan of up to eight: neighbours are the corners' first vertices, in order.
template <Evaluate what>
MERLIN_INLINE auto closedFan(const QuadricView& view, QuadricVertex& w, EdgeCosts& out) {
  out.count = w.degree;
  store(out.neighbour.data(), firsts(&view.corners[w.star].b, w.degree));
  store(out.shared.data(), all(2U));
  const Neighbours<what != Evaluate::kQuadric> at(view, w, out.neighbour.data());
  // Those beyond the last are the first again: the fan closes, then come triangles without area.
  if (what != Evaluate::kEdges)
    Sums(Planes(at.x, at.y, at.z, next(at.x), next(at.y), next(at.z))).store(w, out);
  store(out.rx.data(), at.x);
  store(out.ry.data(), at.y);
  store(out.rz.data(), at.z);
  return at;
}

// Neighbours of any star, each once, with how many triangles it shares.
void findNeighbours(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  const Corner* star = view.corners + w.star;
  out.count = 0;
  const auto indexOf = [&](std::uint32_t v) {
    std::uint32_t i = 0;
    while (i < out.count && out.neighbour[i] != v) ++i;
    if (i == out.count) {
      out.neighbour[i] = v;
      out.shared[i] = 0;
      ++out.count;
    }
    ++out.shared[i];
    return i;
  };
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    out.b[i] = indexOf(star[i].b);
    out.c[i] = indexOf(star[i].c);
  }
}

// Of a closed fan they are the corners' first vertices, in order.
void fanNeighbours(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  out.count = w.degree;
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    out.neighbour[i] = view.corners[w.star + i].b;
    out.shared[i] = 2;
    out.b[i] = i;
    out.c[i] = i + 1;
  }
  out.c[w.degree - 1] = 0;
}

// The triangles of up to eight corners.
MERLIN_INLINE Planes planesOf(const EdgeCosts& out, std::uint32_t first, std::uint32_t count) {
  float u[3][8], v[3][8];
  for (std::uint32_t k = 0; k < 8; ++k) {
    // Beyond the last, a triangle without area.
    const std::uint32_t b = out.b[first + k < count ? first + k : 0];
    const std::uint32_t c = first + k < count ? out.c[first + k] : b;
    u[0][k] = out.rx[b];
    u[1][k] = out.ry[b];
    u[2][k] = out.rz[b];
    v[0][k] = out.rx[c];
    v[1][k] = out.ry[c];
    v[2][k] = out.rz[c];
  }
  return {load(u[0]), load(u[1]), load(u[2]), load(v[0]), load(v[1]), load(v[2])};
}

MERLIN_INLINE void findRing(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  if (w.flags & kOpen)
    findNeighbours(view, w, out);
  else
    fanNeighbours(view, w, out);
  // Beyond the last the first again; a closed fan's last row of eight looks one further.
  store(&out.neighbour[out.count], all(out.neighbour[0]));
  store(&out.neighbour[out.count + 8], all(out.neighbour[0]));
  for (std::uint32_t first = 0; first < out.count + 8; first += 8) {
    const Neighbours<false> at(view, w, &out.neighbour[first]);
    store(&out.rx[first], at.x);
    store(&out.ry[first], at.y);
    store(&out.rz[first], at.z);
  }
}

// Of any star, once findRing() has been there.
MERLIN_INLINE void setQuadric(QuadricVertex& w, EdgeCosts& out) {
  const bool closed = !(w.flags & kOpen);
  const float *x = out.rx.data(), *y = out.ry.data(), *z = out.rz.data();
  Sums total;
  for (std::uint32_t k = 0; k < w.degree; k += 8) {
    total.add(Sums(closed ? Planes(load(x + k), load(y + k), load(z + k), load(x + k + 1),
                                   load(y + k + 1), load(z + k + 1))
                          : planesOf(out, k, w.degree)));
  }
  total.store(w, out);
  if (closed) return;
  for (std::uint32_t i = 0; i < out.count; ++i) {
    if (out.shared[i] == 1) addBorder(w.h, out.rx[i], out.ry[i], out.rz[i]);
  }
}

// The sums of w's channels, and what they add to its quadric.
MERLIN_INLINE void addChannels(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  const QuadricChannels& channels = *view.channels;
  float* block = channels.block(vertex);
  block[0] = 0;
  for (std::size_t k = 0; k < channels.count(); ++k) {
    float* b = block + 1 + 4 * k;
    b[0] = b[1] = b[2] = 0;
  }
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    const std::uint32_t ib = out.b[i], ic = out.c[i];
    const float ux = out.rx[ib], uy = out.ry[ib], uz = out.rz[ib];
    const float vx = out.rx[ic], vy = out.ry[ic], vz = out.rz[ic];
    const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const float l = nx * nx + ny * ny + nz * nz + kTiny;
    const float area = __builtin_sqrtf(l), inverse = 1 / l;
    // Rows of the gradient: s (v x n) + t (n x u), over n n.
    const float px = (vy * nz - vz * ny) * inverse, py = (vz * nx - vx * nz) * inverse,
                pz = (vx * ny - vy * nx) * inverse;
    const float qx = (ny * uz - nz * uy) * inverse, qy = (nz * ux - nx * uz) * inverse,
                qz = (nx * uy - ny * ux) * inverse;
    const float* atb = channels.block(out.neighbour[ib]);
    const float* atc = channels.block(out.neighbour[ic]);
    block[0] += area;
    for (std::size_t k = 0; k < channels.count(); ++k) {
      const float s = atb[4 + 4 * k] - block[4 + 4 * k], t = atc[4 + 4 * k] - block[4 + 4 * k];
      const float gx = s * px + t * qx, gy = s * py + t * qy, gz = s * pz + t * qz;
      const float ax = area * gx, ay = area * gy, az = area * gz;
      float* b = block + 1 + 4 * k;
      b[0] += ax;
      b[1] += ay;
      b[2] += az;
      w.h[0] += ax * gx;
      w.h[1] += ax * gy;
      w.h[2] += ax * gz;
      w.h[3] += ay * gy;
      w.h[4] += ay * gz;
      w.h[5] += az * gz;
    }
  }
}

// As addChannels(), of a closed fan of up to eight.
MERLIN_INLINE void addFanChannels(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  const QuadricChannels& channels = *view.channels;
  float* block = channels.block(vertex);
  const Lanes ux = load(out.rx.data()), uy = load(out.ry.data()), uz = load(out.rz.data());
  const Lanes vx = next(ux), vy = next(uy), vz = next(uz);
  const Lanes nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const Lanes l = nx * nx + ny * ny + nz * nz + kTiny;
  const Lanes inverse = 1.0F / l;
  Lanes area;
  for (int k = 0; k < 8; ++k) area[k] = __builtin_sqrtf(l[k]);
  const Lanes px = (vy * nz - vz * ny) * inverse, py = (vz * nx - vx * nz) * inverse,
              pz = (vx * ny - vy * nx) * inverse;
  const Lanes qx = (ny * uz - nz * uy) * inverse, qy = (nz * ux - nx * uz) * inverse,
              qz = (nx * uy - ny * ux) * inverse;
  const auto value = [&](int i, std::size_t k) {
    return channels.value(out.neighbour[static_cast<std::uint32_t>(i)], k);
  };
  Lanes g[6] = {};
  for (std::size_t k = 0; k < channels.count(); ++k) {
    float* b = block + 1 + 4 * k;
    const Lanes s = Lanes{value(0, k), value(1, k), value(2, k), value(3, k),
                          value(4, k), value(5, k), value(6, k), value(7, k)} -
                    b[3];
    const Lanes t = next(s);
    const Lanes gx = s * px + t * qx, gy = s * py + t * qy, gz = s * pz + t * qz;
    const Lanes ax = area * gx, ay = area * gy, az = area * gz;
    const Lanes sum = sums({ax, ay, az, all(0.0F), all(0.0F), all(0.0F), all(0.0F), all(0.0F)});
    for (int i = 0; i < 3; ++i) b[i] = sum[i];
    g[0] += ax * gx;
    g[1] += ax * gy;
    g[2] += ax * gz;
    g[3] += ay * gy;
    g[4] += ay * gz;
    g[5] += az * gz;
  }
  const Lanes sum = sums({g[0], g[1], g[2], g[3], g[4], g[5], area, all(0.0F)});
  for (int i = 0; i < 6; ++i) w.h[i] += sum[i];
  block[0] = sum[6];
}

// Whether w is a thin tip or a knife's edge.
MERLIN_INLINE void setSharp(QuadricVertex& w, const float* n) {
  const float upright = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const auto faces = static_cast<float>(w.degree);
  w.flags = static_cast<std::uint8_t>(w.flags & ~kSharp);
  if (upright < kSharpMean * kSharpMean * faces * faces) w.flags |= kSharp;
}

// The first of the cheapest, where `rows` are ascending in each lane.
MERLIN_INLINE std::uint32_t rowOfLeast(const Lanes& costs, const Mask& rows) {
  const Mask cheapest = costs == least(costs) ? rows : all(~0U >> 1);
  return static_cast<std::uint32_t>(least(cheapest)[0]);
}

template <bool channels>
MERLIN_INLINE Solver<channels> solverFor(const QuadricView& view, std::uint32_t vertex,
                                         EdgeCosts& out) {
  return {view, view.vertices[vertex].h, channels ? view.channels->block(vertex) : nullptr, out};
}

template <bool channels, Evaluate what>
MERLIN_INLINE void evaluateFan(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  const auto at = closedFan<what>(view, w, out);
  if (what != Evaluate::kEdges) {
    setSharp(w, out.normal);
    if (channels) addFanChannels(view, vertex, out);
  }
  if constexpr (what != Evaluate::kQuadric)
    out.cheapest = rowOfLeast(solverFor<channels>(view, vertex, out).solve(at, 0, w.degree), kLane);
}

template <bool channels, Evaluate what>
MERLIN_INLINE void evaluateStar(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  findRing(view, w, out);
  if (what != Evaluate::kEdges) {
    setQuadric(w, out);
    setSharp(w, out.normal);
    if (channels) addChannels(view, vertex, out);
  }
  if (what == Evaluate::kQuadric) return;
  const auto solver = solverFor<channels>(view, vertex, out);
  Lanes costs = all(2 * kNoEdge);
  Mask rows = {};
  for (std::uint32_t i = 0; i < out.count; i += 8) {
    const Neighbours<true> at(view, w, &out.neighbour[i]);
    const Lanes here = solver.solve(at, i, out.count - i);
    rows = here < costs ? kLane + static_cast<std::int32_t>(i) : rows;
    costs = here < costs ? here : costs;
  }
  out.cheapest = rowOfLeast(costs, rows);
}

MERLIN_INLINE bool isFan(const QuadricVertex& w) { return !(w.flags & kOpen) && w.degree <= 8; }

// All but what evaluate() is quick at.
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

// Most vertices are fans; what they need shares its registers with nothing else.
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

EvaluateEdges portableEdgeEvaluator(Evaluate what) {
  switch (what) {
    case Evaluate::kQuadric: return evaluatePortable<Evaluate::kQuadric>;
    case Evaluate::kEdges: return evaluatePortable<Evaluate::kEdges>;
    case Evaluate::kBoth: break;
  }
  return evaluatePortable<Evaluate::kBoth>;
}

EvaluateEdges edgeEvaluator(Evaluate what) {
  const auto wide = [&]() -> EvaluateEdges {
    switch (what) {
      case Evaluate::kQuadric: return evaluateWide<Evaluate::kQuadric>;
      case Evaluate::kEdges: return evaluateWide<Evaluate::kEdges>;
      case Evaluate::kBoth: break;
    }
    return evaluateWide<Evaluate::kBoth>;
  };
  return forThisProcessor(wide(), portableEdgeEvaluator(what));
}

}  // namespace merlin::render
