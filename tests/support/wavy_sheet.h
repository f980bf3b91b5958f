// A small model for walls that draw on a virtual clock.
#pragma once

#include <cmath>
#include <cstdint>

#include "render/lod/dendrogram.h"
#include "render/reduce/reduce.h"

namespace merlin::test {

// Returns a wavy sheet of 5,000 triangles, reduced as far as possible.
inline render::lod::Dendrogram wavySheet() {
  render::mesh::Mesh mesh;
  constexpr std::uint32_t kSide = 51;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide), y = static_cast<float>(i / kSide);
    mesh.positions.insert(mesh.positions.end(), {x, y, std::sin(x / 5) + std::cos(y / 7)});
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    mesh.triangles.insert(mesh.triangles.end(),
                          {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide});
  }
  render::mesh::ensureNormals(mesh);
  return render::lod::buildDendrogram(mesh, render::reduce::reduce(mesh, {})->log);
}

}  // namespace merlin::test
