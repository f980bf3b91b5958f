#include "render/reduce/pattern_space.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::render::reduce {
namespace {

// Returns the largest extent (maximum - minimum over the mesh) of a feature's components; 1 if all
// components are constant.
float extentOf(const mesh::Feature& f) {
  float extent = 0;
  for (std::size_t k = 0; k < f.dimension; ++k) {
    float low = f.values[k], high = f.values[k];
    for (std::size_t i = k; i < f.values.size(); i += f.dimension) {
      low = std::min(low, f.values[i]);
      high = std::max(high, f.values[i]);
    }
    extent = std::max(extent, high - low);
  }
  return extent > 0 && std::isfinite(extent) ? extent : 1;
}

std::string namesOf(const mesh::Mesh& mesh) {
  std::string names = "geometry, normal, curvature, boundary";
  for (const mesh::Feature& f : mesh.features) {
    if (f.name != "normal") names += ", " + f.name;
  }
  return names;
}

// Returns the dimension of a feature and, as `scale`, its normalisation factor. The dimension is 0
// if the mesh does not have the feature.
PatternFeature measure(const mesh::Mesh& mesh, const std::string& name) {
  if (name == "geometry") {
    const float diagonal = mesh::boundingBox(mesh.positions).diagonal();
    return {name, 3, 0, diagonal > 0 ? 1 / diagonal : 1};
  }
  if (name == "normal") return {name, 3, 0, 1};
  if (name == "curvature" || name == "boundary") return {name, 1, 0, 1};
  const mesh::Feature* f = mesh.find(name);
  if (!f || f->values.empty()) return {name, 0, 0, 1};
  return {name, f->dimension, 0, name == "colour" ? 1 : 1 / extentOf(*f)};
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {{"typical1998", 1, 0.5F, "colour", 1, 2, 1.5F},
                                          {"plane1998", 5, 0.5F, "", 0, 6, 3},
                                          {"perceptron-segmented1998", 50, 1, "label", 10, 15, 1},
                                          {"perceptron-colour1998", 50, 1, "colour", 50, 25, 1},
                                          {"coleman1998", 20, 0.1F, "confidence", 2, 10, 0.25F},
                                          {"elevation1998", 15, 0.1F, "", 0, 10, 2},
                                          {"mug1998", 4, 1, "", 0, 0, 3}};
  return all;
}

Weights presetWeights(const Preset& preset, const mesh::Mesh& mesh) {
  Weights weights{{"geometry", preset.geometry},
                  {"normal", preset.normal},
                  {"boundary", preset.boundary},
                  {"curvature", preset.curvature}};
  if (mesh.find(preset.feature)) weights[preset.feature] = preset.of_feature;
  return weights;
}

Weights defaultWeights(const mesh::Mesh& mesh) {
  Weights weights{{"geometry", 1.0F}, {"normal", 0.05F}, {"boundary", 0.5F}};
  if (mesh.find("colour")) weights["colour"] = 0.03F;
  if (mesh.find("label")) weights["label"] = 1000;  // [GOURLEY98] 5.2.2: "a very high weight"
  return weights;
}

Result<PatternSpace> PatternSpace::make(const mesh::Mesh& mesh, const Weights& weights) {
  PatternSpace space;
  for (const auto& [name, weight] : weights) {
    if (!(weight >= 0) || !(weight <= kMostWeight)) {
      return Error{Errc::kInvalidArgument,
                   fmt::format("weight {}: {} is not from 0 to {:.0f}", name, weight, kMostWeight)};
    }
    PatternFeature f = measure(mesh, name);
    if (f.dimension == 0) {
      return Error{
          Errc::kInvalidArgument,
          fmt::format("weight {}: the mesh has no such feature; it has {}", name, namesOf(mesh))};
    }
    if (weight == 0) continue;
    f.offset = space.dimension_;
    f.scale *= weight;
    space.dimension_ += f.dimension;
    space.features_.push_back(std::move(f));
  }
  if (space.dimension_ == 0) return Error{Errc::kInvalidArgument, "no weight is more than 0"};
  return space;
}

const PatternFeature* PatternSpace::find(std::string_view name) const noexcept {
  for (const PatternFeature& f : features_) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

float curvature(std::span<const float> face_normals, const float* normal) noexcept {
  if (face_normals.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < face_normals.size(); ++i) {
    const double d = double{face_normals[i]} - normal[i % 3];
    sum += d * d;
  }
  return static_cast<float>(std::sqrt(sum / (static_cast<double>(face_normals.size()) / 3)));
}

}  // namespace merlin::render::reduce
