// Reduction: a mesh to the log of its collapses, of which the dendrogram is built.
//
// POLYMUR, [GOURLEY98] chapter 4: shortest edge first, length measured in the space of all
// modalities. What is ours in it and what the source leaves open: README.md.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include "daemon/base/result.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render {

struct ReduceSettings {
  Weights weights{};               // empty: defaultWeights()
  bool preserve_topology = false;  // refuse collapses that join or pinch off parts (P11)

  // When to stop, whichever comes first (P10): as soon as no more triangles are left than these,
  // and before the error would be larger. As they stand: when nothing legal is left.
  std::size_t min_triangles = 0;
  double min_percent = 0;  // of the mesh's triangles left, 0..100
  double max_error_percent = std::numeric_limits<double>::infinity();  // estimate (P9), of the
                                                                       // diagonal of the box
};

struct ReduceProgress {
  std::size_t collapses = 0;
  std::size_t triangles = 0;  // left
};

struct ReduceReport {
  std::size_t collapses = 0;
  std::size_t flips_refused = 0;     // P8; the same edge counts each time
  std::size_t topology_refused = 0;  // by preserve_topology, or since nothing would be left
  std::size_t triangles = 0;         // left
  float error = 0;                   // estimate (P9) of the last level, model units
  const char* stopped = "";          // why: "nothing left to collapse", "triangles", "percent",
                                     // "error", "cancelled"
};

struct Reduction {
  CollapseLog log;  // features as in the mesh that reduce() was given, after ensureNormals()
  ReduceReport report;
};

// Reduces `mesh`; a last triangle always stays. The log's features follow mesh.features, of which
// "normal" is recomputed at each new vertex; a mesh without normals must get them first
// (ensureNormals).
//
// mesh      n vertices, m triangles; borders, components, non-manifold edges allowed.
// progress  called every few thousand collapses; false cancels (what was done is returned).
// errors    kInvalidArgument: a weight or a stop criterion out of range.
// order     ties go to the edge that comes first in the sorted list of edges: one input, one log.
// cost      O(m log m) time; about 110 bytes an edge with three features beside the mesh.
// thread    reentrant.
// REQUIRES  validate(mesh), tidy(mesh), and a feature "normal" of dimension 3.
Result<Reduction> reduce(const Mesh& mesh, const ReduceSettings& settings,
                         const std::function<bool(const ReduceProgress&)>& progress = {});

}  // namespace merlin::render
