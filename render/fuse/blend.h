// Blend: computes the features of the fused surface from the scans' planes. Private to render/fuse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/fuse/view.h"
#include "render/mesh/mesh.h"

namespace merlin::render::fuse {

// A feature of the fused surface: a plane that at least one scan has.
struct Blended {
  std::string name;
  std::size_t dimension = 1;
  bool whole = false;  // for "label", "part": the value with the greatest weight, no mean
};

// Returns the planes of all scans, in the order in which they first appear. If planes with the same
// name have different dimensions, the first one counts.
std::vector<Blended> blendedOf(std::span<const View> views);

struct Blending {
  std::vector<std::uint8_t>
      measured{};           // by vertex: 1 if a scan has a surface within half a truncation
  std::size_t without = 0;  // vertices that kept 0 in some feature, as no neighbour has a value
};

// Adds the features to the mesh. A vertex gets the mean over the scans whose surface is within
// `truncation` [units] of it, weighted by Sight::weight, which falls to 0 at the truncation.
// Vertices that no scan sees get the mean of their neighbours that have a value, repeated in steps
// until no more vertices get one. O(vertices x scans + triangles x steps).
Blending blend(std::span<const View> views, double truncation, unsigned threads, mesh::Mesh& mesh);

}  // namespace merlin::render::fuse
