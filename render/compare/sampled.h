// Computes mean differences between two surfaces, at sample points that are spread evenly over the
// first one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/compare/triangle_tree.h"
#include "render/mesh/mesh.h"

namespace merlin::render::compare {

// Progress callback, called on the caller's thread with the share of the work that is done (0..1)
// and the number of points tested. Returns whether to continue.
using KeepGoing = std::function<bool(double share, std::size_t points)>;

// A mesh and its tree; both must outlive this struct.
struct Surface {
  const mesh::Mesh& mesh;
  const TriangleTree& tree;
};

struct Sampling {
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  // Names of features; both meshes must have them, in equal dimensions.
  std::vector<std::string> features;
  unsigned threads = 1;
};

struct SampledError {
  double rms = 0, mean = 0;              // distance [model units]
  std::optional<double> facet_rms_deg;   // [degrees]; nullopt if no sample met facets with an area
  std::optional<double> normal_rms_deg;  // [degrees]; nullopt unless both meshes have normals
  std::vector<double> features;          // RMS per component, in the feature's unit
};

// Returns the mean differences between samples of `from` and their nearest points of `to`.
//
// Samples are stratified by area: the surface is laid out in the order of the tree's leaves and
// cut into `samples` strips of equal area, with one random point each. O(samples x log n).
// keepGoing     if it returns false, the work ends and the result is nullopt.
// REQUIRES samples > 0, area(from) > 0.
std::optional<SampledError> sampledError(const Surface& from, const Surface& to,
                                         const Sampling& sampling, const KeepGoing& keepGoing);

double area(const mesh::Mesh& mesh) noexcept;

}  // namespace merlin::render::compare
