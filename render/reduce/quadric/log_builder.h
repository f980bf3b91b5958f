// LogBuilder: converts the collapses of a finished reduction to a CollapseLog. Private to
// render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/lod/collapse_log.h"
#include "render/reduce/quadric/reduction_state.h"

namespace merlin::render::reduce {

// Keeps references to the state and the input mesh, which must outlive it.
class LogBuilder {
 public:
  LogBuilder(ReductionState& state, const mesh::Mesh& input) : s_(state), input_(input) {}

  // Returns the log; only its feature "normal" is filled. Frees the stars of the mesh and
  // overwrites state.next. O(n), on state.threads.
  lod::CollapseLog build();

 private:
  void copy(std::size_t k, lod::CollapseLog& log, std::vector<float>* normals) const;
  void pin(lod::CollapseLog& log) const;

  ReductionState& s_;
  const mesh::Mesh& input_;
};

}  // namespace merlin::render::reduce
