// Reduction: a mesh to the log of its collapses, of which the dendrogram is built.
//
// Edges are collapsed one after another, cheapest first. What an edge costs is chosen by name; all
// costs see the modalities of the mesh as one space, with one weight each ([GOURLEY98] chapter 4,
// POLYMUR). What is ours in it and what the source leaves open: README.md.
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

namespace merlin::render {

struct ReduceSettings {
  std::string cost = "quadric";  // of costs()
  Weights weights{};             // empty: the cost's own
  bool preserve_topology =
      false;  // refuse collapses that join or pinch off parts ([GOURLEY98] 6.1)
  // Keep of every component a triangle as long as anything else can go; without it what is smaller
  // than the error goes as well.
  bool preserve_components = false;
  std::vector<bool> locked{};  // quadric: of the mesh's vertices, those that stay where they are as
                               // long as anything else can go, and then all of seams; empty: none
  bool fast = false;           // quadric: a tenth to a third less time, about 6 % more error
  unsigned threads = 0;        // 0: as many as the machine has; the result is the same
  // Bytes that it may take beside the mesh, log included; 0: all it wants. Where that is less than
  // it would take, `quadric` works in blocks, of which the result depends (memory.h).
  std::size_t memory = 0;

  // When to stop, whichever comes first: as soon as no more triangles are left than these,
  // and before the error would be larger. As they stand: when nothing legal is left.
  std::size_t min_triangles = 0;
  double min_percent = 0;  // of the mesh's triangles left, 0..100
  double max_error_percent = std::numeric_limits<double>::infinity();  // the cost's estimate, of
                                                                       // the diagonal of the box
};

struct ReduceProgress {
  std::size_t collapses = 0;
  std::size_t triangles = 0;  // left
};

struct ReduceReport {
  std::size_t collapses = 0;
  std::size_t flips_refused = 0;     // the same edge counts each time
  std::size_t topology_refused = 0;  // by preserve_topology, or since nothing would be left
  std::size_t triangles = 0;         // left
  std::size_t by_all_rules = 0;      // triangles left when the first rule gave way, or at the end
  std::size_t blocks = 1;            // that it was cut into for want of memory
  // Triangles at the ends of edges and beside them that steps looked at: the work, on any machine.
  // No more than some hundred times the mesh's, whatever that is.
  std::size_t visited = 0;
  float error = 0;           // estimate of the last level, model units
  const char* stopped = "";  // why: "nothing left to collapse", "triangles", "percent",
                             // "error", "cancelled"
};

struct Reduction {
  CollapseLog log;  // features as in the mesh that reduce() was given, after ensureNormals()
  ReduceReport report;
};

using Progress = std::function<bool(const ReduceProgress&)>;

// One way to say what an edge costs. A row of the table in reduce.cpp.
struct Cost {
  const char* name;
  const char* help;                 // one line, for a person
  Weights (*weights)(const Mesh&);  // where nobody says otherwise
  Result<Reduction> (*reduce)(const Mesh&, const ReduceSettings&, const Progress&);
};

std::span<const Cost> costs();
const Cost* findCost(std::string_view name);  // nullptr if there is none

// Reduces `mesh`; a last triangle always stays. The log's features follow mesh.features, of which
// "normal" is recomputed at each new vertex; a mesh without normals must get them first
// (ensureNormals).
//
// mesh      n vertices, m triangles; borders, components, non-manifold edges allowed.
// progress  called every few thousand collapses; false cancels (what was done is returned).
// errors    kInvalidArgument: no such cost, a weight or a stop criterion out of range, too little
//           memory.
// order     one input, one log, whatever the number of threads.
// cost      pattern: O(m log m) time, about 110 bytes an edge with three features beside the mesh;
//           quadric: O(m), README.md.
// thread    reentrant.
// REQUIRES  validate(mesh), tidy(mesh), and a feature "normal" of dimension 3.
Result<Reduction> reduce(const Mesh& mesh, const ReduceSettings& settings,
                         const Progress& progress = {});

}  // namespace merlin::render
