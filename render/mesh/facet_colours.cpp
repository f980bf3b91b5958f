#include "render/mesh/facet_colours.h"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace merlin::render::mesh {
namespace {

// A corner of a triangle. Colours are compared by their bits, because NaN has no order.
struct Corner {
  std::uint32_t vertex;
  std::array<std::uint32_t, 3> colour;
  std::uint32_t corner;                             // index into the triangles
  auto operator<=>(const Corner&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14
};

std::vector<Corner> sortedCorners(std::span<const float> colours, const Mesh& mesh) {
  std::vector<Corner> corners;
  corners.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const float* const c = &colours[3 * (i / 3)];
    corners.push_back({mesh.triangles[i],
                       {std::bit_cast<std::uint32_t>(c[0]), std::bit_cast<std::uint32_t>(c[1]),
                        std::bit_cast<std::uint32_t>(c[2])},
                       static_cast<std::uint32_t>(i)});
  }
  std::ranges::sort(corners);
  return corners;
}

}  // namespace

void colourByFacets(std::span<const float> colours, Mesh& mesh) {
  const std::vector<Corner> corners = sortedCorners(colours, mesh);
  Feature colour{"colour", 3, std::vector<float>(3 * mesh.vertexCount(), 1.0F)};
  std::uint32_t vertex = 0;
  for (auto at = corners.begin(); at != corners.end(); ++at) {
    const bool first = at == corners.begin() || std::prev(at)->vertex != at->vertex;
    if (first) {
      vertex = at->vertex;
    } else if (std::prev(at)->colour != at->colour) {
      vertex = addCopy(at->vertex, mesh);
      colour.values.resize(3 * mesh.vertexCount());
    }
    for (std::size_t k = 0; k < 3; ++k)
      colour.values[3 * std::size_t{vertex} + k] = std::bit_cast<float>(at->colour[k]);
    mesh.triangles[at->corner] = vertex;
  }
  mesh.features.push_back(std::move(colour));
}

}  // namespace merlin::render::mesh
