// Implements the cost `pattern`: calls PatternReducer until a stop criterion is met.
#include <algorithm>

#include "render/reduce/costs.h"
#include "render/reduce/pattern/pattern_reducer.h"

namespace merlin::render::reduce {
namespace {

constexpr std::size_t kProgressInterval = 4096;

// Returns the name of the stop criterion that a mesh of `left` triangles meets, or nullptr if it
// meets none.
const char* reasonToStop(std::size_t left, const ReduceSettings& s, std::size_t triangles_before) {
  if (left <= s.min_triangles) return "triangles";
  if (static_cast<double>(left) <= s.min_percent / 100 * static_cast<double>(triangles_before)) {
    return "percent";
  }
  return nullptr;
}

}  // namespace

Result<Reduction> reduceByPattern(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress) {
  const Weights weights = weightsFor(mesh, settings);
  const auto space = PatternSpace::make(mesh, weights);
  if (!space) return space.error();

  PatternReducer reducer(mesh, *space, settings.preserve_topology, settings.preserve_components);
  bool components_stay = settings.preserve_components && !settings.preserve_topology;
  const double max_error =
      settings.max_error_percent / 100 * mesh::boundingBox(mesh.positions).diagonal();
  const char* stopped = nullptr;
  std::size_t by_all_rules = 0;
  while (!stopped) {
    stopped = reasonToStop(reducer.triangles(), settings, mesh.triangleCount());
    if (stopped) break;
    const auto step = reducer.collapseShortest(max_error);
    if (step == PatternReducer::Step::kNothingLeft) {
      if (reducer.allowLargerStars()) continue;
      if (components_stay) {
        by_all_rules = reducer.triangles();
        reducer.releaseComponents();
      } else {
        stopped = "nothing left to collapse";
      }
      components_stay = false;
    }
    if (step == PatternReducer::Step::kTooCoarse) stopped = "error";
    if (!stopped && progress && reducer.collapses() % kProgressInterval == 0 &&
        !progress({reducer.collapses(), reducer.triangles()})) {
      stopped = "cancelled";
    }
  }
  Reduction result = std::move(reducer).finish();
  result.report.stopped = stopped;
  result.report.by_all_rules = std::max(by_all_rules, result.report.triangles);
  result.log.about = aboutText(settings, weights, result.report);
  return result;
}

}  // namespace merlin::render::reduce
