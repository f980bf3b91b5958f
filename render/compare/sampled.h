// Mean differences of two surfaces, over points spread evenly over the first.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/compare/triangle_tree.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// Told on the caller's thread which share of a piece of work is done, 0..1, and how many points it
// has tested; says whether to go on.
using GoOn = std::function<bool(double share, std::size_t points)>;

// A mesh with its tree; both are borrowed.
struct Surface {
  const Mesh& mesh;
  const TriangleTree& tree;
};

struct Sampling {
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  std::vector<std::string> features;  // both meshes have them, of one dimension
  unsigned threads = 1;
};

struct SampledError {
  double rms = 0, mean = 0;              // distance, model units
  std::optional<double> facet_rms_deg;   // none where no sample met facets with an area
  std::optional<double> normal_rms_deg;  // none where the meshes have no "normal" of 3
  std::vector<double> features;          // RMS of a component, in the feature's unit
};

// For each sample the nearest point of `to`; what differs between the two points.
//
// Samples are stratified by area: the surface is laid out in the order of the tree's leaves and
// cut into `samples` strips of equal area, with one random point each. O(samples x log n).
// goOn     false ends the work; then nothing is returned.
// REQUIRES samples > 0, area(from) > 0.
std::optional<SampledError> sampledError(const Surface& from, const Surface& to,
                                         const Sampling& sampling, const GoOn& goOn);

double area(const Mesh& mesh) noexcept;

}  // namespace merlin::render
