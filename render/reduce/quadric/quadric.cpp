// Implements the cost `quadric`: weighted features become channels of the quadrics. Other features
// do not influence the cost; their values at a new vertex are interpolated between the two old
// vertices.
#include "render/reduce/quadric/quadric.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/base/blocks.h"
#include "render/mesh/coincident.h"
#include "render/reduce/costs.h"
#include "render/reduce/memory.h"

namespace merlin::render::reduce {
namespace {

using ChannelFeature = QuadricPlan::ChannelFeature;

// Weight of the label channel, which keeps the boundary between two labels in place. 0.005 removes
// two thirds of the error at that boundary; 0.05 removes nearly all of it, but the surface gets
// worse.
constexpr float kLabelWeight = 0.005F;

std::vector<ChannelFeature> channelsOf(const mesh::Mesh& mesh, const PatternSpace& space) {
  // The weight of a feature is relative to that of the geometry, whose scale is its weight divided
  // by the diagonal of the bounding box; so the ratio of the two scales is in model units.
  const PatternFeature* geometry = space.find("geometry");
  std::vector<ChannelFeature> channels;
  std::size_t first = 0;
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    const PatternFeature* weighted = space.find(mesh.features[f].name);
    if (!weighted || mesh.features[f].name == "normal") continue;
    channels.push_back({f, first, weighted->scale / geometry->scale});
    first += mesh.features[f].dimension;
  }
  return channels;
}

std::size_t countOf(const mesh::Mesh& mesh, const std::vector<ChannelFeature>& channels) {
  std::size_t count = 0;
  for (const ChannelFeature& c : channels) count += mesh.features[c.feature].dimension;
  return count;
}

// Maps labels, which are only names, to numbers in [0, 1) that are far apart for most pairs. The
// channel thus has a step where two labels meet, and a collapse that moves the step has a cost.
std::vector<float> heightsOf(const std::vector<float>& labels) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::vector<float> heights(labels.size());
  std::transform(labels.begin(), labels.end(), heights.begin(), [](float label) {
    const double turns = kGoldenRatio * label;
    return static_cast<float>(turns - std::floor(turns));
  });
  return heights;
}

// Returns the position of a node between its children a and b, projected onto the segment between
// them: 0 at a, 1 at b, 0.5 if a and b coincide.
float between(const float* node, const float* a, const float* b) {
  double ab = 0, an = 0;
  for (int k = 0; k < 3; ++k) {
    ab += (double{b[k]} - a[k]) * (double{b[k]} - a[k]);
    an += (double{b[k]} - a[k]) * (double{node[k]} - a[k]);
  }
  return ab > 0 ? static_cast<float>(std::clamp(an / ab, 0.0, 1.0)) : 0.5F;
}

// Returns a feature's values at all nodes, for a feature that does not influence the cost: values
// are interpolated between the two children; a label is that of the nearer child.
std::vector<float> carryAlong(const mesh::Mesh& mesh, const mesh::Feature& feature,
                              const lod::CollapseLog& log) {
  const std::size_t d = feature.dimension, vertices = mesh.vertexCount();
  std::vector<float> values(log.children.size() * d);
  const auto at = [&](const std::vector<float>& leaves, const std::vector<float>& inner,
                      std::uint32_t n, std::size_t dimension) {
    return n < vertices ? &leaves[n * dimension] : &inner[(n - vertices) * dimension];
  };
  for (std::size_t k = 0; k < log.children.size(); ++k) {
    const auto [a, b] = log.children[k];
    float t = between(&log.positions[3 * k], at(mesh.positions, log.positions, a, 3),
                      at(mesh.positions, log.positions, b, 3));
    if (feature.name == "label") t = std::round(t);
    const float *x = at(feature.values, values, a, d), *y = at(feature.values, values, b, d);
    for (std::size_t i = 0; i < d; ++i) values[k * d + i] = (1 - t) * x[i] + t * y[i];
  }
  return values;
}

const char* reasonOf(const char* stopped, const ReduceSettings& s, std::size_t by_percent) {
  const bool percent = std::string_view(stopped) == "triangles" && by_percent > s.min_triangles;
  return percent ? "percent" : stopped;
}

Result<Ok> checkWeights(const Weights& weights, const PatternSpace& space) {
  const auto normal = weights.find("normal");
  for (const char* name : {"curvature", "boundary"}) {
    const auto w = weights.find(name);
    if (w != weights.end() && w->second > 0) {
      return Error{Errc::kInvalidArgument,
                   std::string("weight ") + name + ": only the cost pattern uses this weight"};
    }
  }
  if (normal != weights.end() && normal->second > 0) {
    return Error{
        Errc::kInvalidArgument,
        "weight normal: normals are computed from the surface; only the cost pattern uses this "
        "weight"};
  }
  if (!space.find("geometry"))
    return Error{Errc::kInvalidArgument, "weight geometry: must be more than 0"};
  return Ok{};
}

// Returns which vertices to lock: those of settings.locked, and all coincident vertices, so that
// seams do not open. Returns an empty vector if there are none. next: the result of
// coincidentVertices().
std::vector<bool> lockedVertices(const ReduceSettings& settings,
                                 const std::vector<std::uint32_t>& next) {
  std::vector<bool> locked = settings.locked;
  for (std::uint32_t v = 0; v < next.size(); ++v) {
    if (next[v] == v) continue;
    locked.resize(next.size());
    locked[v] = true;
  }
  return locked;
}

}  // namespace

Weights quadricWeights(const mesh::Mesh& mesh) {
  Weights weights{{"geometry", 1.0F}};
  for (const mesh::Feature& f : mesh.features) {
    // In pattern space, the names curvature and boundary denote computed values, not features.
    if (f.name == "normal" || f.name == "label" || f.name == "curvature" || f.name == "boundary")
      continue;
    // With 0.003 (also tried: 0.001 and 0.005) renderings of two coloured scans change least,
    // measured as the number of pixels that change by more than 15 %, and the surface's error is a
    // few percent larger than without colours. Texture coordinates weigh more, because a shifted
    // texture is visible before a faded one.
    weights[f.name] = f.name == "texcoord" ? 0.05F : 0.003F;
  }
  return weights;
}

Result<QuadricPlan> planQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                ThreadTeam& team) {
  QuadricPlan plan;
  plan.weights = weightsFor(mesh, settings);
  const auto space = PatternSpace::make(mesh, plan.weights);
  if (!space) return space.error();
  if (const auto checked = checkWeights(plan.weights, *space); !checked) return checked.error();
  plan.channels = channelsOf(mesh, *space);
  // Unless labels have an explicit weight (even 0), they are locked, which acts like the very high
  // weight of [GOURLEY98] 5.2.2.
  plan.labels_lock = mesh.find("label") && !plan.weights.contains("label");
  plan.label_scale = kLabelWeight / space->find("geometry")->scale;
  // If the caller locks vertices, we cannot tell whether both sides of a seam may move.
  plan.seams_shrink = settings.locked.empty();
  plan.by_percent = static_cast<std::size_t>(settings.min_percent / 100 *
                                             static_cast<double>(mesh.triangleCount()));
  QuadricReducer::Limits& limits = plan.limits;
  limits.triangles = std::max(settings.min_triangles, plan.by_percent);
  limits.error = static_cast<float>(settings.max_error_percent / 100 *
                                    mesh::boundingBox(mesh.positions).diagonal());
  limits.preserve_topology = settings.preserve_topology;
  limits.preserve_components = settings.preserve_components;
  limits.fast = settings.fast;
  limits.threads = Threads(threadsOr(settings.threads), team);
  return plan;
}

Reduction runQuadric(const mesh::Mesh& mesh, const QuadricPlan& plan,
                     const std::vector<bool>& locked, const Progress& progress,
                     std::vector<std::uint32_t> coincident) {
  const std::size_t channels = countOf(mesh, plan.channels);
  QuadricReducer reducer(mesh, channels + (plan.labels_lock ? 1 : 0), plan.limits.threads);
  for (const ChannelFeature& c : plan.channels) {
    const mesh::Feature& f = mesh.features[c.feature];
    for (std::size_t k = 0; k < f.dimension; ++k)
      reducer.setChannel(c.first + k, f.values.data() + k, f.dimension, c.scale);
  }
  if (plan.labels_lock) {
    const std::vector<float>& labels = mesh.find("label")->values;
    reducer.setLabels(labels.data());
    reducer.setChannel(channels, heightsOf(labels).data(), 1, plan.label_scale);
  }
  if (!locked.empty()) reducer.lock(locked);
  if (!coincident.empty()) reducer.pair(coincident);
  coincident = {};
  const char* stopped = reducer.run(plan.limits, progress);

  Reduction result = reducer.finish();
  result.report.stopped = stopped;
  for (const ChannelFeature& c : plan.channels) {
    const mesh::Feature& f = mesh.features[c.feature];
    if (f.name == "label") continue;  // labels are not interpolated; carryAlong() sets them
    std::vector<float>& values = result.log.features[c.feature];
    values.resize(result.log.children.size() * f.dimension);
    if (values.empty()) continue;  // no collapses: there is no element to write to
    for (std::size_t k = 0; k < f.dimension; ++k)
      reducer.channelValues(c.first + k, c.scale, values.data() + k, f.dimension);
  }
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    if (result.log.features[f].empty())
      result.log.features[f] = carryAlong(mesh, mesh.features[f], result.log);
  }
  return result;
}

Result<Reduction> reduceByQuadric(const mesh::Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress) {
  ThreadTeam team;
  const auto plan = planQuadric(mesh, settings, team);
  if (!plan) return plan.error();
  const auto blocks = blocksFor(mesh::sizeOf(mesh), settings);
  if (!blocks) return blocks.error();
  std::vector<std::uint32_t> coincident = mesh::coincidentVertices(mesh.positions);
  const std::vector<bool> locked = lockedVertices(settings, coincident);
  if (locked.empty() || !plan->seams_shrink || *blocks > 1) coincident = {};
  Reduction result = *blocks == 1 ? runQuadric(mesh, *plan, locked, progress, std::move(coincident))
                                  : reduceInBlocks(mesh, *plan, locked, *blocks, progress);
  result.report.stopped = reasonOf(result.report.stopped, settings, plan->by_percent);
  result.report.blocks = *blocks;
  result.log.about = aboutText(settings, plan->weights, result.report);
  return result;
}

}  // namespace merlin::render::reduce
