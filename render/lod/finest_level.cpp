#include "render/lod/finest_level.h"

#include <algorithm>

namespace merlin::render::lod {

Dendrogram oneLevel(const mesh::Mesh& mesh) {
  CollapseLog nothing;
  nothing.features.resize(mesh.features.size());
  return buildDendrogram(mesh, nothing);
}

mesh::Box finestBox(const Dendrogram& model) {
  const auto& a = model.arrays();
  if (a.triangles.empty()) return mesh::boundingBox(a.positions);
  const auto at = [&](std::uint32_t corner) {
    return a.positions.subspan(3 * std::size_t{corner}, 3);
  };
  mesh::Box box = mesh::boundingBox(at(a.triangles[0]));
  for (const std::uint32_t corner : a.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], at(corner)[k]);
      box.high[k] = std::max(box.high[k], at(corner)[k]);
    }
  }
  return box;
}

}  // namespace merlin::render::lod
