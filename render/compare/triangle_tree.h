// TriangleTree: a box tree over a mesh's triangles that finds the point of the surface nearest to
// any point.
//
// Binary, binned surface area heuristic, at most 4 triangles a leaf; a node holds both children's
// boxes in one cache line. Triangles are kept in the order of the leaves: a triangle's place in
// that order is how the tree speaks of it, and neighbours there are neighbours in space.
#pragma once

#include <cstdint>
#include <vector>

#include "render/compare/triangle_distance.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// Reentrant once made.
class TriangleTree {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Nearest {
    NearestPoint point;
    std::uint32_t place = kNone;
  };

  // O(n log n) time, about 110 bytes a triangle; keeps no reference to the mesh.
  // REQUIRES: validate(mesh).ok(), at least one triangle. Those without area are legal.
  explicit TriangleTree(const Mesh& mesh);

  std::size_t size() const noexcept { return order_.size(); }
  std::uint32_t triangleAt(std::uint32_t place) const noexcept { return order_[place]; }
  std::array<Vector, 3> cornersAt(std::uint32_t place) const noexcept;

  // Nearest point on one triangle.
  NearestPoint nearestAt(std::uint32_t place, const Vector& p) const noexcept {
    return nearestOnTriangle(p, cornersAt(place));
  }

  // Nearest point on the whole surface. `hint`: a place that may be near (the last answer); it only
  // changes which of several equally near triangles is named, and how long the search takes.
  Nearest nearest(const Vector& p, std::uint32_t hint = kNone) const noexcept;

 private:
  struct Node {
    float low[3][2], high[3][2];  // axis, child
    std::uint32_t child[2];       // a node; where count is not 0 the first place of a leaf
    std::uint32_t count[2];
  };
  static_assert(sizeof(Node) == 64);

  class Builder;

  void nearestOfLeaf(const Node& node, int side, const Vector& p, Nearest& best) const noexcept;

  std::vector<Node> nodes_;           // the first is the root
  std::vector<std::uint32_t> order_;  // place -> triangle of the mesh
  std::vector<float> corners_;        // places x 9
};

}  // namespace merlin::render
