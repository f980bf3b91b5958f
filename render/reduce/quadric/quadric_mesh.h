// QuadricMesh: the mesh during a reduction with the cost `quadric`; it has one record and one star
// per vertex. Private to render/reduce.
//
// The star of a vertex is the list of its triangles, each stored as its other two vertices, a
// Corner (b, c), in the triangle's order. In a closed fan each corner's c is the next corner's b;
// at borders and non-manifold vertices the order is arbitrary. Stars are stored in lines of 8
// corners, 64 bytes. Vertices are numbered along a space-filling curve, so that neighbours are
// close in memory.
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

namespace merlin::render::reduce {

struct Corner {
  std::uint32_t b, c;  // the triangle (vertex, b, c)
};

inline constexpr std::uint32_t kLine = 8;  // corners per line

// Upper triangle of a symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<float, 6>;

// A 3D vector stored in seven bytes, with a precision of 1/8,000 of its largest component.
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
    const float per_unit = powerOfTwo(-exponent_), end = 1 << 14;  // limit for rounding errors
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
  // Position: in units of the mean edge length, from the centre of the bounding box. Quadric h: the
  // sum of A n n' over the star's triangles, where A is twice the area and n the unit normal. Since
  // all these planes pass through the vertex, the quadric has no linear part. `position` and h[0]
  // are loaded together as four floats.
  float position[3];
  float h[6];
  std::uint32_t star;      // index of its first corner
  std::uint32_t degree;    // number of corners in its star
  std::uint32_t capacity;  // number of corners for which its lines have room
  std::uint32_t node;      // index of its node in the log
  float deviation;         // bound of the squared distance to the vertices merged into it
  std::uint8_t flags;
  ShortVector witness;  // position of the witness (quadric_witness.h), relative to the vertex
};
static_assert(sizeof(QuadricVertex) == 64);

enum : std::uint8_t {
  kOpen = 1,     // its star is not one closed fan: the vertex is at a border or non-manifold
  kDead = 2,     // merged into another vertex; its record now holds a NodeRecord
  kIdle = 4,     // has no legal edge; queued again when its neighbourhood changes
  kInside = 8,   // all its neighbours are in the same part (PartsReduction)
  kLocked = 32,  // must keep its position
  kSharp = 16,   // a thin tip or a sharp ridge: the normals of its faces nearly cancel
  kHub = 64,     // has too many triangles to take part for now; see HubRecord
};

// Returns true if the vertex is part of the surface: it is not merged into another one and has
// triangles.
inline bool lives(const QuadricVertex& v) noexcept { return !(v.flags & kDead) && v.degree > 0; }

// A hub is a vertex with so many triangles that each collapse next to it would take long. Its
// record holds a HubRecord instead of a quadric; the NaN in it gives each edge to the hub the cost
// kNoEdge. A collapse next to a hub does not update the hub's star, only its number of triangles.
// Until tidyHub(), a dead vertex in the star therefore stands for the vertex that it merged into
// (mergedInto()), and a corner whose two vertices have become the same is no longer a triangle.
struct HubRecord {
  float no_number;  // NaN; stored in place of h[0]
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

// Returns the number of triangles of v, whether v is a hub or not.
inline std::uint32_t trianglesOf(const QuadricVertex& v) noexcept {
  return v.flags & kHub ? hubRecordOf(v).triangles : v.degree;
}

// Returns a reference to the index of the vertex that a dead vertex merged into. It takes the place
// of the star's index. REQUIRES: the vertex is dead.
inline std::uint32_t& mergedInto(QuadricVertex& dead) noexcept { return dead.star; }

// The result of a collapse. It is stored in the record of the vertex that died, over its position
// and h.
struct NodeRecord {
  std::uint32_t children[2];
  float position[3], error, normal[3];
};
static_assert(sizeof(NodeRecord) == sizeof(QuadricVertex::position) + sizeof(QuadricVertex::h));

inline NodeRecord nodeRecordOf(const QuadricVertex& dead) noexcept {
  NodeRecord record;
  std::memcpy(&record, static_cast<const void*>(dead.position), sizeof record);
  return record;
}

inline void setNodeRecord(QuadricVertex& dead, const NodeRecord& record) noexcept {
  std::memcpy(static_cast<void*>(dead.position), &record, sizeof record);
}

// Hands out lines of corners that no star has used yet. Thread-safe; all threads share one.
class FreshLines {
 public:
  void reset(std::uint32_t begin, std::uint32_t end) {
    next_ = begin;
    end_ = end;
  }
  // Claims `corners` consecutive corners and returns the index of the first one; returns nothing if
  // too few are left.
  std::optional<std::uint32_t> claim(std::uint32_t corners);

 private:
  std::atomic<std::uint32_t> next_ = 0;
  std::uint32_t end_ = 0;
};

// Allocates room for stars in whole lines of corners, and reuses returned room of the same size.
// Thread-bound: use one per thread.
class StarRoom {
 public:
  StarRoom() = default;
  explicit StarRoom(FreshLines& fresh) : fresh_(&fresh) {}

  // Allocates room for at least `corners` corners, returns the index of its first corner and sets
  // `capacity` to its size in corners. Throws std::bad_alloc if no room is left.
  std::uint32_t take(std::uint32_t corners, std::uint32_t& capacity);
  void give(std::uint32_t star, std::uint32_t capacity);

  // Takes over the returned room that `other` holds.
  void join(StarRoom&& other);

 private:
  bool claimFresh(std::uint32_t corners);

  FreshLines* fresh_ = nullptr;
  std::uint32_t next_ = 0, end_ = 0;              // the unused part of the lines claimed last
  std::vector<std::vector<std::uint32_t>> free_;  // returned room, by number of lines
};

// Returns the indices of the mesh's vertices in the order of a space-filling curve; the order does
// not depend on the number of threads. O(n) time (radix sort), 16 bytes of temporary memory per
// vertex.
std::vector<std::uint32_t> alongCurve(const mesh::Mesh& mesh, Threads threads);

class QuadricMesh {
 public:
  // Builds records and stars from an input mesh, in O(n). REQUIRES: validate(mesh), tidy(mesh).
  explicit QuadricMesh(const mesh::Mesh& mesh, Threads threads = 1);

  std::uint32_t vertexCount() const noexcept { return static_cast<std::uint32_t>(input_.size()); }
  QuadricVertex& operator[](std::uint32_t v) const noexcept { return vertices_[v]; }
  std::span<Corner> star(const QuadricVertex& v) const noexcept {
    return {stars_.data() + v.star, v.degree};
  }
  Corner* corners(std::uint32_t star) const noexcept { return stars_.data() + star; }
  // Returns the index in the input mesh of vertex v.
  std::uint32_t inputOf(std::uint32_t v) const noexcept { return input_[v]; }

  float scale() const noexcept { return scale_; }  // 1 / mean edge length, in model units
  std::array<float, 3> toWorking(const float* model) const noexcept;
  std::array<float, 3> toModel(const float* position) const noexcept;
  StarRoom freeRoom() noexcept { return StarRoom(fresh_); }
  void dropStars() { stars_ = {}; }
  // Updates the star of a hub: replaces dead vertices by those that they merged into, and removes
  // corners that are no longer triangles. Amortised O(corners). Must not be called in parallel for
  // hubs whose stars contain the same dead vertex.
  void tidyHub(std::uint32_t hub) noexcept;

 private:
  void fillStars(const mesh::Mesh& mesh, const HugeArray<std::uint32_t>& numbers, Threads threads);
  void orderStar(QuadricVertex& v);

  std::vector<std::uint32_t> input_;
  HugeArray<QuadricVertex> vertices_;
  HugeArray<Corner> stars_;
  FreshLines fresh_;
  float scale_ = 1;
  std::array<float, 3> centre_{};
};

}  // namespace merlin::render::reduce
