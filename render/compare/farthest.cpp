#include "render/compare/farthest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace merlin::render::compare {
namespace {

constexpr std::size_t kBlock = 2048;     // triangles or vertices per block of the first pass
constexpr std::size_t kRound = 1024;     // parts that are halved in one round
constexpr std::size_t kRoundBlock = 64;  // parts
constexpr double kFirstPassShare = 0.5;  // share of the first pass in the progress

// A triangle of the first surface, or a part of such a triangle.
struct Part {
  std::array<Vector, 3> corners;
  // By corner: place of its nearest triangle in the other surface.
  std::array<std::uint32_t, 3> nearest{};
  // Place of the triangle from which `upper` follows.
  std::uint32_t bounded_by = TriangleTree::kNone;
  // Upper bound of the distances of its points.
  double upper = std::numeric_limits<double>::infinity();
};

bool isLess(const Part& a, const Part& b) { return a.upper < b.upper; }

// Computes the upper bound of `part`: the lowest of the bounds that the triangles known to be near
// give.
void bound(const TriangleTree& to, Part& part) {
  const std::array<std::uint32_t, 4> candidates = {part.nearest[0], part.nearest[1],
                                                   part.nearest[2], part.bounded_by};
  double least2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto seen = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    if (candidates[i] == TriangleTree::kNone ||
        std::find(candidates.begin(), seen, candidates[i]) != seen)
      continue;
    double most2 = 0;
    for (const Vector& corner : part.corners)
      most2 = std::max(most2, to.nearestAt(candidates[i], corner).distance2);
    if (!(most2 < least2)) continue;
    least2 = most2;
    part.bounded_by = candidates[i];
  }
  part.upper = std::min(part.upper, std::sqrt(least2));
}

// The two halves of a part, cut at the middle of its longest edge.
struct Halves {
  std::array<Part, 2> parts;
  double distance = 0;  // distance from the other surface of the point of the cut
};

Halves halve(const TriangleTree& to, const Part& part) {
  std::size_t i = 0;
  const auto length2 = [&](std::size_t k) {
    return squared(part.corners[(k + 1) % 3] - part.corners[k]);
  };
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    if (length2(k) > length2(i)) i = k;
  }
  const std::size_t j = (i + 1) % 3;
  const Vector middle = 0.5 * part.corners[i] + 0.5 * part.corners[j];
  const TriangleTree::Nearest nearest = to.nearest(middle, part.nearest[i]);
  Halves halves{{part, part}, std::sqrt(nearest.point.distance2)};
  halves.parts[0].corners[j] = halves.parts[1].corners[i] = middle;
  halves.parts[0].nearest[j] = halves.parts[1].nearest[i] = nearest.place;
  for (Part& half : halves.parts) bound(to, half);
  return halves;
}

std::size_t blocksOf(std::size_t count, std::size_t size) { return (count + size - 1) / size; }

class FarthestSearch {
 public:
  FarthestSearch(const Surface& from, const Surface& to, const Search& search,
                 const KeepGoing& keepGoing)
      : from_(from), to_(to.tree), search_(search), keep_going_(keepGoing) {}

  bool testVertices();
  bool collectTriangles();
  bool refine();

  Interval interval() const {
    const double open = parts_.empty() ? 0.0 : parts_.front().upper;
    return {low_, std::max({low_, dropped_, open}), evaluations_};
  }

 private:
  bool inBlocks(std::size_t count, double from, const std::function<void(std::size_t)>& work);
  bool matters(const Part& part) const { return part.upper > low_ + search_.width; }
  void keep(const Part& part);
  bool refineRound();
  double shareDone() const;

  const Surface& from_;
  const TriangleTree& to_;
  const Search& search_;
  const KeepGoing& keep_going_;

  std::vector<std::uint32_t> nearest_;  // by vertex: place of the nearest triangle; kNone if unused
  std::vector<Part> parts_;             // heap; the part with the largest bound is first
  double low_ = 0;
  double dropped_ = 0;  // largest upper bound of the dropped parts
  double first_gap_ = 0;
  std::size_t evaluations_ = 0;
};

bool FarthestSearch::inBlocks(std::size_t count, double from,
                              const std::function<void(std::size_t)>& work) {
  const std::size_t blocks = blocksOf(count, kBlock);
  return forBlocks(search_.threads, blocks, work, [&](std::size_t done) {
    const double share = static_cast<double>(done) / static_cast<double>(blocks);
    return keep_going_(kFirstPassShare * (from + share / 2), std::min(done * kBlock, count));
  });
}

// Tests the vertices in the order of the tree's leaves, so that each result is a good hint for the
// next search.
bool FarthestSearch::testVertices() {
  nearest_.assign(from_.mesh.vertexCount(), TriangleTree::kNone);
  std::vector<std::uint32_t> order;
  std::vector<bool> seen(from_.mesh.vertexCount());
  for (std::uint32_t place = 0; place < from_.tree.size(); ++place) {
    const std::size_t triangle = from_.tree.triangleAt(place);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = from_.mesh.triangles[3 * triangle + k];
      if (!seen[v]) order.push_back(v);
      seen[v] = true;
    }
  }
  std::vector<double> most(blocksOf(order.size(), kBlock));
  const bool done = inBlocks(order.size(), 0, [&](std::size_t block) {
    std::uint32_t hint = TriangleTree::kNone;
    const std::size_t last = std::min((block + 1) * kBlock, order.size());
    for (std::size_t i = block * kBlock; i < last; ++i) {
      const float* p = &from_.mesh.positions[3 * std::size_t{order[i]}];
      const TriangleTree::Nearest nearest = to_.nearest(vectorAt(p), hint);
      nearest_[order[i]] = hint = nearest.place;
      most[block] = std::max(most[block], std::sqrt(nearest.point.distance2));
    }
  });
  evaluations_ += order.size();
  low_ = *std::max_element(most.begin(), most.end());
  return done;
}

bool FarthestSearch::collectTriangles() {
  struct Found {
    std::vector<Part> parts;
    double dropped = 0;
  };
  std::vector<Found> found(blocksOf(from_.tree.size(), kBlock));
  const bool done = inBlocks(from_.tree.size(), 0.5, [&](std::size_t block) {
    const std::size_t last = std::min((block + 1) * kBlock, from_.tree.size());
    for (std::size_t i = block * kBlock; i < last; ++i) {
      const auto place = static_cast<std::uint32_t>(i);
      Part part{from_.tree.cornersAt(place)};
      const std::size_t triangle = from_.tree.triangleAt(place);
      for (std::size_t k = 0; k < 3; ++k)
        part.nearest[k] = nearest_[from_.mesh.triangles[3 * triangle + k]];
      bound(to_, part);
      if (matters(part))
        found[block].parts.push_back(part);
      else
        found[block].dropped = std::max(found[block].dropped, part.upper);
    }
  });
  for (const Found& f : found) {
    dropped_ = std::max(dropped_, f.dropped);
    parts_.insert(parts_.end(), f.parts.begin(), f.parts.end());
  }
  std::make_heap(parts_.begin(), parts_.end(), isLess);
  return done;
}

void FarthestSearch::keep(const Part& part) {
  if (matters(part)) {
    parts_.push_back(part);
    std::push_heap(parts_.begin(), parts_.end(), isLess);
  } else {
    dropped_ = std::max(dropped_, part.upper);
  }
}

// Halves the parts with the largest upper bounds. The choice of parts in a round does not depend on
// the number of threads.
bool FarthestSearch::refineRound() {
  const double share = shareDone();
  std::vector<Part> round;
  while (round.size() < kRound && !parts_.empty() && matters(parts_.front())) {
    round.push_back(parts_.front());
    std::pop_heap(parts_.begin(), parts_.end(), isLess);
    parts_.pop_back();
  }
  std::vector<Halves> halves(round.size());
  const bool done = forBlocks(
      search_.threads, blocksOf(round.size(), kRoundBlock),
      [&](std::size_t block) {
        const std::size_t last = std::min((block + 1) * kRoundBlock, round.size());
        for (std::size_t i = block * kRoundBlock; i < last; ++i) halves[i] = halve(to_, round[i]);
      },
      [&](std::size_t) { return keep_going_(share, evaluations_); });
  evaluations_ += round.size();
  for (const Halves& h : halves) low_ = std::max(low_, h.distance);
  for (const Halves& h : halves) {
    for (const Part& part : h.parts) keep(part);
  }
  return done;
}

bool FarthestSearch::refine() {
  first_gap_ = interval().high - low_;
  while (!parts_.empty() && matters(parts_.front()) && evaluations_ < search_.max_evaluations) {
    if (!refineRound()) return false;
  }
  return true;
}

// The gap usually shrinks by the same factor in each round, so its logarithm measures the progress.
double FarthestSearch::shareDone() const {
  const double gap = interval().high - low_;
  if (!(gap > search_.width) || !(first_gap_ > search_.width)) return 1;
  const double share = std::log(first_gap_ / gap) / std::log(first_gap_ / search_.width);
  return kFirstPassShare + (1 - kFirstPassShare) * std::clamp(share, 0.0, 1.0);
}

}  // namespace

std::optional<Interval> farthest(const Surface& from, const Surface& to, const Search& search,
                                 const KeepGoing& keepGoing) {
  FarthestSearch farthest_search(from, to, search, keepGoing);
  if (!farthest_search.testVertices() || !farthest_search.collectTriangles() ||
      !farthest_search.refine())
    return std::nullopt;
  return farthest_search.interval();
}

}  // namespace merlin::render::compare
