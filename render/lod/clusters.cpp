#include "render/lod/clusters.h"

#include <algorithm>
#include <cassert>

namespace merlin::render::lod {

std::size_t Clusters::prefix(const DetailStep& step, std::size_t group,
                             std::uint32_t alive) const noexcept {
  const auto first = ranks_.begin() + steps_.front().begins[group];
  const auto last = first + (step.begins[group + 1] - step.begins[group]);
  return static_cast<std::size_t>(std::lower_bound(first, last, alive) - first);
}

std::size_t Clusters::stepFor(std::span<const DetailStep> steps, std::size_t level) noexcept {
  std::size_t step = 0;
  while (step + 1 < steps.size() && steps[step + 1].level <= level) ++step;
  return step;
}

std::size_t Clusters::trianglesAt(std::size_t cluster, std::size_t level) const noexcept {
  const DetailStep& step = steps_[stepFor(steps_, level)];
  return prefix(step, 2 * cluster, alive_[level]) + prefix(step, 2 * cluster + 1, alive_[level]);
}

std::uint32_t* Clusters::replaceAt(std::size_t level, const std::uint32_t* from,
                                   std::size_t corners, std::uint32_t* out) const noexcept {
  find_alive_ancestors_(forest_, aliveBelow(level), from, corners, out);
  return out + corners;
}

std::uint32_t* Clusters::replaceEach(std::span<const std::uint32_t> levels,
                                     const std::uint32_t* from, std::size_t corners,
                                     std::uint32_t* out) const noexcept {
  for (std::size_t i = 0; i < corners; ++i)
    *out++ = forest_.aliveAncestor(from[i], aliveBelow(levels[cluster_of_[from[i]]]));
  return out;
}

std::size_t Clusters::cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                          std::span<std::uint32_t> ends) const noexcept {
  assert(levels.size() == size() && ends.size() == size() + 1);
  std::uint32_t* at = out.data();
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t level = levels[i];
    assert(level >= finestLevel() && level <= coarsest_);
    const DetailStep& inner = steps_[stepFor(steps_, level)];
    at = replaceAt(level, &inner.corners[3 * std::size_t{inner.begins[2 * i]}],
                   3 * prefix(inner, 2 * i, alive_[level]), at);
    // Corners may lie in clusters that are cut at finer levels, so use the step for the finest of
    // these levels.
    std::size_t finest = level;
    for (const std::uint16_t n : neighbours_[i]) finest = std::min<std::size_t>(finest, levels[n]);
    const DetailStep& mixed = steps_[stepFor(steps_, finest)];
    at = replaceEach(levels, &mixed.corners[3 * std::size_t{mixed.begins[2 * i + 1]}],
                     3 * prefix(mixed, 2 * i + 1, alive_[level]), at);
    ends[i] = static_cast<std::uint32_t>((at - out.data()) / 3);
  }
  const std::size_t finest = *std::min_element(levels.begin(), levels.end());
  const DetailStep& step = steps_[stepFor(steps_, finest)];
  at = replaceEach(levels, &step.corners[3 * std::size_t{step.begins[2 * size()]}],
                   3 * alwaysThere(), at);
  return ends[size()] = static_cast<std::uint32_t>((at - out.data()) / 3);
}

std::size_t Clusters::cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept {
  const std::size_t triangles = alive_[level];
  if (level < finestLevel()) return dendrogram_.cut(level, out);
  if (level >= plain_.front().level) {
    const DetailStep& step = plain_[stepFor(plain_, level)];
    replaceAt(level, step.corners.data(), 3 * triangles, out.data());
    return triangles;
  }
  const DetailStep& step = steps_[stepFor(steps_, level)];
  std::uint32_t* at = out.data();
  for (std::size_t g = 0; g + 1 < step.begins.size(); ++g)
    at = replaceAt(level, &step.corners[3 * std::size_t{step.begins[g]}],
                   3 * prefix(step, g, alive_[level]), at);
  return triangles;
}

std::size_t Clusters::memoryBytes() const noexcept {
  std::size_t bytes =
      2 * cluster_of_.size() + 4 * ranks_.size() + sizeof(ClusterBounds) * bounds_.size();
  for (const auto* steps : {&steps_, &plain_}) {
    for (const DetailStep& r : *steps) bytes += 4 * (r.begins.size() + r.corners.size());
  }
  for (const auto& list : neighbours_) bytes += 2 * list.size() + sizeof list;
  return bytes;
}

}  // namespace merlin::render::lod
