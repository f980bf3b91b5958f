// QuadricMesh: the surface while `quadric` reduces it: one record a vertex, one star a vertex.
// Private to render/reduce.
//
// A vertex' star is the list of its triangles, each as the two other corners in the triangle's own
// order. In a closed fan they follow one another (a's second is b's first); at borders and where
// the surface is no manifold they may stand in any order. Stars live in lines of 8 corners, 64
// bytes. Vertices are numbered along a space-filling curve, so that what is near is near in memory.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/blocks.h"
#include "daemon/base/huge_array.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct Corner {
  std::uint32_t b, c;  // the triangle (vertex, b, c)
};

inline constexpr std::uint32_t kLine = 8;  // corners

// Upper triangle of a symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<float, 6>;

// A vector in seven bytes, to 1/8,000 of its length.
class ShortVector {
 public:
  std::array<float, 3> get() const noexcept {
    std::int16_t units[3];
    std::memcpy(units, units_, sizeof units);
    const float unit = powerOfTwo(exponent_);
    return {unit * units[0], unit * units[1], unit * units[2]};
  }
  void set(const std::array<float, 3>& v) noexcept {
    const float most = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(most) >> 23) - 127;
    exponent_ = static_cast<std::int8_t>(std::clamp(exponent, -100, 100) - 13);
    const float per_unit = powerOfTwo(-exponent_), end = 1 << 14;  // in range in any case
    std::int16_t units[3];
    for (std::size_t k = 0; k < 3; ++k)
      units[k] = static_cast<std::int16_t>(std::clamp(per_unit * v[k], -end, end));
    std::memcpy(units_, units, sizeof units);
  }

 private:
  static float powerOfTwo(int exponent) noexcept {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23);
  }
  std::int8_t exponent_;
  std::byte units_[6];
};

struct alignas(64) QuadricVertex {
  // In mean edges, from the box' centre. The quadric: sum of A n n' over the star's triangles, A
  // twice the area, n the unit normal: all planes pass through the vertex, so that there is no
  // linear part. The fourth position and h[0] are loaded as one.
  float position[3];
  float h[6];
  std::uint32_t star;      // index of its first corner
  std::uint32_t degree;    // corners
  std::uint32_t capacity;  // corners that its lines hold
  std::uint32_t node;      // of the log
  float deviation;         // squared distance that what it stands for may be off by now
  std::uint8_t flags;
  ShortVector witness;  // where it is (quadric_witness.h), from here
};
static_assert(sizeof(QuadricVertex) == 64);

enum : std::uint8_t {
  kOpen = 1,     // its star is no closed fan: a border, or no manifold
  kDead = 2,     // merged into another; its record then holds a NodeRecord
  kIdle = 4,     // no legal edge; back in the queue when its neighbourhood changes
  kInside = 8,   // its whole ring is in its part
  kLocked = 32,  // stays where it is
  kSharp = 16,   // a thin tip or a knife's edge: its faces' normals cancel
  kHub = 64,     // has so many triangles that it takes no part for now: hub()
};

// Whether it is part of the surface. (One that has lost its triangles is left, and belongs to
// none.)
inline bool lives(const QuadricVertex& v) noexcept { return !(v.flags & kDead) && v.degree > 0; }

// A hub is a vertex of so many triangles that each step beside it would take long. While it is one
// its record holds no quadric, so that no edge to it costs less than kNoEdge, and collapses beside
// it do not write into its star: names of dead vertices there stand for those that they merged
// into (mergedInto()), and a corner whose two names have become one is no triangle any more. How
// many triangles it still has is counted.
struct HubRecord {
  float no_number;  // in the place of h[0]
  std::uint32_t triangles;
};

inline HubRecord hubRecordOf(const QuadricVertex& v) noexcept {
  HubRecord hub;
  std::memcpy(&hub, v.h, sizeof hub);
  return hub;
}

inline void setHub(QuadricVertex& v, std::uint32_t triangles) noexcept {
  const HubRecord hub{std::numeric_limits<float>::quiet_NaN(), triangles};
  std::memcpy(v.h, &hub, sizeof hub);
  v.flags |= kHub;
}

// How many triangles v has.
inline std::uint32_t trianglesOf(const QuadricVertex& v) noexcept {
  return v.flags & kHub ? hubRecordOf(v).triangles : v.degree;
}

// For a dead vertex: the vertex that it merged into, stored in the place of its star.
inline std::uint32_t& mergedInto(QuadricVertex& dead) noexcept { return dead.star; }

// The result of a collapse, stored in the dead vertex' record over its position and h.
struct NodeRecord {
  std::uint32_t children[2];
  float position[3], error, normal[3];
};
static_assert(sizeof(NodeRecord) == sizeof(QuadricVertex::position) + sizeof(QuadricVertex::h));

// Lines of corners that no star has had yet, for all threads.
class FreshLines {
 public:
  void reset(std::uint32_t begin, std::uint32_t end) {
    next_ = begin;
    end_ = end;
  }
  // So many more that follow one another; where they begin, or nothing where too few are left.
  std::optional<std::uint32_t> claim(std::uint32_t corners);

 private:
  std::atomic<std::uint32_t> next_ = 0;
  std::uint32_t end_ = 0;
};

// Lines of corners, handed out and taken back by size. One a thread.
class StarRoom {
 public:
  StarRoom() = default;
  explicit StarRoom(FreshLines& fresh) : fresh_(&fresh) {}

  // Throws std::bad_alloc where there is no room. `capacity` becomes the room there is.
  std::uint32_t take(std::uint32_t corners, std::uint32_t& capacity);
  void give(std::uint32_t star, std::uint32_t capacity);

  // Takes over what another has been given back.
  void join(StarRoom&& other);

 private:
  bool claimFresh(std::uint32_t corners);

  FreshLines* fresh_ = nullptr;
  std::uint32_t next_ = 0, end_ = 0;              // of the lines claimed last
  std::vector<std::vector<std::uint32_t>> free_;  // by lines
};

// The mesh's vertices in the order of a space-filling curve; the same for any number of threads.
// O(n): a radix sort. 16 bytes a vertex besides.
std::vector<std::uint32_t> alongCurve(const Mesh& mesh, Threads threads);

class QuadricMesh {
 public:
  // REQUIRES: validate(mesh), tidy(mesh). O(n).
  explicit QuadricMesh(const Mesh& mesh, Threads threads = 1);

  std::uint32_t vertexCount() const noexcept { return static_cast<std::uint32_t>(input_.size()); }
  QuadricVertex& operator[](std::uint32_t v) const noexcept { return vertices_[v]; }
  std::span<Corner> star(const QuadricVertex& v) const noexcept {
    return {stars_.data() + v.star, v.degree};
  }
  Corner* corners(std::uint32_t star) const noexcept { return stars_.data() + star; }
  // The mesh's vertex of that number.
  std::uint32_t inputOf(std::uint32_t v) const noexcept { return input_[v]; }

  float scale() const noexcept { return scale_; }  // mean edges in a model unit
  std::array<float, 3> toWorking(const float* model) const noexcept;
  std::array<float, 3> toModel(const float* position) const noexcept;
  StarRoom freeRoom() noexcept { return StarRoom(fresh_); }
  void dropStars() { stars_ = {}; }
  // A hub's star as it is by now: names of living vertices, no corner that is no triangle.
  // Amortised O(corners). Of other stars that are tidied at once no name may be the same.
  void tidyHub(std::uint32_t hub) noexcept;

 private:
  void fillStars(const Mesh& mesh, const HugeArray<std::uint32_t>& numbers, Threads threads);
  void orderStar(QuadricVertex& v);

  std::vector<std::uint32_t> input_;
  HugeArray<QuadricVertex> vertices_;
  HugeArray<Corner> stars_;
  FreshLines fresh_;
  float scale_ = 1;
  std::array<float, 3> centre_{};
};

}  // namespace merlin::render
