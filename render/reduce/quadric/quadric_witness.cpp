#include "render/reduce/quadric/quadric_witness.h"

#include "render/reduce/quadric/star_lanes.h"

namespace merlin::render::reduce {
namespace {

constexpr float kTiny = 1e-30F;

struct Point {
  float x, y, z;
};

MERLIN_INLINE Floats dot(const Floats (&a)[3], const Floats (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

MERLIN_INLINE Floats dot(const Floats (&a)[3], const Point& p) {
  return a[0] * p.x + a[1] * p.y + a[2] * p.z;
}

// Returns the squared distance from a point p to the segment from the origin to a, computed from
// the dot products of p and a.
MERLIN_INLINE Floats segmentDistance2(const Floats& pp, const Floats& pa, const Floats& aa,
                                      const Floats& inverse_aa) {
  Floats t = pa * inverse_aa;
  t = t > 0 ? t : all(0.0F);
  t = t < 1 ? t : all(1.0F);
  return pp - t * (pa + pa - t * aa);
}

// Eight triangles, one per lane, with the vertices (origin, b, c).
struct Triangles {
  Floats b[3], c[3];

  // Lowers `nearest`, the squared distances from two points to the surface, where a triangle is
  // nearer. Only triangles whose lanes are set in `there` count.
  MERLIN_INLINE void approach(const Point (&points)[2], const Ints& there,
                              Floats (&nearest)[2]) const {
    const Floats n[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                         b[0] * c[1] - b[1] * c[0]};
    const Floats bb = dot(b, b), bc = dot(b, c), cc = dot(c, c), nn = dot(n, n);
    const Floats ee = bb - 2.0F * bc + cc;
    const Floats ibb = 1.0F / (bb + kTiny), icc = 1.0F / (cc + kTiny), iee = 1.0F / (ee + kTiny);
    const Floats inn = 1.0F / (nn + kTiny);
    for (int i = 0; i < 2; ++i) {
      const Point& p = points[i];
      const Floats pp = all(p.x * p.x + p.y * p.y + p.z * p.z);
      const Floats pb = dot(b, p), pc = dot(c, p), pn = dot(n, p);
      const Floats u = cc * pb - bc * pc, v = bb * pc - bc * pb;
      const Ints inside = (u >= 0) & (v >= 0) & (u + v <= nn) & (nn > kTiny);
      const Floats to_b = segmentDistance2(pp, pb, bb, ibb);
      const Floats to_c = segmentDistance2(pp, pc, cc, icc);
      const Floats across = segmentDistance2(pp - 2.0F * pb + bb, pc - pb - bc + bb, ee, iee);
      Floats edge = to_b < to_c ? to_b : to_c;
      edge = across < edge ? across : edge;
      const Floats here = inside ? pn * pn * inn : edge;
      nearest[i] = (there & (here < nearest[i])) ? here : nearest[i];
    }
  }
};

// Computes the positions of eight vertices relative to `to`.
MERLIN_INLINE void cornersFrom(const QuadricView& view, const Ints& vertices, const float* to,
                               Floats (&corners)[3]) {
  std::uint32_t numbers[8];
  store(numbers, vertices);
  Floats unused;
  transpose([&](int k) { return view.vertices[numbers[k]].position; }, corners[0], corners[1],
            corners[2], unused);
  for (int k = 0; k < 3; ++k) corners[k] -= to[k];
}

// Calls Triangles::approach() for the triangles of v's star that remain after v and `other` have
// merged at `to`.
MERLIN_INLINE void approachStar(const QuadricView& view, const QuadricVertex& v,
                                std::uint32_t other, const float* to, const Point (&points)[2],
                                Floats (&nearest)[2]) {
  for (std::uint32_t first = 0; first < v.degree; first += kLine) {
    const std::uint32_t* const corners = &view.corners[v.star + first].b;
    const std::uint32_t count = v.degree - first;
    const Ints b = firsts(corners, count);
    Ints c = next(b);  // valid for a closed fan; replaced below for other stars
    Triangles t;
    cornersFrom(view, b, to, t.b);
    if (!(v.flags & kOpen) && v.degree <= kLine) {
      for (int k = 0; k < 3; ++k) t.c[k] = next(t.b[k]);
    } else {
      c = seconds(corners, count);
      cornersFrom(view, c, to, t.c);
    }
    t.approach(points, (b != all(other)) & (c != all(other)), nearest);
  }
}

MERLIN_INLINE FartherWitness farther(const QuadricView& view, std::uint32_t w,
                                     const EdgeCosts& costs, std::uint32_t edge) {
  const std::uint32_t x = costs.neighbour[edge];
  const QuadricVertex &a = view.vertices[w], &b = view.vertices[x];
  const float step[] = {costs.x[edge], costs.y[edge], costs.z[edge]};
  const float to[] = {a.position[0] + step[0], a.position[1] + step[1], a.position[2] + step[2]};
  const std::array<float, 3> of_a = a.witness.get(), of_b = b.witness.get();
  const Point points[2] = {{of_a[0] - step[0], of_a[1] - step[1], of_a[2] - step[2]},
                           {of_b[0] + costs.rx[edge] - step[0], of_b[1] + costs.ry[edge] - step[1],
                            of_b[2] + costs.rz[edge] - step[2]}};
  Floats nearest[2];
  for (int i = 0; i < 2; ++i) {
    const Point& p = points[i];
    nearest[i] = all(p.x * p.x + p.y * p.y + p.z * p.z);
  }
  approachStar(view, a, x, to, points, nearest);
  approachStar(view, b, w, to, points, nearest);
  const float of_w = simd::leastLane(nearest[0])[0], of_x = simd::leastLane(nearest[1])[0];
  return of_x > of_w ? FartherWitness{of_x, 1} : FartherWitness{of_w, 0};
}

FartherWitness fartherPortable(const QuadricView& view, std::uint32_t w, const EdgeCosts& costs,
                               std::uint32_t edge) {
  return farther(view, w, costs, edge);
}

MERLIN_WIDE FartherWitness fartherWide(const QuadricView& view, std::uint32_t w,
                                       const EdgeCosts& costs, std::uint32_t edge) {
  return farther(view, w, costs, edge);
}

}  // namespace

void keepWitness(QuadricVertex& a, const QuadricVertex& of, const float* to) noexcept {
  std::array<float, 3> from = of.witness.get();
  for (std::size_t k = 0; k < 3; ++k) from[k] += of.position[k] - to[k];
  a.witness.set(from);
}

FindFarther portableFartherWitness() { return fartherPortable; }

FindFarther fartherWitness() { return simd::pick(fartherWide, fartherPortable); }

}  // namespace merlin::render::reduce
