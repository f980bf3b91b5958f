// Dendrogram: the merge tree of a reduction, from which a mesh of any triangle count is extracted
// ("cut") directly.
//
// A reduction of a mesh with V vertices by C collapses has N = V + C nodes: each vertex, and the
// new vertex of each collapse (so optimal positions are kept). A node is alive until a collapse
// merges it with another node. Nodes are numbered by that collapse, last one first: the roots,
// which are never merged, then the two nodes that collapse C-1 merges, ... the two that collapse 0
// merges. So
//
//   collapse k merges the nodes N - 2k - 1 and N - 2k - 2, and their parent has a smaller number;
//   at level L (collapses 0..L-1 done) a node is dead if its number is >= N - 2L.
//
// Triangles are those of the mesh, with leaf nodes as corners, sorted by the collapse that removes
// them, latest first: the triangles alive at a level are a prefix. A cut takes that prefix and
// replaces each corner by its nearest ancestor that is alive. It needs no state of other cuts,
// allows levels in any order, and is exact to one collapse. The idea: H. Hoppe, "Progressive
// Meshes", 1996, here as a sorted merge tree (../../README.md has measurements); the dendrogram is
// [GOURLEY98] 4.2.2.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"

namespace merlin::render::lod {

struct FeatureView {
  std::string name;
  std::size_t dimension = 1;
  std::span<const float> values;  // nodes x dimension
};

// A read-only view of a dendrogram in memory; `owner` keeps the memory (a file's mapping, or
// arrays) alive. Reentrant: any number of threads may cut one dendrogram.
class Dendrogram {
 public:
  struct Arrays {
    std::span<const float> positions;  // nodes x 3 [model units]
    std::vector<FeatureView> features;
    // One per collapse; [k]: the node that collapse k makes.
    std::span<const std::uint32_t> parents;
    std::span<const std::uint32_t> triangles;  // triangles x 3: leaf nodes, sorted as above
    // One per level; [L]: triangles left at level L, 0..C.
    std::span<const std::uint32_t> alive;
    // One per level: estimate [model units]; never decreases.
    std::span<const float> error;
    std::string about;
    std::span<const std::uint8_t> texture{};  // a PNG or JPEG file (not checked), or empty
  };

  // Makes a dendrogram of `arrays`, which must lie in memory that `owner` keeps alive. Checks
  // everything that a cut relies on, so that no file can make a cut read out of bounds or run
  // forever: sizes agree, corners are leaves, each inner node is made once, every path of parents
  // ends, triangle counts never increase. O(file). Errors: kMalformed.
  static Result<Dendrogram> make(Arrays arrays, std::shared_ptr<const void> owner);

  std::size_t nodeCount() const noexcept { return a_.positions.size() / 3; }
  std::size_t levels() const noexcept { return a_.alive.size(); }  // collapses + 1
  std::size_t vertexCount() const noexcept { return nodeCount() - a_.parents.size(); }
  std::size_t triangleCount() const noexcept { return a_.triangles.size() / 3; }
  const Arrays& arrays() const noexcept { return a_; }
  // Nullptr if there is no such feature.
  const FeatureView* find(std::string_view name) const noexcept;

  // collapseOf() returns the collapse that merges a node, parentOf() the node that this collapse
  // makes. REQUIRES: the node is not a root.
  std::size_t collapseOf(std::uint32_t node) const noexcept { return (nodeCount() - 1 - node) / 2; }
  std::uint32_t parentOf(std::uint32_t node) const noexcept { return a_.parents[collapseOf(node)]; }

  std::size_t trianglesAt(std::size_t level) const noexcept { return a_.alive[level]; }
  float errorAt(std::size_t level) const noexcept { return a_.error[level]; }

  // Returns the finest level with at most `budget` triangles; the coarsest level if none has so
  // few. O(log levels).
  std::size_t levelFor(std::size_t budget) const noexcept;

  // Returns the coarsest level whose error estimate is at most `error` [model units]; 0 if there is
  // none. O(log levels).
  std::size_t levelForError(float error) const noexcept;

  // Writes the triangles of `level` to `out`, as 3 * trianglesAt(level) node numbers; returns the
  // number of triangles. REQUIRES: level < levels(); `out` has room for the numbers. Allocates
  // nothing.
  std::size_t cut(std::size_t level, std::span<std::uint32_t> out) const noexcept;

 private:
  Dendrogram(Arrays arrays, std::shared_ptr<const void> owner)
      : a_(std::move(arrays)), owner_(std::move(owner)) {}

  Arrays a_;
  std::shared_ptr<const void> owner_;
};

// Builds the dendrogram of a reduction; `mesh` is the mesh before the reduction. O(n log n) time,
// about twice the memory of the result. Reentrant; the same input gives the same bytes. REQUIRES:
// `log` belongs to `mesh`, and no node is merged twice.
Dendrogram buildDendrogram(const mesh::Mesh& mesh, const CollapseLog& log);

// Returns the surface at `level` as an independent mesh, with the features of its nodes. REQUIRES:
// level < levels().
mesh::Mesh extract(const Dendrogram& dendrogram, std::size_t level);

}  // namespace merlin::render::lod
