// Builds a Dendrogram of a reduction: renumber nodes by death, sort triangles by death.
#include <algorithm>
#include <cassert>
#include <memory>
#include <numeric>

#include "render/lod/dendrogram.h"

namespace merlin::render {
namespace {

struct Storage {
  std::vector<float> positions;
  std::vector<std::vector<float>> features;
  std::vector<std::uint32_t> parents, triangles, alive;
  std::vector<float> error;
};

// New number of each node: roots keep their order, then the children of the last collapse, ...
std::vector<std::uint32_t> numberByDeath(std::size_t nodes, const CollapseLog& log) {
  const std::size_t collapses = log.children.size();
  std::vector<std::uint32_t> number(nodes, 0);
  std::vector<bool> dies(nodes, false);
  for (std::size_t k = 0; k < collapses; ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = log.children[k][side];
      assert(child < nodes && !dies[child]);
      dies[child] = true;
      number[child] = static_cast<std::uint32_t>(nodes - 2 * k - 1 - side);
    }
  }
  std::uint32_t root = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    if (!dies[n]) number[n] = root++;
  }
  return number;
}

// The level from which on the triangle is gone: when two of its corners are one node. At each step
// the corner that dies first goes up; 0 is impossible, levels beyond the last mean never.
std::uint32_t deathOf(const std::uint32_t* corners, const std::vector<std::uint32_t>& parents,
                      std::uint32_t nodes) {
  std::uint32_t c[] = {corners[0], corners[1], corners[2]};
  for (;;) {
    std::uint32_t& deepest = *std::max_element(c, c + 3);
    const std::uint32_t collapse = (nodes - 1 - deepest) / 2;
    if (collapse >= parents.size()) return static_cast<std::uint32_t>(parents.size()) + 1;
    const std::uint32_t pair = nodes - 2 * collapse - 1;  // this and pair - 1 become one
    for (std::uint32_t& corner : c) {
      if (corner == pair || corner == pair - 1) corner = parents[collapse];
    }
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return collapse + 1;
  }
}

std::vector<float> scatter(const std::vector<float>& leaves, const std::vector<float>& inner,
                           std::size_t dimension, const std::vector<std::uint32_t>& number) {
  std::vector<float> rows(leaves.size() + inner.size());
  const std::size_t vertices = leaves.size() / dimension;
  for (std::size_t n = 0; n < number.size(); ++n) {
    const float* from = n < vertices ? &leaves[n * dimension] : &inner[(n - vertices) * dimension];
    std::copy_n(from, dimension, rows.begin() + static_cast<std::ptrdiff_t>(number[n] * dimension));
  }
  return rows;
}

void sortTriangles(const Mesh& mesh, const std::vector<std::uint32_t>& number, Storage& s) {
  const auto nodes = static_cast<std::uint32_t>(number.size());
  const std::size_t count = mesh.triangleCount(), levels = s.parents.size() + 1;
  std::vector<std::uint32_t> corners(mesh.triangles.size());
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = number[mesh.triangles[i]];
  std::vector<std::uint32_t> death(count), order(count);
  for (std::size_t t = 0; t < count; ++t) death[t] = deathOf(&corners[3 * t], s.parents, nodes);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return death[a] > death[b]; });
  s.triangles.reserve(corners.size());
  s.alive.assign(levels, 0);
  for (const std::uint32_t t : order) {
    s.triangles.insert(s.triangles.end(),
                       {corners[3 * std::size_t{t}], corners[3 * std::size_t{t} + 1],
                        corners[3 * std::size_t{t} + 2]});
    ++s.alive[std::min<std::size_t>(death[t], levels) - 1];
  }
  // alive[L] = triangles that die later than L.
  for (std::size_t level = levels - 1; level-- > 0;) s.alive[level] += s.alive[level + 1];
}

}  // namespace

Dendrogram buildDendrogram(const Mesh& mesh, const CollapseLog& log) {
  const std::size_t collapses = log.children.size(), vertices = mesh.vertexCount();
  const auto number = numberByDeath(vertices + collapses, log);
  auto s = std::make_shared<Storage>();
  s->positions = scatter(mesh.positions, log.positions, 3, number);
  s->parents.resize(collapses);
  for (std::size_t k = 0; k < collapses; ++k) s->parents[k] = number[vertices + k];
  s->error.assign(collapses + 1, 0);
  for (std::size_t k = 0; k < collapses; ++k) s->error[k + 1] = std::max(s->error[k], log.error[k]);
  sortTriangles(mesh, number, *s);

  Dendrogram::Arrays a{s->positions, {}, s->parents, s->triangles, s->alive, s->error, log.about};
  s->features.reserve(mesh.features.size());
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    const Feature& feature = mesh.features[f];
    s->features.push_back(scatter(feature.values, log.features[f], feature.dimension, number));
    a.features.push_back({feature.name, feature.dimension, s->features.back()});
  }
  auto made = Dendrogram::make(std::move(a), s);
  assert(made.ok());
  return *std::move(made);
}

}  // namespace merlin::render
