// Triangulates a file's faces with more than three corners; the triangles stay inside the face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// A face with more corners than this stays a fan around its first corner, since any other
// triangulation takes O(corners^2).
inline constexpr std::size_t kMostCutCorners = 4096;

// A face as a fan around its first corner: corners - 2 consecutive triangles of the mesh.
struct Fan {
  std::size_t triangle = 0;  // index of the first one
  std::size_t corners = 0;
};

// Triangulates the polygon with these corners (x, y, z each) in the plane of Newell's normal.
// Returns three corner indices for each of its corners - 2 triangles, which all face the same way.
// Returns an empty vector if the fan around the first corner is right, i.e. none of its triangles
// faces the other way (as in every convex polygon); and if no other triangulation is found: the
// polygon has no area, crosses itself, has a coordinate that is not finite or more than
// kMostCutCorners corners. O(corners^2).
std::vector<std::uint32_t> cutPolygon(std::span<const float> positions);

// Collects the faces of a file for which a fan is wrong, or may be wrong because their vertices
// have not been read yet.
class Fans {
 public:
  // Takes the last corners - 2 triangles of `mesh` as the fan of a face. REQUIRES: corners >= 3.
  void take(const Mesh& mesh, std::size_t corners);

  // Called for each face that is not triangulated as a fan. `order`: what cutPolygon() returned.
  using OnCut = std::function<void(const Fan& fan, std::span<const std::uint32_t> order)>;
  // To be called when all vertices have been read. Triangulates anew the collected faces for which
  // a fan is wrong, and calls `on_cut` for each of them.
  void cut(Mesh& mesh, const OnCut& on_cut = {});

 private:
  std::vector<Fan> fans_;
};

// Reorders the values at the corners of a fan's triangles to match the new triangulation `order`.
template <typename T>
void reorder(const Fan& fan, std::span<const std::uint32_t> order, std::vector<T>& at_corners) {
  T* const at = &at_corners[3 * fan.triangle];
  std::vector<T> values = {at[0], at[1]};
  for (std::size_t k = 2; k < fan.corners; ++k) values.push_back(at[3 * (k - 2) + 2]);
  for (std::size_t i = 0; i < order.size(); ++i) at[i] = values[order[i]];
}

}  // namespace merlin::render::mesh
