// Reduction: simplifies a mesh by edge collapses and returns the log of the collapses, from which
// buildDendrogram() makes a multiresolution model.
//
// Edges are collapsed one after another, the cheapest first. The cost function is chosen by name.
// Each cost function treats the position and features of a vertex as one vector, in which each
// feature has a weight ([GOURLEY98] chapter 4, POLYMUR). The README.md in the folder of each cost
// lists the differences from the source.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render::reduce {

struct ReduceSettings {
  std::string cost = "quadric";  // name of a row of costs()
  Weights weights{};             // empty: the default weights of the cost function
  // If true, refuses collapses that join or separate parts of the surface ([GOURLEY98] 6.1).
  bool preserve_topology = false;
  // If true, keeps at least one triangle of every connected component as long as any other triangle
  // can be removed. If false, components smaller than the error are removed as well.
  bool preserve_components = false;
  // Only for the cost `quadric`. Has one entry per vertex of the mesh; true keeps the position of
  // the vertex as long as any other collapse is allowed. If not empty, vertices on seams are locked
  // as well. Empty: no vertex is locked by the caller, and seams may shrink.
  std::vector<bool> locked{};
  // only for `quadric`: takes 10 to 33 % less time; RMS error about 6 % larger
  bool fast = false;
  unsigned threads = 0;  // 0: one per hardware thread; the result does not depend on it
  // Memory limit of the reduction in bytes, including the log but not the input mesh; 0: no limit.
  // If the limit is too low for the mesh as a whole, `quadric` reduces the mesh in blocks
  // (memory.h); the result then depends on the limit.
  std::size_t memory = 0;

  // Stop criteria: the reduction ends as soon as the number of triangles has fallen to one of the
  // two minima, or the next collapse would exceed the maximum error. With the defaults the
  // reduction ends when no legal collapse is left.
  std::size_t min_triangles = 0;
  double min_percent = 0;  // minimum of triangles, in percent of the input's, 0..100
  // Maximum of the cost function's error estimate, in percent of the diagonal of the bounding box.
  double max_error_percent = std::numeric_limits<double>::infinity();
};

struct ReduceProgress {
  std::size_t collapses = 0;
  std::size_t triangles = 0;  // left
};

struct ReduceReport {
  std::size_t collapses = 0;
  // Numbers of refused collapses; an edge counts each time it is refused. Flips: a face would turn
  // over. Topology: mostly the link condition, but also labels, components and large stars.
  std::size_t flips_refused = 0;
  std::size_t topology_refused = 0;
  std::size_t triangles = 0;     // left
  std::size_t by_all_rules = 0;  // triangles left when the first rule was dropped, or at the end
  std::size_t blocks = 1;        // number of blocks, to save memory; 1: reduced as a whole
  // Machine-independent measure of the work: the number of triangles in all stars that were
  // visited. It is at most a few hundred times the mesh's triangles, whatever the mesh's shape.
  std::size_t visited = 0;
  float error = 0;  // largest error estimate of all collapses [model units]
  // reason: "nothing left to collapse", "triangles", "percent", "error", "cancelled"
  const char* stopped = "";
};

struct Reduction {
  lod::CollapseLog log;  // has the features of the mesh that reduce() was given, in their order
  ReduceReport report;
};

using Progress = std::function<bool(const ReduceProgress&)>;

// A cost function for edge collapses; one row of the table in reduce.cpp.
struct Cost {
  const char* name;
  const char* help;                       // one-line description, shown to users
  Weights (*weights)(const mesh::Mesh&);  // default weights
  Result<Reduction> (*reduce)(const mesh::Mesh&, const ReduceSettings&, const Progress&);
};

std::span<const Cost> costs();
const Cost* findCost(std::string_view name);  // nullptr if no cost has this name

// Reduces `mesh` and returns the log of the collapses with a report; at least one triangle always
// remains. The log has the features of the mesh; "normal" is recomputed at each new vertex. Call
// ensureNormals() first for a mesh without normals.
//
// mesh      n vertices, m triangles; borders, components, non-manifold edges allowed.
// progress  called regularly on the caller's thread. If it returns false, the reduction stops and
//           returns the collapses done so far.
// errors    kInvalidArgument: no such cost, a weight or a stop criterion out of range, too little
//           memory.
// order     the same input gives the same log, whatever the number of threads.
// cost      `pattern` takes O(m log m) time and, with three features, about 110 bytes of memory per
//           edge in addition to the mesh. `quadric` takes O(m) time; memory: quadric/README.md.
// thread    reentrant.
// REQUIRES  validate(mesh), tidy(mesh), and a feature "normal" of dimension 3.
Result<Reduction> reduce(const mesh::Mesh& mesh, const ReduceSettings& settings,
                         const Progress& progress = {});

}  // namespace merlin::render::reduce
