#include "render/scan/modalities.h"

#include <algorithm>
#include <cassert>

namespace merlin::render::scan {
namespace {

bool hasName(const mesh::Feature& feature, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return feature.name == name; });
}

}  // namespace

Modalities::Modalities(const Scene& scene, range::RangeImage& image)
    : scene_(scene), image_(image) {
  const mesh::Feature* texcoord = scene.mesh.find("texcoord");
  assert(!scene.texture || (texcoord && texcoord->dimension == 2));
  if (scene.texture) addPlane("colour", 3, 1, {From::kTexture, texcoord});
  for (const mesh::Feature& feature : scene.mesh.features) add(feature);
  addPlane("confidence", 1, 1, {From::kIncidence, nullptr});
}

void Modalities::add(const mesh::Feature& feature) {
  if (hasName(feature, {"normal", "texcoord"})) return;
  const bool colour = feature.name == "colour" && feature.dimension == 3;
  const bool taken = hasName(feature, {"confidence", "border"}) || image_.find(feature.name);
  if (taken || (feature.dimension != 1 && !colour)) {
    left_out_.push_back(feature.name);
    return;
  }
  const bool whole = hasName(feature, {"label", "part"});
  addPlane(feature.name, feature.dimension, colour ? 1.0F : 0.0F,
           {whole ? From::kNearestCorner : From::kInterpolated, &feature});
}

void Modalities::addPlane(const std::string& name, std::size_t dimension, float high,
                          const Source& source) {
  range::Plane plane{name, dimension, {}, "", 0, high};
  plane.values.assign(dimension * image_.pixels(), 0.0F);
  image_.planes.push_back(std::move(plane));
  sources_.push_back(source);
}

double Modalities::at(const mesh::Feature& feature, const Place& place, std::size_t k) const {
  const std::uint32_t* corners = &scene_.mesh.triangles[3 * std::size_t{place.triangle}];
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += place.barycentric[i] * double{feature.values[feature.dimension * corners[i] + k]};
  return sum;
}

void Modalities::set(std::size_t pixel, const Place& place) {
  const auto& b = place.barycentric;
  const auto nearest = static_cast<std::size_t>(std::max_element(b.begin(), b.end()) - b.begin());
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    range::Plane& plane = image_.planes[i];
    float* out = &plane.values[plane.dimension * pixel];
    if (source.from == From::kIncidence) {
      *out = static_cast<float>(place.cosine);
    } else if (source.from == From::kNearestCorner) {
      const std::size_t corner = scene_.mesh.triangles[3 * std::size_t{place.triangle} + nearest];
      *out = source.feature->values[corner];
    } else if (source.from == From::kTexture) {
      const auto rgb = scene_.texture->at(static_cast<float>(at(*source.feature, place, 0)),
                                          static_cast<float>(at(*source.feature, place, 1)),
                                          image::Wrap::kRepeat, image::Wrap::kRepeat);
      std::copy(rgb.begin(), rgb.end(), out);
    } else {
      for (std::size_t k = 0; k < plane.dimension; ++k)
        out[k] = static_cast<float>(at(*source.feature, place, k));
    }
  }
}

}  // namespace merlin::render::scan
