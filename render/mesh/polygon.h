// Faces of more than three corners, as files have them: each becomes triangles within itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// The triangles of a face with more corners than this stay the fan around its first corner: to cut
// it otherwise takes O(corners^2).
inline constexpr std::size_t kMostCutCorners = 4096;

// A face as the fan around its first corner: corners - 2 triangles that follow one another.
struct Fan {
  std::size_t triangle = 0;  // the first of them
  std::size_t corners = 0;
};

// Cuts the polygon with these corners (x, y, z each) in the plane of Newell's normal. Returns three
// numbers of corners for each of its corners - 2 triangles, which face the same way. Empty where
// the fan around the first corner has no triangle that faces the other way, as in every convex
// polygon; and where no other cut is found: the polygon has no area, crosses itself, has a
// coordinate that is not finite or more than kMostCutCorners corners. O(corners^2).
std::vector<std::uint32_t> cutPolygon(std::span<const float> positions);

// Collects the faces of a file for which a fan is wrong, or of which that is not known yet, since
// their vertices come later.
class Fans {
 public:
  // Takes the last triangles of `mesh` as the fan of a face of so many corners, 3 or more.
  void take(const Mesh& mesh, std::size_t corners);

  // What is to be done for a face that is cut otherwise than as a fan: `order` is what
  // cutPolygon() returned.
  using OnCut = std::function<void(const Fan& fan, std::span<const std::uint32_t> order)>;
  // Once all vertices are there: cuts the faces that are to be cut, and calls `on_cut` for each.
  void cut(Mesh& mesh, const OnCut& on_cut = {});

 private:
  std::vector<Fan> fans_;
};

// Puts values at the corners of a fan's triangles into the order of the cut.
template <typename T>
void reorder(const Fan& fan, std::span<const std::uint32_t> order, std::vector<T>& at_corners) {
  T* const at = &at_corners[3 * fan.triangle];
  std::vector<T> values = {at[0], at[1]};
  for (std::size_t k = 2; k < fan.corners; ++k) values.push_back(at[3 * (k - 2) + 2]);
  for (std::size_t i = 0; i < order.size(); ++i) at[i] = values[order[i]];
}

}  // namespace merlin::render::mesh
