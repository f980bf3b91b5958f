// QuadricReducer along seams. At a seam two vertices coincide, because a feature differs on either
// side. Edges on both sides collapse together, so that the seam does not open.
#include <algorithm>
#include <cstring>

#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render::reduce {
namespace {

std::uint32_t rowOf(const EdgeCosts& costs, std::uint32_t neighbour) {
  std::uint32_t row = 0;
  while (row < costs.count && costs.neighbour[row] != neighbour) ++row;
  return row;
}

}  // namespace

void QuadricReducer::pair(const std::vector<std::uint32_t>& next) {
  std::vector<std::uint32_t> working(mesh_.vertexCount());
  for (std::uint32_t v = 0; v < working.size(); ++v) working[mesh_.inputOf(v)] = v;
  twins_.assign(mesh_.vertexCount(), kNowhere);
  for (std::uint32_t v = 0; v < twins_.size(); ++v) {
    const std::uint32_t here = mesh_.inputOf(v), there = next[here];
    if (there != here && next[there] == here) twins_[v] = working[there];
  }
}

bool QuadricReducer::isAlongSeam(const EdgeCosts& costs, std::uint32_t v,
                                 std::uint32_t edge) const {
  return !twins_.empty() && keepsTopology(stage_) && costs.shared[edge] == 1 &&
         twins_[v] != kNowhere && twins_[costs.neighbour[edge]] != kNowhere;
}

// Evaluates the edges of v's twin into w.twin and returns the row of the one that coincides with
// `edge` of v. kNowhere if there is none, or if the two sides are so close that one collapse would
// change the other side's edge.
std::uint32_t QuadricReducer::findTwin(Worker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t x = w.costs.neighbour[edge], tv = twins_[v], tx = twins_[x];
  const std::uint8_t inside = mesh_[tv].flags & mesh_[tx].flags & kInside;
  const bool gone = (mesh_[tv].flags | mesh_[tx].flags) & (kDead | kHub);
  if (gone || mesh_[tv].degree == 0 || (w.inside_only && !inside)) return kNowhere;
  if (rowOf(w.costs, tv) < w.costs.count || rowOf(w.costs, tx) < w.costs.count) return kNowhere;
  evaluate_(view(), tv, w.twin);
  const std::uint32_t row = rowOf(w.twin, tx);
  if (row == w.twin.count || w.twin.shared[row] != 1) return kNowhere;
  for (std::uint32_t i = 0; i < w.costs.count; ++i) {  // the sides must have no common neighbour
    if (rowOf(w.twin, w.costs.neighbour[i]) < w.twin.count) return kNowhere;
  }
  return row;
}

void QuadricReducer::stayOnSeam(Worker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t other = findTwin(w, v, edge);
  if (other == kNowhere)
    w.costs.cost[edge] = kNoEdge;
  else
    goAlongSeam(view(), v, w.costs, edge, twins_[v], w.twin, other);
}

// Adds the normal of the twin's present star to `normal`, if both sides are one surface.
void QuadricReducer::addNormalOf(std::uint32_t twin, float* normal) const {
  const QuadricVertex& t = mesh_[twin];
  if (!lives(t) || (t.flags & kHub)) return;
  float other[3] = {};
  for (const Corner& c : mesh_.star(t)) {
    const auto face = mesh::faceNormal(t.position, mesh_[c.b].position, mesh_[c.c].position);
    for (std::size_t k = 0; k < 3; ++k) other[k] += face[k];
  }
  const bool one = mesh::areOneSurface(normal, other);
  for (std::size_t k = 0; one && k < 3; ++k) normal[k] += other[k];
}

// Copies the normal of the node of `from` to that of `to`, if both sides are one surface.
void QuadricReducer::shareNormal(std::uint32_t from, std::uint32_t to) {
  const NodeRecord good = recordOf(from);
  NodeRecord record = recordOf(to);
  if (!mesh::areOneSurface(record.normal, good.normal)) return;
  std::copy_n(good.normal, 3, record.normal);
  std::memcpy(static_cast<void*>(mesh_[to].position), &record, sizeof record);
}

// Collapses the edge on both sides of the seam if both collapses are allowed; returns whether it
// did. REQUIRES: guard() was called for the edge.
bool QuadricReducer::collapseSeam(Worker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t tv = twins_[v], other = findTwin(w, v, edge);
  if (other == kNowhere || (!w.inside_only && triangles_ - w.removed <= 2)) return false;
  w.twin.x[other] = w.costs.x[edge];
  w.twin.y[other] = w.costs.y[edge];
  w.twin.z[other] = w.costs.z[edge];
  w.twin.cost[other] = w.costs.cost[edge];
  w.twin.deviation[other] = w.costs.deviation[edge];
  w.twin.witness[other] = w.costs.staysAt(edge);  // that of the end that moves
  if (!mayCollapse(w, w.costs, v, edge) || !mayCollapse(w, w.twin, tv, other)) return false;
  const std::uint32_t x = w.costs.neighbour[edge], tx = w.twin.neighbour[other];
  collapse(w, v, edge);
  if (mesh_[v].degree > 0) enqueue(w, v, w.costs.least());
  std::swap(w.costs, w.twin);
  collapse(w, tv, other);
  shareNormal(tx, x);                                       // computed after both sides had moved
  if ((mesh_[tv].flags & kIdle) && mesh_[tv].degree > 0) {  // else it is in the queue
    mesh_[tv].flags &= static_cast<std::uint8_t>(~kIdle);
    enqueue(w, tv, w.costs.least());
  }
  return true;
}

}  // namespace merlin::render::reduce
