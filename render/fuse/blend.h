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
  // True for "label" and "part": no mean, but the value with the greatest weight.
  bool whole = false;
};

// Returns the features that blend() computes: the planes of all scans, in the order in which they
// first appear, except planes of more than 16 dimensions. If planes with the same name have
// different dimensions, the first one counts.
std::vector<Blended> blendedOf(std::span<const View> views);

struct Blending {
  std::vector<std::uint8_t>
      // By vertex: 1 if a scan has a surface within half the truncation distance, else 0.
      measured{};
  // Number of vertices that kept 0 in some feature, as no neighbour had a value.
  std::size_t without = 0;
};

// Adds the features of blendedOf() to the mesh. A vertex gets the mean over the scans whose surface
// is within `truncation` [units] of it, weighted by Sight::weight, which is made to fall to 0 at
// the truncation. A vertex that no scan sees gets the mean of those neighbours that have a value;
// this is repeated until no more vertices get a value, at most 256 times. O(vertices x scans +
// triangles x steps).
Blending blend(std::span<const View> views, double truncation, unsigned threads, mesh::Mesh& mesh);

}  // namespace merlin::render::fuse
