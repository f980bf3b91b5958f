#include "render/segment/segment.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <tuple>

#include "render/mesh/coincident.h"

namespace merlin::render::segment {
namespace {

// Returns the curvature at each vertex; curvature() takes the normals of its faces as one array.
std::vector<float> curvatures(const mesh::Mesh& mesh) {
  const std::vector<float>& normals = mesh.find("normal")->values;
  std::vector<std::vector<float>> faces(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return &mesh.positions[3 * std::size_t{mesh.triangles[i + k]}];
    };
    const auto normal = mesh::faceNormal(at(0), at(1), at(2));
    for (std::size_t k = 0; k < 3; ++k) {
      auto& f = faces[mesh.triangles[i + k]];
      f.insert(f.end(), normal.begin(), normal.end());
    }
  }
  std::vector<float> values;
  values.reserve(faces.size());
  for (std::size_t v = 0; v < faces.size(); ++v)
    values.push_back(reduce::curvature(faces[v], &normals[3 * v]));
  return values;
}

std::vector<double> patternsOf(const mesh::Mesh& mesh, const reduce::PatternSpace& space) {
  const std::size_t d = space.dimension();
  std::vector<double> patterns(mesh.vertexCount() * d);
  for (const reduce::PatternFeature& f : space.features()) {
    const std::vector<float> values = f.name == "geometry"    ? mesh.positions
                                      : f.name == "curvature" ? curvatures(mesh)
                                                              : mesh.find(f.name)->values;
    for (std::size_t i = 0; i < values.size(); ++i)
      patterns[i / f.dimension * d + f.offset + i % f.dimension] = double{values[i]} * f.scale;
  }
  return patterns;
}

class Clusters {
 public:
  Clusters(std::vector<double> patterns, std::size_t dimension, std::size_t vertices)
      : means_(std::move(patterns)), dimension_(dimension), parent_(vertices), size_(vertices, 1) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t of(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

  double distance2(std::uint32_t a, std::uint32_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < dimension_; ++k) {
      const double d = means_[a * dimension_ + k] - means_[b * dimension_ + k];
      sum += d * d;
    }
    return sum;
  }

  // Returns the increase of the sum of squared distances from the means if the two clusters are
  // merged.
  double cost(std::uint32_t a, std::uint32_t b) const {
    const double n = size_[a], m = size_[b];
    return n * m / (n + m) * distance2(a, b);
  }

  // Merges two clusters; the result has the smaller number.
  void merge(std::uint32_t a, std::uint32_t b) {
    if (b < a) std::swap(a, b);
    squares_ += cost(a, b);
    const double share = size_[b] / (size_[a] + size_[b]);
    for (std::size_t k = 0; k < dimension_; ++k)
      means_[a * dimension_ + k] +=
          share * (means_[b * dimension_ + k] - means_[a * dimension_ + k]);
    size_[a] += size_[b];
    parent_[b] = a;
  }

  double size(std::uint32_t cluster) const { return size_[cluster]; }
  double squares() const { return squares_; }

  // Returns the numbers of all clusters, the largest first.
  std::vector<std::uint32_t> bySize() {
    std::vector<std::uint32_t> clusters;
    for (std::uint32_t v = 0; v < parent_.size(); ++v) {
      if (parent_[v] == v) clusters.push_back(v);
    }
    std::stable_sort(clusters.begin(), clusters.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return size_[a] > size_[b]; });
    return clusters;
  }

 private:
  std::vector<double> means_;
  std::size_t dimension_;
  std::vector<std::uint32_t> parent_;
  std::vector<double> size_;
  double squares_ = 0;
};

using Pair = std::tuple<double, std::uint32_t, std::uint32_t>;  // cost, two vertices
using Queue = std::priority_queue<Pair, std::vector<Pair>, std::greater<>>;

Queue neighbours(const mesh::Mesh& mesh, const Clusters& clusters) {
  std::vector<Pair> pairs;
  pairs.reserve(mesh.triangles.size() / 2 + mesh.vertexCount());
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (a < b) pairs.emplace_back(clusters.cost(a, b), a, b);
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const std::uint32_t* t = &mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {  // a border edge occurs in one direction only
      add(t[k], t[(k + 1) % 3]);
      add(t[(k + 1) % 3], t[k]);
    }
  }
  const auto next = mesh::coincidentVertices(mesh.positions);
  for (std::uint32_t v = 0; v < next.size(); ++v) add(v, next[v]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return Queue({}, std::move(pairs));
}

// Merges neighbours until `keep` clusters are left, or no two are neighbours. Returns how many are
// left.
std::size_t mergeNeighbours(const mesh::Mesh& mesh, Clusters& clusters, std::size_t keep) {
  Queue queue = neighbours(mesh, clusters);
  std::size_t left = mesh.vertexCount();
  while (left > keep && !queue.empty()) {
    const auto [cost, v, w] = queue.top();
    queue.pop();
    const std::uint32_t a = clusters.of(v), b = clusters.of(w);
    if (a == b) continue;
    if (const double now = clusters.cost(a, b); now > cost) {
      queue.emplace(now, v, w);  // the clusters have grown since
      continue;
    }
    clusters.merge(a, b);
    --left;
  }
  return left;
}

// Merges each cluster, except the `keep` largest, with the nearest of these.
void joinTheRest(Clusters& clusters, std::size_t keep) {
  const std::vector<std::uint32_t> all = clusters.bySize();
  for (std::size_t i = keep; i < all.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = clusters.of(all[0]);
    for (std::size_t k = 0; k < keep; ++k) {
      const std::uint32_t large = clusters.of(all[k]);
      if (const double d = clusters.distance2(large, all[i]); d < least) {
        least = d;
        nearest = large;
      }
    }
    clusters.merge(nearest, all[i]);
  }
}

Segmentation labelled(Clusters& clusters, std::size_t vertices) {
  Segmentation result;
  const std::vector<std::uint32_t> order = clusters.bySize();
  std::vector<std::uint32_t> label(vertices);
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    label[order[k]] = k;
    result.sizes.push_back(static_cast<std::size_t>(clusters.size(order[k])));
  }
  for (std::uint32_t v = 0; v < vertices; ++v) result.labels.push_back(label[clusters.of(v)]);
  result.error = std::sqrt(clusters.squares() / static_cast<double>(vertices));
  return result;
}

}  // namespace

reduce::Weights segmentWeights(const mesh::Mesh& mesh) {
  reduce::Weights weights{{"normal", 1.0F}};
  if (mesh.find("colour")) weights["colour"] = 1.0F;
  return weights;
}

Result<Segmentation> segment(const mesh::Mesh& mesh, const SegmentSettings& settings) {
  assert(mesh.find("normal") && mesh.find("normal")->dimension == 3 && mesh.vertexCount() > 0);
  if (settings.segments == 0)
    return Error{Errc::kInvalidArgument, "0 segments: at least one is needed"};
  const auto space = reduce::PatternSpace::make(
      mesh, settings.weights.empty() ? segmentWeights(mesh) : settings.weights);
  if (!space) return space.error();
  if (space->find("boundary"))
    return Error{Errc::kInvalidArgument, "weight boundary: segmentation does not use this weight"};
  Clusters clusters(patternsOf(mesh, *space), space->dimension(), mesh.vertexCount());
  if (mergeNeighbours(mesh, clusters, settings.segments) > settings.segments)
    joinTheRest(clusters, settings.segments);
  return labelled(clusters, mesh.vertexCount());
}

}  // namespace merlin::render::segment
