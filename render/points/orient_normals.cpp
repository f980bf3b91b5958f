#include "render/points/orient_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace merlin::render::points {
namespace {

using Vector = std::array<double, 3>;

double dotOf(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct NeighbourEdge {
  float cost;
  std::uint32_t a, b;
};

class Orientation {
 public:
  Orientation(std::span<const float> positions, std::span<double> normals)
      : positions_(positions), normals_(normals), tree_(positions.size() / 3) {
    std::iota(tree_.begin(), tree_.end(), 0U);
  }

  std::size_t run(std::span<const std::uint32_t> neighbours, std::size_t k) {
    const auto kept = forestOf(edgesOf(neighbours, k));
    const auto roots = highestPoints();
    turnFrom(roots, kept);
    return roots.size();
  }

 private:
  Vector normalOf(std::uint32_t p) const {
    return {normals_[3 * p], normals_[3 * p + 1], normals_[3 * p + 2]};
  }

  Vector directionTo(std::uint32_t a, std::uint32_t b) const {
    Vector step{};
    for (std::size_t i = 0; i < 3; ++i)
      step[i] = double{positions_[3 * b + i]} - double{positions_[3 * a + i]};
    const double length = std::sqrt(dotOf(step, step));
    for (double& x : step) x = length > 0 ? x / length : 0;
    return step;
  }

  // Turns the normal at a towards b as along an arc of a circle (i.e. reflects it at the plane
  // halfway between a and b), and returns the cosine between the result and the normal at b. This
  // is also correct at an edge sharper than a right angle.
  double agreement(std::uint32_t a, std::uint32_t b) const {
    const Vector na = normalOf(a), nb = normalOf(b), d = directionTo(a, b);
    return dotOf(na, nb) - 2 * dotOf(na, d) * dotOf(nb, d);
  }

  // Returns the cost of an edge. Edges that leave the surface, e.g. through a thin part, are
  // expensive, so that they are used last.
  float costOf(std::uint32_t a, std::uint32_t b) const {
    const Vector d = directionTo(a, b);
    const double out = std::max(std::abs(dotOf(normalOf(a), d)), std::abs(dotOf(normalOf(b), d)));
    return static_cast<float>(1 - std::abs(agreement(a, b)) + out);
  }

  std::vector<NeighbourEdge> edgesOf(std::span<const std::uint32_t> neighbours,
                                     std::size_t k) const {
    std::vector<NeighbourEdge> edges;
    edges.reserve(neighbours.size());
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      const auto a = static_cast<std::uint32_t>(i / k), b = neighbours[i];
      if (a != b) edges.push_back({costOf(a, b), std::min(a, b), std::max(a, b)});
    }
    // Edges of equal cost are sorted by their indices, so that the result is unique.
    std::ranges::sort(edges, {}, [](const NeighbourEdge& e) { return std::tie(e.cost, e.a, e.b); });
    return edges;
  }

  std::uint32_t treeOf(std::uint32_t p) {
    while (tree_[p] != p) p = tree_[p] = tree_[tree_[p]];
    return p;
  }

  // Computes the minimum spanning forest by Kruskal's algorithm; returns its edges.
  std::vector<NeighbourEdge> forestOf(std::vector<NeighbourEdge> edges) {
    std::erase_if(edges, [this](const NeighbourEdge& e) {
      const std::uint32_t a = treeOf(e.a), b = treeOf(e.b);
      tree_[std::max(a, b)] = std::min(a, b);
      return a == b;
    });
    return edges;
  }

  // Returns the highest point of each tree.
  std::vector<std::uint32_t> highestPoints() {
    constexpr std::uint32_t kNone = ~0U;
    std::vector<std::uint32_t> highest(tree_.size(), kNone);
    for (std::uint32_t p = 0; p < tree_.size(); ++p) {
      std::uint32_t& best = highest[treeOf(p)];
      if (best == kNone || positions_[3 * p + 2] > positions_[3 * best + 2]) best = p;
    }
    std::erase(highest, kNone);
    return highest;
  }

  void turn(std::uint32_t p) {
    for (std::size_t i = 0; i < 3; ++i) normals_[3 * p + i] = -normals_[3 * p + i];
  }

  void turnFrom(const std::vector<std::uint32_t>& roots, const std::vector<NeighbourEdge>& kept) {
    std::vector<std::uint32_t> start(tree_.size() + 1), beside(2 * kept.size());
    for (const auto& e : kept) ++start[e.a + 1], ++start[e.b + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    auto next = start;
    for (const auto& e : kept) beside[next[e.a]++] = e.b, beside[next[e.b]++] = e.a;
    std::vector<bool> done(tree_.size());
    std::vector<std::uint32_t> open(roots);
    for (const std::uint32_t p : roots) {
      done[p] = true;
      if (normals_[3 * p + 2] < 0) turn(p);
    }
    while (!open.empty()) {
      const std::uint32_t p = open.back();
      open.pop_back();
      for (std::uint32_t i = start[p]; i < start[p + 1]; ++i) {
        const std::uint32_t other = beside[i];
        if (done[other]) continue;
        done[other] = true;
        if (agreement(p, other) < 0) turn(other);
        open.push_back(other);
      }
    }
  }

  std::span<const float> positions_;
  std::span<double> normals_;
  std::vector<std::uint32_t> tree_;  // union-find: parent of each point in its tree
};

}  // namespace

std::size_t orientAlike(std::span<const float> positions, std::span<const std::uint32_t> neighbours,
                        std::size_t k, std::span<double> normals) {
  return Orientation(positions, normals).run(neighbours, k);
}

}  // namespace merlin::render::points
