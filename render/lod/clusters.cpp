#include "render/lod/clusters.h"

#include <algorithm>
#include <cassert>

namespace merlin::render {

std::size_t Clusters::prefix(const Rung& rung, std::size_t group,
                             std::uint32_t alive) const noexcept {
  const auto first = ranks_.begin() + rungs_.front().begins[group];
  const auto last = first + (rung.begins[group + 1] - rung.begins[group]);
  return static_cast<std::size_t>(std::lower_bound(first, last, alive) - first);
}

std::size_t Clusters::rungFor(std::span<const Rung> rungs, std::size_t level) noexcept {
  std::size_t rung = 0;
  while (rung + 1 < rungs.size() && rungs[rung + 1].level <= level) ++rung;
  return rung;
}

std::size_t Clusters::trianglesAt(std::size_t cluster, std::size_t level) const noexcept {
  const Rung& rung = rungs_[rungFor(rungs_, level)];
  return prefix(rung, 2 * cluster, alive_[level]) + prefix(rung, 2 * cluster + 1, alive_[level]);
}

std::uint32_t* Clusters::chaseTo(std::size_t level, const std::uint32_t* from, std::size_t corners,
                                 std::uint32_t* out) const noexcept {
  chase_all_(forest_, aliveBelow(level), from, corners, out);
  return out + corners;
}

std::uint32_t* Clusters::chaseEach(std::span<const std::uint32_t> levels, const std::uint32_t* from,
                                   std::size_t corners, std::uint32_t* out) const noexcept {
  for (std::size_t i = 0; i < corners; ++i)
    *out++ = forest_.chase(from[i], aliveBelow(levels[cluster_of_[from[i]]]));
  return out;
}

std::size_t Clusters::cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                          std::span<std::uint32_t> ends) const noexcept {
  assert(levels.size() == size() && ends.size() == size() + 1);
  std::uint32_t* at = out.data();
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t level = levels[i];
    assert(level >= finestLevel() && level <= coarsest_);
    const Rung& inner = rungs_[rungFor(rungs_, level)];
    at = chaseTo(level, &inner.corners[3 * std::size_t{inner.begins[2 * i]}],
                 3 * prefix(inner, 2 * i, alive_[level]), at);
    // A corner of another cluster starts where that one may still be finer.
    std::size_t finest = level;
    for (const std::uint16_t n : neighbours_[i]) finest = std::min<std::size_t>(finest, levels[n]);
    const Rung& mixed = rungs_[rungFor(rungs_, finest)];
    at = chaseEach(levels, &mixed.corners[3 * std::size_t{mixed.begins[2 * i + 1]}],
                   3 * prefix(mixed, 2 * i + 1, alive_[level]), at);
    ends[i] = static_cast<std::uint32_t>((at - out.data()) / 3);
  }
  const std::size_t finest = *std::min_element(levels.begin(), levels.end());
  const Rung& rung = rungs_[rungFor(rungs_, finest)];
  at = chaseEach(levels, &rung.corners[3 * std::size_t{rung.begins[2 * size()]}], 3 * alwaysThere(),
                 at);
  return ends[size()] = static_cast<std::uint32_t>((at - out.data()) / 3);
}

std::size_t Clusters::cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept {
  const std::size_t triangles = alive_[level];
  if (level < finestLevel()) return dendrogram_.cut(level, out);
  if (level >= plain_.front().level) {
    const Rung& rung = plain_[rungFor(plain_, level)];
    chaseTo(level, rung.corners.data(), 3 * triangles, out.data());
    return triangles;
  }
  const Rung& rung = rungs_[rungFor(rungs_, level)];
  std::uint32_t* at = out.data();
  for (std::size_t g = 0; g + 1 < rung.begins.size(); ++g)
    at = chaseTo(level, &rung.corners[3 * std::size_t{rung.begins[g]}],
                 3 * prefix(rung, g, alive_[level]), at);
  return triangles;
}

std::size_t Clusters::memoryBytes() const noexcept {
  std::size_t bytes =
      2 * cluster_of_.size() + 4 * ranks_.size() + sizeof(ClusterBounds) * bounds_.size();
  for (const auto* rungs : {&rungs_, &plain_}) {
    for (const Rung& r : *rungs) bytes += 4 * (r.begins.size() + r.corners.size());
  }
  for (const auto& list : neighbours_) bytes += 2 * list.size() + sizeof list;
  return bytes;
}

}  // namespace merlin::render
