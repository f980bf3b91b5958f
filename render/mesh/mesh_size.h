// MeshSize: the counts that determine the memory of a mesh; the mesh need not be loaded.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct MeshSize {
  std::size_t vertices = 0, triangles = 0;
  std::size_t values = 0;  // feature values (floats) per vertex

  std::size_t bytes() const noexcept { return vertices * (12 + 4 * values) + triangles * 12; }
};

inline MeshSize sizeOf(const Mesh& mesh) noexcept {
  MeshSize size{mesh.vertexCount(), mesh.triangleCount(), 0};
  for (const Feature& f : mesh.features) size.values += f.dimension;
  return size;
}

}  // namespace merlin::render::mesh
