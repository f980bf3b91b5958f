// The cost `quadric`: weighted features become channels of the quadrics; the others are carried
// along and mixed by where the new vertex lies between the two old ones.
#include "render/reduce/quadric/quadric.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/base/blocks.h"
#include "render/mesh/places.h"
#include "render/reduce/costs.h"
#include "render/reduce/memory.h"

namespace merlin::render {
namespace {

using ChannelFeature = QuadricPlan::ChannelFeature;

// Weight of the step between locked labels: with 0.005 two thirds of the error at their edge
// vanish; with 0.05 nearly all of it, but the surface gets worse.
constexpr float kLabelWeight = 0.005F;

std::vector<ChannelFeature> channelsOf(const Mesh& mesh, const PatternSpace& space) {
  // As in pattern space, geometry counts by the diagonal of the box.
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

std::size_t countOf(const Mesh& mesh, const std::vector<ChannelFeature>& channels) {
  std::size_t count = 0;
  for (const ChannelFeature& c : channels) count += mesh.features[c.feature].dimension;
  return count;
}

// Labels are names: as heights of equal weight, far from one another for most pairs, so that where
// they meet there is a step whose edge stays.
std::vector<float> heightsOf(const std::vector<float>& labels) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::vector<float> heights(labels.size());
  std::transform(labels.begin(), labels.end(), heights.begin(), [](float label) {
    const double turns = kGoldenRatio * label;
    return static_cast<float>(turns - std::floor(turns));
  });
  return heights;
}

// Where the node lies between its children: 0 at the first, 1 at the second.
float between(const float* node, const float* a, const float* b) {
  double ab = 0, an = 0;
  for (int k = 0; k < 3; ++k) {
    ab += (double{b[k]} - a[k]) * (double{b[k]} - a[k]);
    an += (double{b[k]} - a[k]) * (double{node[k]} - a[k]);
  }
  return ab > 0 ? static_cast<float>(std::clamp(an / ab, 0.0, 1.0)) : 0.5F;
}

// Values at the nodes of a feature that does not cost: mixed, or of the nearer child for labels.
std::vector<float> carryAlong(const Mesh& mesh, const Feature& feature, const CollapseLog& log) {
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
                   std::string("weight ") + name + ": only the cost pattern has it"};
    }
  }
  if (normal != weights.end() && normal->second > 0) {
    return Error{Errc::kInvalidArgument,
                 "weight normal: normals follow from the surface; only the cost pattern has it"};
  }
  if (!space.find("geometry"))
    return Error{Errc::kInvalidArgument, "weight geometry: has to be more than 0"};
  return Ok{};
}

// Those of the settings, and both sides of a seam, so that it does not gape; empty: none.
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

Weights quadricWeights(const Mesh& mesh) {
  Weights weights{{"geometry", 1.0F}};
  for (const Feature& f : mesh.features) {
    // The last two: names that mean something else to the cost pattern.
    if (f.name == "normal" || f.name == "label" || f.name == "curvature" || f.name == "boundary")
      continue;
    // Chosen from 0.001, 0.003 and 0.005: with 0.003 pictures of two coloured scans change least
    // (pixels that change by more than 15 %), and the surface is a few percent further off than
    // without colours. Textures weigh more, because a texture slides before it fades.
    weights[f.name] = f.name == "texcoord" ? 0.05F : 0.003F;
  }
  return weights;
}

Result<QuadricPlan> planQuadric(const Mesh& mesh, const ReduceSettings& settings,
                                ThreadTeam& team) {
  QuadricPlan plan;
  plan.weights = weightsFor(mesh, settings);
  const auto space = PatternSpace::make(mesh, plan.weights);
  if (!space) return space.error();
  if (const auto checked = checkWeights(plan.weights, *space); !checked) return checked.error();
  plan.channels = channelsOf(mesh, *space);
  // [GOURLEY98] 5.2.2: as good as a colour of very high weight, unless somebody weighs it, be it by
  // 0.
  plan.labels_lock = mesh.find("label") && !plan.weights.contains("label");
  plan.label_scale = kLabelWeight / space->find("geometry")->scale;
  plan.seams_shrink = settings.locked.empty();  // what has to stay is no seam's for sure
  plan.by_percent = static_cast<std::size_t>(settings.min_percent / 100 *
                                             static_cast<double>(mesh.triangleCount()));
  QuadricReducer::Limits& limits = plan.limits;
  limits.triangles = std::max(settings.min_triangles, plan.by_percent);
  limits.error =
      static_cast<float>(settings.max_error_percent / 100 * boundingBox(mesh.positions).diagonal());
  limits.preserve_topology = settings.preserve_topology;
  limits.preserve_components = settings.preserve_components;
  limits.fast = settings.fast;
  limits.threads = Threads(threadsOr(settings.threads), team);
  return plan;
}

Reduction runQuadric(const Mesh& mesh, const QuadricPlan& plan, const std::vector<bool>& locked,
                     const Progress& progress, std::vector<std::uint32_t> places) {
  const std::size_t channels = countOf(mesh, plan.channels);
  QuadricReducer reducer(mesh, channels + (plan.labels_lock ? 1 : 0), plan.limits.threads);
  for (const ChannelFeature& c : plan.channels) {
    const Feature& f = mesh.features[c.feature];
    for (std::size_t k = 0; k < f.dimension; ++k)
      reducer.setChannel(c.first + k, f.values.data() + k, f.dimension, c.scale);
  }
  if (plan.labels_lock) {
    const std::vector<float>& labels = mesh.find("label")->values;
    reducer.setLabels(labels.data());
    reducer.setChannel(channels, heightsOf(labels).data(), 1, plan.label_scale);
  }
  if (!locked.empty()) reducer.lock(locked);
  if (!places.empty()) reducer.pair(places);
  places = {};
  const char* stopped = reducer.run(plan.limits, progress);

  Reduction result = reducer.finish(mesh);
  result.report.stopped = stopped;
  for (const ChannelFeature& c : plan.channels) {
    const Feature& f = mesh.features[c.feature];
    if (f.name == "label") continue;  // is never mixed
    std::vector<float>& values = result.log.features[c.feature];
    values.resize(result.log.children.size() * f.dimension);
    for (std::size_t k = 0; k < f.dimension; ++k)
      reducer.channelValues(c.first + k, c.scale, values.data() + k, f.dimension);
  }
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    if (result.log.features[f].empty())
      result.log.features[f] = carryAlong(mesh, mesh.features[f], result.log);
  }
  return result;
}

Result<Reduction> reduceByQuadric(const Mesh& mesh, const ReduceSettings& settings,
                                  const Progress& progress) {
  ThreadTeam team;
  const auto plan = planQuadric(mesh, settings, team);
  if (!plan) return plan.error();
  const auto blocks = blocksFor(sizeOf(mesh), settings);
  if (!blocks) return blocks.error();
  std::vector<std::uint32_t> places = samePlace(mesh.positions);
  const std::vector<bool> locked = lockedVertices(settings, places);
  if (locked.empty() || !plan->seams_shrink || *blocks > 1) places = {};
  Reduction result = *blocks == 1 ? runQuadric(mesh, *plan, locked, progress, std::move(places))
                                  : reduceInBlocks(mesh, *plan, locked, *blocks, progress);
  result.report.stopped = reasonOf(result.report.stopped, settings, plan->by_percent);
  result.report.blocks = *blocks;
  result.log.about = aboutText(settings, plan->weights, result.report);
  return result;
}

}  // namespace merlin::render
