#include "render/lod/removal_order.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "daemon/base/blocks.h"

namespace merlin::render::lod {
namespace {

constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

// The collapses in terms of places, which are vertices of the mesh: when two nodes merge, the new
// node takes over the place of the first node, and the place of the second node ends. Places that
// are near in space are near in memory, while the numbers of nodes would lead to a distant address
// at each step.
struct Places {
  struct End {
    std::uint32_t collapse = kNever, into = 0;
  };
  HugeArray<End> ends;  // by vertex

  Places(std::size_t vertices, const CollapseLog& log) : ends(vertices) {
    for (std::size_t v = 0; v < vertices; ++v) ends[v] = {};
    // [k]: place of the node that collapse k makes.
    HugeArray<std::uint32_t> place_of(log.children.size());
    for (std::size_t k = 0; k < log.children.size(); ++k) {
      const auto place = [&](std::uint32_t n) { return n < vertices ? n : place_of[n - vertices]; };
      const std::uint32_t on = place(log.children[k][0]), over = place(log.children[k][1]);
      assert(ends[over].collapse == kNever && ends[on].collapse == kNever);
      place_of[k] = on;
      ends[over] = {static_cast<std::uint32_t>(k), on};
    }
  }

  // Returns the first level, at least 1, at which the triangle is gone because two of its corners
  // share a place; kNever if no collapse removes the triangle.
  std::uint32_t removalOf(const std::uint32_t* corners) const {
    std::uint32_t c[] = {corners[0], corners[1], corners[2]};
    std::uint32_t at[] = {ends[c[0]].collapse, ends[c[1]].collapse, ends[c[2]].collapse};
    for (;;) {
      const auto first = static_cast<std::size_t>(std::min_element(at, at + 3) - at);
      const std::uint32_t collapse = at[first];
      if (collapse == kNever) return kNever;
      c[first] = ends[c[first]].into;
      at[first] = ends[c[first]].collapse;
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return collapse + 1;
    }
  }
};

}  // namespace

RemovalOrder::RemovalOrder(const mesh::Mesh& mesh, const CollapseLog& log, unsigned threads)
    : log_(log), alive_(log.children.size() + 2) {
  {
    HugeArray<std::uint32_t> removals(mesh.triangleCount());
    findRemovals(mesh, threads, removals);
    sortTriangles(removals);
  }
  numbers_ = HugeArray<std::uint32_t>(mesh.vertexCount() + log.children.size());
  numberNodes();
}

// Numbers the roots in their order, then the children of each collapse, from the last to the first.
void RemovalOrder::numberNodes() {
  const std::size_t nodes = numbers_.size();
  for (std::size_t n = 0; n < nodes; ++n) numbers_[n] = kNever;
  for (std::size_t k = 0; k < collapses(); ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = log_.children[k][side];
      assert(child < nodes && numbers_[child] == kNever);
      numbers_[child] = static_cast<std::uint32_t>(nodes - 2 * k - 1 - side);
    }
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    if (numbers_[n] != kNever) continue;
    numbers_[n] = static_cast<std::uint32_t>(roots_.size());
    roots_.push_back(static_cast<std::uint32_t>(n));
  }
}

void RemovalOrder::findRemovals(const mesh::Mesh& mesh, unsigned threads,
                                HugeArray<std::uint32_t>& removals) {
  const std::size_t count = mesh.triangleCount();
  const Places places(mesh.vertexCount(), log_);
  const auto levels = static_cast<std::uint32_t>(collapses() + 1);
  forEach(threads, count, [&](std::size_t t) {
    // `levels` means never.
    removals[t] = std::min(levels, places.removalOf(&mesh.triangles[3 * t]));
  });
}

// Sorts the triangles by the level of their removal (counting sort), last level first; triangles
// with the same level keep the order of the mesh. alive_[d] first is the number of triangles that
// are removed after level d, which is the index where the triangles of level d begin. After the
// sort it is the index where they end, which is the number of triangles left at level d - 1.
void RemovalOrder::sortTriangles(const HugeArray<std::uint32_t>& removals) {
  for (std::size_t t = 0; t < removals.size(); ++t) ++alive_[removals[t]];
  std::uint32_t later = 0;
  for (std::size_t d = alive_.size(); d-- > 0;) {
    const std::uint32_t here = alive_[d];
    alive_[d] = later;
    later += here;
  }
  triangles_ = HugeArray<std::uint32_t>(removals.size());
  for (std::size_t t = 0; t < removals.size(); ++t)
    triangles_[alive_[removals[t]]++] = static_cast<std::uint32_t>(t);
}

}  // namespace merlin::render::lod
