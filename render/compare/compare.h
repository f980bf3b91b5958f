// Comparison: how far two surfaces are apart, and how much their features differ there.
//
// The measure of [METRO98]: the distance of each point of one surface from the nearest point of the
// other, in both directions. Means are estimated from samples; the maximum is given as an interval
// that is certain to contain it.
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
  std::size_t samples = 500'000;  // per direction, for the means; at least 1
  std::uint64_t seed = 1;         // of the random positions of the samples
  // Width of the maximum's interval, in percent of the diagonal of a's bounding box; > 0.
  double width_percent = 0.01;
  std::size_t max_evaluations = 50'000'000;  // limit of points tested for `max`, per direction
  std::vector<std::string> features{};       // names; empty: all features that both meshes have
  unsigned threads = 0;                      // 0: one per hardware thread; the result is the same
};

struct FeatureError {
  std::string name;
  double rms = 0;  // per component: sqrt(mean |difference|^2 / dimension), in the feature's unit
};

// Distances and differences from the points of one surface to the other surface.
struct Deviation {
  double rms = 0, mean = 0;  // distance, model units, over the area
  Interval max;              // largest distance, model units
  // RMS angles, 0 to 180 degrees; nullopt if nothing could be compared.
  std::optional<double> facet_rms_deg;   // between the triangles' own normals
  std::optional<double> normal_rms_deg;  // between the interpolated features "normal"
  std::vector<FeatureError> features;    // without "normal"
};

struct Comparison {
  double diagonal = 0;  // of a's bounding box, model units
  Deviation forward;    // from a to b
  Deviation backward;   // from b to a

  // Returns for each value the larger one of the two directions, and the sum of their evaluations.
  Deviation symmetric() const;
};

struct CompareProgress {
  double share = 0;        // 0..1; estimated while the maximum is searched
  std::size_t points = 0;  // tested so far
};

// Compares b with the original a.
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
