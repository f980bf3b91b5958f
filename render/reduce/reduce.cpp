#include "render/reduce/reduce.h"

#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "render/reduce/pattern_reducer.h"

namespace merlin::render {
namespace {

constexpr std::size_t kProgressInterval = 4096;

Result<Ok> check(const ReduceSettings& s) {
  if (!(s.min_percent >= 0 && s.min_percent <= 100)) {
    return Error{Errc::kInvalidArgument, fmt::format("percent {} is not 0 to 100", s.min_percent)};
  }
  if (!(s.max_error_percent >= 0)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("error {} % is not 0 or more", s.max_error_percent)};
  }
  return Ok{};
}

std::string aboutText(const Weights& weights, const ReduceSettings& s, const ReduceReport& report) {
  std::string text = fmt::format("cost=pattern\npreserve_topology={}\nstopped={}\n",
                                 s.preserve_topology, report.stopped);
  for (const auto& [name, weight] : weights) text += fmt::format("weight.{}={}\n", name, weight);
  return text;
}

// Why so many triangles are few enough; null where they are not.
const char* reasonToStop(std::size_t left, const ReduceSettings& s, std::size_t triangles_before) {
  if (left <= s.min_triangles) return "triangles";
  if (static_cast<double>(left) <= s.min_percent / 100 * static_cast<double>(triangles_before)) {
    return "percent";
  }
  return nullptr;
}

}  // namespace

Result<Reduction> reduce(const Mesh& mesh, const ReduceSettings& settings,
                         const std::function<bool(const ReduceProgress&)>& progress) {
  assert(mesh.find("normal") && mesh.find("normal")->dimension == 3);
  if (const auto checked = check(settings); !checked) return checked.error();
  const Weights weights = settings.weights.empty() ? defaultWeights(mesh) : settings.weights;
  const auto space = PatternSpace::make(mesh, weights);
  if (!space) return space.error();

  PatternReducer reducer(mesh, *space, settings.preserve_topology);
  const double max_error =
      settings.max_error_percent / 100 * boundingBox(mesh.positions).diagonal();
  const char* stopped = nullptr;
  while (!stopped) {
    stopped = reasonToStop(reducer.triangles(), settings, mesh.triangleCount());
    if (stopped) break;
    const auto step = reducer.collapseShortest(max_error);
    if (step == PatternReducer::Step::kNothingLeft) stopped = "nothing left to collapse";
    if (step == PatternReducer::Step::kTooCoarse) stopped = "error";
    if (!stopped && progress && reducer.collapses() % kProgressInterval == 0 &&
        !progress({reducer.collapses(), reducer.triangles()})) {
      stopped = "cancelled";
    }
  }
  Reduction result = std::move(reducer).finish();
  result.report.stopped = stopped;
  result.log.about = aboutText(weights, settings, result.report);
  return result;
}

}  // namespace merlin::render
