#include "render/lod/clusters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/mesh/morton.h"

namespace merlin::render {
namespace {

constexpr std::uint16_t kNoCluster = std::numeric_limits<std::uint16_t>::max();
constexpr double kRungStep = 1.41421356;
constexpr unsigned kCurveBits = 10;
// Cuts of fewer triangles a cluster are made without clusters.
constexpr std::size_t kFewPerCluster = 64;
// Where nobody says how many clusters.
constexpr std::size_t kVerticesOfACluster = 700, kLeastUsual = 512, kMostUsual = 2048;

}  // namespace

// What the constructor works with, once.
struct Clusters::Builder {
  Clusters& c;
  const Dendrogram& d;
  std::size_t finest;

  // L0, and the finest level for whose rungs there is memory.
  void chooseLevels(const ClusterSettings& settings);
  void numberClusters();
  void sortFinest();
  std::vector<std::uint32_t> groupTriangles(std::span<const std::uint32_t> corners) const;
  void addRungs();
  void addPlainRungs();
  void findNeighbours();
  void measure();
  void measureCone(std::size_t cluster);
};

void Clusters::Builder::chooseLevels(const ClusterSettings& settings) {
  const std::size_t vertices = d.vertexCount();
  const std::size_t usual = std::clamp(vertices / kVerticesOfACluster, kLeastUsual, kMostUsual);
  const std::size_t wanted =
      std::clamp<std::size_t>(settings.clusters > 0 ? settings.clusters : usual, 1, kNoCluster - 1);
  const std::size_t roots = std::clamp<std::size_t>(vertices / 16, 1, wanted);
  c.coarsest_ = std::min(d.levels() - 1, vertices > roots ? vertices - roots : 0);
  // 16 bytes for each of 1 + 1/sqrt(2) + ... times the triangles of the finest, 12 for those of
  // the finest plain one.
  const std::size_t plain = std::min(settings.memory / 2, 42 * kFewPerCluster * roots);
  finest = std::min(d.levelFor((settings.memory - plain) / 57), c.coarsest_);
}

// Every node goes to the cluster of its parent; those alive at L0 are roots. Clusters are numbered
// along a curve.
void Clusters::Builder::numberClusters() {
  const auto alive = c.aliveBelow(c.coarsest_);
  c.cluster_of_.assign(c.aliveBelow(finest), kNoCluster);
  std::vector<std::uint32_t> roots;
  std::vector<bool> made(alive, false);  // by a later collapse: not there yet at L0
  for (std::size_t k = c.coarsest_; k < c.forest_.parents.size(); ++k)
    made[c.forest_.parents[k]] = true;
  for (std::uint32_t n = 0; n < alive; ++n) {
    if (!made[n]) roots.push_back(n);
  }
  const auto positions = d.arrays().positions;
  const Box box = boundingBox(positions);
  std::array<float, 3> extent{};
  for (std::size_t k = 0; k < 3; ++k) {
    extent[k] = box.high[k] - box.low[k];
    if (!(extent[k] > 0)) extent[k] = 1;
  }
  const auto key = [&](std::uint32_t n) {
    return mortonKey(&positions[3 * std::size_t{n}], box.low, extent, kCurveBits);
  };
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  // Where a mesh has more parts than there may be clusters, neighbours share one.
  const std::size_t share = roots.size() / (kNoCluster - 1) + 1;
  for (std::size_t i = 0; i < roots.size(); ++i)
    c.cluster_of_[roots[i]] = static_cast<std::uint16_t>(i / share);
  for (std::uint32_t n = alive; n < c.cluster_of_.size(); ++n)
    c.cluster_of_[n] = c.cluster_of_[c.forest_.parentOf(n)];
  c.bounds_.resize((roots.size() + share - 1) / share);
}

// Which group each triangle of the finest level belongs to.
std::vector<std::uint32_t> Clusters::Builder::groupTriangles(
    std::span<const std::uint32_t> corners) const {
  std::vector<std::uint32_t> group(corners.size() / 3, static_cast<std::uint32_t>(2 * c.size()));
  std::size_t level = d.levels() - 1;
  for (std::size_t rank = c.alive_[c.coarsest_]; rank < group.size(); ++rank) {
    while (rank >= c.alive_[level]) --level;  // the last level at which it is alive
    const std::uint16_t dies_in = c.cluster_of_[c.aliveBelow(level) - 1];
    const std::uint32_t* corner = &corners[3 * rank];
    const bool inner = c.cluster_of_[corner[0]] == dies_in && c.cluster_of_[corner[1]] == dies_in &&
                       c.cluster_of_[corner[2]] == dies_in;
    group[rank] = 2U * dies_in + (inner ? 0 : 1);
  }
  return group;
}

void Clusters::Builder::sortFinest() {
  std::vector<std::uint32_t> corners(3 * d.trianglesAt(finest));
  d.cut(finest, corners);
  const std::vector<std::uint32_t> group = groupTriangles(corners);
  Rung rung{finest, std::vector<std::uint32_t>(2 * c.size() + 2, 0), {}, {}};
  for (const std::uint32_t g : group) ++rung.begins[g + 1];
  std::partial_sum(rung.begins.begin(), rung.begins.end(), rung.begins.begin());
  rung.ranks.resize(group.size());
  rung.corners.resize(corners.size());
  std::vector<std::uint32_t> at(rung.begins.begin(), rung.begins.end() - 1);
  for (std::size_t rank = 0; rank < group.size(); ++rank) {
    const std::uint32_t i = at[group[rank]]++;
    rung.ranks[i] = static_cast<std::uint32_t>(rank);
    std::copy_n(&corners[3 * rank], 3, &rung.corners[3 * std::size_t{i}]);
  }
  c.rungs_.push_back(std::move(rung));
}

// Each from the one before, at steps of sqrt(2) in triangles.
void Clusters::Builder::addRungs() {
  auto triangles = static_cast<double>(d.trianglesAt(finest));
  while ((triangles /= kRungStep) > static_cast<double>(d.trianglesAt(c.coarsest_))) {
    const std::size_t level = d.levelFor(static_cast<std::size_t>(triangles));
    const Rung& finer = c.rungs_.back();
    if (level <= finer.level || level >= c.coarsest_) continue;
    Rung rung{level, {0}, {}, {}};
    rung.ranks.reserve(c.alive_[level]);
    rung.corners.resize(3 * std::size_t{c.alive_[level]});
    std::uint32_t* at = rung.corners.data();
    for (std::size_t g = 0; g + 1 < finer.begins.size(); ++g) {
      const std::size_t begin = finer.begins[g], n = prefix(finer, g, c.alive_[level]);
      rung.ranks.insert(rung.ranks.end(), &finer.ranks[begin], &finer.ranks[begin] + n);
      at = c.chaseTo(level, &finer.corners[3 * begin], 3 * n, at);
      rung.begins.push_back(static_cast<std::uint32_t>(rung.ranks.size()));
    }
    c.rungs_.push_back(std::move(rung));
  }
}

// For cuts of so few triangles that clusters would cost more than they bring.
void Clusters::Builder::addPlainRungs() {
  auto triangles = static_cast<double>(std::min(kFewPerCluster * c.size(), d.trianglesAt(finest)));
  for (; triangles >= 1; triangles /= kRungStep) {
    const std::size_t level = d.levelFor(static_cast<std::size_t>(triangles));
    if (!c.plain_.empty() && level <= c.plain_.back().level) continue;
    Rung rung{level, {}, {}, std::vector<std::uint32_t>(3 * d.trianglesAt(level))};
    if (c.plain_.empty())
      d.cut(level, rung.corners);
    else
      c.chaseTo(level, c.plain_.back().corners.data(), rung.corners.size(), rung.corners.data());
    c.plain_.push_back(std::move(rung));
  }
}

void Clusters::Builder::findNeighbours() {
  c.neighbours_.resize(c.size());
  const Rung& finest_rung = c.rungs_.front();
  for (std::size_t i = 0; i < c.size(); ++i) {
    auto& list = c.neighbours_[i];
    for (std::size_t t = 3 * std::size_t{finest_rung.begins[2 * i + 1]};
         t < 3 * std::size_t{finest_rung.begins[2 * i + 2]}; ++t)
      list.push_back(c.cluster_of_[finest_rung.corners[t]]);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.shrink_to_fit();
  }
}

// Spheres round all that a cluster's triangles can be made of, and cones round the finest normals.
void Clusters::Builder::measure() {
  const auto positions = d.arrays().positions;
  std::vector<Box> boxes(c.size());
  std::vector<bool> seen(c.size(), false);
  const auto grow = [&](std::size_t cluster, std::uint32_t node) {
    const float* p = &positions[3 * std::size_t{node}];
    for (std::size_t k = 0; k < 3; ++k) {
      boxes[cluster].low[k] = seen[cluster] ? std::min(boxes[cluster].low[k], p[k]) : p[k];
      boxes[cluster].high[k] = seen[cluster] ? std::max(boxes[cluster].high[k], p[k]) : p[k];
    }
    seen[cluster] = true;
  };
  // Down to the leaves, finer than the finest level too.
  std::vector<std::uint16_t> of = c.cluster_of_;
  of.resize(d.nodeCount());
  for (std::uint32_t n = 0; n < of.size(); ++n) {
    if (n >= c.cluster_of_.size()) of[n] = of[c.forest_.parentOf(n)];
    if (of[n] != kNoCluster) grow(of[n], n);
  }
  const auto leaves = d.arrays().triangles;
  for (std::size_t i = 0; finest > 0 && i < leaves.size(); ++i) {
    const std::uint16_t cluster = of[leaves[i - i % 3]];
    if (of[leaves[i]] != cluster) grow(cluster, leaves[i]);
  }
  // Corners in other clusters, and what they may be chased up to.
  const auto coarse = c.aliveBelow(c.coarsest_);
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Rung& rung = c.rungs_.front();
    for (std::size_t t = 3 * std::size_t{rung.begins[2 * i + 1]};
         t < 3 * std::size_t{rung.begins[2 * i + 2]}; ++t) {
      std::uint32_t node = rung.corners[t];
      if (c.cluster_of_[node] == i) continue;
      grow(i, node);
      while (node >= coarse) grow(i, node = c.forest_.parentOf(node));
    }
  }
  for (std::size_t i = 0; i < c.size(); ++i) {
    ClusterBounds& b = c.bounds_[i];
    for (std::size_t k = 0; k < 3; ++k) b.centre[k] = (boxes[i].low[k] + boxes[i].high[k]) / 2;
    b.radius = boxes[i].diagonal() / 2;
    measureCone(i);
  }
}

// Of the finest triangles: their mean normal, and how far they turn from it.
void Clusters::Builder::measureCone(std::size_t cluster) {
  const auto positions = d.arrays().positions;
  std::vector<std::array<float, 3>> normals;
  const Rung& rung = c.rungs_.front();
  for (std::size_t t = rung.begins[2 * cluster]; t < rung.begins[2 * cluster + 2]; ++t) {
    const auto at = [&](std::size_t k) {
      return &positions[3 * std::size_t{rung.corners[3 * t + k]}];
    };
    normals.push_back(faceNormal(at(0), at(1), at(2)));
  }
  ClusterBounds& b = c.bounds_[cluster];
  std::array<float, 3> sum{};
  for (const auto& n : normals) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += n[k];
  }
  const float length = std::hypot(sum[0], sum[1], sum[2]);
  if (!(length > 0)) return;
  for (std::size_t k = 0; k < 3; ++k) b.axis[k] = sum[k] / length;
  b.cone_cos = 1;
  for (const auto& n : normals) {
    const float cosine = n[0] * b.axis[0] + n[1] * b.axis[1] + n[2] * b.axis[2];
    if (n[0] != 0 || n[1] != 0 || n[2] != 0) b.cone_cos = std::min(b.cone_cos, cosine);
  }
}

Clusters::Clusters(const Dendrogram& dendrogram, const ClusterSettings& settings)
    : dendrogram_(dendrogram),
      alive_(dendrogram.arrays().alive),
      forest_{dendrogram.arrays().parents, static_cast<std::uint32_t>(dendrogram.nodeCount())},
      chase_all_(chaser(dendrogram.nodeCount())) {
  Builder builder{*this, dendrogram, 0};
  builder.chooseLevels(settings);
  builder.numberClusters();
  builder.sortFinest();
  builder.addRungs();
  builder.addPlainRungs();
  builder.findNeighbours();
  builder.measure();
}

std::size_t Clusters::prefix(const Rung& rung, std::size_t group, std::uint32_t alive) noexcept {
  const auto first = rung.ranks.begin() + rung.begins[group];
  const auto last = rung.ranks.begin() + rung.begins[group + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, alive) - first);
}

std::size_t Clusters::rungFor(std::span<const Rung> rungs, std::size_t level) noexcept {
  std::size_t rung = 0;
  while (rung + 1 < rungs.size() && rungs[rung + 1].level <= level) ++rung;
  return rung;
}

std::size_t Clusters::trianglesAt(std::size_t cluster, std::size_t level) const noexcept {
  const Rung& rung = rungs_[rungFor(rungs_, level)];
  return prefix(rung, 2 * cluster, alive_[level]) + prefix(rung, 2 * cluster + 1, alive_[level]);
}

std::uint32_t* Clusters::chaseTo(std::size_t level, const std::uint32_t* from, std::size_t corners,
                                 std::uint32_t* out) const noexcept {
  chase_all_(forest_, aliveBelow(level), from, corners, out);
  return out + corners;
}

std::uint32_t* Clusters::chaseEach(std::span<const std::uint32_t> levels, const std::uint32_t* from,
                                   std::size_t corners, std::uint32_t* out) const noexcept {
  for (std::size_t i = 0; i < corners; ++i)
    *out++ = forest_.chase(from[i], aliveBelow(levels[cluster_of_[from[i]]]));
  return out;
}

std::size_t Clusters::cut(std::span<const std::uint32_t> levels, std::span<std::uint32_t> out,
                          std::span<std::uint32_t> ends) const noexcept {
  assert(levels.size() == size() && ends.size() == size() + 1);
  std::uint32_t* at = out.data();
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t level = levels[i];
    assert(level >= finestLevel() && level <= coarsest_);
    const Rung& inner = rungs_[rungFor(rungs_, level)];
    at = chaseTo(level, &inner.corners[3 * std::size_t{inner.begins[2 * i]}],
                 3 * prefix(inner, 2 * i, alive_[level]), at);
    // A corner of another cluster starts where that one may still be finer.
    std::size_t finest = level;
    for (const std::uint16_t n : neighbours_[i]) finest = std::min<std::size_t>(finest, levels[n]);
    const Rung& mixed = rungs_[rungFor(rungs_, finest)];
    at = chaseEach(levels, &mixed.corners[3 * std::size_t{mixed.begins[2 * i + 1]}],
                   3 * prefix(mixed, 2 * i + 1, alive_[level]), at);
    ends[i] = static_cast<std::uint32_t>((at - out.data()) / 3);
  }
  const std::size_t finest = *std::min_element(levels.begin(), levels.end());
  const Rung& rung = rungs_[rungFor(rungs_, finest)];
  at = chaseEach(levels, &rung.corners[3 * std::size_t{rung.begins[2 * size()]}], 3 * alwaysThere(),
                 at);
  return ends[size()] = static_cast<std::uint32_t>((at - out.data()) / 3);
}

std::size_t Clusters::cutEvenly(std::size_t level, std::span<std::uint32_t> out) const noexcept {
  const std::size_t triangles = alive_[level];
  if (level < finestLevel()) return dendrogram_.cut(level, out);
  if (level >= plain_.front().level) {
    const Rung& rung = plain_[rungFor(plain_, level)];
    chaseTo(level, rung.corners.data(), 3 * triangles, out.data());
    return triangles;
  }
  const Rung& rung = rungs_[rungFor(rungs_, level)];
  std::uint32_t* at = out.data();
  for (std::size_t g = 0; g + 1 < rung.begins.size(); ++g)
    at = chaseTo(level, &rung.corners[3 * std::size_t{rung.begins[g]}],
                 3 * prefix(rung, g, alive_[level]), at);
  return triangles;
}

void Clusters::everything(std::vector<std::uint32_t>& corners,
                          std::vector<std::uint32_t>& ends) const {
  const auto leaves = dendrogram_.arrays().triangles;
  const std::uint32_t alive = aliveBelow(finestLevel());
  std::vector<std::uint16_t> cluster(leaves.size() / 3);
  std::vector<std::uint32_t> at(size() + 1, 0);
  for (std::size_t t = 0; t < cluster.size(); ++t) {
    cluster[t] = cluster_of_[forest_.chase(leaves[3 * t], alive)];
    ++at[cluster[t] + 1U];
  }
  std::partial_sum(at.begin(), at.end(), at.begin());
  ends.assign(at.begin() + 1, at.end());
  ends.push_back(at.back());
  corners.resize(leaves.size());
  for (std::size_t t = 0; t < cluster.size(); ++t)
    std::copy_n(&leaves[3 * t], 3, &corners[3 * std::size_t{at[cluster[t]]++}]);
}

std::size_t Clusters::memoryBytes() const noexcept {
  std::size_t bytes = 2 * cluster_of_.size() + sizeof(ClusterBounds) * bounds_.size();
  for (const auto* rungs : {&rungs_, &plain_}) {
    for (const Rung& r : *rungs) bytes += 4 * (r.begins.size() + r.ranks.size() + r.corners.size());
  }
  for (const auto& list : neighbours_) bytes += 2 * list.size() + sizeof list;
  return bytes;
}

}  // namespace merlin::render
