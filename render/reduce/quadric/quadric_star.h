// Computes the data of one vertex from its star: ring, quadric, normal, channel sums. Private to
// quadric_evaluate.cpp, which compiles it for two instruction sets (simd.h).
#pragma once

#include <algorithm>
#include <cstring>

#include "render/reduce/quadric/quadric_evaluate.h"
#include "render/reduce/quadric/star_lanes.h"

namespace merlin::render::reduce {

inline constexpr float kTiny = 1e-30F;
// A vertex is sharp if the mean of its faces' unit normals is shorter than this. For a cone the
// length of the mean is the sine of the angle between its axis and its side.
inline constexpr float kSharpMean = 0.6F;

// Eight neighbours of a vertex w, one per SIMD lane: their positions relative to w and, if
// `quadrics` is true, their quadrics h.
template <bool quadrics>
struct Neighbours {
  Floats x, y, z, h[6];

  MERLIN_INLINE Neighbours(const QuadricView& view, const QuadricVertex& w,
                           const std::uint32_t* numbers) {
    const auto at = [&](int k) -> const QuadricVertex& { return view.vertices[numbers[k]]; };
    transpose<quadrics ? 4 : 3>([&](int k) { return at(k).position; }, x, y, z, h[0]);
    if (quadrics) {
      transpose([&](int k) { return &at(k).h[1]; }, h[1], h[2], h[3], h[4]);
      h[5] = Floats{at(0).h[5], at(1).h[5], at(2).h[5], at(3).h[5],
                    at(4).h[5], at(5).h[5], at(6).h[5], at(7).h[5]};
    }
    x -= w.position[0];
    y -= w.position[1];
    z -= w.position[2];
  }
};

// Does what findNeighbours() does, for a star of more than kPairwise corners. O(corners).
inline void findManyNeighbours(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  out.count = 0;
  out.numbers.reset(2 * std::size_t{w.degree});
  const auto indexOf = [&](std::uint32_t v) {
    std::uint32_t& after = out.numbers[v];  // row of the neighbour + 1; 0: not found yet
    if (after == 0) {
      out.neighbour[out.count] = v;
      out.shared[out.count] = 0;
      after = ++out.count;
    }
    ++out.shared[after - 1];
    return after - 1;
  };
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    out.b[i] = indexOf(view.corners[w.star + i].b);
    out.c[i] = indexOf(view.corners[w.star + i].c);
  }
}

// Finds each neighbour of w once, and the number of triangles that each shares with w; works for
// any star.
inline void findNeighbours(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  if (w.degree > kPairwise) {
    findManyNeighbours(view, w, out);
    return;
  }
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

// Finds the neighbours of a vertex w whose star is a closed fan: they are the first vertices of its
// corners, in order.
inline void fanNeighbours(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  out.count = w.degree;
  for (std::uint32_t i = 0; i < w.degree; ++i) {
    out.neighbour[i] = view.corners[w.star + i].b;
    out.shared[i] = 2;
  }
}

MERLIN_INLINE void findRing(const QuadricView& view, const QuadricVertex& w, EdgeCosts& out) {
  if (w.flags & kOpen)
    findNeighbours(view, w, out);
  else
    fanNeighbours(view, w, out);
  // Pads the rows with the first neighbour, because rows are processed eight at a time and a closed
  // fan also reads the row after the last group of eight.
  store(&out.neighbour[out.count], all(out.neighbour[0]));
  store(&out.neighbour[out.count + 8], all(out.neighbour[0]));
  for (std::uint32_t first = 0; first < out.count + 8; first += 8) {
    const Neighbours<false> at(view, w, &out.neighbour[first]);
    store(&out.rx[first], at.x);
    store(&out.ry[first], at.y);
    store(&out.rz[first], at.z);
  }
}

// Up to eight triangles (w, b, c): u and v are the positions of their vertices b and c relative to
// w. Unused lanes hold triangles of zero area.
struct EightTriangles {
  Floats ux, uy, uz, vx, vy, vz;
  Ints b, c;
};

// Returns the triangles of a closed fan of up to eight triangles. x, y, z: positions of
// `neighbours` relative to w. Lanes beyond the last neighbour must repeat the first one, so that
// the fan closes.
MERLIN_INLINE EightTriangles fanTriangles(const Floats& x, const Floats& y, const Floats& z,
                                          const Ints& neighbours) {
  return {x, y, z, next(x), next(y), next(z), neighbours, next(neighbours)};
}

// Returns the eight triangles of w's star from corner `first` on. REQUIRES: findRing() was called.
MERLIN_INLINE EightTriangles starTriangles(const QuadricVertex& w, const EdgeCosts& out,
                                           std::uint32_t first) {
  const float *x = out.rx.data(), *y = out.ry.data(), *z = out.rz.data();
  const std::uint32_t* neighbour = out.neighbour.data();
  if (!(w.flags & kOpen)) {
    const std::uint32_t k = first;
    return {load(x + k),     load(y + k),     load(z + k),         load(x + k + 1),
            load(y + k + 1), load(z + k + 1), load(neighbour + k), load(neighbour + k + 1)};
  }
  float u[3][8], v[3][8];
  std::uint32_t of_b[8], of_c[8];
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t b = out.b[first + k < w.degree ? first + k : 0];
    const std::uint32_t c = first + k < w.degree ? out.c[first + k] : b;
    u[0][k] = x[b];
    u[1][k] = y[b];
    u[2][k] = z[b];
    v[0][k] = x[c];
    v[1][k] = y[c];
    v[2][k] = z[c];
    of_b[k] = neighbour[b];
    of_c[k] = neighbour[c];
  }
  return {load(u[0]), load(u[1]), load(u[2]), load(v[0]),
          load(v[1]), load(v[2]), load(of_b), load(of_c)};
}

// Quadrics and unit normals of eight triangles; both are zero for triangles of zero area.
struct Planes {
  Floats h[6], normal[3];
  Floats area, inverse;  // twice the area, and its reciprocal

  MERLIN_INLINE explicit Planes(const EightTriangles& t) {
    const Floats x = t.uy * t.vz - t.uz * t.vy, y = t.uz * t.vx - t.ux * t.vz,
                 z = t.ux * t.vy - t.uy * t.vx;
    const Floats square = x * x + y * y + z * z + kTiny;
    for (int k = 0; k < 8; ++k) area[k] = __builtin_sqrtf(square[k]);
    inverse = 1.0F / area;
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

// Returns the values of channel k at eight vertices.
MERLIN_INLINE Floats valuesOf(const QuadricChannels& channels, const Ints& vertices,
                              std::size_t k) {
  const auto at = [&](int i) { return channels.value(static_cast<std::uint32_t>(vertices[i]), k); };
  return Floats{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
}

// Adds the contribution of the channels' gradients to the quadrics of the triangles and to the
// channel sums in `block`, the channel block of w. `fan`: the triangles are from fanTriangles(), so
// that vertex c of a triangle is vertex b of the next one.
template <bool fan>
MERLIN_INLINE void addGradients(const QuadricChannels& channels, const EightTriangles& t,
                                Planes& planes, float* block) {
  const Floats(&n)[3] = planes.normal;
  const Floats &area = planes.area, &inverse = planes.inverse;
  // Gradient of a channel: (s (v x n) + t (n x u)) / area. s and t are its values at b and c minus
  // that at w, n is the unit normal, and area is twice the triangle's.
  const Floats px = (t.vy * n[2] - t.vz * n[1]) * inverse,
               py = (t.vz * n[0] - t.vx * n[2]) * inverse,
               pz = (t.vx * n[1] - t.vy * n[0]) * inverse;
  const Floats qx = (n[1] * t.uz - n[2] * t.uy) * inverse,
               qy = (n[2] * t.ux - n[0] * t.uz) * inverse,
               qz = (n[0] * t.uy - n[1] * t.ux) * inverse;
  block[0] += sum(area);
  for (std::size_t k = 0; k < channels.count(); ++k) {
    float* b = block + 1 + 4 * k;
    const Floats at_b = valuesOf(channels, t.b, k) - b[3];
    const Floats at_c = fan ? next(at_b) : valuesOf(channels, t.c, k) - b[3];
    const Floats gx = at_b * px + at_c * qx, gy = at_b * py + at_c * qy, gz = at_b * pz + at_c * qz;
    const Floats ax = area * gx, ay = area * gy, az = area * gz;
    const Floats none = all(0.0F), g = sums({ax, ay, az, none, none, none, none, none});
    for (int i = 0; i < 3; ++i) b[i] += g[i];
    planes.h[0] += ax * gx;
    planes.h[1] += ax * gy;
    planes.h[2] += ax * gz;
    planes.h[3] += ay * gy;
    planes.h[4] += ay * gz;
    planes.h[5] += az * gz;
  }
}

// Sums of quadrics and normals over the triangles of a star.
struct Sums {
  Floats most = {};  // the six components of h, then x and y of the normal
  float z = 0;       // z component of the normal

  Sums() = default;
  MERLIN_INLINE explicit Sums(const Planes& p)
      : most(sums({p.h[0], p.h[1], p.h[2], p.h[3], p.h[4], p.h[5], p.normal[0], p.normal[1]})),
        z(sum(p.normal[2])) {}

  MERLIN_INLINE void add(const Sums& other) {
    most += other.most;
    z += other.z;
  }
  // Stores the sums in w.h and out.normal. It writes pieces of register size, since the quadric is
  // read again immediately.
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

// Returns the sums over eight triangles. `block`: the channel block of w; used only if `channels`.
template <bool channels, bool fan>
MERLIN_INLINE Sums sumsOf(const QuadricView& view, const EightTriangles& triangles, float* block) {
  Planes planes(triangles);
  if (channels) addGradients<fan>(*view.channels, triangles, planes, block);
  return Sums(planes);
}

MERLIN_INLINE void clearSums(const QuadricChannels& channels, float* block) {
  block[0] = 0;
  for (std::size_t k = 0; k < channels.count(); ++k) std::fill_n(block + 1 + 4 * k, 3, 0.0F);
}

// Adds the quadric kBorderWeight (|e|^2 I - e e') of a border edge e = (x, y, z) to h: the squared
// distance to the line of the edge, weighted by |e|^2 and kBorderWeight.
MERLIN_INLINE void addBorder(float h[6], float x, float y, float z) {
  const float l = x * x + y * y + z * z;
  h[0] += kBorderWeight * (l - x * x);
  h[1] -= kBorderWeight * (x * y);
  h[2] -= kBorderWeight * (x * z);
  h[3] += kBorderWeight * (l - y * y);
  h[4] -= kBorderWeight * (y * z);
  h[5] += kBorderWeight * (l - z * z);
}

// Sets or clears kSharp of w: whether w is a thin tip or a sharp ridge. n: sum of the unit normals
// of its faces.
MERLIN_INLINE void setSharp(QuadricVertex& w, const float* n) {
  const float upright = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const auto faces = static_cast<float>(w.degree);
  w.flags = static_cast<std::uint8_t>(w.flags & ~kSharp);
  if (upright < kSharpMean * kSharpMean * faces * faces) w.flags |= kSharp;
}

// Sets the quadric, kSharp and channel sums of w, and out.normal; works for any star. `block`: the
// channel block of w; used only if `channels`. REQUIRES: findRing() was called.
template <bool channels>
MERLIN_INLINE void setOwn(const QuadricView& view, QuadricVertex& w, EdgeCosts& out, float* block) {
  if (channels) clearSums(*view.channels, block);
  Sums total;
  for (std::uint32_t first = 0; first < w.degree; first += 8)
    total.add(sumsOf<channels, false>(view, starTriangles(w, out, first), block));
  total.store(w, out);
  setSharp(w, out.normal);
  if (!(w.flags & kOpen)) return;
  for (std::uint32_t i = 0; i < out.count; ++i) {
    if (out.shared[i] == 1) addBorder(w.h, out.rx[i], out.ry[i], out.rz[i]);
  }
}

// Does what setOwn() does, for a closed fan of up to eight triangles. out.neighbour holds the first
// vertices of its corners in order; x, y, z are their positions relative to w.
template <bool channels>
MERLIN_INLINE void setOwnOfFan(const QuadricView& view, QuadricVertex& w, const Floats& x,
                               const Floats& y, const Floats& z, EdgeCosts& out, float* block) {
  if (channels) clearSums(*view.channels, block);
  const Ints neighbours = load(out.neighbour.data());
  sumsOf<channels, true>(view, fanTriangles(x, y, z, neighbours), block).store(w, out);
  setSharp(w, out.normal);
}

}  // namespace merlin::render::reduce
