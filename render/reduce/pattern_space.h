// PatternSpace: the vector space in which the cost `pattern` measures edges. Each vertex is a
// vector of its weighted features (modalities), including its position; the length of an edge is
// the Euclidean distance between the vectors of its ends. [GOURLEY98] 4.2.1, equations 4.1 to 4.3.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render::reduce {

// One weight per feature, by the feature's name. Every mesh has "geometry", "normal", "curvature"
// and "boundary"; other names are those of mesh.features ("colour", "confidence", ...). A feature
// without a weight does not influence the cost, but its values are still computed for new vertices.
using Weights = std::map<std::string, float, std::less<>>;

// upper limit of a weight; with more, rounding errors swamp the geometry
inline constexpr float kMostWeight = 1e6F;

// A named set of weights for the cost `pattern`, from [GOURLEY98] chapter 5. The typical weights
// (figure 5.2) include none for colour; we give colour the weight of geometry. For the segmented
// data and for Coleman's data the source does not name the third weight; we assume that it belongs
// to the label and to the confidence, respectively.
struct Preset {
  const char* name;
  float geometry, normal;
  // name of one more weighted feature, ignored if the mesh lacks it; may be empty
  const char* feature;
  float of_feature, boundary, curvature;
};
const std::vector<Preset>& presets();
Weights presetWeights(const Preset& preset, const mesh::Mesh& mesh);

// Returns the default weights of the cost `pattern`. Compared with the typical weights of 1998, the
// normal's weight is a tenth and the curvature's is 0: on scans the RMS error is lowest for a
// normal's weight of 0.03 to 0.1 (pattern/README.md).
Weights defaultWeights(const mesh::Mesh& mesh);

// The components of a pattern vector that one feature takes: from index `offset` to `offset +
// dimension` (exclusive).
struct PatternFeature {
  std::string name;
  std::size_t dimension = 0, offset = 0;
  float scale = 1;  // factor for raw values: weight / normalisation
};

class PatternSpace {
 public:
  // Makes the space of all features whose weight is more than 0. Normalisation (4.2.1): geometry is
  // divided by the diagonal of the mesh's bounding box; normals, curvature, boundary and colour are
  // used as they are; any other feature is divided by its largest extent over the mesh. Errors:
  // kInvalidArgument if a weight is negative, not finite or above kMostWeight, if the mesh lacks a
  // weighted feature, or if no weight is more than 0.
  static Result<PatternSpace> make(const mesh::Mesh& mesh, const Weights& weights);

  std::size_t dimension() const noexcept { return dimension_; }
  std::span<const PatternFeature> features() const noexcept { return features_; }
  const PatternFeature* find(std::string_view name) const noexcept;  // nullptr if it has no weight

 private:
  std::vector<PatternFeature> features_;
  std::size_t dimension_ = 0;
};

// Returns the curvature at a vertex by equation 4.2: C = sqrt(sum |F_j - N|^2 / n), where N is the
// vertex normal (`normal`, 3 floats) and F_j are the unit normals of its n faces (`face_normals`, n
// x 3 floats). Returns 0 if there are no faces.
float curvature(std::span<const float> face_normals, const float* normal) noexcept;

}  // namespace merlin::render::reduce
