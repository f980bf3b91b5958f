#include "render/mesh/borders.h"

#include <algorithm>
#include <cstdint>

namespace merlin::render::mesh {

std::vector<bool> borderVertices(const Mesh& mesh) {
  std::vector<std::uint64_t> edges;
  edges.reserve(mesh.triangles.size());
  for (std::size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    const std::uint64_t a = mesh.triangles[corner];
    const std::uint64_t b = mesh.triangles[corner % 3 == 2 ? corner - 2 : corner + 1];
    edges.push_back(std::min(a, b) << 32 | std::max(a, b));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<bool> border(mesh.vertexCount());
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::upper_bound(edge, edges.end(), *edge);
    if (next - edge == 1) border[*edge >> 32] = border[*edge & 0xffffffff] = true;
    edge = next;
  }
  return border;
}

}  // namespace merlin::render::mesh
