#include "render/lod/dendrogram.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "render/lod/alive_ancestors.h"

namespace merlin::render::lod {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Error broken(std::string what) { return {Errc::kMalformed, std::move(what)}; }

Result<Ok> checkSizes(const Dendrogram::Arrays& a) {
  const std::size_t nodes = a.positions.size() / 3, collapses = a.parents.size();
  if (a.positions.size() % 3 != 0 || nodes >= kNone) return broken("positions are not triples");
  if (2 * collapses >= nodes && collapses > 0) {
    return broken(fmt::format("{} collapses need more than {} nodes", collapses, nodes));
  }
  if (a.triangles.size() % 3 != 0) return broken("triangles are not triples of nodes");
  if (a.alive.size() != collapses + 1 || a.error.size() != collapses + 1) {
    return broken(fmt::format("{} collapses need {} levels, there are {} counts and {} errors",
                              collapses, collapses + 1, a.alive.size(), a.error.size()));
  }
  for (const FeatureView& f : a.features) {
    if (f.dimension == 0 || f.values.size() != nodes * f.dimension) {
      return broken(fmt::format("feature {}: {} values for {} nodes x {}", f.name, f.values.size(),
                                nodes, f.dimension));
    }
  }
  return Ok{};
}

Result<Ok> checkTree(const Dendrogram::Arrays& a) {
  const std::size_t nodes = a.positions.size() / 3;
  std::vector<bool> made(nodes, false);
  for (std::size_t k = 0; k < a.parents.size(); ++k) {
    const std::uint32_t parent = a.parents[k];
    if (parent >= nodes - 2 * k - 2) {
      return broken(fmt::format(
          "collapse {}: the number of the parent, {}, is not less than the numbers of its children",
          k, parent));
    }
    if (made[parent]) return broken(fmt::format("collapse {}: node {} is made twice", k, parent));
    made[parent] = true;
  }
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    const std::uint32_t node = a.triangles[i];
    if (node >= nodes)
      return broken(
          fmt::format("triangle {}: there is no node {}, the model has {}", i / 3, node, nodes));
    if (!made[node]) continue;
    return broken(fmt::format("triangle {}: node {} is not a vertex of the mesh", i / 3, node));
  }
  return Ok{};
}

Result<Ok> checkValues(const Dendrogram::Arrays& a) {
  std::size_t most = a.triangles.size() / 3;
  for (std::size_t k = 0; k < a.alive.size(); ++k) {
    if (a.alive[k] > most)
      return broken(
          fmt::format("level {}: {} triangles, at most {} are possible", k, a.alive[k], most));
    most = a.alive[k];
    if (!std::isfinite(a.error[k]) || (k > 0 && a.error[k] < a.error[k - 1])) {
      return broken(fmt::format(
          "level {}: its error is not finite, or is less than the error of the level before it",
          k));
    }
  }
  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(a.positions.begin(), a.positions.end(), finite)) {
    return broken("a position is not finite");
  }
  return Ok{};
}

}  // namespace

Result<Dendrogram> Dendrogram::make(Arrays arrays, std::shared_ptr<const void> owner) {
  if (const auto sizes = checkSizes(arrays); !sizes) return sizes.error();
  if (const auto tree = checkTree(arrays); !tree) return tree.error();
  if (const auto values = checkValues(arrays); !values) return values.error();
  return Dendrogram(std::move(arrays), std::move(owner));
}

const FeatureView* Dendrogram::find(std::string_view name) const noexcept {
  for (const FeatureView& f : a_.features) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

std::size_t Dendrogram::levelFor(std::size_t budget) const noexcept {
  const auto fits = std::partition_point(a_.alive.begin(), a_.alive.end(),
                                         [&](std::uint32_t n) { return n > budget; });
  return fits == a_.alive.end() ? levels() - 1 : static_cast<std::size_t>(fits - a_.alive.begin());
}

std::size_t Dendrogram::levelForError(float error) const noexcept {
  const auto beyond =
      std::partition_point(a_.error.begin(), a_.error.end(), [&](float e) { return e <= error; });
  return beyond == a_.error.begin() ? 0 : static_cast<std::size_t>(beyond - a_.error.begin()) - 1;
}

std::size_t Dendrogram::cut(std::size_t level, std::span<std::uint32_t> out) const noexcept {
  assert(level < levels());
  const std::size_t corners = 3 * std::size_t{a_.alive[level]};
  assert(out.size() >= corners);
  const auto nodes = static_cast<std::uint32_t>(nodeCount());
  const auto alive = static_cast<std::uint32_t>(nodes - 2 * level);
  aliveAncestorFinder(nodes)({a_.parents, nodes}, alive, a_.triangles.data(), corners, out.data());
  return corners / 3;
}

mesh::Mesh extract(const Dendrogram& dendrogram, std::size_t level) {
  mesh::Mesh mesh;
  mesh.triangles.resize(3 * dendrogram.trianglesAt(level));
  dendrogram.cut(level, mesh.triangles);
  std::vector<std::uint32_t> place(dendrogram.nodeCount(), kNone);
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t& corner : mesh.triangles) {
    if (place[corner] == kNone) {
      place[corner] = static_cast<std::uint32_t>(nodes.size());
      nodes.push_back(corner);
    }
    corner = place[corner];
  }
  const auto gather = [&](std::span<const float> from, std::size_t dimension) {
    std::vector<float> rows;
    rows.reserve(nodes.size() * dimension);
    for (const std::uint32_t n : nodes) {
      for (std::size_t k = 0; k < dimension; ++k) rows.push_back(from[n * dimension + k]);
    }
    return rows;
  };
  mesh.positions = gather(dendrogram.arrays().positions, 3);
  for (const FeatureView& f : dendrogram.arrays().features) {
    mesh.features.push_back({f.name, f.dimension, gather(f.values, f.dimension)});
  }
  const auto texture = dendrogram.arrays().texture;
  mesh.texture.assign(texture.begin(), texture.end());
  return mesh;
}

}  // namespace merlin::render::lod
