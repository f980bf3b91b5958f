// Fusion: several range images with known poses become one surface.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/range/range_image.h"
#include "render/range/work.h"

namespace merlin::render::fuse {

struct FuseSettings {
  double voxel = 0;       // edge of a voxel [units]
  double truncation = 3;  // distance up to which a scan says how far a surface is [voxels]
  // Longest edge of a scan's surface [units]; nothing: 10 times the step between its pixels, as
  // `merlin mesh import` takes it.
  std::optional<double> max_edge{};
  // What no scan saw is inside, and what lies outside the box around all scans is empty: the
  // surface is closed.
  bool close = false;
  // With `close`: a ray in a window of 3 x 3 pixels without a return went through empty space.
  bool background_is_empty = true;
  std::size_t memory = 0;  // limit of what fuse() takes in addition to the scans [bytes]
};

struct Fused {
  // With "normal" and the scans' planes as features; with `close` also "measured": 1 where a scan
  // saw the surface, 0 where it was closed. There the other features spread from the neighbours.
  mesh::Mesh mesh;
  std::size_t blocks = 0;       // of 8 x 8 x 8 voxels that the surface crosses
  std::size_t looked_at = 0;    // blocks whose values were computed
  std::size_t measured = 0;     // vertices that a scan saw
  std::size_t split = 0;        // vertices added where open surfaces touched in a point or an edge
  std::size_t not_numbers = 0;  // vertices left with 0 in some feature, as no neighbour has one
};

// A fault of a scan that fuse() cannot take, as the end of a message; empty if there is none.
std::string faultOf(const range::RangeImage& scan);

// The median, over the scans, of the step between neighbouring pixels at the median range [units].
// O(pixels). REQUIRES: faultOf() each is empty.
double voxelFor(std::span<const range::RangeImage> scans);

// The surface between the voxels that the scans put inside and those that they put outside, by a
// weighted mean of truncated signed distances ([CURLESS96]) and marching tetrahedra. README.md has
// the method.
//
// errors  kInvalidArgument: the memory does not suffice, or the lattice has too many voxels along
//         an axis (the message names a voxel that fits); kMalformed: the scans have no surface, or
//         none at this voxel
// order   the same scans in the same order give the same mesh, whatever the number of threads
// cost    O(blocks x scans); about 20 KiB a block, and 15 bytes a pixel
// REQUIRES: voxel > 0, truncation >= 1, faultOf() each is empty. Reentrant.
Result<Fused> fuse(std::span<const range::RangeImage> scans, const FuseSettings& settings,
                   const range::Work& work);

}  // namespace merlin::render::fuse
