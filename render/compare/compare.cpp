#include "render/compare/compare.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "render/compare/sampled.h"

namespace merlin::render::compare {
namespace {

constexpr double kSampledShare = 0.6;  // share of sampling in the progress of one direction

Error invalid(std::string what) { return {Errc::kInvalidArgument, std::move(what)}; }

Result<Ok> check(const CompareSettings& settings) {
  if (settings.samples == 0) return invalid("samples 0: at least 1 is needed");
  if (!(settings.width_percent > 0) || std::isinf(settings.width_percent))
    return invalid(
        fmt::format("width {} % is not a finite number above 0", settings.width_percent));
  return Ok{};
}

Result<Ok> check(const char* name, const mesh::Mesh& mesh) {
  if (const auto valid = validate(mesh); !valid)
    return Error{valid.error().code, fmt::format("{}: {}", name, valid.error().what)};
  if (mesh.triangleCount() == 0) return invalid(fmt::format("{}: has no triangles", name));
  if (!(area(mesh) > 0))
    return invalid(fmt::format("{}: none of {} triangles has an area", name, mesh.triangleCount()));
  return Ok{};
}

bool areAlike(const mesh::Feature* a, const mesh::Feature* b) {
  return a && b && a->dimension == b->dimension;
}

std::string sizeOf(const mesh::Feature* feature) {
  return feature ? fmt::format("has dimension {}", feature->dimension) : "lacks it";
}

// Returns the names of the features to compare, without "normal", which is always compared, as
// angles. Errors: kInvalidArgument if one of the meshes lacks a wanted feature, or the dimensions
// differ.
Result<std::vector<std::string>> featuresOf(const mesh::Mesh& a, const mesh::Mesh& b,
                                            const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : wanted) {
    const mesh::Feature *of_a = a.find(name), *of_b = b.find(name);
    if (!areAlike(of_a, of_b))
      return invalid(fmt::format("feature {}: the first mesh {}, the second {}", name, sizeOf(of_a),
                                 sizeOf(of_b)));
    if (name != "normal") names.push_back(name);
  }
  if (!wanted.empty()) return names;
  for (const mesh::Feature& f : a.features) {
    if (f.name != "normal" && areAlike(&f, b.find(f.name))) names.push_back(f.name);
  }
  return names;
}

// Builds the trees of both meshes, in parallel if there are several threads.
std::array<std::unique_ptr<const TriangleTree>, 2> treesOf(const mesh::Mesh& a, const mesh::Mesh& b,
                                                           unsigned threads) {
  std::array<std::unique_ptr<const TriangleTree>, 2> trees;
  const std::array<const mesh::Mesh*, 2> meshes = {&a, &b};
  forBlocks(
      threads, 2,
      [&](std::size_t i) { trees[i] = std::make_unique<const TriangleTree>(*meshes[i]); },
      [](std::size_t) { return true; });
  return trees;
}

std::optional<Deviation> deviation(const Surface& from, const Surface& to, const Sampling& sampling,
                                   const Search& search, const KeepGoing& keepGoing) {
  const auto sampled = sampledError(from, to, sampling, [&](double share, std::size_t points) {
    return keepGoing(kSampledShare * share, points);
  });
  if (!sampled) return std::nullopt;
  const auto max = farthest(from, to, search, [&](double share, std::size_t points) {
    return keepGoing(kSampledShare + (1 - kSampledShare) * share, sampling.samples + points);
  });
  if (!max) return std::nullopt;
  Deviation d{sampled->rms,           sampled->mean,           *max,
              sampled->facet_rms_deg, sampled->normal_rms_deg, {}};
  for (std::size_t i = 0; i < sampling.features.size(); ++i)
    d.features.push_back({sampling.features[i], sampled->features[i]});
  return d;
}

}  // namespace

Deviation Comparison::symmetric() const {
  assert(forward.features.size() == backward.features.size());
  Deviation d = forward;
  d.rms = std::max(forward.rms, backward.rms);
  d.mean = std::max(forward.mean, backward.mean);
  d.max = {std::max(forward.max.low, backward.max.low),
           std::max(forward.max.high, backward.max.high),
           forward.max.evaluations + backward.max.evaluations};
  d.facet_rms_deg = std::max(forward.facet_rms_deg, backward.facet_rms_deg);
  d.normal_rms_deg = std::max(forward.normal_rms_deg, backward.normal_rms_deg);
  for (std::size_t i = 0; i < d.features.size(); ++i)
    d.features[i].rms = std::max(forward.features[i].rms, backward.features[i].rms);
  return d;
}

Result<Comparison> compare(const mesh::Mesh& a, const mesh::Mesh& b,
                           const CompareSettings& settings,
                           const std::function<bool(const CompareProgress&)>& progress) {
  if (const auto fine = check(settings); !fine) return fine.error();
  if (const auto fine = check("the first mesh", a); !fine) return fine.error();
  if (const auto fine = check("the second mesh", b); !fine) return fine.error();
  const auto features = featuresOf(a, b, settings.features);
  if (!features) return features.error();
  const unsigned threads = threadsOr(settings.threads);

  Comparison comparison;
  comparison.diagonal = mesh::boundingBox(a.positions).diagonal();
  const auto trees = treesOf(a, b, threads);
  const Surface first{a, *trees[0]}, second{b, *trees[1]};
  const Sampling sampling{settings.samples, settings.seed, *features, threads};
  const Search search{settings.width_percent / 100 * comparison.diagonal, settings.max_evaluations,
                      threads};
  const auto half = [&progress](double from, std::size_t before) -> KeepGoing {
    return [&progress, from, before](double share, std::size_t points) {
      return !progress || progress({from + share / 2, before + points});
    };
  };
  const auto forward = deviation(first, second, sampling, search, half(0, 0));
  const std::size_t before = forward ? settings.samples + forward->max.evaluations : 0;
  const auto backward =
      forward ? deviation(second, first, sampling, search, half(0.5, before)) : std::nullopt;
  if (!backward) return Error{Errc::kClosed, "the comparison was cancelled"};
  comparison.forward = *forward;
  comparison.backward = *backward;
  return comparison;
}

}  // namespace merlin::render::compare
