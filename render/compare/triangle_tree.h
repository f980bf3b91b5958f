// TriangleTree: a bounding volume hierarchy over the triangles of a mesh. It finds the point of the
// surface that is nearest to a given point, and the first point along a ray.
//
// The tree is binary, with axis-aligned boxes, built by a binned surface area heuristic, with at
// most 4 triangles per leaf; a node holds the boxes of both children in one cache line. Triangles
// are stored in the order of the leaves, so that neighbours in this order are close in space. A
// triangle's `place` is its index in this order.
#pragma once

#include <cstdint>
#include <vector>

#include "render/compare/triangle_distance.h"
#include "render/compare/triangle_ray.h"
#include "render/mesh/mesh.h"

namespace merlin::render::compare {

// Reentrant after construction.
class TriangleTree {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Nearest {
    NearestPoint point;
    std::uint32_t place = kNone;
  };

  struct Crossing {
    RayHit hit;
    std::uint32_t place = kNone;
  };

  // Takes O(n log n) time and about 110 bytes per triangle; keeps no reference to the mesh.
  // REQUIRES: validate(mesh).ok(), at least one triangle. Triangles without area are allowed.
  explicit TriangleTree(const mesh::Mesh& mesh);

  std::size_t size() const noexcept { return order_.size(); }
  std::uint32_t triangleAt(std::uint32_t place) const noexcept { return order_[place]; }
  std::array<Vector, 3> cornersAt(std::uint32_t place) const noexcept;

  // Returns the point of the triangle at `place` that is nearest to p.
  NearestPoint nearestAt(std::uint32_t place, const Vector& p) const noexcept {
    return nearestOnTriangle(p, cornersAt(place));
  }

  // Returns the point of the whole surface that is nearest to p. `hint`: place of a triangle that
  // may be near, such as the last result; it affects only the search time, and which of several
  // equally near triangles is returned.
  Nearest nearest(const Vector& p, std::uint32_t hint = kNone) const noexcept;

  // Returns where the ray first meets the surface, from either side; `place` is kNone if it does
  // not. If the ray meets several triangles at the same distance (on their common edge), returns
  // the triangle that is visited first, which depends only on the tree and the ray.
  Crossing firstAlong(const Ray& ray) const noexcept;

 private:
  struct Node {
    float low[3][2], high[3][2];  // [axis][child]
    std::uint32_t child[2];       // index of a node; if count is not 0, first place of a leaf
    std::uint32_t count[2];
  };
  static_assert(sizeof(Node) == 64);

  class Builder;

  // Calls visitLeaf(node, side) for the leaves whose boxes are nearer than `limit`, nearer boxes
  // first; the calls may lower `limit`. distancesOf(node) returns the distances of both children's
  // boxes, infinite for an empty box.
  template <typename DistancesOf, typename VisitLeaf>
  void walk(const DistancesOf& distancesOf, const double& limit,
            const VisitLeaf& visitLeaf) const noexcept;
  void nearestOfLeaf(const Node& node, int side, const Vector& p, Nearest& best) const noexcept;
  void firstOfLeaf(const Node& node, int side, const Ray& ray, Crossing& best) const noexcept;

  std::vector<Node> nodes_;           // the first is the root
  std::vector<std::uint32_t> order_;  // place -> triangle of the mesh
  std::vector<float> corners_;        // places x 9
};

}  // namespace merlin::render::compare
