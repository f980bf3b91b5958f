// Builds the Dendrogram of a reduction: gathers all rows in the order of their removal, the last
// removed first.
#include <algorithm>
#include <cassert>
#include <memory>

#include "daemon/base/blocks.h"
#include "render/lod/dendrogram.h"
#include "render/lod/removal_order.h"

namespace merlin::render::lod {
namespace {

struct Storage {
  std::vector<float> positions;
  std::vector<std::vector<float>> features;
  std::vector<std::uint32_t> parents, triangles, alive;
  std::vector<float> error;
  std::vector<std::uint8_t> texture;
};

std::vector<float> gather(const std::vector<float>& leaves, const std::vector<float>& inner,
                          std::size_t dimension, const RemovalOrder& order) {
  std::vector<float> rows(leaves.size() + inner.size());
  for (std::size_t n = 0; n < order.nodeCount(); ++n) {
    const std::size_t at = order.nodeOf(n) * dimension;
    const float* from = at < leaves.size() ? &leaves[at] : &inner[at - leaves.size()];
    std::copy_n(from, dimension, rows.begin() + static_cast<std::ptrdiff_t>(n * dimension));
  }
  return rows;
}

}  // namespace

Dendrogram buildDendrogram(const mesh::Mesh& mesh, const CollapseLog& log) {
  const RemovalOrder order(mesh, log, threadsOr(0));
  const std::size_t collapses = log.children.size(), vertices = mesh.vertexCount();
  auto s = std::make_shared<Storage>();
  s->positions = gather(mesh.positions, log.positions, 3, order);
  s->parents.resize(collapses);
  for (std::size_t k = 0; k < collapses; ++k) s->parents[k] = order.numberOf(vertices + k);
  s->error = risingError(log);
  s->alive.resize(collapses + 1);
  for (std::size_t level = 0; level <= collapses; ++level) s->alive[level] = order.aliveAt(level);
  s->triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangleCount(); ++i) {
    const std::uint32_t* corners = &mesh.triangles[3 * std::size_t{order.triangleOf(i)}];
    for (int k = 0; k < 3; ++k) s->triangles.push_back(order.numberOf(corners[k]));
  }

  Dendrogram::Arrays a{s->positions, {},       s->parents, s->triangles,
                       s->alive,     s->error, log.about,  {}};
  s->features.reserve(mesh.features.size());
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    const mesh::Feature& feature = mesh.features[f];
    s->features.push_back(gather(feature.values, log.features[f], feature.dimension, order));
    a.features.push_back({feature.name, feature.dimension, s->features.back()});
  }
  s->texture = mesh.texture;
  a.texture = s->texture;
  auto made = Dendrogram::make(std::move(a), s);
  assert(made.ok());
  return *std::move(made);
}

std::vector<float> risingError(const CollapseLog& log) {
  std::vector<float> error(log.error.size() + 1, 0);
  for (std::size_t k = 0; k < log.error.size(); ++k)
    error[k + 1] = std::max(error[k], log.error[k]);
  return error;
}

}  // namespace merlin::render::lod
