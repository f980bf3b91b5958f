#include "render/reduce/quadric/quadric_refresh.h"

#include <atomic>

namespace merlin::render::reduce {
namespace {

// Turns all hubs back into normal vertices. Not in parallel, since the stars of several hubs may
// contain the same dead vertices.
void releaseHubs(ReductionState& state) {
  for (std::uint32_t v = 0; state.hubs && v < state.mesh.vertexCount(); ++v) {
    if (!(state.mesh[v].flags & kHub)) continue;
    state.mesh.tidyHub(v);
    state.mesh[v].flags &= static_cast<std::uint8_t>(~kHub);
  }
}

}  // namespace

void refreshQuadrics(ReductionState& state) {
  releaseHubs(state);
  std::atomic<bool> hubs = false;
  const EvaluateEdges set = edgeEvaluator(Evaluate::kQuadric);
  forEachLiving(state, [&](std::uint32_t v, EdgeCosts& scratch) {
    const std::uint32_t triangles = state.mesh[v].degree;
    if (triangles <= state.rules.most_corners) {
      set(state.view(), v, scratch);
      return;
    }
    setHub(state.mesh[v], triangles);
    hubs = true;
  });
  state.hubs = hubs;
}

}  // namespace merlin::render::reduce
