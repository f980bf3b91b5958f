// Reduction: simplifies a mesh by edge collapses and returns the log of the collapses, from which
// buildDendrogram() makes a multiresolution model.
//
// Edges are collapsed one after another, the cheapest first. The cost function is chosen by name.
// All cost functions treat position and features of a vertex as one vector, in which each feature
// has a weight ([GOURLEY98] chapter 4, POLYMUR). The README.md of each cost's folder lists where we
// differ from the source.
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
  Weights weights{};             // empty: the default weights of the cost
  // Refuse collapses that join or separate parts of the surface ([GOURLEY98] 6.1).
  bool preserve_topology = false;
  // Keep at least one triangle of every connected component as long as any other triangle can be
  // removed. If false, components smaller than the error are removed as well.
  bool preserve_components = false;
  // Only for the cost quadric. One entry per vertex of the mesh: true keeps the vertex where it is
  // as long as any other collapse is allowed. If not empty, vertices on seams are kept as well.
  // Empty: no vertex is locked.
  std::vector<bool> locked{};
  bool fast = false;     // only for quadric: 10 to 33 % less time, about 6 % larger RMS error
  unsigned threads = 0;  // 0: one per hardware thread; the result does not depend on it
  // Memory limit in bytes, without the mesh but with the log; 0: no limit. If it is too low for the
  // mesh as a whole, `quadric` reduces it in blocks (memory.h); the result then depends on the
  // limit.
  std::size_t memory = 0;

  // Stop criteria; the first one that is met ends the reduction: the number of triangles falls to
  // one of the two minima, or going on would exceed the maximum error. With the defaults the
  // reduction ends when no legal collapse is left.
  std::size_t min_triangles = 0;
  double min_percent = 0;  // triangles left, in percent of the mesh's, 0..100
  // Limit of the cost's error estimate, in percent of the diagonal of the bounding box.
  double max_error_percent = std::numeric_limits<double>::infinity();
};

struct ReduceProgress {
  std::size_t collapses = 0;
  std::size_t triangles = 0;  // left
};

struct ReduceReport {
  std::size_t collapses = 0;
  // Refused collapses; an edge counts each time that it is refused. Flips: a face would turn over.
  // Topology: mostly the link condition, but also labels, components and large stars.
  std::size_t flips_refused = 0;
  std::size_t topology_refused = 0;
  std::size_t triangles = 0;     // left
  std::size_t by_all_rules = 0;  // triangles left when the first rule was dropped, or at the end
  std::size_t blocks = 1;        // that the mesh was cut into to save memory; 1: none
  // Measure of the work that does not depend on the machine: number of triangles in all stars that
  // were looked at. At most a few hundred times the mesh's triangles, whatever its shape.
  std::size_t visited = 0;
  float error = 0;           // largest error estimate of all collapses, model units
  const char* stopped = "";  // why: "nothing left to collapse", "triangles", "percent",
                             // "error", "cancelled"
};

struct Reduction {
  lod::CollapseLog log;  // has the features of the mesh that reduce() was given, in their order
  ReduceReport report;
};

using Progress = std::function<bool(const ReduceProgress&)>;

// A cost function for edge collapses: one row of the table in reduce.cpp.
struct Cost {
  const char* name;
  const char* help;                       // one line, for a person
  Weights (*weights)(const mesh::Mesh&);  // default weights
  Result<Reduction> (*reduce)(const mesh::Mesh&, const ReduceSettings&, const Progress&);
};

std::span<const Cost> costs();
const Cost* findCost(std::string_view name);  // nullptr if there is none

// Reduces `mesh`; at least one triangle always stays. The log has the features of the mesh, of
// which "normal" is recomputed at each new vertex. A mesh without normals must get them from
// ensureNormals() first.
//
// mesh      n vertices, m triangles; borders, components, non-manifold edges allowed.
// progress  called regularly on the caller's thread; false cancels, and the collapses done so far
//           are returned.
// errors    kInvalidArgument: no such cost, a weight or a stop criterion out of range, too little
//           memory.
// order     the same input gives the same log, whatever the number of threads.
// cost      pattern: O(m log m) time; with three features about 110 bytes an edge in addition to
//           the mesh. quadric: O(m) time; figures in quadric/README.md.
// thread    reentrant.
// REQUIRES  validate(mesh), tidy(mesh), and a feature "normal" of dimension 3.
Result<Reduction> reduce(const mesh::Mesh& mesh, const ReduceSettings& settings,
                         const Progress& progress = {});

}  // namespace merlin::render::reduce
