// Triangulates a file's faces with more than three corners; the triangles stay inside the face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// A face with more corners than this remains a fan around its first corner, since any other
// triangulation takes O(corners^2).
inline constexpr std::size_t kMostCutCorners = 4096;

// A face that is stored as a fan around its first corner: corners - 2 consecutive triangles of the
// mesh.
struct Fan {
  std::size_t triangle = 0;  // index of the fan's first triangle
  std::size_t corners = 0;
};

// Triangulates a polygon in the plane of its Newell normal. positions: x, y, z of each corner.
// Returns three corner indices for each of the corners - 2 triangles, which all face the same way.
// Returns an empty vector in two cases: the fan around the first corner is correct, i.e. none of
// its triangles faces the other way (as in every convex polygon); or no triangulation is found,
// because the polygon has no area, crosses itself, has a coordinate that is not finite, or has more
// than kMostCutCorners corners. O(corners^2).
std::vector<std::uint32_t> cutPolygon(std::span<const float> positions);

// Collects the faces of a file for which a fan is wrong, or may be wrong because their vertices
// have not been read yet.
class Fans {
 public:
  // Registers the last corners - 2 triangles of `mesh` as the fan of a face with this many corners.
  // REQUIRES: corners >= 3.
  void take(const Mesh& mesh, std::size_t corners);

  // Type of a function that is called for each face that is not triangulated as a fan. `order`: the
  // result of cutPolygon().
  using OnCut = std::function<void(const Fan& fan, std::span<const std::uint32_t> order)>;
  // Triangulates the registered faces for which a fan is wrong in a different way, and calls
  // `on_cut` for each of them. Call it once all vertices have been read.
  void cut(Mesh& mesh, const OnCut& on_cut = {});

 private:
  std::vector<Fan> fans_;
};

// Reorders per-corner values of a fan's triangles to match the new triangulation `order`.
// at_corners: 3 values for each triangle of the mesh.
template <typename T>
void reorder(const Fan& fan, std::span<const std::uint32_t> order, std::vector<T>& at_corners) {
  T* const at = &at_corners[3 * fan.triangle];
  std::vector<T> values = {at[0], at[1]};
  for (std::size_t k = 2; k < fan.corners; ++k) values.push_back(at[3 * (k - 2) + 2]);
  for (std::size_t i = 0; i < order.size(); ++i) at[i] = values[order[i]];
}

}  // namespace merlin::render::mesh
