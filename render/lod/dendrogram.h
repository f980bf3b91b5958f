// Dendrogram: the merge tree of a reduction, from which any triangle count is cut at once.
//
// A reduction of a mesh with V vertices by C collapses has N = V + C nodes: each vertex, and the
// new vertex of each collapse (so optimal positions are kept). Nodes are numbered by when they die,
// last first: roots, then the two that collapse C-1 merges, ... the two that collapse 0 merges. So
//
//   collapse k merges the nodes N - 2k - 1 and N - 2k - 2, and their parent has a smaller number;
//   at level L (collapses 0..L-1 done) a node is dead if its number is >= N - 2L.
//
// Triangles are the mesh's own, with leaf corners, sorted by the collapse that removes them, last
// first: those alive at a level are a prefix. A cut takes that prefix and chases each corner up its
// parents to the first node that is alive. No state from the last frame, any order, exact to one
// collapse. The idea: H. Hoppe, "Progressive Meshes", 1996, told as a sorted merge tree
// (../../README.md says what was measured); the dendrogram is [GOURLEY98] 4.2.2.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct FeatureView {
  std::string name;
  std::size_t dimension = 1;
  std::span<const float> values;  // nodes x dimension
};

// A read-only view; the memory (a file's mapping, or arrays) is kept alive by `owner`.
// Reentrant: any number of threads may cut one dendrogram.
class Dendrogram {
 public:
  struct Arrays {
    std::span<const float> positions;  // nodes x 3, model units
    std::vector<FeatureView> features;
    std::span<const std::uint32_t> parents;    // collapses: the node that collapse k makes
    std::span<const std::uint32_t> triangles;  // triangles x 3, leaf nodes, sorted as above
    std::span<const std::uint32_t> alive;      // levels: triangles left at level 0..C
    std::span<const float> error;  // levels: estimate at level 0..C, model units, rising
    std::string about;
    std::span<const std::uint8_t> texture{};  // the picture of "texcoord", a PNG or JPEG file, not
                                              // looked into; or none
  };

  // Checks everything that a cut relies on, so that no file can lead it astray: sizes that agree,
  // corners that are leaves, each inner node made once, chains that end, counts that fall. O(file).
  // Errors: kMalformed.
  static Result<Dendrogram> make(Arrays arrays, std::shared_ptr<const void> owner);

  std::size_t nodeCount() const noexcept { return a_.positions.size() / 3; }
  std::size_t levels() const noexcept { return a_.alive.size(); }  // collapses + 1
  std::size_t vertexCount() const noexcept { return nodeCount() - a_.parents.size(); }
  std::size_t triangleCount() const noexcept { return a_.triangles.size() / 3; }
  const Arrays& arrays() const noexcept { return a_; }
  const FeatureView* find(std::string_view name) const noexcept;  // nullptr if there is none

  // For a node that dies: the collapse that merges it, and the node that this collapse makes.
  std::size_t collapseOf(std::uint32_t node) const noexcept { return (nodeCount() - 1 - node) / 2; }
  std::uint32_t parentOf(std::uint32_t node) const noexcept { return a_.parents[collapseOf(node)]; }

  std::size_t trianglesAt(std::size_t level) const noexcept { return a_.alive[level]; }
  float errorAt(std::size_t level) const noexcept { return a_.error[level]; }

  // The finest level with at most `budget` triangles; the coarsest where none is that small.
  // O(log levels).
  std::size_t levelFor(std::size_t budget) const noexcept;

  // The coarsest level whose error estimate is at most `error`, model units. O(log levels).
  std::size_t levelForError(float error) const noexcept;

  // Writes the triangles of `level`, 3 * trianglesAt(level) node numbers, to `out`; returns how
  // many triangles. REQUIRES: level < levels(), out large enough. Allocates nothing.
  std::size_t cut(std::size_t level, std::span<std::uint32_t> out) const noexcept;

 private:
  Dendrogram(Arrays arrays, std::shared_ptr<const void> owner)
      : a_(std::move(arrays)), owner_(std::move(owner)) {}

  Arrays a_;
  std::shared_ptr<const void> owner_;
};

// Sorts nodes and triangles of a reduction as above. `mesh` is the mesh before it.
// O(n log n) time, about 2 x the result's memory. Reentrant; same input, same bytes.
// REQUIRES: the log is of this mesh, and no node is merged twice.
Dendrogram buildDendrogram(const Mesh& mesh, const CollapseLog& log);

// The surface at `level` as a mesh of its own, with the features of its nodes.
Mesh extract(const Dendrogram& dendrogram, std::size_t level);

}  // namespace merlin::render
