#include "render/reduce/quadric/seams.h"

#include <algorithm>

namespace merlin::render::reduce {
namespace {

std::uint32_t rowOf(const EdgeCosts& costs, std::uint32_t neighbour) {
  std::uint32_t row = 0;
  while (row < costs.count && costs.neighbour[row] != neighbour) ++row;
  return row;
}

}  // namespace

void Seams::pair(const std::vector<std::uint32_t>& next) {
  const QuadricMesh& mesh = s_.mesh;
  std::vector<std::uint32_t> working(mesh.vertexCount());
  for (std::uint32_t v = 0; v < working.size(); ++v) working[mesh.inputOf(v)] = v;
  twins_.assign(mesh.vertexCount(), kNowhere);
  for (std::uint32_t v = 0; v < twins_.size(); ++v) {
    const std::uint32_t here = mesh.inputOf(v), there = next[here];
    if (there != here && next[there] == here) twins_[v] = working[there];
  }
}

std::uint32_t Seams::findTwinEdge(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const {
  const QuadricMesh& mesh = s_.mesh;
  const std::uint32_t x = w.costs.neighbour[edge], tv = twins_[v], tx = twins_[x];
  const std::uint8_t inside = mesh[tv].flags & mesh[tx].flags & kInside;
  const bool gone = (mesh[tv].flags | mesh[tx].flags) & (kDead | kHub);
  if (gone || mesh[tv].degree == 0 || (w.inside_only && !inside)) return kNowhere;
  if (rowOf(w.costs, tv) < w.costs.count || rowOf(w.costs, tx) < w.costs.count) return kNowhere;
  evaluate_(s_.view(), tv, w.twin);
  const std::uint32_t row = rowOf(w.twin, tx);
  if (row == w.twin.count || w.twin.shared[row] != 1) return kNowhere;
  for (std::uint32_t i = 0; i < w.costs.count; ++i) {  // the sides must have no common neighbour
    if (rowOf(w.twin, w.costs.neighbour[i]) < w.twin.count) return kNowhere;
  }
  return row;
}

void Seams::setCost(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const {
  const std::uint32_t other = findTwinEdge(w, v, edge);
  if (other == kNowhere)
    w.costs.cost[edge] = kNoEdge;
  else
    goAlongSeam(s_.view(), v, w.costs, edge, twins_[v], w.twin, other);
}

void Seams::merge(std::uint32_t v, std::uint32_t x) {
  if (twins_.empty() || (s_.mesh[v].flags & kLocked) || twins_[x] == kNowhere) return;
  twins_[v] = twins_[x];
  twins_[twins_[v]] = v;
}

void Seams::addTwinNormal(std::uint32_t v, float* normal) const {
  if (twinOf(v) == kNowhere) return;
  const QuadricVertex& t = s_.mesh[twins_[v]];
  if (!lives(t) || (t.flags & kHub)) return;
  float other[3] = {};
  for (const Corner& c : s_.mesh.star(t)) {
    const auto face = mesh::faceNormal(t.position, s_.mesh[c.b].position, s_.mesh[c.c].position);
    for (std::size_t k = 0; k < 3; ++k) other[k] += face[k];
  }
  const bool one = mesh::areOneSurface(normal, other);
  for (std::size_t k = 0; one && k < 3; ++k) normal[k] += other[k];
}

void Seams::shareNormal(std::uint32_t from, std::uint32_t to) const {
  const NodeRecord good = nodeRecordOf(s_.mesh[from]);
  NodeRecord record = nodeRecordOf(s_.mesh[to]);
  if (!mesh::areOneSurface(record.normal, good.normal)) return;
  std::copy_n(good.normal, 3, record.normal);
  setNodeRecord(s_.mesh[to], record);
}

}  // namespace merlin::render::reduce
