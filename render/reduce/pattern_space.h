// Pattern space: each vertex is a vector of its weighted features (modalities), position included,
// so that the length of an edge is the Euclidean distance between the vectors of its ends.
// [GOURLEY98] 4.2.1, equations 4.1 to 4.3.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render::reduce {

// One weight per feature, by name. Every mesh has "geometry", "normal", "curvature" and "boundary";
// all other names are those of the mesh's features ("colour", "confidence", ...). A feature without
// a weight does not influence the cost; its values are carried along.
using Weights = std::map<std::string, float, std::less<>>;

inline constexpr float kMostWeight = 1e6F;  // above it, rounding loses the geometry

// Weights from [GOURLEY98] chapter 5, for the cost pattern. The typical weights (figure 5.2)
// include none for colour; we give colour the weight of geometry. For the segmented data and for
// Coleman's data we infer that the third weight belongs to the label and to the confidence,
// respectively.
struct Preset {
  const char* name;
  float geometry, normal;
  const char* feature;  // a further feature, weighted if the mesh has it; may be empty
  float of_feature, boundary, curvature;
};
const std::vector<Preset>& presets();
Weights presetWeights(const Preset& preset, const mesh::Mesh& mesh);

// Default weights of the cost pattern. Compared with those of 1998, the normal's weight is a tenth
// and the curvature's is 0: on scans the RMS error is lowest for a normal's weight of 0.03 to 0.1
// (pattern/README.md).
Weights defaultWeights(const mesh::Mesh& mesh);

// The range of components that one feature has in a pattern vector; `offset` is the index of the
// first one.
struct PatternFeature {
  std::string name;
  std::size_t dimension = 0, offset = 0;
  float scale = 1;  // factor for raw values: weight / normalisation
};

class PatternSpace {
 public:
  // Normalisation (4.2.1): geometry is divided by the diagonal of the mesh's bounding box; normals,
  // curvature, boundary and colour are used as they are; any other feature is divided by its
  // largest extent over the mesh. Errors: kInvalidArgument (a weight is negative, not finite or
  // above kMostWeight; the mesh does not have the feature; no weight is more than 0).
  static Result<PatternSpace> make(const mesh::Mesh& mesh, const Weights& weights);

  std::size_t dimension() const noexcept { return dimension_; }
  std::span<const PatternFeature> features() const noexcept { return features_; }
  const PatternFeature* find(std::string_view name) const noexcept;  // nullptr if it has no weight

 private:
  std::vector<PatternFeature> features_;
  std::size_t dimension_ = 0;
};

// Equation 4.2: C = sqrt(sum |F_j - N|^2 / n) for a vertex with the normal N and n faces with the
// unit normals F_j (`face_normals`, n x 3 floats); 0 if it has no face.
float curvature(std::span<const float> face_normals, const float* normal) noexcept;

}  // namespace merlin::render::reduce
