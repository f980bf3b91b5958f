#include "render/reduce/quadric/edge_choice.h"

#include <algorithm>

namespace merlin::render::reduce {
namespace {

// Number of edges, the cheapest ones, that a vertex with a large star tries.
constexpr std::size_t kMostCandidates = 8;

}  // namespace

void EdgeChoice::leaveOut(std::uint32_t v, EdgeCosts& costs) const {
  const std::uint32_t degree = s_.mesh[v].degree;
  for (std::uint32_t i = 0; s_.rules.most_corners > kMostCorners && i < costs.count; ++i) {
    const std::uint32_t there = s_.mesh[costs.neighbour[i]].degree;
    if (there > kMostCorners && there > degree) costs.cost[i] = kNoEdge;
  }
  if (degree > (s_.rules.keepTopology() ? kMostCorners : kManyCorners))
    costs.keepCheapest(kMostCandidates);
  costs.findCheapest();
}

// Returns the squared distance from the surface of the farther of the edge's two witnesses, and
// stores in w.costs.witness which end it belongs to. To save time, returns an estimate from the
// planes of the ends' stars if that estimate would not raise the cost; not at sharp vertices, where
// planes do not show what a thin tip loses.
float EdgeChoice::witnessDeviation(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const {
  const QuadricVertex &a = s_.mesh[v], &x = s_.mesh[w.costs.neighbour[edge]];
  const EdgeCosts& c = w.costs;
  const float step[] = {c.x[edge], c.y[edge], c.z[edge]};
  const float back[] = {step[0] - c.rx[edge], step[1] - c.ry[edge], step[2] - c.rz[edge]};
  const float of_a = a.deviation + costAt(a.h, step) / trace(a.h);
  const float of_x = x.deviation + costAt(x.h, back) / trace(x.h);
  FartherWitness farther{std::max(of_a, of_x), of_x > of_a};
  if (((a.flags | x.flags) & kSharp) || !(deviationCost(farther.distance2) <= c.cost[edge]))
    farther = farther_(s_.view(), v, w.costs, edge);
  w.costs.witness[edge] = farther.end;
  return farther.distance2;
}

bool EdgeChoice::raise(CollapseWorker& w, std::uint32_t v, std::uint32_t edge) const {
  float& deviation = w.costs.deviation[edge];
  if (deviation >= 0) return false;
  deviation = 0;
  const CollapseRules& rules = s_.rules;
  const QuadricVertex &a = s_.mesh[v], &x = s_.mesh[w.costs.neighbour[edge]];
  w.visited += a.degree + x.degree;
  const std::uint8_t flags = a.flags | x.flags;
  const float before = w.costs.cost[edge];
  if (seams_.isAlong(w.costs, v, edge))
    seams_.setCost(w, v, edge);
  else if ((flags & kLocked) && rules.keepTopology())
    stayAtLocked(s_.view(), v, w.costs, edge);
  if (w.costs.cost[edge] >= kNoEdge) return before < kNoEdge;
  // The border deviation is not measured at large unordered stars, whose borders do not describe a
  // shape.
  const bool unordered = !rules.keepTopology() && a.degree + x.degree > 2 * kManyCorners;
  if ((flags & kOpen) && !unordered) deviation = borderDeviation(s_.view(), v, w.costs, edge);
  if (!rules.fast) deviation = std::max(deviation, witnessDeviation(w, v, edge));
  if (rules.keepTopology() && vanishes(s_.view(), v, w.costs, edge))
    deviation = std::max(deviation, reachOf(w.costs) + std::max(a.deviation, x.deviation));
  const float least = deviationCost(deviation);
  w.costs.cost[edge] = std::max(w.costs.cost[edge], least);
  return w.costs.cost[edge] > before;
}

bool EdgeChoice::mayCollapse(CollapseWorker& w, const EdgeCosts& costs, std::uint32_t v,
                             std::uint32_t edge) const {
  const CollapseRules& rules = s_.rules;
  const QuadricVertex &a = s_.mesh[v], &x = s_.mesh[costs.neighbour[edge]];
  if (w.inside_only && !(x.flags & kInside)) return false;
  // At least one triangle must stay. (A part of the mesh needs no check, because the rules of the
  // first stage keep some triangles.)
  if (!w.inside_only && costs.shared[edge] >= s_.triangles - w.removed) return false;
  const bool locked = rules.stage == QuadricStage::kAll && !s_.labels.empty() &&
                      s_.labels[v] != s_.labels[costs.neighbour[edge]];
  if (locked ||
      (rules.keep_components && rules.keepTopology() && vanishes(s_.view(), v, costs, edge))) {
    ++w.links;
    return false;
  }
  const std::uint32_t star = a.degree + x.degree - 2 * costs.shared[edge];
  if (star > rules.most_corners) {
    w.refused_star = std::min(w.refused_star, star);
    ++w.links;
    return false;
  }
  const Verdict verdict = judge_(s_.view(), v, costs, edge, rules.stage);
  if (verdict != Verdict::kLegal) {
    ++(verdict == Verdict::kFlip ? w.flips : w.links);
    return false;
  }
  if (!(errorOf(a, x, costs.cost[edge]) > rules.max_error)) return true;
  w.too_coarse = true;
  return false;
}

}  // namespace merlin::render::reduce
