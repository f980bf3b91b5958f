// The one mesh that all programs of the reduction benchmark get.
#pragma once

#include <cstddef>
#include <string>

#include "render/mesh/mesh.h"

namespace merlin::bench {

struct Kind {
  std::size_t edges = 0, borders = 0, non_manifold = 0, components = 0;
};

// Makes one vertex of two at one place that an edge joins, and drops the triangles between them:
// VTK takes such a triangle's quadric for singular, and stops. Returns how many vertices went.
std::size_t contractZeroEdges(render::Mesh& mesh);

// Gives a vertex whose triangles hang together in several fans one copy for each of them; triangles
// are neighbours over an edge that has two, which run opposite ways. Some peers take manifolds
// only, and range images touch themselves in single points. Returns how many vertices were added.
std::size_t splitManifold(render::Mesh& mesh);

Kind kindOf(const render::Mesh& mesh);

// Reads `in`, leaves colour as the only feature, contracts, splits, writes `out`, returns a line of
// JSON.
Result<std::string> prepare(const std::string& in, const std::string& out);

}  // namespace merlin::bench
