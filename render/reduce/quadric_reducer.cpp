#include "render/reduce/quadric_reducer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "daemon/base/blocks.h"
namespace merlin::render {
namespace {

// A popped edge may cost so much more than its bucket and is still taken.
constexpr float kTolerance = 1.5F;
// Steps of cost, in buckets, after which the parts wait for one another: a factor of 1.4.
constexpr std::size_t kStep = 32;
// As far as validate() lets a mesh reach.
constexpr float kFarthest = 1e18F;
constexpr std::size_t kProgressInterval = 1 << 16;  // triangles

// How many parts a mesh is first reduced in. Few, since seams wait; many enough for some cores.
std::size_t partsFor(std::size_t vertices) {
  if (vertices < 20'000) return 1;
  return std::clamp<std::size_t>(vertices / 250'000, 2, 64);
}

// What the parts leave to the whole, where `target` triangles are asked for.
std::size_t leftByParts(std::size_t triangles, std::size_t target) {
  return std::max(triangles / 6, 3 * target);
}

float trace(const float* h) { return h[0] + h[3] + h[5]; }

}  // namespace

QuadricReducer::QuadricReducer(const Mesh& mesh, std::size_t channels, unsigned threads)
    : mesh_(mesh, threads),
      input_positions_(mesh.positions.data()),
      channels_(mesh.vertexCount(), channels),
      ranges_(channels),
      evaluate_(edgeEvaluator()),
      log_(mesh.vertexCount()),
      triangles_(mesh.triangleCount()) {}

void QuadricReducer::setChannel(std::size_t channel, const float* values, std::size_t stride,
                                float scale) {
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
    channels_.value(v, channel) = values[mesh_.inputOf(v) * stride] * scale * mesh_.scale();
  Range& range = ranges_[channel];
  range = {channels_.value(0, channel), channels_.value(0, channel)};
  for (std::uint32_t v = 1; v < mesh_.vertexCount(); ++v) {
    range.low = std::min(range.low, channels_.value(v, channel));
    range.high = std::max(range.high, channels_.value(v, channel));
  }
}

void QuadricReducer::setLabels(const float* values) {
  labels_.resize(mesh_.vertexCount());
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v) labels_[v] = values[mesh_.inputOf(v)];
}

void QuadricReducer::lock(const std::vector<bool>& locked) {
  pinned_.assign(2 * std::size_t{mesh_.vertexCount()}, kNowhere);
  for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v) {
    if (!locked[mesh_.inputOf(v)]) continue;
    mesh_[v].flags |= kLocked;
    pinned_[mesh_.inputOf(v)] = mesh_.inputOf(v);
  }
}

void QuadricReducer::enqueue(Worker& w, std::uint32_t v) {
  const float cost = w.costs.cost[w.costs.cheapest()];
  if (cost >= kNoEdge)
    mesh_[v].flags |= kIdle;
  else
    w.queue.push(v, cost, nextOf());
}

// Most of the time goes into waiting for memory: what the next three vertices need is asked for in
// stages, record, star, ring. Always inlined: GCC takes a call that only prefetches for one without
// effect and drops it.
[[gnu::always_inline]] inline void QuadricReducer::prefetch(const Worker& w) const {
  const std::uint32_t first = w.queue.front();
  if (first == BucketQueue::kNone) return;
  for (const Corner& c : mesh_.star(mesh_[first])) __builtin_prefetch(&mesh_[c.b]);
  const std::uint32_t second = mesh_[first].next;
  if (second == BucketQueue::kNone) return;
  __builtin_prefetch(mesh_.corners(mesh_[second].star));
  const std::uint32_t third = mesh_[second].next;
  if (third != BucketQueue::kNone) __builtin_prefetch(&mesh_[third]);
}

void QuadricReducer::reduceTo(Worker& w, std::size_t removed, std::size_t bucket_limit) {
  while (w.removed < removed) {
    const std::uint32_t v = w.queue.pop(bucket_limit, nextOf());
    if (v == BucketQueue::kNone) return;
    prefetch(w);
    if (!(mesh_[v].flags & kDead) && mesh_[v].degree > 0) tryVertex(w, v);
  }
}

// Raises the edge's cost where area does not say what is lost, once. Returns whether it did.
bool QuadricReducer::guard(Worker& w, std::uint32_t v, std::uint32_t edge) {
  float& deviation = w.costs.deviation[edge];
  if (deviation >= 0) return false;
  deviation = 0;
  const QuadricVertex &a = mesh_[v], &x = mesh_[w.costs.neighbour[edge]];
  const std::uint8_t flags = a.flags | x.flags;
  const float before = w.costs.cost[edge];
  if ((flags & kLocked) && stage_ <= QuadricStage::kNoLock) stayAtLocked(view(), v, w.costs, edge);
  if (flags & kOpen) deviation = borderDeviation(view(), v, w.costs, edge);
  if ((flags & kSharp) || a.deviation > 0 || x.deviation > 0)
    deviation = std::max(deviation, tipDeviation(view(), v, w.costs, edge));
  if (stage_ <= QuadricStage::kNoLock && vanishes(view(), v, w.costs, edge))
    deviation = std::max(deviation, reachOf(w.costs) + std::max(a.deviation, x.deviation));
  const float least = deviationCost(deviation);
  w.costs.cost[edge] = std::max(w.costs.cost[edge], least);
  return w.costs.cost[edge] > before;
}

void QuadricReducer::tryVertex(Worker& w, std::uint32_t v) {
  const std::size_t bucket = w.queue.current();
  const bool last = bucket + 1 == BucketQueue::buckets();
  const float ceiling = last ? kNoEdge : kTolerance * BucketQueue::floorOf(bucket + 1);
  evaluate(w, v);
  EdgeCosts& costs = w.costs;
  std::fill_n(costs.deviation.begin(), costs.count, -1.0F);
  for (;;) {
    const std::uint32_t edge = costs.cheapest();
    const float cost = costs.cost[edge];
    if (cost >= kNoEdge) {
      mesh_[v].flags |= kIdle;
      return;
    }
    if (cost >= ceiling) {
      w.queue.push(v, cost, nextOf());
      return;
    }
    const std::uint32_t x = costs.neighbour[edge];
    __builtin_prefetch(mesh_.corners(mesh_[x].star));
    if (guard(w, v, edge)) continue;
    if (mayCollapse(w, v, edge)) {
      collapse(w, v, edge);
      return;
    }
    costs.cost[edge] = kNoEdge;
  }
}

bool QuadricReducer::mayCollapse(Worker& w, std::uint32_t v, std::uint32_t edge) {
  if (w.inside_only && !(mesh_[w.costs.neighbour[edge]].flags & kInside)) return false;
  // The last triangle stays. (A part keeps some by the first stage's rules.)
  if (!w.inside_only && w.costs.shared[edge] >= triangles_ - w.removed) return false;
  const bool locked = stage_ == QuadricStage::kAll && !labels_.empty() &&
                      labels_[v] != labels_[w.costs.neighbour[edge]];
  if (locked ||
      (keep_components_ && stage_ <= QuadricStage::kNoLock && vanishes(view(), v, w.costs, edge))) {
    ++w.links;
    return false;
  }
  const Verdict verdict = judge(view(), v, w.costs, edge, stage_);
  if (verdict != Verdict::kLegal) {
    ++(verdict == Verdict::kFlip ? w.flips : w.links);
    return false;
  }
  if (!(errorOf(w, v, edge) > max_error_)) return true;
  w.too_coarse = true;
  return false;
}

// The root of the mean square distance to the planes of both stars, in mean edges.
float QuadricReducer::errorOf(const Worker& w, std::uint32_t v, std::uint32_t edge) const {
  const float area = trace(mesh_[v].h) + trace(mesh_[w.costs.neighbour[edge]].h);
  return area > 0 ? std::sqrt(w.costs.cost[edge] / area) : 0;
}

void QuadricReducer::collapse(Worker& w, std::uint32_t v, std::uint32_t edge) {
  const std::uint32_t x = w.costs.neighbour[edge];
  const float cost = w.costs.cost[edge];
  const std::uint32_t shared = w.costs.shared[edge];
  const float error = errorOf(w, v, edge);
  if (channels_.count() > 0) mixChannels(v, x, w.costs, edge);
  mergeStars(w, v, x);
  QuadricVertex &a = mesh_[v], &b = mesh_[x];
  const bool to_b = (b.flags & kLocked) && stage_ <= QuadricStage::kNoLock;
  a.flags |= b.flags & (kOpen | kLocked);
  if (stage_ > QuadricStage::kNoLock) a.flags |= kOpen;
  b.flags |= kDead;
  a.deviation = std::max({a.deviation, b.deviation, w.costs.deviation[edge]});
  const float step[] = {w.costs.x[edge], w.costs.y[edge], w.costs.z[edge]};
  for (int k = 0; k < 3; ++k) a.position[k] = to_b ? b.position[k] : a.position[k] + step[k];
  NodeRecord record{
      {a.node, b.node}, {a.position[0], a.position[1], a.position[2]}, error, {0, 0, 0}};
  a.node = mesh_.vertexCount() + x;
  w.log[w.collapses++] = x;
  w.removed += shared;
  wakeRing(w, v, cost);
  if (a.degree > 0) {
    evaluate(w, v);
    std::copy_n(w.costs.normal, 3, record.normal);
    enqueue(w, v);
  }
  std::memcpy(static_cast<void*>(b.position), &record, sizeof record);
}

void QuadricReducer::mergeStars(Worker& w, std::uint32_t v, std::uint32_t x) {
  QuadricVertex &a = mesh_[v], &b = mesh_[x];
  const std::span<Corner> sa = mesh_.star(a), sb = mesh_.star(b);
  w.merged.clear();
  // Each from the edge on, so that two fans become one.
  const auto append = [&](std::span<const Corner> star, std::uint32_t other) {
    std::size_t first = 0;
    while (first < star.size() && star[first].b != other) ++first;
    if (first == star.size()) {
      first = 0;
      while (first < star.size() && star[first].c != other) ++first;
    }
    for (std::size_t k = 0; k < star.size(); ++k) {
      const Corner& c = star[first + k < star.size() ? first + k : first + k - star.size()];
      if (c.b != other && c.c != other) w.merged.push_back(c);
    }
  };
  append(sa, x);
  append(sb, v);
  for (const Corner& c : sb) {
    if (c.b != v) renameInRing(c.b, v, x);
    if ((b.flags & kOpen) && c.c != v) renameInRing(c.c, v, x);
  }
  const auto n = static_cast<std::uint32_t>(w.merged.size());
  if (n <= a.capacity) {
    w.room.give(b.star, b.capacity);
  } else if (n <= b.capacity) {
    w.room.give(a.star, a.capacity);
    a.star = b.star;
    a.capacity = b.capacity;
  } else {
    const QuadricVertex old_a = a;
    a.star = w.room.take(n, a.capacity);
    w.room.give(old_a.star, old_a.capacity);
    w.room.give(b.star, b.capacity);
  }
  std::copy(w.merged.begin(), w.merged.end(), mesh_.corners(a.star));
  a.degree = n;
  b.degree = 0;
}

// In the star of o, a neighbour of x: triangles with both ends go, x becomes v.
void QuadricReducer::renameInRing(std::uint32_t o, std::uint32_t v, std::uint32_t x) {
  QuadricVertex& ring = mesh_[o];
  Corner* star = mesh_.corners(ring.star);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < ring.degree; ++i) {
    Corner c = star[i];
    if ((c.b == v || c.c == v) && (c.b == x || c.c == x)) continue;
    if (c.b == x) c.b = v;
    if (c.c == x) c.c = v;
    star[kept++] = c;
  }
  ring.degree = kept;
  if (stage_ > QuadricStage::kNoLock) ring.flags |= kOpen;
}

// The neighbours that had no legal edge may have one now.
void QuadricReducer::wakeRing(Worker& w, std::uint32_t v, float cost) {
  const auto wake = [&](std::uint32_t o) {
    if (!(mesh_[o].flags & kIdle)) return;
    mesh_[o].flags &= static_cast<std::uint8_t>(~kIdle);
    w.queue.push(o, cost, nextOf());
  };
  for (const Corner& c : mesh_.star(mesh_[v])) {
    wake(c.b);
    if (mesh_[v].flags & kOpen) wake(c.c);
  }
}

// The channels' values that are best for the new vertex; they stay with x as the node's.
void QuadricReducer::mixChannels(std::uint32_t v, std::uint32_t x, const EdgeCosts& costs,
                                 std::uint32_t edge) {
  float *of_v = channels_.block(v), *of_x = channels_.block(x);
  const float p[] = {costs.x[edge], costs.y[edge], costs.z[edge]};
  const float q[] = {p[0] - costs.rx[edge], p[1] - costs.ry[edge], p[2] - costs.rz[edge]};
  const float area = of_v[0] + of_x[0];
  for (std::size_t k = 0; k < channels_.count(); ++k) {
    const float *b = of_v + 1 + 4 * k, *c = of_x + 1 + 4 * k;
    const float delta = c[3] - b[3];
    float s = area > 0 ? (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + c[0] * q[0] + c[1] * q[1] +
                          c[2] * q[2] + of_x[0] * delta) /
                             area
                       : delta / 2;
    if (!std::isfinite(s)) s = delta / 2;
    const float value = std::clamp(b[3] + s, ranges_[k].low, ranges_[k].high);
    channels_.value(v, k) = channels_.value(x, k) = value;
  }
}

// --- parts ---------------------------------------------------------------------------------------

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
    if (std::all_of(star.begin(), star.end(),
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
  forEachPart([&](std::size_t p) { startPart(p, parts[p]); });
  // A part of nothing but planes is not worn down to its seams.
  const double most = 1 - 0.5 * static_cast<double>(keep) / static_cast<double>(triangles_);
  std::size_t limit = BucketQueue::buckets();
  for (const Worker& w : parts) limit = std::min(limit, w.queue.current());
  const std::size_t before = triangles_;
  while (triangles_ > keep && limit < BucketQueue::buckets() && !cancelled_) {
    limit += kStep;
    forEachPart([&](std::size_t p) {
      reduceTo(parts[p], static_cast<std::size_t>(most * static_cast<double>(parts[p].triangles)),
               limit);
      parts[p].steps.push_back(parts[p].collapses);
    });
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

// Every vertex that lives, in one queue.
void QuadricReducer::requeue() {
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
    if (stage > QuadricStage::kNoLock && limits.preserve_topology) break;
    stage_ = stage;
    reduceWhole(keep, progress);
  }
  if (cancelled_) return "cancelled";
  if (triangles_ <= keep && limits.triangles > 0) return "triangles";
  return whole_.too_coarse ? "error" : "nothing left to collapse";
}

// --- the result ----------------------------------------------------------------------------------

// A node that stands where a locked vertex was is there to the last bit, so that seams fit.
void QuadricReducer::pin(std::size_t k, const std::array<std::uint32_t, 2>& children,
                         const float* position, std::array<float, 3>& p) {
  for (const std::uint32_t child : children) {
    const std::uint32_t v = pinned_[child];
    if (v == kNowhere) continue;
    const auto place = mesh_.toWorking(&input_positions_[3 * std::size_t{v}]);
    if (!std::equal(place.begin(), place.end(), position)) continue;
    std::copy_n(&input_positions_[3 * std::size_t{v}], 3, p.begin());
    pinned_[mesh_.vertexCount() + k] = v;
    return;
  }
}

Reduction QuadricReducer::finish(const Mesh& mesh) {
  mesh_.dropStars();
  const std::uint32_t vertices = mesh_.vertexCount();
  const std::size_t collapses = whole_.collapses;
  for (std::size_t k = 0; k < collapses; ++k) mesh_[log_[k]].next = static_cast<std::uint32_t>(k);
  const auto node = [&](std::uint32_t n) {
    return n < vertices ? mesh_.inputOf(n) : vertices + mesh_[n - vertices].next;
  };
  Reduction result;
  CollapseLog& log = result.log;
  log.children.reserve(collapses);
  log.positions.reserve(3 * collapses);
  log.error.reserve(collapses);
  log.features.resize(mesh.features.size());
  std::vector<float>* normals = nullptr;
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    if (mesh.features[f].name == "normal") normals = &log.features[f];
  }
  if (normals) normals->reserve(3 * collapses);
  for (std::size_t k = 0; k < collapses; ++k) {
    NodeRecord r;
    std::memcpy(&r, static_cast<const void*>(mesh_[log_[k]].position), sizeof r);
    log.children.push_back({node(r.children[0]), node(r.children[1])});
    auto p = mesh_.toModel(r.position);
    for (float& x : p) x = std::clamp(x, -kFarthest, kFarthest);
    if (!pinned_.empty()) pin(k, log.children.back(), r.position, p);
    log.positions.insert(log.positions.end(), p.begin(), p.end());
    log.error.push_back(r.error / mesh_.scale());
    const float length = std::hypot(r.normal[0], r.normal[1], r.normal[2]);
    for (const float x : r.normal) {
      if (normals) normals->push_back(length > 0 ? x / length : 0);
    }
  }
  result.report.collapses = collapses;
  result.report.flips_refused = whole_.flips;
  result.report.topology_refused = whole_.links;
  result.report.triangles = triangles_;
  result.report.error =
      log.error.empty() ? 0 : *std::max_element(log.error.begin(), log.error.end());
  return result;
}

std::vector<float> QuadricReducer::channelValues(std::size_t channel, float scale) const {
  std::vector<float> values(whole_.collapses);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = channels_.value(log_[k], channel) / (scale * mesh_.scale());
  return values;
}

}  // namespace merlin::render
