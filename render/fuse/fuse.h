// Fusion: combines several range images with known poses into one surface.
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
  double truncation = 3;  // largest distance from a scan's surface that is used [voxels]
  // Longest edge of a scan's surface [units]; not set: 10 times the step between its pixels, as in
  // `merlin mesh import`.
  std::optional<double> max_edge{};
  // If true, the surface is closed: space that no scan saw counts as inside, and space outside the
  // box around all scans as empty.
  bool close = false;
  // Only used with `close`: rays in a window of 3 x 3 pixels, none of which has a return, are
  // assumed to have gone through empty space.
  bool background_is_empty = true;
  std::size_t memory = 0;  // memory limit of fuse(), without the scans [bytes]
};

struct Fused {
  // The surface, with "normal" and the scans' planes as features. With FuseSettings::close, it also
  // has the feature "measured": 1 if a scan saw the surface at the vertex, 0 where the surface was
  // closed artificially; there the other features come from the neighbours.
  mesh::Mesh mesh;
  std::size_t blocks = 0;       // number of blocks of 8 x 8 x 8 voxels that the surface crosses
  std::size_t looked_at = 0;    // number of blocks whose values were computed
  std::size_t measured = 0;     // number of vertices that a scan saw
  std::size_t split = 0;        // vertices added where open surfaces touched in a point or an edge
  std::size_t not_numbers = 0;  // vertices with 0 in some feature, as no neighbour has a value
};

// Returns why fuse() cannot use a scan, as the end of a message; empty if it can.
std::string faultOf(const range::RangeImage& scan);

// Returns a voxel size for these scans [units]: the median, over the scans, of the distance between
// neighbouring pixels at the scan's median range. O(pixels). REQUIRES: faultOf() is empty for each
// scan.
double voxelFor(std::span<const range::RangeImage> scans);

// Computes the surface between the voxels that are inside and those that are outside according to
// the scans, by a weighted mean of truncated signed distances ([CURLESS96]) and marching
// tetrahedra. README.md has the method.
//
// errors  kInvalidArgument: the memory does not suffice, or the lattice has too many voxels along
//         an axis (the message names a voxel that fits); kMalformed: the scans have no surface, or
//         none at this voxel
// order   the same scans in the same order give the same mesh, whatever the number of threads
// cost    O(blocks x scans); about 20 KiB a block, and 15 bytes a pixel
// REQUIRES: voxel > 0, truncation >= 1, faultOf() is empty for each scan. Reentrant.
Result<Fused> fuse(std::span<const range::RangeImage> scans, const FuseSettings& settings,
                   const range::Work& work);

}  // namespace merlin::render::fuse
