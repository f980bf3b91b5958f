#include "render/reduce/quadric/log_builder.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::reduce {
namespace {

// The largest coordinate that validate() allows.
constexpr float kFarthest = 1e18F;
constexpr std::size_t kAhead = 16;  // number of records that are prefetched ahead

}  // namespace

lod::CollapseLog LogBuilder::build() {
  s_.mesh.dropStars();
  const std::size_t collapses = s_.whole.collapses;
  for (std::size_t k = 0; k < collapses; ++k) s_.next[s_.log[k]] = static_cast<std::uint32_t>(k);
  lod::CollapseLog log;
  log.children.resize(collapses);
  log.positions.resize(3 * collapses);
  log.error.resize(collapses);
  log.features.resize(input_.features.size());
  std::vector<float>* normals = nullptr;
  for (std::size_t f = 0; f < input_.features.size(); ++f) {
    if (input_.features[f].name == "normal") normals = &log.features[f];
  }
  if (normals) normals->resize(3 * collapses);
  forEach(s_.threads, collapses, [&](std::size_t k) { copy(k, log, normals); });
  pin(log);
  return log;
}

// Copies collapse k into the log. REQUIRES: state.next maps each dead vertex to its collapse.
void LogBuilder::copy(std::size_t k, lod::CollapseLog& log, std::vector<float>* normals) const {
  const std::uint32_t vertices = s_.mesh.vertexCount();
  const auto node = [&](std::uint32_t n) {
    return n < vertices ? s_.mesh.inputOf(n) : vertices + s_.next[n - vertices];
  };
  if (k + kAhead < log.error.size()) __builtin_prefetch(&s_.mesh[s_.log[k + kAhead]]);
  const NodeRecord r = nodeRecordOf(s_.mesh[s_.log[k]]);
  log.children[k] = {node(r.children[0]), node(r.children[1])};
  auto p = s_.mesh.toModel(r.position);
  for (float& x : p) x = std::clamp(x, -kFarthest, kFarthest);
  std::copy_n(p.begin(), 3, &log.positions[3 * k]);
  // The error may be infinite where areas are tiny.
  log.error[k] = std::min(r.error / s_.mesh.scale(), kFarthest);
  const float* const n = r.normal;
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (std::size_t i = 0; normals && i < 3; ++i)
    (*normals)[3 * k + i] = length > 0 ? n[i] / length : 0;
}

// Gives each node at the position of a locked vertex exactly the coordinates of that vertex in the
// input mesh, so that the two sides of a seam match bit by bit.
void LogBuilder::pin(lod::CollapseLog& log) const {
  if (s_.locked.empty()) return;
  const std::uint32_t vertices = s_.mesh.vertexCount();
  // pinned[node]: the locked vertex of the input at whose position the node is, or kNowhere.
  std::vector<std::uint32_t> pinned(vertices + log.children.size(), kNowhere);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (s_.locked[v]) pinned[v] = v;
  }
  for (std::size_t k = 0; k < log.children.size(); ++k) {
    for (const std::uint32_t child : log.children[k]) {
      const std::uint32_t v = pinned[child];
      if (v == kNowhere) continue;
      const float* const there = &input_.positions[3 * std::size_t{v}];
      const auto place = s_.mesh.toWorking(there);
      const NodeRecord r = nodeRecordOf(s_.mesh[s_.log[k]]);
      if (!std::equal(place.begin(), place.end(), r.position)) continue;
      std::copy_n(there, 3, &log.positions[3 * k]);
      pinned[vertices + k] = v;
      break;
    }
  }
}

}  // namespace merlin::render::reduce
