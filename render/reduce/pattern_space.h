// Pattern space: each vertex as a vector of all its modalities, weighted, so that the length of an
// edge is the plain distance of its ends. [GOURLEY98] 4.2.1, equations 4.1 to 4.3.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// One weight a feature, by name: "geometry", "normal", "curvature", "boundary" for what every mesh
// has, else the name of a feature of the mesh ("colour", "confidence", ...). A feature without a
// weight is carried along and does not count.
using Weights = std::map<std::string, float, std::less<>>;

inline constexpr float kMostWeight = 1e6F;  // beyond, floats lose the geometry beside it

// Weights of 1998 (chapter 5), for the cost pattern. The typical ones (figure 5.2) name none for
// colour, which then weighs as the geometry. That the third number of segmented and of Coleman's
// data is the label's and the confidence's is inferred.
struct Preset {
  const char* name;
  float geometry, normal;
  const char* feature;  // weighed where the mesh has it
  float of_feature, boundary, curvature;
};
const std::vector<Preset>& presets();
Weights presetWeights(const Preset& preset, const Mesh& mesh);

// Weights that MERLIN uses if none are given. Compared with those of 1998, normals weigh a tenth
// and curvature nothing: on scans the RMS error is lowest for a normal's weight of 0.03 to 0.1
// (README.md).
Weights defaultWeights(const Mesh& mesh);

// One dimension or more of the pattern vectors. `offset` is where it starts in a vector.
struct PatternFeature {
  std::string name;
  std::size_t dimension = 0, offset = 0;
  float scale = 1;  // weight / normalisation: what a raw value is multiplied by
};

class PatternSpace {
 public:
  // Normalisation (4.2.1): geometry by the diagonal of the mesh's box; normals, curvature and
  // boundary as they are; any other feature by its largest extent over the mesh. Errors:
  // kInvalidArgument: a weight that is negative or not finite, or names no feature; none that is
  // more than 0.
  static Result<PatternSpace> make(const Mesh& mesh, const Weights& weights);

  std::size_t dimension() const noexcept { return dimension_; }
  std::span<const PatternFeature> features() const noexcept { return features_; }
  const PatternFeature* find(std::string_view name) const noexcept;  // nullptr if not weighted

 private:
  std::vector<PatternFeature> features_;
  std::size_t dimension_ = 0;
};

// Equation 4.2: C = sqrt(sum |F_j - N|^2 / n) over the unit normals F_j of a vertex' n faces (n x 3
// floats) and its normal N; 0 where it has no face.
float curvature(std::span<const float> face_normals, const float* normal) noexcept;

}  // namespace merlin::render
