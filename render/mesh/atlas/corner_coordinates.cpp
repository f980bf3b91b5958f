#include "render/mesh/atlas/corner_coordinates.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <map>

namespace merlin::render::mesh {
namespace {

using Bits = std::array<std::uint32_t, 3>;  // a vertex, and the bits of u and v

void appendCopy(std::vector<float>& values, std::size_t dimension, std::size_t row) {
  for (std::size_t k = 0; k < dimension; ++k) values.push_back(values[row * dimension + k]);
}

}  // namespace

void setCornerCoordinates(Mesh& mesh, const std::vector<std::array<float, 2>>& corners) {
  assert(corners.size() == mesh.triangles.size());
  std::erase_if(mesh.features, [](const Feature& f) { return f.name == "texcoord"; });
  std::vector<std::array<float, 2>> coordinates(mesh.vertexCount());
  std::vector<bool> set(mesh.vertexCount(), false);
  std::map<Bits, std::uint32_t> twins;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    std::uint32_t& v = mesh.triangles[i];
    // Turns -0 into 0.
    const std::array<float, 2> uv = {corners[i][0] + 0.0F, corners[i][1] + 0.0F};
    if (!set[v]) coordinates[v] = uv;
    set[v] = true;
    if (coordinates[v] == uv) continue;
    const Bits key = {v, std::bit_cast<std::uint32_t>(uv[0]), std::bit_cast<std::uint32_t>(uv[1])};
    const auto next = static_cast<std::uint32_t>(mesh.vertexCount());
    const auto [found, fresh] = twins.try_emplace(key, next);
    if (fresh) {
      appendCopy(mesh.positions, 3, v);
      for (Feature& f : mesh.features) appendCopy(f.values, f.dimension, v);
      coordinates.push_back(uv);
    }
    v = found->second;
  }
  Feature texcoord{"texcoord", 2, {}};
  for (const auto& uv : coordinates)
    texcoord.values.insert(texcoord.values.end(), uv.begin(), uv.end());
  mesh.features.push_back(std::move(texcoord));
}

}  // namespace merlin::render::mesh
