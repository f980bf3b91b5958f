#include "render/reduce/quadric/quadric_reducer.h"

#include <algorithm>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric/log_builder.h"
#include "render/reduce/quadric/parts_reduction.h"
#include "render/reduce/quadric/whole_reduction.h"

namespace merlin::render::reduce {

QuadricReducer::QuadricReducer(const mesh::Mesh& mesh, std::size_t channels, Threads threads)
    : input_(mesh), state_(mesh, channels, threads) {}

void QuadricReducer::setChannel(std::size_t channel, const float* values, std::size_t stride,
                                float scale) {
  const QuadricMesh& mesh = state_.mesh;
  const auto weighted = [&](float value) { return value * scale * mesh.scale(); };
  QuadricChannels::Range given{values[0], values[0]};
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
    given = {std::min(given.low, values[v * stride]), std::max(given.high, values[v * stride])};
  forEach(state_.threads, mesh.vertexCount(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    state_.channels.value(v, channel) = weighted(values[mesh.inputOf(v) * stride]);
  });
  state_.channels.setRange(channel, given, {weighted(given.low), weighted(given.high)});
}

void QuadricReducer::setLabels(const float* values) {
  state_.labels.resize(state_.mesh.vertexCount());
  for (std::uint32_t v = 0; v < state_.labels.size(); ++v)
    state_.labels[v] = values[state_.mesh.inputOf(v)];
}

void QuadricReducer::lock(const std::vector<bool>& locked) {
  state_.locked = locked;
  for (std::uint32_t v = 0; v < state_.mesh.vertexCount(); ++v) {
    if (locked[state_.mesh.inputOf(v)]) state_.mesh[v].flags |= kLocked;
  }
}

const char* QuadricReducer::run(const Limits& limits, const Progress& progress) {
  state_.threads = limits.threads;
  state_.rules.max_error = limits.error * state_.mesh.scale();
  state_.rules.fast = limits.fast;
  state_.rules.keep_components = limits.preserve_topology || limits.preserve_components;
  const std::size_t keep = std::max<std::size_t>(limits.triangles, 1);
  // Parts stop at three times the target, so that the final reduction of the whole mesh can even
  // out differences in coarseness between them.
  if (PartsReduction::partsFor(state_.mesh.vertexCount()) > 1 && 3 * keep < state_.triangles)
    PartsReduction(state_, seams_, loop_).run(3 * keep, progress);
  else
    state_.whole.room = state_.mesh.freeRoom();
  state_.whole.log = state_.log.data();
  runStages(keep, limits, progress);
  if (state_.cancelled) return "cancelled";
  if (state_.triangles <= keep && limits.triangles > 0) return "triangles";
  return state_.whole.too_coarse ? "error" : "nothing left to collapse";
}

void QuadricReducer::runStages(std::size_t keep, const Limits& limits, const Progress& progress) {
  WholeReduction whole(state_, loop_);
  by_all_rules_ = state_.triangles;
  const auto stages = {QuadricStage::kAll, QuadricStage::kNoLock, QuadricStage::kNoLink,
                       QuadricStage::kNoFlips};
  for (const QuadricStage stage : stages) {
    if (state_.triangles <= keep || state_.cancelled) return;
    if (stage != QuadricStage::kAll && limits.by_all_rules) return;
    // Once the error limit is reached, dropping rules would not help.
    if (stage != QuadricStage::kAll && state_.whole.too_coarse) return;
    if (stage == QuadricStage::kNoLock && state_.labels.empty()) continue;
    if (!keepsTopology(stage) && limits.preserve_topology) return;
    state_.rules.stage = stage;
    whole.run(keep, progress);
    if (stage == QuadricStage::kAll) by_all_rules_ = state_.triangles;
  }
}

void QuadricReducer::channelValues(std::size_t channel, float scale, float* values,
                                   std::size_t stride) const {
  forEach(state_.threads, state_.whole.collapses, [&](std::size_t k) {
    values[stride * k] = state_.channels.given(state_.log[k], channel, scale * state_.mesh.scale());
  });
}

Reduction QuadricReducer::finish() {
  Reduction result;
  result.log = LogBuilder(state_, input_).build();
  const std::vector<float>& error = result.log.error;
  result.report.collapses = error.size();
  result.report.flips_refused = state_.whole.flips;
  result.report.topology_refused = state_.whole.links;
  result.report.visited = state_.whole.visited;
  result.report.triangles = state_.triangles;
  result.report.by_all_rules = by_all_rules_;
  result.report.error = error.empty() ? 0 : *std::max_element(error.begin(), error.end());
  return result;
}

}  // namespace merlin::render::reduce
