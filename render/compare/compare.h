// Comparison: how far two surfaces are from one another, and how much their features differ there.
//
// The measure of [METRO98]: each point of one surface against the nearest point of the other, in
// both directions. Means are sampled, the maximum is certain: an interval that holds it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/compare/farthest.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct CompareSettings {
  std::size_t samples = 500'000;  // of each direction, for the means; at least 1
  std::uint64_t seed = 1;         // of the samples
  double width_percent = 0.01;    // of the maximum's interval, of the diagonal of a's box; > 0
  std::size_t max_evaluations = 50'000'000;  // points tested for it, each direction
  std::vector<std::string> features{};       // which to compare; empty: all that both have
  unsigned threads = 0;                      // 0: as many as the machine has; any gives one answer
};

struct FeatureError {
  std::string name;
  double rms = 0;  // of a component: sqrt(mean |difference|^2 / dimension), in the feature's unit
};

// From the points of one surface to the other one.
struct Deviation {
  double rms = 0, mean = 0;  // distance, model units, over the area
  Interval max;              // largest distance, model units
  // Angles, 0 to 180 degrees; none where nothing could be compared.
  std::optional<double> facet_rms_deg;   // between the triangles' own normals
  std::optional<double> normal_rms_deg;  // between the interpolated features "normal"
  std::vector<FeatureError> features;    // without "normal"
};

struct Comparison {
  double diagonal = 0;  // of a's box, model units
  Deviation forward;    // from a to b
  Deviation backward;   // from b to a

  // The larger one of both directions, figure by figure; evaluations are added.
  Deviation symmetric() const;
};

struct CompareProgress {
  double share = 0;        // 0..1; how far the search for the maximum is, is a guess
  std::size_t points = 0;  // tested so far
};

// Compares b with the original a.
//
// progress  called on the caller's thread a few hundred times; false cancels.
// errors    kInvalidArgument: a mesh without triangles or area, a feature that one of them lacks or
//           has of another dimension, a setting out of range; kMalformed: of validate();
//           kClosed: cancelled.
// cost      O((n + samples) log n) time and, for the maximum, what the surfaces make of it; about
//           130 bytes a triangle.
// thread    reentrant; uses `threads` threads. Same input and seed, same bits.
Result<Comparison> compare(const Mesh& a, const Mesh& b, const CompareSettings& settings = {},
                           const std::function<bool(const CompareProgress&)>& progress = {});

}  // namespace merlin::render
