#include "render/reduce/pattern/pattern_reducer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace merlin::render::reduce {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
// Factor by which the length of a refused edge grows (4.3 says "lengthen", but not how much).
constexpr float kLengthening = 4;
constexpr float kShortest = 1e-6F;

}  // namespace

PatternReducer::PatternReducer(const mesh::Mesh& mesh, const PatternSpace& space,
                               bool preserve_topology, bool preserve_components)
    : surface_(mesh),
      space_(space),
      preserve_topology_(preserve_topology),
      preserve_components_(preserve_components),
      positions_(mesh.positions),
      features_(mesh.features),
      patterns_(mesh.vertexCount() * space.dimension()),
      boundary_(mesh.vertexCount()),
      error_(mesh.vertexCount(), 0.0F),
      node_(mesh.vertexCount()),
      heap_({}) {
  while (features_[normal_].name != "normal") ++normal_;
  std::iota(node_.begin(), node_.end(), 0U);
  const auto vertices = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::uint32_t v = 0; v < vertices; ++v) boundary_[v] = surface_.isBoundary(v);
  for (std::uint32_t v = 0; v < vertices; ++v) makePattern(v);
  std::vector<float> lengths(surface_.edgeCount());
  for (std::uint32_t e = 0; e < lengths.size(); ++e) lengths[e] = lengthOf(e);
  heap_ = EdgeHeap(std::move(lengths));
  result_.log.features.resize(features_.size());
}

Reduction PatternReducer::finish() && {
  result_.report.collapses = collapses();
  result_.report.triangles = triangles();
  return std::move(result_);
}

PatternReducer::Step PatternReducer::collapseShortest(double max_error) {
  while (!heap_.empty() && heap_.length(heap_.top()) < kNever) {
    const std::uint32_t edge = heap_.top();
    if (!isSmallEnough(edge)) {
      lengthen(edge);
      continue;
    }
    for (const std::uint32_t end : surface_.ends(edge)) {
      surface_.tidy(end);
      result_.report.visited += surface_.triangleCount(end);
    }
    const Plan p = plan(edge);
    if (!mayGo(p, edge)) {
      ++result_.report.topology_refused;
      lengthen(edge);
    } else if (flips(p)) {
      ++result_.report.flips_refused;
      lengthen(edge);
    } else {
      const float error = errorAfter(p);
      if (error > max_error) return Step::kTooCoarse;
      apply(p, edge, error);
      return Step::kDone;
    }
  }
  return Step::kNothingLeft;
}

// Returns false if the collapse would remove the mesh's last triangle. With preserve_components_,
// also returns false if it would remove a component's last triangle; with preserve_topology_, also
// if it would change the topology.
bool PatternReducer::mayGo(const Plan& p, std::uint32_t edge) {
  const std::size_t shared = surface_.trianglesAt(edge);
  if (shared == surface_.liveTriangles()) return false;
  const std::size_t around = surface_.trianglesOf(p.a).size() + surface_.trianglesOf(p.b).size();
  if (preserve_components_ && around == 2 * shared) return false;
  return !preserve_topology_ || surface_.linkCondition(edge);
}

// Returns true if neither end of the edge nor the merged vertex has more than most_triangles_
// triangles, since the time of a collapse is proportional to these numbers. Otherwise records the
// excess in smallest_left_out_.
bool PatternReducer::isSmallEnough(std::uint32_t edge) {
  const auto [a, b] = surface_.ends(edge);
  const std::size_t of_a = surface_.triangleCount(a), of_b = surface_.triangleCount(b);
  const std::size_t most = std::max({of_a, of_b, of_a + of_b - 2 * surface_.trianglesAt(edge)});
  if (most <= most_triangles_) return true;
  smallest_left_out_ = std::min(smallest_left_out_, most);
  return false;
}

bool PatternReducer::allowLargerStars() {
  constexpr std::size_t kGrowth = 4;
  if (smallest_left_out_ == kNoneLeftOut) return false;
  most_triangles_ = std::max(smallest_left_out_, kGrowth * most_triangles_);
  smallest_left_out_ = kNoneLeftOut;
  measureAll();
  return true;
}

void PatternReducer::releaseComponents() {
  preserve_components_ = false;
  measureAll();
}

void PatternReducer::measureAll() {
  for (std::uint32_t v = 0; v < node_.size(); ++v) {
    surface_.tidy(v);
    for (const std::uint32_t e : surface_.edgesOf(v)) heap_.update(e, lengthOf(e));
  }
}

// Chooses the position of the new vertex by [GOURLEY98] 4.3: if both ends are on the boundary, the
// end at the sharper corner; if one is, that end; if none is, the midpoint.
PatternReducer::Plan PatternReducer::plan(std::uint32_t edge) const {
  const auto [a, b] = surface_.ends(edge);
  Plan p{a, b, 0.5F, {}};
  if (boundary_[a] && boundary_[b])
    p.towards_b = sharpness(b) > sharpness(a) ? 1.0F : 0.0F;
  else if (boundary_[a])
    p.towards_b = 0;
  else if (boundary_[b])
    p.towards_b = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    p.position[k] = std::lerp(position(a)[k], position(b)[k], p.towards_b);
  }
  return p;
}

// Returns the angle by which the border turns at v [rad], from 0 (straight) to pi. Returns 4 if v
// does not have exactly two border edges.
float PatternReducer::sharpness(std::uint32_t v) const {
  Vec3 direction[2];
  std::size_t found = 0;
  for (const std::uint32_t e : surface_.edgesOf(v)) {
    const std::uint32_t x = surface_.otherEnd(e, v);
    if (surface_.trianglesAt(e) != 1) continue;
    if (found == 2) return 4;
    for (std::size_t k = 0; k < 3; ++k) direction[found][k] = position(x)[k] - position(v)[k];
    ++found;
  }
  if (found != 2) return 4;
  const float* d = direction[0].data();
  const float* e = direction[1].data();
  const float lengths = std::sqrt(mesh::dot(d, d) * mesh::dot(e, e));
  if (!(lengths > 0)) return 0;
  return std::numbers::pi_v<float> - std::acos(std::clamp(mesh::dot(d, e) / lengths, -1.0F, 1.0F));
}

// Returns whether a face of the new star would turn over or lose its area ([GOURLEY98] 4.3). Stores
// the unit normals of the new faces in new_normals_.
bool PatternReducer::flips(const Plan& p) {
  new_normals_.clear();
  const float* moved = p.position.data();
  for (const std::uint32_t v : {p.a, p.b}) {
    for (const std::uint32_t t : surface_.trianglesOf(v)) {
      if (surface_.contains(t, v == p.a ? p.b : p.a)) continue;
      const float* before[3];
      const float* after[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = surface_.corners(t)[k];
        before[k] = position(corner);
        after[k] = corner == v ? moved : before[k];
      }
      const Vec3 was = mesh::faceNormal(before[0], before[1], before[2]);
      const Vec3 is = mesh::faceNormal(after[0], after[1], after[2]);
      if (mesh::dot(was.data(), was.data()) > 0 && !(mesh::dot(was.data(), is.data()) > 0))
        return true;
      const bool has_area = mesh::dot(is.data(), is.data()) > 0;
      if (has_area) new_normals_.insert(new_normals_.end(), is.begin(), is.end());
    }
  }
  return false;
}

// Returns the distances of a and b from the nearest plane of a new face (equations 4.8, 4.9); all
// these planes pass through the new vertex. If there is no new face, returns the distances from the
// new vertex.
std::array<float, 2> PatternReducer::planeDistances(const Plan& p) const {
  std::array<float, 2> nearest{};
  for (std::size_t side = 0; side < 2; ++side) {
    const float* old = position(side == 0 ? p.a : p.b);
    const float d[] = {p.position[0] - old[0], p.position[1] - old[1], p.position[2] - old[2]};
    float least = std::sqrt(mesh::dot(d, d));
    for (std::size_t i = 0; i < new_normals_.size(); i += 3) {
      least = std::min(least, std::abs(mesh::dot(d, &new_normals_[i])));
    }
    nearest[side] = least;
  }
  return nearest;
}

// Returns the accumulated error of the new vertex (equation 4.10): each end's distance is added to
// its accumulated error, and the larger sum counts.
float PatternReducer::errorAfter(const Plan& p) const {
  const auto [a, b] = planeDistances(p);
  return std::max(error_[p.a] + a, error_[p.b] + b);
}

void PatternReducer::apply(const Plan& p, std::uint32_t edge, float error) {
  mixFeatures(p);
  std::copy(p.position.begin(), p.position.end(), positions_.begin() + 3 * std::ptrdiff_t{p.a});
  for (const std::uint32_t gone : surface_.collapse(p.a, p.b)) heap_.remove(gone);
  heap_.remove(edge);
  boundary_[p.a] = surface_.isBoundary(p.a);
  recordNode(p, error);
  makePattern(p.a);
  for (const std::uint32_t e : surface_.edgesOf(p.a)) heap_.update(e, lengthOf(e));
}

// Sets the features of the new vertex: the normal is computed from the new faces; all other
// features are interpolated with the same weight as the position.
void PatternReducer::mixFeatures(const Plan& p) {
  for (std::size_t f = 0; f < features_.size(); ++f) {
    float* a = &features_[f].values[p.a * features_[f].dimension];
    const float* b = &features_[f].values[p.b * features_[f].dimension];
    const float t = features_[f].name == "label" ? std::round(p.towards_b) : p.towards_b;
    for (std::size_t k = 0; k < features_[f].dimension; ++k) a[k] = std::lerp(a[k], b[k], t);
  }
  Vec3 sum{};
  for (std::size_t i = 0; i < new_normals_.size(); ++i) sum[i % 3] += new_normals_[i];
  const float length = std::sqrt(mesh::dot(sum.data(), sum.data()));
  if (!(length > 0)) return;  // no face left: keep the interpolated normal
  for (std::size_t k = 0; k < 3; ++k) features_[normal_].values[3 * p.a + k] = sum[k] / length;
}

void PatternReducer::recordNode(const Plan& p, float error) {
  lod::CollapseLog& log = result_.log;
  const auto node = static_cast<std::uint32_t>(error_.size() + log.children.size());
  log.children.push_back({node_[p.a], node_[p.b]});
  log.positions.insert(log.positions.end(), p.position.begin(), p.position.end());
  for (std::size_t f = 0; f < features_.size(); ++f) {
    const float* from = &features_[f].values[p.a * features_[f].dimension];
    log.features[f].insert(log.features[f].end(), from, from + features_[f].dimension);
  }
  log.error.push_back(error);
  error_[p.a] = error;
  node_[p.a] = node;
  result_.report.error = std::max(result_.report.error, error);
}

void PatternReducer::makePattern(std::uint32_t v) {
  float* pattern = &patterns_[v * space_.dimension()];
  const float* normal = &features_[normal_].values[3 * std::size_t{v}];
  for (const PatternFeature& f : space_.features()) {
    float own = 0;
    const float* values = &own;
    if (f.name == "geometry") {
      values = position(v);
    } else if (f.name == "boundary") {
      own = boundary_[v];
    } else if (f.name == "curvature") {
      new_normals_.clear();
      for (const std::uint32_t t : surface_.trianglesOf(v)) {
        const auto& c = surface_.corners(t);
        const Vec3 n = mesh::faceNormal(position(c[0]), position(c[1]), position(c[2]));
        new_normals_.insert(new_normals_.end(), n.begin(), n.end());
      }
      own = curvature(new_normals_, normal);
    } else {
      const auto named = [&](const mesh::Feature& feature) { return feature.name == f.name; };
      const auto feature = std::find_if(features_.begin(), features_.end(), named);
      values = &feature->values[v * f.dimension];
    }
    for (std::size_t k = 0; k < f.dimension; ++k) pattern[f.offset + k] = values[k] * f.scale;
  }
}

float PatternReducer::patternDistance(std::uint32_t a, std::uint32_t b) const noexcept {
  const std::size_t d = space_.dimension();
  double sum = 0;
  for (std::size_t k = 0; k < d; ++k) {
    const double step = double{patterns_[a * d + k]} - patterns_[b * d + k];
    sum += step * step;
  }
  return static_cast<float>(std::sqrt(sum));
}

// Makes a refused edge longer, so that other edges come first; after enough refusals its length is
// infinite and it is not tried again.
void PatternReducer::lengthen(std::uint32_t edge) {
  heap_.update(edge, std::max(heap_.length(edge), kShortest) * kLengthening);
}

}  // namespace merlin::render::reduce
