// Converts the result of a QuadricReducer to a CollapseLog.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render::reduce {
namespace {

// The largest coordinate that validate() allows.
constexpr float kFarthest = 1e18F;
constexpr std::size_t kAhead = 16;  // records prefetched

}  // namespace

// Gives each node at the position of a locked vertex exactly the coordinates of the input, so that
// seams match bit by bit.
void QuadricReducer::pin(lod::CollapseLog& log) {
  for (std::size_t k = 0; k < log.children.size(); ++k) {
    for (const std::uint32_t child : log.children[k]) {
      const std::uint32_t v = pinned_[child];
      if (v == kNowhere) continue;
      const float* const there = &input_positions_[3 * std::size_t{v}];
      const auto place = mesh_.toWorking(there);
      const NodeRecord r = recordOf(log_[k]);
      if (!std::equal(place.begin(), place.end(), r.position)) continue;
      std::copy_n(there, 3, &log.positions[3 * k]);
      pinned_[mesh_.vertexCount() + k] = v;
      break;
    }
  }
}

NodeRecord QuadricReducer::recordOf(std::uint32_t dead) const {
  NodeRecord r;
  std::memcpy(&r, static_cast<const void*>(mesh_[dead].position), sizeof r);
  return r;
}

// Copies collapse k into the log. REQUIRES: next_ maps each dead vertex to its collapse.
void QuadricReducer::copyTo(lod::CollapseLog& log, std::vector<float>* normals,
                            std::size_t k) const {
  const std::uint32_t vertices = mesh_.vertexCount();
  const auto node = [&](std::uint32_t n) {
    return n < vertices ? mesh_.inputOf(n) : vertices + next_[n - vertices];
  };
  if (k + kAhead < log.error.size()) __builtin_prefetch(&mesh_[log_[k + kAhead]]);
  const NodeRecord r = recordOf(log_[k]);
  log.children[k] = {node(r.children[0]), node(r.children[1])};
  auto p = mesh_.toModel(r.position);
  for (float& x : p) x = std::clamp(x, -kFarthest, kFarthest);
  std::copy_n(p.begin(), 3, &log.positions[3 * k]);
  log.error[k] = std::min(r.error / mesh_.scale(), kFarthest);  // may be infinite: tiny area
  const float* const n = r.normal;
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (std::size_t i = 0; normals && i < 3; ++i)
    (*normals)[3 * k + i] = length > 0 ? n[i] / length : 0;
}

Reduction QuadricReducer::finish(const mesh::Mesh& mesh) {
  mesh_.dropStars();
  const std::size_t collapses = whole_.collapses;
  for (std::size_t k = 0; k < collapses; ++k) next_[log_[k]] = static_cast<std::uint32_t>(k);
  Reduction result;
  lod::CollapseLog& log = result.log;
  log.children.resize(collapses);
  log.positions.resize(3 * collapses);
  log.error.resize(collapses);
  log.features.resize(mesh.features.size());
  std::vector<float>* normals = nullptr;
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    if (mesh.features[f].name == "normal") normals = &log.features[f];
  }
  if (normals) normals->resize(3 * collapses);
  forEach(threads_, collapses, [&](std::size_t k) { copyTo(log, normals, k); });
  if (!pinned_.empty()) pin(log);
  result.report.collapses = collapses;
  result.report.flips_refused = whole_.flips;
  result.report.topology_refused = whole_.links;
  result.report.visited = whole_.visited;
  result.report.triangles = triangles_;
  result.report.by_all_rules = by_all_rules_;
  result.report.error =
      log.error.empty() ? 0 : *std::max_element(log.error.begin(), log.error.end());
  return result;
}

// If a feature is so large or so small that weighting makes its values NaN, the lowest input value
// is written.
void QuadricReducer::channelValues(std::size_t channel, float scale, float* values,
                                   std::size_t stride) const {
  const Range given = given_[channel];
  forEach(threads_, whole_.collapses, [&](std::size_t k) {
    const float value = channels_.value(log_[k], channel) / (scale * mesh_.scale());
    values[stride * k] = value >= given.low ? std::min(value, given.high) : given.low;
  });
}

}  // namespace merlin::render::reduce
