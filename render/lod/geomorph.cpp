#include "render/lod/geomorph.h"

#include <algorithm>

namespace merlin::render::lod {
namespace {

// The range of collapses [begin, end) whose nodes are displaced.
struct Window {
  std::size_t begin = 0, end = 0;

  bool has(std::size_t collapse) const { return collapse >= begin && collapse < end; }
  float ownAt(std::size_t collapse) const {
    return static_cast<float>(collapse - begin + 1) / static_cast<float>(end - begin + 1);
  }
};

Window windowAt(const Dendrogram& dendrogram, std::size_t level, double share) {
  const auto left = static_cast<double>(dendrogram.trianglesAt(level)) * (1 - share);
  return {level, std::max(level, dendrogram.levelFor(static_cast<std::size_t>(left)))};
}

struct NodeRange {
  std::uint32_t begin, end;
};

// Returns the range of the nodes that the window's collapses merge.
NodeRange nodesOf(const Dendrogram& dendrogram, const Window& window) {
  const std::size_t nodes = dendrogram.nodeCount();
  return {static_cast<std::uint32_t>(nodes - 2 * window.end),
          static_cast<std::uint32_t>(nodes - 2 * window.begin)};
}

}  // namespace

void morphsAt(const Dendrogram& dendrogram, std::size_t level, double share,
              std::vector<Morph>& morphs) {
  morphs.clear();
  if (!(share > 0)) return;
  const Window window = windowAt(dendrogram, level, share);
  const NodeRange nodes = nodesOf(dendrogram, window);
  for (std::uint32_t n = nodes.begin; n < nodes.end; ++n)
    morphs.push_back({n, window.ownAt(dendrogram.collapseOf(n))});
}

void morphsAt(const Dendrogram& dendrogram, const Clusters& clusters,
              std::span<const std::uint32_t> levels, double share, std::vector<Morph>& morphs) {
  morphs.clear();
  if (!(share > 0)) return;
  std::vector<Window> windows;
  Window all{dendrogram.levels(), 0};
  for (const std::uint32_t level : levels) {
    if (!windows.empty() && windows.back().begin == level) {
      windows.push_back(windows.back());
      continue;
    }
    Window window = windowAt(dendrogram, level, share);
    window.end = std::clamp(clusters.coarsestLevel(), window.begin, window.end);
    all = {std::min(all.begin, window.begin), std::max(all.end, window.end)};
    windows.push_back(window);
  }
  const NodeRange nodes = nodesOf(dendrogram, all);
  for (std::uint32_t n = nodes.begin; n < nodes.end; ++n) {
    const std::size_t collapse = dendrogram.collapseOf(n);
    const Window& window = windows[clusters.clusterOf(n)];
    if (window.has(collapse)) morphs.push_back({n, window.ownAt(collapse)});
  }
}

}  // namespace merlin::render::lod
