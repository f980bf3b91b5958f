// WholeReduction: reduces the entire mesh in one piece, under the rules of one QuadricStage (see
// quadric_rules.h). Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/reduce/quadric/collapse_loop.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

class WholeReduction {
 public:
  // Keeps references to both arguments, which must outlive it.
  WholeReduction(ReductionState& state, CollapseLoop& loop) : s_(state), loop_(loop) {}

  // Reduces the mesh until at most `keep` triangles are left or state.rules.stage allows no more
  // collapses. Collapses only small stars at first, where a collapse is fast; then raises the limit
  // of the star size step by step, as more collapses become possible with a higher limit.
  void run(std::size_t keep, const Progress& progress);

 private:
  void requeue();
  void reduceTo(std::size_t keep, const Progress& progress);
  std::uint32_t smallestLeftOut() const;

  ReductionState& s_;
  CollapseLoop& loop_;
};

}  // namespace merlin::render::reduce
