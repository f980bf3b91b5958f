// Comparison: measures how far two surfaces are apart, and how much their features differ there.
//
// The measure is that of [METRO98]: the distance of each point of one surface from the nearest
// point of the other surface, in both directions. Means are estimated from samples; the maximum is
// given as an interval that is certain to contain it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/compare/farthest.h"
#include "render/mesh/mesh.h"

namespace merlin::render::compare {

struct CompareSettings {
  std::size_t samples = 500'000;  // number of samples per direction, for the means; at least 1
  std::uint64_t seed = 1;         // seed of the random positions of the samples
  // Wanted width of the interval of the maximum, in percent of the diagonal of a's bounding box; >
  // 0.
  double width_percent = 0.01;
  std::size_t max_evaluations = 50'000'000;  // limit of points tested for `max`, per direction
  // Names of features to compare; empty: all that both meshes have.
  std::vector<std::string> features{};
  unsigned threads = 0;  // 0: one per hardware thread; the result is the same
};

struct FeatureError {
  std::string name;
  double rms = 0;  // per component: sqrt(mean |difference|^2 / dimension), in the feature's unit
};

// Distances and differences from the points of one surface to the other surface.
struct Deviation {
  double rms = 0, mean = 0;  // distance, averaged over the area [model units]
  Interval max;              // largest distance [model units]
  // Root mean squares of angles, 0 to 180 degrees; nullopt if nothing could be compared.
  std::optional<double> facet_rms_deg;   // between the normals of the triangles
  std::optional<double> normal_rms_deg;  // between the interpolated features "normal"
  std::vector<FeatureError> features;    // compared features, except "normal"
};

struct Comparison {
  double diagonal = 0;  // diagonal of a's bounding box [model units]
  Deviation forward;    // from a to b
  Deviation backward;   // from b to a

  // Returns the larger one of the two directions for each value, and the sum of their evaluations.
  Deviation symmetric() const;
};

struct CompareProgress {
  double share = 0;        // share of the work, 0..1; an estimate while the maximum is searched
  std::size_t points = 0;  // number of points tested so far
};

// Compares mesh b with the original mesh a.
//
// progress  called on the caller's thread a few hundred times; false cancels.
// errors    kInvalidArgument: a mesh without triangles or area, a feature that one mesh lacks or
//           has with another dimension, a setting out of range; those of validate(); kClosed:
//           cancelled.
// cost      O((n + samples) log n) time, and for the maximum a search whose time depends on the
//           surfaces (see max_evaluations); about 130 bytes a triangle.
// thread    reentrant; uses `threads` threads. The same input and seed give the same bits.
Result<Comparison> compare(const mesh::Mesh& a, const mesh::Mesh& b,
                           const CompareSettings& settings = {},
                           const std::function<bool(const CompareProgress&)>& progress = {});

}  // namespace merlin::render::compare
