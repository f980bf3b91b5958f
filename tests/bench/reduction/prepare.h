// Prepares the mesh that all programs of the reduction benchmark reduce.
#pragma once

#include <cstddef>
#include <string>

#include "render/mesh/mesh.h"

namespace merlin::bench {

struct Kind {
  std::size_t edges = 0, borders = 0, non_manifold = 0, components = 0;
};

// Merges coincident vertices that an edge joins, and removes the triangles that collapse thereby:
// VTK treats the quadric of such a triangle as singular and stops. Returns the number of vertices
// removed.
std::size_t contractZeroEdges(render::mesh::Mesh& mesh);

// Splits each vertex whose triangles form several fans into one vertex for each fan. Two triangles
// belong to the same fan if they share an edge that has exactly two triangles with opposite
// directions. Some peers support manifold meshes only, and range images touch themselves at single
// points. Returns the number of vertices added.
std::size_t splitManifold(render::mesh::Mesh& mesh);

Kind kindOf(const render::mesh::Mesh& mesh);

// Reads the mesh `in`, keeps colour as the only feature, calls contractZeroEdges() and
// splitManifold(), writes the mesh `out`, and returns a line of JSON with the counts.
Result<std::string> prepare(const std::string& in, const std::string& out);

}  // namespace merlin::bench
