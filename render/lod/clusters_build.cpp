// Builds Clusters, once for each model; clusters.cpp makes cuts from them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "daemon/base/blocks.h"
#include "render/lod/clusters.h"
#include "render/mesh/morton.h"

namespace merlin::render::lod {
namespace {

constexpr std::uint16_t kNoCluster = std::numeric_limits<std::uint16_t>::max();
// Ratio of triangle counts between successive detail steps: sqrt(2) up to 300,000 triangles, 2
// above.
constexpr double kRungStep = 1.41421356, kLargeRungStep = 2;
constexpr std::size_t kLargeRung = 300'000;
constexpr unsigned kCurveBits = 10;
// If a cut has fewer triangles per cluster than this, clusters are not used.
constexpr std::size_t kFewPerCluster = 64;
// For the automatic number of clusters: vertices per cluster, smallest and largest number.
constexpr std::size_t kVerticesOfACluster = 700, kLeastUsual = 512, kMostUsual = 2048;
// Number of pieces into which all nodes or triangles are divided for threads; the result does not
// depend on it.
constexpr std::size_t kPieces = 16;

// Returns the number of triangles of the finest step such that all steps fit into `memory`. A step
// takes 12 bytes per triangle; the finest step takes 6 more per triangle (rank and cluster).
std::size_t trianglesThatFit(std::size_t memory) {
  constexpr std::size_t kOfRungs = 12 * 3414 / 1000, kOfLargeRungs = 12 * 2, kOfFinest = 4 + 2;
  constexpr std::size_t kLeastLarge = (kOfRungs + kOfFinest) * kLargeRung;
  if (memory <= kLeastLarge) return memory / (kOfRungs + kOfFinest);
  return kLargeRung + (memory - kLeastLarge) / (kOfLargeRungs + kOfFinest);
}

// Index range [first, last) of a piece.
struct Piece {
  std::size_t first, last;
};

Piece pieceOf(std::size_t size, std::size_t piece) {
  return {size * piece / kPieces, size * (piece + 1) / kPieces};
}

// Bounding boxes, one for each cluster.
class Boxes {
 public:
  explicit Boxes(std::size_t clusters)
      : boxes_(clusters, mesh::Box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}}) {}

  void grow(std::size_t cluster, const float* position) {
    mesh::Box& box = boxes_[cluster];
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], position[k]);
      box.high[k] = std::max(box.high[k], position[k]);
    }
  }
  void grow(const Boxes& others) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (others.isEmpty(i)) continue;
      grow(i, others.boxes_[i].low.data());
      grow(i, others.boxes_[i].high.data());
    }
  }
  bool isEmpty(std::size_t cluster) const { return boxes_[cluster].low[0] == kFar; }
  const mesh::Box& operator[](std::size_t cluster) const { return boxes_[cluster]; }

 private:
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  std::vector<mesh::Box> boxes_;
};

}  // namespace

// Working state of the constructor.
struct Clusters::Builder {
  Clusters& c;
  const Dendrogram& d;
  std::size_t finest;

  // Chooses L0 (coarsest_) and sets `finest` to the finest level whose steps fit into the memory.
  void chooseLevels(const ClusterSettings& settings);
  void numberClusters();
  void sortFinest();
  std::vector<std::uint32_t> groupTriangles(std::span<const std::uint32_t> corners) const;
  void addRungs();
  void addPlainRungs();
  void findNeighbours();
  Boxes boxesOfNodes() const;
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
  const std::size_t plain = std::min(settings.memory / 2, 42 * kFewPerCluster * roots);
  finest = std::min(d.levelFor(trianglesThatFit(settings.memory - plain)), c.coarsest_);
}

// Assigns a cluster to each node. The nodes alive at L0 are the roots of clusters; every other node
// belongs to the cluster of its parent. Clusters are numbered along a Morton curve. Roots at the
// same position are the two sides of a seam; they share a cluster, so that both sides always have
// the same level and no gap opens between them.
void Clusters::Builder::numberClusters() {
  const auto alive = c.aliveBelow(c.coarsest_);
  c.cluster_of_.assign(c.aliveBelow(finest), kNoCluster);
  std::vector<std::uint32_t> roots;
  std::vector<bool> made(alive, false);  // nodes made by a later collapse, which do not exist at L0
  for (std::size_t k = c.coarsest_; k < c.forest_.parents.size(); ++k)
    made[c.forest_.parents[k]] = true;
  for (std::uint32_t n = 0; n < alive; ++n) {
    if (!made[n]) roots.push_back(n);
  }
  const auto positions = d.arrays().positions;
  const mesh::Box box = mesh::boundingBox(positions);
  std::array<float, 3> extent{};
  for (std::size_t k = 0; k < 3; ++k) {
    extent[k] = box.high[k] - box.low[k];
    if (!(extent[k] > 0)) extent[k] = 1;
  }
  const auto key = [&](std::uint32_t n) {
    return mesh::mortonKey(&positions[3 * std::size_t{n}], box.low, extent, kCurveBits);
  };
  const auto place = [&](std::uint32_t n) {
    const float* p = &positions[3 * std::size_t{n}];
    return std::tuple(key(n), p[0], p[1], p[2]);
  };
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  // If a mesh has more parts than there may be clusters, neighbouring roots share a cluster.
  const std::size_t share = roots.size() / (kNoCluster - 1) + 1;
  std::size_t places = 0;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (i > 0 && place(roots[i - 1]) != place(roots[i])) ++places;
    c.cluster_of_[roots[i]] = static_cast<std::uint16_t>(places / share);
  }
  for (std::uint32_t n = alive; n < c.cluster_of_.size(); ++n)
    c.cluster_of_[n] = c.cluster_of_[c.forest_.parentOf(n)];
  c.bounds_.resize(roots.empty() ? 0 : places / share + 1);
}

// Returns the group of each triangle at the level `finest`, by rank: 2 k if it belongs to cluster k
// and all its corners do, 2 k + 1 if not all do, 2 c.size() if it belongs to no cluster.
std::vector<std::uint32_t> Clusters::Builder::groupTriangles(
    std::span<const std::uint32_t> corners) const {
  std::vector<std::uint32_t> group(corners.size() / 3, static_cast<std::uint32_t>(2 * c.size()));
  std::size_t level = d.levels() - 1;
  for (std::size_t rank = c.alive_[c.coarsest_]; rank < group.size(); ++rank) {
    while (rank >= c.alive_[level]) --level;  // to the last level at which the triangle is alive
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
  DetailStep step{finest, std::vector<std::uint32_t>(2 * c.size() + 2, 0), {}};
  for (const std::uint32_t g : group) ++step.begins[g + 1];
  std::partial_sum(step.begins.begin(), step.begins.end(), step.begins.begin());
  c.ranks_.resize(group.size());
  step.corners.resize(corners.size());
  std::vector<std::uint32_t> at(step.begins.begin(), step.begins.end() - 1);
  for (std::size_t rank = 0; rank < group.size(); ++rank) {
    const std::uint32_t i = at[group[rank]]++;
    c.ranks_[i] = static_cast<std::uint32_t>(rank);
    std::copy_n(&corners[3 * rank], 3, &step.corners[3 * std::size_t{i}]);
  }
  c.steps_.push_back(std::move(step));
}

// Makes the coarser steps, each from the step before.
void Clusters::Builder::addRungs() {
  auto triangles = static_cast<double>(d.trianglesAt(finest));
  for (;;) {
    triangles /= triangles > kLargeRung ? kLargeRungStep : kRungStep;
    // Stops below one triangle: the coarsest level may have no triangle, a count that division
    // never reaches.
    if (triangles < 1 || triangles <= static_cast<double>(d.trianglesAt(c.coarsest_))) return;
    const std::size_t level = d.levelFor(static_cast<std::size_t>(triangles));
    const DetailStep& finer = c.steps_.back();
    if (level <= finer.level || level >= c.coarsest_) continue;
    DetailStep step{level, {0}, {}};
    step.corners.resize(3 * std::size_t{c.alive_[level]});
    std::uint32_t* at = step.corners.data();
    for (std::size_t g = 0; g + 1 < finer.begins.size(); ++g) {
      const std::size_t begin = finer.begins[g], n = c.prefix(finer, g, c.alive_[level]);
      at = c.replaceAt(level, &finer.corners[3 * begin], 3 * n, at);
      step.begins.push_back(static_cast<std::uint32_t>(step.begins.back() + n));
    }
    c.steps_.push_back(std::move(step));
  }
}

// Makes steps without clusters, for cuts with so few triangles that clusters would cost more time
// than they save.
void Clusters::Builder::addPlainRungs() {
  auto triangles = static_cast<double>(std::min(kFewPerCluster * c.size(), d.trianglesAt(finest)));
  for (; triangles >= 1; triangles /= kRungStep) {
    const std::size_t level = d.levelFor(static_cast<std::size_t>(triangles));
    if (!c.plain_.empty() && level <= c.plain_.back().level) continue;
    DetailStep step{level, {}, std::vector<std::uint32_t>(3 * d.trianglesAt(level))};
    if (c.plain_.empty())
      d.cut(level, step.corners);
    else
      c.replaceAt(level, c.plain_.back().corners.data(), step.corners.size(), step.corners.data());
    c.plain_.push_back(std::move(step));
  }
}

void Clusters::Builder::findNeighbours() {
  c.neighbours_.resize(c.size());
  const DetailStep& finest_step = c.steps_.front();
  for (std::size_t i = 0; i < c.size(); ++i) {
    auto& list = c.neighbours_[i];
    for (std::size_t t = 3 * std::size_t{finest_step.begins[2 * i + 1]};
         t < 3 * std::size_t{finest_step.begins[2 * i + 2]}; ++t)
      list.push_back(c.cluster_of_[finest_step.corners[t]]);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.shrink_to_fit();
  }
}

// Returns the cluster of each node, including nodes that are finer than the finest level.
std::vector<std::uint16_t> Clusters::clusterOfEach() const {
  std::vector<std::uint16_t> of = cluster_of_;
  of.resize(forest_.nodes);
  for (auto n = static_cast<std::uint32_t>(cluster_of_.size()); n < of.size(); ++n)
    of[n] = of[forest_.parentOf(n)];
  return of;
}

// Returns the bounding box of each cluster's nodes and of the corners of its leaf triangles.
Boxes Clusters::Builder::boxesOfNodes() const {
  const auto positions = d.arrays().positions;
  const auto leaves = d.arrays().triangles;
  const std::vector<std::uint16_t> of = c.clusterOfEach();
  const auto at = [&](std::uint32_t node) { return &positions[3 * std::size_t{node}]; };
  std::vector<Boxes> boxes(kPieces, Boxes(c.size()));
  forBlocks(threadsOr(0), kPieces, [&](std::size_t piece) {
    Boxes& own = boxes[piece];
    const Piece nodes = pieceOf(of.size(), piece);
    for (std::size_t n = nodes.first; n < nodes.last; ++n) {
      if (of[n] != kNoCluster) own.grow(of[n], at(static_cast<std::uint32_t>(n)));
    }
    const Piece triangles = pieceOf(leaves.size() / 3, piece);
    for (std::size_t t = triangles.first; t < triangles.last; ++t) {
      const std::uint16_t cluster = of[leaves[3 * t]];
      for (const std::size_t i : {3 * t + 1, 3 * t + 2}) {
        if (of[leaves[i]] != cluster) own.grow(cluster, at(leaves[i]));
      }
    }
  });
  for (std::size_t piece = 1; piece < kPieces; ++piece) boxes[0].grow(boxes[piece]);
  return std::move(boxes[0]);
}

// Computes for each cluster the sphere around all nodes that its triangles can have at any level,
// and the cone around the normals of its triangles at the finest level.
void Clusters::Builder::measure() {
  const auto positions = d.arrays().positions;
  Boxes boxes = boxesOfNodes();
  // The spheres also contain corners in other clusters, and all ancestors that may replace them.
  const auto coarse = c.aliveBelow(c.coarsest_);
  forBlocks(threadsOr(0), c.size(), [&](std::size_t i) {
    const DetailStep& step = c.steps_.front();
    for (std::size_t t = 3 * std::size_t{step.begins[2 * i + 1]};
         t < 3 * std::size_t{step.begins[2 * i + 2]}; ++t) {
      std::uint32_t node = step.corners[t];
      if (c.cluster_of_[node] == i) continue;
      boxes.grow(i, &positions[3 * std::size_t{node}]);
      while (node >= coarse) {
        node = c.forest_.parentOf(node);
        boxes.grow(i, &positions[3 * std::size_t{node}]);
      }
    }
    if (boxes.isEmpty(i)) return;
    ClusterBounds& b = c.bounds_[i];
    for (std::size_t k = 0; k < 3; ++k) b.centre[k] = (boxes[i].low[k] + boxes[i].high[k]) / 2;
    b.radius = boxes[i].diagonal() / 2;
    measureCone(i);
  });
}

// Computes the mean normal of the cluster's finest triangles and their largest angle from it.
void Clusters::Builder::measureCone(std::size_t cluster) {
  const auto positions = d.arrays().positions;
  std::vector<std::array<float, 3>> normals;
  const DetailStep& step = c.steps_.front();
  for (std::size_t t = step.begins[2 * cluster]; t < step.begins[2 * cluster + 2]; ++t) {
    const auto at = [&](std::size_t k) {
      return &positions[3 * std::size_t{step.corners[3 * t + k]}];
    };
    normals.push_back(mesh::faceNormal(at(0), at(1), at(2)));
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
      find_alive_ancestors_(aliveAncestorFinder(dendrogram.nodeCount())) {
  Builder builder{*this, dendrogram, 0};
  builder.chooseLevels(settings);
  builder.numberClusters();
  builder.sortFinest();
  builder.addRungs();
  builder.addPlainRungs();
  builder.findNeighbours();
  builder.measure();
}

// This is a parallel counting sort by cluster. It is stable, so the result does not depend on the
// number of threads.
void Clusters::everything(std::vector<std::uint32_t>& corners,
                          std::vector<std::uint32_t>& ends) const {
  const auto leaves = dendrogram_.arrays().triangles;
  const std::vector<std::uint16_t> of = clusterOfEach();
  // For each piece and cluster: the index at which the next triangle is stored.
  std::vector<std::uint32_t> at(kPieces * size(), 0);
  forBlocks(threadsOr(0), kPieces, [&](std::size_t piece) {
    const Piece triangles = pieceOf(leaves.size() / 3, piece);
    for (std::size_t t = triangles.first; t < triangles.last; ++t)
      ++at[piece * size() + of[leaves[3 * t]]];
  });
  ends.clear();
  std::uint32_t sum = 0;
  for (std::size_t cluster = 0; cluster < size(); ++cluster) {
    for (std::size_t piece = 0; piece < kPieces; ++piece)
      sum += std::exchange(at[piece * size() + cluster], sum);
    ends.push_back(sum);
  }
  ends.push_back(sum);
  corners.resize(leaves.size());
  forBlocks(threadsOr(0), kPieces, [&](std::size_t piece) {
    const Piece triangles = pieceOf(leaves.size() / 3, piece);
    for (std::size_t t = triangles.first; t < triangles.last; ++t) {
      const std::uint32_t to = at[piece * size() + of[leaves[3 * t]]]++;
      std::copy_n(&leaves[3 * t], 3, &corners[3 * std::size_t{to}]);
    }
  });
}

}  // namespace merlin::render::lod
