// TriangleTree: a bounding volume hierarchy over the triangles of a mesh; finds the point of the
// surface that is nearest to a given point, and the first one along a ray.
//
// Binary, axis-aligned boxes, binned surface area heuristic, at most 4 triangles per leaf; a node
// holds both children's boxes in one cache line. Triangles are stored in the order of the leaves,
// so that neighbours in that order are close in space. A triangle's `place` is its index in that
// order.
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

  // O(n log n) time, about 110 bytes a triangle; keeps no reference to the mesh.
  // REQUIRES: validate(mesh).ok(), at least one triangle. Triangles without area are allowed.
  explicit TriangleTree(const mesh::Mesh& mesh);

  std::size_t size() const noexcept { return order_.size(); }
  std::uint32_t triangleAt(std::uint32_t place) const noexcept { return order_[place]; }
  std::array<Vector, 3> cornersAt(std::uint32_t place) const noexcept;

  // Nearest point on one triangle.
  NearestPoint nearestAt(std::uint32_t place, const Vector& p) const noexcept {
    return nearestOnTriangle(p, cornersAt(place));
  }

  // Finds the nearest point on the whole surface. `hint`: a place that may be near, such as the
  // last result; it affects only the search time, and which of several equally near triangles is
  // returned.
  Nearest nearest(const Vector& p, std::uint32_t hint = kNone) const noexcept;

  // Finds where the ray first meets the surface, from either side; kNone if it does not. If it
  // meets several triangles at the same distance (on their common edge), returns the one that is
  // visited first, which depends only on the tree and the ray.
  Crossing firstAlong(const Ray& ray) const noexcept;

 private:
  struct Node {
    float low[3][2], high[3][2];  // axis, child
    std::uint32_t child[2];       // a node; if count is not 0, the first place of a leaf
    std::uint32_t count[2];
  };
  static_assert(sizeof(Node) == 64);

  class Builder;

  // Visits the leaves whose boxes are nearer than `limit`, which the visits may lower; nearer boxes
  // first. distancesOf(node) gives the distances of both children's boxes, infinite for an empty
  // one.
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
