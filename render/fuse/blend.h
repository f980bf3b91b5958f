// Blend: the features of the fused surface, from the scans' planes. Private to render/fuse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/fuse/view.h"
#include "render/mesh/mesh.h"

namespace merlin::render::fuse {

// A plane that one or more of the scans have.
struct Blended {
  std::string name;
  std::size_t dimension = 1;
  bool whole = false;  // "label", "part": the value with the greatest weight, not a mean
};

// The planes of all scans, in the order in which they appear; of two with one name and different
// dimensions the first.
std::vector<Blended> blendedOf(std::span<const View> views);

struct Blending {
  std::vector<std::uint8_t>
      measured{};           // by vertex: 1 if a scan has a surface within half a truncation
  std::size_t without = 0;  // vertices that kept 0 in some feature, as no neighbour has a value
};

// Adds the features to the mesh: at each vertex the mean of the scans that see it within
// `truncation` [units], by their weight, which falls to 0 there. A vertex that none sees gets the
// mean of its neighbours that have a value, step by step. O(vertices x scans + triangles x steps).
Blending blend(std::span<const View> views, double truncation, unsigned threads, mesh::Mesh& mesh);

}  // namespace merlin::render::fuse
