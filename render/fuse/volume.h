// Volume: finds the blocks of voxels that the surface crosses, by following the surface. Private to
// render/fuse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "render/fuse/fuse.h"
#include "render/fuse/tetrahedra.h"
#include "render/fuse/view.h"

namespace merlin::render::fuse {

// A lattice of corners in world coordinates.
struct Grid {
  Point low{}, high{};  // box that may contain the surface
  double voxel = 1;

  Point at(const Lattice& corner) const noexcept {
    Point p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = low[k] + voxel * static_cast<double>(corner[k]);
    return p;
  }
  bool contains(const Point& p) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(p[k] > low[k] && p[k] < high[k])) return false;
    }
    return true;
  }
};

// Thread-bound; run() may be called once. Keeps references to views, settings and grid, which must
// outlive it.
class Volume {
 public:
  Volume(std::span<const View> views, const FuseSettings& settings, const Grid& grid,
         std::size_t values)
      : views_(views), settings_(settings), grid_(grid), values_(values) {}

  // Finds the blocks: starts with those that contain a point of a scan's surface, and follows the
  // surface through their sides. Errors: kInvalidArgument if the memory limit does not suffice.
  Result<Ok> run(const range::Work& work);

  // Returns the signed distance at a corner, in truncation distances: 1 in free space, negative
  // inside, NaN if unknown. Pure.
  float valueAt(const Lattice& corner) const;

  const std::vector<Piece>& pieces() const noexcept { return pieces_; }  // in a fixed order
  void clearPieces() { pieces_ = {}; }
  std::size_t lookedAt() const noexcept { return seen_.size(); }

 private:
  void findSeeds();
  std::uint8_t fill(std::uint64_t block, Piece& piece) const;
  void grow(const std::vector<std::uint8_t>& sides, std::size_t from);
  Result<Ok> checkMemory(std::size_t blocks) const;

  std::span<const View> views_;
  const FuseSettings& settings_;
  const Grid& grid_;
  std::size_t values_;  // number of feature values (floats) per vertex
  std::unordered_set<std::uint64_t> seen_{};
  std::vector<std::uint64_t> queue_{};  // blocks in the order in which they are filled
  std::vector<Piece> pieces_{};
};

}  // namespace merlin::render::fuse
