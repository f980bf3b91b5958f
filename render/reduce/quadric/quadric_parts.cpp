// QuadricReducer: which thread works on which part of the mesh, and until when.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric/quadric_reducer.h"

namespace merlin::render::reduce {
namespace {

// Step of all parts, in buckets of cost: a factor of about 1.4.
constexpr std::size_t kStep = 32;
constexpr std::size_t kProgressInterval = 1 << 16;  // triangles
constexpr double kStepTakes = 1.25;  // typical factor by which a step reduces the triangles
constexpr std::size_t kMostSteps = 16;
constexpr std::size_t kMostParts = 32;
constexpr std::size_t kLeastPart = 30'000;  // vertices
// Factor by which parts of 200,000 vertices are reduced before they are joined.
constexpr double kReduction = 6;

// Returns the number of parts at first, a power of two: few, since triangles at borders have to
// wait; but enough for several cores.
std::size_t partsFor(std::size_t vertices) {
  if (vertices < 20'000) return 1;
  std::size_t parts = 2;
  while (parts < kMostParts && vertices / parts >= 2 * kLeastPart) parts *= 2;
  return parts;
}

// Returns the number of triangles at which `parts` parts are joined in pairs. Their borders, which
// have to wait, are then at most a tenth of the triangles; a fourth in small meshes, where joining
// earlier would hardly pay.
std::size_t leftBy(std::size_t parts, std::size_t vertices, std::size_t triangles) {
  const double part = static_cast<double>(vertices) / static_cast<double>(parts);
  const double ratio = kReduction * std::sqrt(part / 200'000);
  return static_cast<std::size_t>(static_cast<double>(triangles) /
                                  std::max(ratio, parts == 2 ? kReduction : 1.0));
}

// Returns how many steps the parts may take before they wait for one another: as many as are surely
// needed to get from `left` to `keep` triangles.
std::size_t stepsAtOnce(std::size_t left, std::size_t keep) {
  const double ratio = static_cast<double>(left) / static_cast<double>(keep);
  const double steps = std::log(std::max(1.0, ratio)) / std::log(kStepTakes);
  return std::clamp<std::size_t>(static_cast<std::size_t>(steps), 1, kMostSteps);
}

}  // namespace

// Calls work(v, scratch), which writes only data of v, for each living vertex, in parallel blocks.
void QuadricReducer::forEachLiving(
    const std::function<void(std::uint32_t, EdgeCosts&)>& work) const {
  constexpr std::size_t kBlock = 1 << 12;
  const std::size_t n = mesh_.vertexCount();
  forBlocks(threads_, (n + kBlock - 1) / kBlock, [&](std::size_t block) {
    EdgeCosts scratch;
    const auto end = static_cast<std::uint32_t>(std::min(n, (block + 1) * kBlock));
    for (auto v = static_cast<std::uint32_t>(block * kBlock); v < end; ++v) {
      if (lives(mesh_[v])) work(v, scratch);
    }
  });
}

// Makes all hubs normal vertices. Not in parallel, since the stars of several hubs may contain the
// same dead vertices.
void QuadricReducer::releaseHubs() {
  for (std::uint32_t v = 0; hubs_ && v < mesh_.vertexCount(); ++v) {
    if (!(mesh_[v].flags & kHub)) continue;
    mesh_.tidyHub(v);
    mesh_[v].flags &= static_cast<std::uint8_t>(~kHub);
  }
}

// Recomputes the quadrics of all living vertices. Those with too many triangles become hubs without
// a quadric; since the cost of an edge needs the quadrics of both ends, they do not take part.
void QuadricReducer::setQuadrics() {
  releaseHubs();
  std::atomic<bool> hubs = false;
  const EvaluateEdges set = edgeEvaluator(Evaluate::kQuadric);
  forEachLiving([&](std::uint32_t v, EdgeCosts& scratch) {
    const std::uint32_t triangles = mesh_[v].degree;
    if (triangles <= most_corners_) {
      set(view(), v, scratch);
      return;
    }
    setHub(mesh_[v], triangles);
    hubs = true;
  });
  hubs_ = hubs;
}

// Cuts the curve into `count` parts of equal numbers of vertices.
std::vector<QuadricReducer::Worker> QuadricReducer::makeParts(std::size_t count) {
  std::vector<Worker> parts(count);
  const std::size_t n = mesh_.vertexCount();
  forBlocks(threads_, count, [&](std::size_t p) {
    Worker& w = parts[p];
    w.begin = static_cast<std::uint32_t>(n * p / count);
    w.end = static_cast<std::uint32_t>(n * (p + 1) / count);
    w.room = mesh_.freeRoom();
    w.log = log_.data() + w.begin;
    w.inside_only = true;
    std::size_t corners = 0;
    for (std::uint32_t v = w.begin; v < w.end; ++v) corners += mesh_[v].degree;
    w.triangles = corners / 3;
  });
  return parts;
}

bool QuadricReducer::isInside(const Worker& w, std::uint32_t v) const {
  const auto is_here = [&](std::uint32_t o) { return o >= w.begin && o < w.end; };
  if (!twins_.empty() && twins_[v] != kNowhere && !is_here(twins_[v])) return false;
  const auto star = mesh_.star(mesh_[v]);
  return std::all_of(star.begin(), star.end(),
                     [&](const Corner& c) { return is_here(c.b) && is_here(c.c); });
}

// Queues the vertices of a part that are not in the queue yet and whose ring is inside the part.
void QuadricReducer::startPart(Worker& w, EvaluateEdges measure) {
  for (std::uint32_t v = w.end; v-- > w.begin;) {
    QuadricVertex& x = mesh_[v];
    const bool queued = (x.flags & kInside) && !(x.flags & kIdle);
    if (queued || !lives(x) || !isInside(w, v)) continue;
    x.flags = static_cast<std::uint8_t>((x.flags | kInside) & ~kIdle);
    if (x.flags & kHub) {
      x.flags |= kIdle;
      continue;
    }
    measure(view(), v, w.costs);
    enqueue(w, v, w.costs.least());
  }
}

// Reduces and joins parts until at most `keep` triangles are left or the last two parts have
// reached their limit.
void QuadricReducer::reduceParts(std::size_t keep, const Progress& progress) {
  const std::size_t n = mesh_.vertexCount(), triangles = triangles_;
  std::vector<Worker> parts = makeParts(partsFor(n));
  HugeArray<std::uint32_t> joined(n);
  setQuadrics();
  EvaluateEdges measure = edgeEvaluator(Evaluate::kEdges);
  std::size_t limit = 0;
  for (;;) {
    forBlocks(threads_, parts.size(), [&](std::size_t p) { startPart(parts[p], measure); });
    const std::size_t left = leftBy(parts.size(), n, triangles);
    reduceInSteps(parts, std::max(left, keep), limit, progress);
    joinLogs(parts, joined);
    if (parts.size() == 2 || cancelled_) break;
    forBlocks(threads_, parts.size() / 2,
              [&](std::size_t p) { joinPart(parts[2 * p], std::move(parts[2 * p + 1])); });
    for (std::size_t p = 0; 2 * p < parts.size(); ++p) std::swap(parts[p], parts[2 * p]);
    parts.resize(parts.size() / 2);
    measure = evaluate_;  // also quadrics: those at former borders are stale
  }
  log_ = std::move(joined);
  whole_.room = mesh_.freeRoom();
  for (Worker& w : parts) whole_.takeOver(std::move(w));
}

// Reduces all parts to the same cost, step by step, until at most `keep` triangles are left. limit:
// the bucket that the parts have reached (in and out).
void QuadricReducer::reduceInSteps(std::vector<Worker>& parts, std::size_t keep, std::size_t& limit,
                                   const Progress& progress) {
  std::size_t first = BucketQueue::buckets(), before = triangles_;
  for (const Worker& w : parts) {
    first = std::min(first, w.queue.current());
    before += w.removed;
  }
  limit = std::max(limit, first);
  // Keeps a flat part, where collapses cost nothing, from being reduced to its borders.
  const double most = 1 - 0.5 * static_cast<double>(keep) / static_cast<double>(before);
  while (triangles_ > keep && limit < BucketQueue::buckets() && !cancelled_) {
    const std::size_t steps = stepsAtOnce(triangles_, keep);
    forBlocks(threads_, parts.size(), [&](std::size_t p) {
      const double share = most * static_cast<double>(parts[p].triangles);
      for (std::size_t step = 1; step <= steps; ++step) {
        reduceTo(parts[p], static_cast<std::size_t>(share), limit + step * kStep);
        parts[p].steps.push_back(parts[p].collapses);
      }
    });
    limit += steps * kStep;
    triangles_ = before;
    std::size_t collapses = whole_.collapses;
    for (const Worker& w : parts) {
      triangles_ -= w.removed;
      collapses += w.collapses;
    }
    cancelled_ = progress && !progress({collapses, triangles_});
  }
}

// Appends the parts' logs to `joined`: for each step, slices of all parts in turn, so that all
// parts are equally coarse at every level.
void QuadricReducer::joinLogs(std::vector<Worker>& parts, HugeArray<std::uint32_t>& joined) {
  constexpr std::size_t kSlices = 64;
  for (std::size_t step = 0; step < parts[0].steps.size(); ++step) {
    for (std::size_t slice = 0; slice < kSlices; ++slice) {
      for (const Worker& w : parts) {
        const std::size_t first = step ? w.steps[step - 1] : 0, count = w.steps[step] - first;
        const std::size_t from = first + count * slice / kSlices;
        const std::size_t to = first + count * (slice + 1) / kSlices;
        std::copy(w.log + from, w.log + to, joined.data() + whole_.collapses);
        whole_.collapses += to - from;
      }
    }
  }
  for (Worker& w : parts) {
    w.steps.clear();
    w.collapses = 0;
  }
}

// Takes over the counts of another worker and the room that it returned, but not its queue.
void QuadricReducer::Worker::takeOver(Worker&& other) {
  room.join(std::move(other.room));
  flips += other.flips;
  links += other.links;
  visited += other.visited;
  too_coarse |= other.too_coarse;
}

// Joins the next part on the curve to w.
void QuadricReducer::joinPart(Worker& w, Worker&& other) {
  w.end = other.end;
  w.queue.join(std::move(other.queue), nextOf());
  w.triangles += other.triangles;
  w.removed += other.removed;
  w.takeOver(std::move(other));
}

// Puts all living vertices into one queue.
void QuadricReducer::requeue() {
  setQuadrics();
  // Stores the costs in next_, in parallel, before it takes the links of the queue.
  const EvaluateEdges edges = edgeEvaluator(Evaluate::kEdges);
  forEachLiving([&](std::uint32_t v, EdgeCosts& costs) {
    const bool hub = mesh_[v].flags & kHub;
    if (!hub) edges(view(), v, costs);
    next_[v] = std::bit_cast<std::uint32_t>(hub ? kNoEdge : costs.least());
  });
  whole_.queue = BucketQueue();
  for (std::uint32_t v = mesh_.vertexCount(); v-- > 0;) {
    if (!lives(mesh_[v])) continue;
    mesh_[v].flags &= static_cast<std::uint8_t>(~kIdle);
    enqueue(whole_, v, std::bit_cast<float>(next_[v]));
  }
}

// Reduces the whole mesh until at most `keep` triangles are left or the stage allows no more.
void QuadricReducer::reduceWhole(std::size_t keep, const Progress& progress) {
  requeue();
  while (triangles_ > keep && !cancelled_) {
    whole_.removed = 0;
    reduceTo(whole_, std::min(triangles_ - keep, kProgressInterval), BucketQueue::buckets());
    if (whole_.removed == 0) return;
    triangles_ -= whole_.removed;
    whole_.removed = 0;
    cancelled_ = progress && !progress({whole_.collapses, triangles_});
  }
}

// Returns the number of triangles of the smallest star above most_corners_: of a hub, or of a star
// that a refused collapse would have made.
std::uint32_t QuadricReducer::smallestLeftOut() const {
  std::uint32_t smallest = whole_.refused_star;
  for (std::uint32_t v = 0; hubs_ && v < mesh_.vertexCount(); ++v) {
    if (mesh_[v].flags & kHub) smallest = std::min(smallest, trianglesOf(mesh_[v]));
  }
  return smallest;
}

// Reduces with small stars first, where a collapse is fast, then raises the limit for what is left.
// The higher the limit, the fewer triangles are left.
void QuadricReducer::reduceStage(std::size_t keep, const Progress& progress) {
  constexpr std::uint32_t kGrowth = 4, kNoneLeftOut = std::numeric_limits<std::uint32_t>::max();
  most_corners_ = keepsTopology(stage_) ? kMostCorners : kMostUnordered;
  for (;;) {
    whole_.refused_star = kNoneLeftOut;
    reduceWhole(keep, progress);
    const std::uint32_t left_out = smallestLeftOut();
    if (left_out == kNoneLeftOut || triangles_ <= keep || cancelled_) return;
    most_corners_ = std::max(left_out, kGrowth * std::min(most_corners_, kNoneLeftOut / kGrowth));
  }
}

const char* QuadricReducer::run(const Limits& limits, const Progress& progress) {
  threads_ = limits.threads;
  max_error_ = limits.error * mesh_.scale();
  fast_ = limits.fast;
  keep_components_ = limits.preserve_topology || limits.preserve_components;
  const std::size_t keep = std::max<std::size_t>(limits.triangles, 1);
  // Parts stop at three times the target, so that the final reduction of the whole makes it even.
  if (partsFor(mesh_.vertexCount()) > 1 && 3 * keep < triangles_)
    reduceParts(3 * keep, progress);
  else
    whole_.room = mesh_.freeRoom();
  whole_.log = log_.data();
  by_all_rules_ = triangles_;
  const auto stages = {QuadricStage::kAll, QuadricStage::kNoLock, QuadricStage::kNoLink,
                       QuadricStage::kNoFlips};
  for (const QuadricStage stage : stages) {
    if (triangles_ <= keep || cancelled_ || (stage != QuadricStage::kAll && limits.by_all_rules))
      break;
    // Once the error limit is reached, fewer rules would not help.
    if (stage != QuadricStage::kAll && whole_.too_coarse) break;
    if (stage == QuadricStage::kNoLock && labels_.empty()) continue;
    if (!keepsTopology(stage) && limits.preserve_topology) break;
    stage_ = stage;
    reduceStage(keep, progress);
    if (stage == QuadricStage::kAll) by_all_rules_ = triangles_;
  }
  if (cancelled_) return "cancelled";
  if (triangles_ <= keep && limits.triangles > 0) return "triangles";
  return whole_.too_coarse ? "error" : "nothing left to collapse";
}

}  // namespace merlin::render::reduce
