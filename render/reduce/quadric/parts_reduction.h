// PartsReduction: reduces parts of the mesh side by side, on several threads. Private to
// render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/collapse_loop.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

// The vertices are divided into parts along a space-filling curve. Each part is reduced by itself,
// step by step up to a common cost; no collapse reaches across its borders. Then parts are joined
// in pairs, so that borders never make up much of the mesh. The parts depend on the mesh alone, so
// the result does not depend on the number of threads.
class PartsReduction {
 public:
  // Returns the initial number of parts, a power of two: enough for several cores, but few, since
  // triangles at the borders between parts have to wait. 1: the mesh is too small for parts.
  static std::size_t partsFor(std::size_t vertices);

  // Keeps references, which must outlive it.
  PartsReduction(ReductionState& state, const Seams& seams, CollapseLoop& loop)
      : s_(state), seams_(seams), loop_(loop) {}

  // Reduces and joins parts until at most `keep` triangles are left or the last two parts have
  // reached their limit. The worker of the whole mesh takes over their counts, and state.log has
  // their collapses in an order in which all parts are equally coarse. REQUIRES: partsFor() > 1.
  void run(std::size_t keep, const Progress& progress);

 private:
  std::vector<CollapseWorker> makeParts(std::size_t count);
  bool isInside(const CollapseWorker& w, std::uint32_t v) const;
  void startPart(CollapseWorker& w, EvaluateEdges measure);
  void reduceInSteps(std::vector<CollapseWorker>& parts, std::size_t keep,
                     const Progress& progress);
  void joinLogs(std::vector<CollapseWorker>& parts, HugeArray<std::uint32_t>& joined);
  void joinInPairs(std::vector<CollapseWorker>& parts);

  ReductionState& s_;
  const Seams& seams_;
  CollapseLoop& loop_;
  std::size_t limit_ = 0;  // the bucket that the parts have reached
};

}  // namespace merlin::render::reduce
