// QuadricReducer in parts and as a whole: who works on what, and until when.
#include <algorithm>
#include <cmath>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric_reducer.h"

namespace merlin::render {
namespace {

// Steps of cost, in buckets, after which the parts wait for one another: a factor of 1.4.
constexpr std::size_t kStep = 32;
constexpr std::size_t kProgressInterval = 1 << 16;  // triangles
// Of what is left above the goal: a step takes about as much.
constexpr double kStepTakes = 1.25;
constexpr std::size_t kMostSteps = 16;

// How many parts a mesh is first reduced in. Few, since seams wait; many enough for some cores.
std::size_t partsFor(std::size_t vertices) {
  if (vertices < 20'000) return 1;
  return std::clamp<std::size_t>(vertices / 250'000, 2, 64);
}

// What the parts leave to the whole, where `target` triangles are asked for.
std::size_t leftByParts(std::size_t triangles, std::size_t target) {
  return std::max(triangles / 6, 3 * target);
}

// How many steps parts may take before they wait for one another, with `left` triangles of which
// `keep` are to stay: as many as are surely needed.
std::size_t stepsAtOnce(std::size_t left, std::size_t keep) {
  const double ratio = static_cast<double>(left) / static_cast<double>(keep);
  const double steps = std::log(std::max(1.0, ratio)) / std::log(kStepTakes);
  return std::clamp<std::size_t>(static_cast<std::size_t>(steps), 1, kMostSteps);
}

}  // namespace

void QuadricReducer::forEachPart(const std::function<void(std::size_t)>& work) const {
  forBlocks(threads_, part_ends_.size(), work);
}

// Equal parts of the curve.
void QuadricReducer::planParts() {
  const std::size_t n = mesh_.vertexCount(), parts = partsFor(n);
  for (std::size_t p = 1; p <= parts; ++p)
    part_ends_.push_back(static_cast<std::uint32_t>(n * p / parts));
}

void QuadricReducer::startPart(std::size_t part, Worker& w) {
  const std::uint32_t begin = part == 0 ? 0 : part_ends_[part - 1], end = part_ends_[part];
  const auto is_here = [&](std::uint32_t v) { return v >= begin && v < end; };
  std::size_t corners = 0;
  for (std::uint32_t v = begin; v < end; ++v) {
    const auto star = mesh_.star(mesh_[v]);
    corners += star.size();
    const bool alone = twins_.empty() || twins_[v] == kNowhere;
    if ((alone || is_here(twins_[v])) &&
        std::all_of(star.begin(), star.end(),
                    [&](const Corner& c) { return is_here(c.b) && is_here(c.c); })) {
      mesh_[v].flags |= kInside;
    }
  }
  w.inside_only = true;
  w.log = log_.data() + begin;
  w.triangles = corners / 3;
  for (std::uint32_t v = end; v-- > begin;) {
    if (!(mesh_[v].flags & kInside) || mesh_[v].degree == 0) continue;
    evaluate(w, v);
    enqueue(w, v);
  }
}

// Each part up to the same cost, step by step, until no more than `keep` triangles are left.
void QuadricReducer::reduceParts(std::size_t keep, const Progress& progress) {
  std::vector<Worker> parts(part_ends_.size());
  StarRoom all = mesh_.freeRoom();
  const std::uint32_t share =
      (all.end() - all.next()) / static_cast<std::uint32_t>(parts.size()) / 8 * 8;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto begin = all.next() + static_cast<std::uint32_t>(p) * share;
    parts[p].room = StarRoom(begin, begin + share);
  }
  setQuadrics();
  forEachPart([&](std::size_t p) { startPart(p, parts[p]); });
  // A part of nothing but planes is not worn down to its seams.
  const double most = 1 - 0.5 * static_cast<double>(keep) / static_cast<double>(triangles_);
  std::size_t limit = BucketQueue::buckets();
  for (const Worker& w : parts) limit = std::min(limit, w.queue.current());
  const std::size_t before = triangles_;
  while (triangles_ > keep && limit < BucketQueue::buckets() && !cancelled_) {
    const std::size_t steps = stepsAtOnce(triangles_, keep);
    forEachPart([&](std::size_t p) {
      const double share = most * static_cast<double>(parts[p].triangles);
      for (std::size_t step = 1; step <= steps; ++step) {
        reduceTo(parts[p], static_cast<std::size_t>(share), limit + step * kStep);
        parts[p].steps.push_back(parts[p].collapses);
      }
    });
    limit += steps * kStep;
    triangles_ = before;
    std::size_t collapses = 0;
    for (const Worker& w : parts) {
      triangles_ -= w.removed;
      collapses += w.collapses;
    }
    cancelled_ = progress && !progress({collapses, triangles_});
  }
  joinParts(parts);
}

// The logs as one: of each step a little of every part in turn, so that all parts are equally
// coarse at every level.
void QuadricReducer::joinParts(std::vector<Worker>& parts) {
  HugeArray<std::uint32_t> joined(mesh_.vertexCount());
  std::size_t n = 0;
  std::vector<std::size_t> done(parts.size(), 0);
  for (std::size_t step = 0; step < parts[0].steps.size(); ++step) {
    const auto behind = [&](std::size_t p, std::size_t q) {  // p's share done is less than q's
      const std::size_t from_p = step ? parts[p].steps[step - 1] : 0,
                        from_q = step ? parts[q].steps[step - 1] : 0;
      return (2 * (done[p] - from_p) + 1) * (parts[q].steps[step] - from_q) <
             (2 * (done[q] - from_q) + 1) * (parts[p].steps[step] - from_p);
    };
    for (;;) {
      std::size_t best = parts.size();
      for (std::size_t p = 0; p < parts.size(); ++p) {
        if (done[p] < parts[p].steps[step] && (best == parts.size() || behind(p, best))) best = p;
      }
      if (best == parts.size()) break;
      joined[n++] = parts[best].log[done[best]++];
    }
  }
  log_ = std::move(joined);
  whole_.collapses = n;
  whole_.room = std::move(parts[0].room);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (p > 0) whole_.room.join(std::move(parts[p].room));
    whole_.flips += parts[p].flips;
    whole_.links += parts[p].links;
    whole_.too_coarse |= parts[p].too_coarse;
  }
}

// All quadrics anew, so that edges cost what they cost when they are first looked at.
void QuadricReducer::setQuadrics() {
  const EvaluateEdges set = quadricSetter();
  constexpr std::size_t kBlock = 1 << 13;
  const std::size_t n = mesh_.vertexCount();
  forBlocks(threads_, (n + kBlock - 1) / kBlock, [&](std::size_t block) {
    EdgeCosts scratch;
    const auto end = static_cast<std::uint32_t>(std::min(n, (block + 1) * kBlock));
    for (auto v = static_cast<std::uint32_t>(block * kBlock); v < end; ++v) {
      if (!(mesh_[v].flags & kDead) && mesh_[v].degree > 0) set(view(), v, scratch);
    }
  });
}

// Every vertex that lives, in one queue.
void QuadricReducer::requeue() {
  setQuadrics();
  whole_.queue = BucketQueue();
  for (std::uint32_t v = mesh_.vertexCount(); v-- > 0;) {
    if ((mesh_[v].flags & kDead) || mesh_[v].degree == 0) continue;
    mesh_[v].flags &= static_cast<std::uint8_t>(~kIdle);
    evaluate(whole_, v);
    enqueue(whole_, v);
  }
}

// Until no more than `keep` triangles are left or the stage allows no more.
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

const char* QuadricReducer::run(const Limits& limits, const Progress& progress) {
  threads_ = std::max(1U, limits.threads);
  max_error_ = limits.error * mesh_.scale();
  keep_components_ = limits.preserve_topology || limits.preserve_components;
  const std::size_t keep = std::max<std::size_t>(limits.triangles, 1);
  planParts();
  if (const std::size_t left = leftByParts(triangles_, keep);
      part_ends_.size() > 1 && left < triangles_)
    reduceParts(left, progress);
  else
    whole_.room = mesh_.freeRoom();
  whole_.log = log_.data();
  const auto stages = {QuadricStage::kAll, QuadricStage::kNoLock, QuadricStage::kNoLink,
                       QuadricStage::kNoFlips};
  for (const QuadricStage stage : stages) {
    if (triangles_ <= keep || cancelled_ || (stage != QuadricStage::kAll && limits.by_all_rules))
      break;
    // What is left after an error's limit is not what rules are in the way of.
    if (stage != QuadricStage::kAll && whole_.too_coarse) break;
    if (stage == QuadricStage::kNoLock && labels_.empty()) continue;
    if (!keepsTopology(stage) && limits.preserve_topology) break;
    stage_ = stage;
    reduceWhole(keep, progress);
  }
  if (cancelled_) return "cancelled";
  if (triangles_ <= keep && limits.triangles > 0) return "triangles";
  return whole_.too_coarse ? "error" : "nothing left to collapse";
}

}  // namespace merlin::render
