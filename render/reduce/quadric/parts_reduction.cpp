#include "render/reduce/quadric/parts_reduction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/reduce/quadric/quadric_refresh.h"

namespace merlin::render::reduce {
namespace {

// In one step, the cost limit of all parts rises by this many buckets, which is a factor of about
// 1.4.
constexpr std::size_t kStep = 32;
// Typical factor by which one step reduces the number of triangles.
constexpr double kStepTakes = 1.25;
constexpr std::size_t kMostSteps = 16;
constexpr std::size_t kMostParts = 32;
// Minimum number of vertices per part, if there are more than two parts.
constexpr std::size_t kLeastPart = 30'000;
// Factor by which parts of 200,000 vertices are reduced before they are joined.
constexpr double kReduction = 6;

// Returns the number of triangles at which `parts` parts are joined in pairs. The borders between
// the parts, which cannot be reduced before that, then have at most a tenth of the triangles. In
// small meshes they have up to a fourth, since joining earlier would hardly save time.
std::size_t leftBy(std::size_t parts, std::size_t vertices, std::size_t triangles) {
  const double part = static_cast<double>(vertices) / static_cast<double>(parts);
  const double ratio = kReduction * std::sqrt(part / 200'000);
  return static_cast<std::size_t>(static_cast<double>(triangles) /
                                  std::max(ratio, parts == 2 ? kReduction : 1.0));
}

// Returns the number of steps that each part does before it waits for the others: the estimated
// number of steps from `left` to `keep` triangles, clamped to 1 .. kMostSteps.
std::size_t stepsAtOnce(std::size_t left, std::size_t keep) {
  const double ratio = static_cast<double>(left) / static_cast<double>(keep);
  const double steps = std::log(std::max(1.0, ratio)) / std::log(kStepTakes);
  return std::clamp<std::size_t>(static_cast<std::size_t>(steps), 1, kMostSteps);
}

}  // namespace

std::size_t PartsReduction::partsFor(std::size_t vertices) {
  if (vertices < 20'000) return 1;
  std::size_t parts = 2;
  while (parts < kMostParts && vertices / parts >= 2 * kLeastPart) parts *= 2;
  return parts;
}

void PartsReduction::run(std::size_t keep, const Progress& progress) {
  const std::size_t n = s_.mesh.vertexCount(), triangles = s_.triangles;
  std::vector<CollapseWorker> parts = makeParts(partsFor(n));
  HugeArray<std::uint32_t> joined(n);
  refreshQuadrics(s_);
  EvaluateEdges measure = edgeEvaluator(Evaluate::kEdges);
  for (;;) {
    forBlocks(s_.threads, parts.size(), [&](std::size_t p) { startPart(parts[p], measure); });
    const std::size_t left = leftBy(parts.size(), n, triangles);
    reduceInSteps(parts, std::max(left, keep), progress);
    joinLogs(parts, joined);
    if (parts.size() == 2 || s_.cancelled) break;
    joinInPairs(parts);
    measure = edgeEvaluator();  // also recomputes quadrics, since those at former borders are stale
  }
  s_.log = std::move(joined);
  s_.whole.room = s_.mesh.freeRoom();
  for (CollapseWorker& w : parts) s_.whole.takeOver(std::move(w));
}

// Divides the curve into `count` parts with equal numbers of vertices.
std::vector<CollapseWorker> PartsReduction::makeParts(std::size_t count) {
  std::vector<CollapseWorker> parts(count);
  const std::size_t n = s_.mesh.vertexCount();
  forBlocks(s_.threads, count, [&](std::size_t p) {
    CollapseWorker& w = parts[p];
    w.begin = static_cast<std::uint32_t>(n * p / count);
    w.end = static_cast<std::uint32_t>(n * (p + 1) / count);
    w.room = s_.mesh.freeRoom();
    w.log = s_.log.data() + w.begin;
    w.inside_only = true;
    std::size_t corners = 0;
    for (std::uint32_t v = w.begin; v < w.end; ++v) corners += s_.mesh[v].degree;
    w.triangles = corners / 3;
  });
  return parts;
}

bool PartsReduction::isInside(const CollapseWorker& w, std::uint32_t v) const {
  const auto is_here = [&](std::uint32_t o) { return o >= w.begin && o < w.end; };
  const std::uint32_t twin = seams_.twinOf(v);
  if (twin != kNowhere && !is_here(twin)) return false;
  const auto star = s_.mesh.star(s_.mesh[v]);
  return std::all_of(star.begin(), star.end(),
                     [&](const Corner& c) { return is_here(c.b) && is_here(c.c); });
}

// Queues the vertices of a part that are not in the queue yet and whose ring is inside the part.
void PartsReduction::startPart(CollapseWorker& w, EvaluateEdges measure) {
  for (std::uint32_t v = w.end; v-- > w.begin;) {
    QuadricVertex& x = s_.mesh[v];
    const bool queued = (x.flags & kInside) && !(x.flags & kIdle);
    if (queued || !lives(x) || !isInside(w, v)) continue;
    x.flags = static_cast<std::uint8_t>((x.flags | kInside) & ~kIdle);
    if (x.flags & kHub) {
      x.flags |= kIdle;
      continue;
    }
    measure(s_.view(), v, w.costs);
    s_.enqueue(w, v, w.costs.least());
  }
}

// Reduces all parts to the same cost, step by step, until at most `keep` triangles are left.
void PartsReduction::reduceInSteps(std::vector<CollapseWorker>& parts, std::size_t keep,
                                   const Progress& progress) {
  std::size_t first = BucketQueue::buckets(), before = s_.triangles;
  for (const CollapseWorker& w : parts) {
    first = std::min(first, w.queue.current());
    before += w.removed;
  }
  limit_ = std::max(limit_, first);
  // Largest share of its triangles that a part may lose, so that a flat part, where collapses cost
  // nothing, is not reduced to its borders.
  const double most = 1 - 0.5 * static_cast<double>(keep) / static_cast<double>(before);
  while (s_.triangles > keep && limit_ < BucketQueue::buckets() && !s_.cancelled) {
    const std::size_t steps = stepsAtOnce(s_.triangles, keep);
    forBlocks(s_.threads, parts.size(), [&](std::size_t p) {
      const double share = most * static_cast<double>(parts[p].triangles);
      for (std::size_t step = 1; step <= steps; ++step) {
        loop_.reduceTo(parts[p], static_cast<std::size_t>(share), limit_ + step * kStep);
        parts[p].steps.push_back(parts[p].collapses);
      }
    });
    limit_ += steps * kStep;
    s_.triangles = before;
    std::size_t collapses = s_.whole.collapses;
    for (const CollapseWorker& w : parts) {
      s_.triangles -= w.removed;
      collapses += w.collapses;
    }
    s_.cancelled = progress && !progress({collapses, s_.triangles});
  }
}

// Appends the parts' logs to `joined`: for each step, slices of all parts in turn, so that all
// parts are equally coarse at every level.
void PartsReduction::joinLogs(std::vector<CollapseWorker>& parts,
                              HugeArray<std::uint32_t>& joined) {
  constexpr std::size_t kSlices = 64;
  for (std::size_t step = 0; step < parts[0].steps.size(); ++step) {
    for (std::size_t slice = 0; slice < kSlices; ++slice) {
      for (const CollapseWorker& w : parts) {
        const std::size_t first = step ? w.steps[step - 1] : 0, count = w.steps[step] - first;
        const std::size_t from = first + count * slice / kSlices;
        const std::size_t to = first + count * (slice + 1) / kSlices;
        std::copy(w.log + from, w.log + to, joined.data() + s_.whole.collapses);
        s_.whole.collapses += to - from;
      }
    }
  }
  for (CollapseWorker& w : parts) {
    w.steps.clear();
    w.collapses = 0;
  }
}

// Joins each second part to the part before it on the curve.
void PartsReduction::joinInPairs(std::vector<CollapseWorker>& parts) {
  forBlocks(s_.threads, parts.size() / 2, [&](std::size_t p) {
    CollapseWorker &w = parts[2 * p], &other = parts[2 * p + 1];
    w.end = other.end;
    w.queue.join(std::move(other.queue), s_.nextOf());
    w.triangles += other.triangles;
    w.removed += other.removed;
    w.takeOver(std::move(other));
  });
  for (std::size_t p = 0; 2 * p < parts.size(); ++p) std::swap(parts[p], parts[2 * p]);
  parts.resize(parts.size() / 2);
}

}  // namespace merlin::render::reduce
