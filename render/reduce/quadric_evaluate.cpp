#include "render/reduce/quadric_evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

// Lanes as wide as eight floats are passed to functions that are all inlined: the calling
// convention that GCC warns about is never used.
#pragma GCC diagnostic ignored "-Wpsabi"
#define MERLIN_INLINE [[gnu::always_inline]] inline

namespace merlin::render {
namespace {

using Lanes = float __attribute__((vector_size(32)));
using Mask = std::int32_t __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));

constexpr float kTiny = 1e-30F;
constexpr float kLeastCost = 1e-22F;
// Of a sharp vertex the mean of its faces' normals is shorter. A cone's is the sine of the angle
// between its axis and its side.
constexpr float kSharpMean = 0.6F;
constexpr float kPull = 1e-5F;  // to the middle of the edge, in the quadric's trace

MERLIN_INLINE Lanes all(float x) { return Lanes{x, x, x, x, x, x, x, x}; }
MERLIN_INLINE Lanes load(const float* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
MERLIN_INLINE void store(float* p, const Lanes& v) { std::memcpy(p, &v, sizeof v); }
MERLIN_INLINE float sum(const Lanes& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}
MERLIN_INLINE Lanes inverseRoot(const Lanes& v) {
  Lanes r;
  for (int k = 0; k < 8; ++k) r[k] = __builtin_sqrtf(v[k]);
  return 1.0F / r;
}

// Four floats of eight vertices each, as four lanes of eight.
MERLIN_INLINE void gather(const float* const p[8], Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  Quad q[8];
  for (int k = 0; k < 8; ++k) std::memcpy(&q[k], p[k], sizeof q[k]);
  const Lanes r0 = __builtin_shufflevector(q[0], q[4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r1 = __builtin_shufflevector(q[1], q[5], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r2 = __builtin_shufflevector(q[2], q[6], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r3 = __builtin_shufflevector(q[3], q[7], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes t0 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes t1 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes t2 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes t3 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}

// The next of each; `last` after the eighth.
MERLIN_INLINE Lanes next(const Lanes& v, float last) {
  return __builtin_shufflevector(v, all(last), 1, 2, 3, 4, 5, 6, 7, 8);
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

// Eight edges at a time: neighbours' quadrics, one a lane.
struct Solver {
  const QuadricView& view;
  const float* wh;  // w's quadric
  const float* wc;  // and its channels' block
  EdgeCosts& out;

  // Sums that A and the right side get from the channels of edge (w, x) once their best values are
  // put in; the same sums give the cost afterwards.
  struct Channel {
    Lanes bx, by, bz, a, delta;  // of x: sum area g, sum area; its value less w's
  };

  MERLIN_INLINE Channel channelOf(const std::uint32_t* x, std::size_t k) const {
    const float *p[8], *q[8];
    for (int i = 0; i < 8; ++i) {
      q[i] = view.channels->block(x[i]);
      p[i] = q[i] + 1 + 4 * k;
    }
    Channel c;
    gather(p, c.bx, c.by, c.bz, c.delta);
    c.delta -= wc[4 + 4 * k];
    for (int i = 0; i < 8; ++i) c.a[i] = q[i][0];
    return c;
  }

  // REQUIRES: room for 8 rows from `first`; count rows count.
  MERLIN_INLINE void solve(std::uint32_t first, std::uint32_t count) const {
    std::uint32_t x[8];
    const float* p[8];
    float xx[8], zz[8];
    for (std::uint32_t k = 0; k < 8; ++k) {
      x[k] = out.neighbour[first + (k < count ? k : 0)];
      p[k] = &view.vertices[x[k]].h[1];
      xx[k] = view.vertices[x[k]].h[0];
      zz[k] = view.vertices[x[k]].h[5];
    }
    Lanes h[6];
    h[0] = load(xx);
    h[5] = load(zz);
    gather(p, h[1], h[2], h[3], h[4]);
    const Lanes X = load(&out.rx[first]), Y = load(&out.ry[first]), Z = load(&out.rz[first]);
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
    for (std::size_t k = 0; k < view.channels->count(); ++k) {
      const Channel c = channelOf(x, k);
      const float* wb = wc + 1 + 4 * k;
      const Lanes b0 = c.bx + wb[0], b1 = c.by + wb[1], b2 = c.bz + wb[2];
      const Lanes s = 1.0F / (c.a + wc[0] + kTiny);
      const Lanes g = (c.a * c.delta - (c.bx * X + c.by * Y + c.bz * Z)) * s;
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
    for (std::size_t k = 0; k < view.channels->count(); ++k) {
      const Channel c = channelOf(x, k);
      const float* wb = wc + 1 + 4 * k;
      const Lanes ofw = wb[0] * v + wb[1] * y + wb[2] * z;
      const Lanes ofx = c.bx * e0 + c.by * e1 + c.bz * e2;
      const Lanes s = (ofw + ofx + c.a * c.delta) / (c.a + wc[0] + kTiny);
      const Lanes left = c.delta - s;
      f += s * (wc[0] * s - 2.0F * ofw) + left * (c.a * left + 2.0F * ofx);
    }
    const Mask lane = {0, 1, 2, 3, 4, 5, 6, 7};
    f = f > kLeastCost ? f : (f == f ? all(kLeastCost) : all(kNoEdge));
    f = f < kNoEdge ? f : all(kNoEdge);
    f = lane < static_cast<std::int32_t>(count) ? f : all(kNoEdge);
    store(&out.cost[first], f);
    store(&out.x[first], v);
    store(&out.y[first], y);
    store(&out.z[first], z);
  }
};

// A closed fan of up to eight: neighbours are the corners' first vertices, in order.
MERLIN_INLINE void closedFan(const QuadricView& view, QuadricVertex& w, EdgeCosts& out) {
  const Corner* star = view.corners + w.star;
  const std::uint32_t n = w.degree;
  const float* p[8];
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t v = star[k < n ? k : 0].b;
    out.neighbour[k] = v;
    out.shared[k] = 2;
    p[k] = view.vertices[v].position;
  }
  out.count = n;
  Lanes x, y, z, unused;
  gather(p, x, y, z, unused);
  x -= w.position[0];
  y -= w.position[1];
  z -= w.position[2];
  const Planes planes(x, y, z, next(x, x[0]), next(y, y[0]), next(z, z[0]));
  for (int k = 0; k < 6; ++k) w.h[k] = sum(planes.h[k]);
  for (int k = 0; k < 3; ++k) out.normal[k] = sum(planes.normal[k]);
  store(out.rx.data(), x);
  store(out.ry.data(), y);
  store(out.rz.data(), z);
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
  for (std::uint32_t i = 0; i < out.count + 8; ++i) {
    const float* p = view.vertices[out.neighbour[i < out.count ? i : 0]].position;
    out.rx[i] = p[0] - w.position[0];
    out.ry[i] = p[1] - w.position[1];
    out.rz[i] = p[2] - w.position[2];
  }
}

MERLIN_INLINE void anyStar(const QuadricView& view, QuadricVertex& w, EdgeCosts& out) {
  findNeighbours(view, w, out);
  float h[6] = {}, normal[3] = {};
  for (std::uint32_t first = 0; first < w.degree; first += 8) {
    float u[3][8], v[3][8];
    for (std::uint32_t k = 0; k < 8; ++k) {
      // Beyond the last, a triangle without area.
      const std::uint32_t b = out.b[first + k < w.degree ? first + k : 0];
      const std::uint32_t c = first + k < w.degree ? out.c[first + k] : b;
      u[0][k] = out.rx[b];
      u[1][k] = out.ry[b];
      u[2][k] = out.rz[b];
      v[0][k] = out.rx[c];
      v[1][k] = out.ry[c];
      v[2][k] = out.rz[c];
    }
    const Planes planes(load(u[0]), load(u[1]), load(u[2]), load(v[0]), load(v[1]), load(v[2]));
    for (int k = 0; k < 6; ++k) h[k] += sum(planes.h[k]);
    for (int k = 0; k < 3; ++k) normal[k] += sum(planes.normal[k]);
  }
  for (std::uint32_t i = 0; i < out.count; ++i) {
    if (out.shared[i] == 1) addBorder(h, out.rx[i], out.ry[i], out.rz[i]);
  }
  std::memcpy(w.h, h, sizeof h);
  std::memcpy(out.normal, normal, sizeof normal);
}

// The sums of w's channels, and what they add to its quadric.
MERLIN_INLINE void addChannels(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out,
                               bool closed) {
  QuadricVertex& w = view.vertices[vertex];
  const QuadricChannels& channels = *view.channels;
  float* block = channels.block(vertex);
  block[0] = 0;
  for (std::size_t k = 0; k < channels.count(); ++k) {
    float* b = block + 1 + 4 * k;
    b[0] = b[1] = b[2] = 0;
  }
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    const std::uint32_t ib = closed ? i : out.b[i];
    const std::uint32_t ic = closed ? (i + 1 < w.degree ? i + 1 : 0) : out.c[i];
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

MERLIN_INLINE void evaluate(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  QuadricVertex& w = view.vertices[vertex];
  out.makeRoom(w.degree);
  const bool small = !(w.flags & kOpen) && w.degree <= 8;
  if (small)
    closedFan(view, w, out);
  else
    anyStar(view, w, out);
  const float* n = out.normal;
  const float upright = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const auto faces = static_cast<float>(w.degree);
  w.flags = static_cast<std::uint8_t>(w.flags & ~kSharp);
  if (upright < kSharpMean * kSharpMean * faces * faces) w.flags |= kSharp;
  const float* block = nullptr;
  if (view.channels->count() > 0) {
    addChannels(view, vertex, out, small);
    block = view.channels->block(vertex);
  }
  const Solver solver{view, w.h, block, out};
  for (std::uint32_t i = 0; i < out.count; i += 8) solver.solve(i, std::min(8U, out.count - i));
}

void evaluatePortable(const QuadricView& view, std::uint32_t vertex, EdgeCosts& out) {
  evaluate(view, vertex, out);
}

#if defined(__x86_64__)
// The same text: wider registers, no fused operation, so the same bits.
__attribute__((target("avx2"))) void evaluateAvx2(const QuadricView& view, std::uint32_t vertex,
                                                  EdgeCosts& out) {
  evaluate(view, vertex, out);
}
#endif

}  // namespace

void EdgeCosts::makeRoom(std::size_t corners) {
  const std::size_t rows = 2 * corners + 16;
  if (neighbour.size() >= rows) return;
  for (auto* list : {&neighbour, &shared, &b, &c}) list->resize(2 * rows);
  for (auto* list : {&cost, &x, &y, &z, &rx, &ry, &rz, &deviation}) list->resize(2 * rows);
}

std::uint32_t EdgeCosts::cheapest() const noexcept {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < count; ++i) {
    if (cost[i] < cost[best]) best = i;
  }
  return best;
}

EvaluateEdges portableEdgeEvaluator() { return evaluatePortable; }

EvaluateEdges edgeEvaluator() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return evaluateAvx2;
#endif
  return evaluatePortable;
}

}  // namespace merlin::render
