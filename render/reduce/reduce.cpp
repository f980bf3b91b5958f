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

// Why it stops before the next collapse; empty where it goes on.
const char* reasonToStop(const PatternReducer& reducer, const ReduceSettings& s,
                         std::size_t triangles_before, float diagonal) {
  const std::size_t left = reducer.triangles();
  if (left <= s.min_triangles) return "triangles";
  if (static_cast<double>(left) <= s.min_percent / 100 * static_cast<double>(triangles_before)) {
    return "percent";
  }
  if (100.0 * reducer.error() > s.max_error_percent * diagonal) return "error";
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
  const float diagonal = boundingBox(mesh.positions).diagonal();
  const char* stopped = nullptr;
  while (!stopped) {
    stopped = reasonToStop(reducer, settings, mesh.triangleCount(), diagonal);
    if (!stopped && !reducer.collapseShortest()) stopped = "nothing left to collapse";
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
