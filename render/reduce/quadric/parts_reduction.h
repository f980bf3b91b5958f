// PartsReduction: reduces parts of the mesh in parallel, on several threads. Private to
// render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/reduce/quadric/collapse_loop.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

// The vertices are divided into parts along a space-filling curve. Each part is reduced
// independently, in steps up to a cost limit that is the same for all parts; no collapse reaches
// across a part's borders. Then parts are joined in pairs, so that borders never make up much of
// the mesh. The parts depend on the mesh alone, so the result does not depend on the number of
// threads.
class PartsReduction {
 public:
  // Returns the initial number of parts, a power of two; 1 means that the mesh is too small for
  // parts. The number is enough for several cores, but small, since triangles at the borders
  // between parts cannot be reduced until the parts are joined.
  static std::size_t partsFor(std::size_t vertices);

  // Keeps references to all three arguments, which must outlive it.
  PartsReduction(ReductionState& state, const Seams& seams, CollapseLoop& loop)
      : s_(state), seams_(seams), loop_(loop) {}

  // Reduces and joins parts until at most `keep` triangles are left or the last two parts have
  // reached their limit. Then state.whole has the sums of the parts' counts, and state.log has
  // their collapses, interleaved so that all parts are equally coarse at each point. REQUIRES:
  // partsFor() > 1.
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
  std::size_t limit_ = 0;  // index of the bucket up to which all parts have been reduced
};

}  // namespace merlin::render::reduce
