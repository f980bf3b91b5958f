// The lines "key=value" of a model's text "about" that say what its numbers mean: its unit, where
// it lies, and unit and range of its features.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "render/mesh/origin.h"
#include "render/range/range_image.h"

namespace merlin::cli {

// What a feature of the mesh means, as far as it is known.
struct FeatureFacts {
  std::string name, unit;
  std::size_t dimension = 1;
  float low = 0, high = 0;  // as the file states, otherwise the range of the values; equal: unknown
};

// The text after `key` and "="; empty if there is no such line.
std::string valueIn(std::string_view about, const std::string& key);

// "mesh.origin=X Y Z" and a line feed; empty for 0 0 0.
std::string aboutOrigin(const render::mesh::Origin& origin);
// Reads what aboutOrigin() wrote, or "points.origin=" of a point cloud; 0 0 0 if there is no such
// line, or it is damaged.
render::mesh::Origin originIn(std::string_view about);

// "feature.NAME.unit=" and "feature.NAME.range=", a line each, for features with one value.
std::string aboutFeatures(const std::vector<FeatureFacts>& features);
// Reads what aboutFeatures() wrote about this feature; without a unit or a range if there is none.
FeatureFacts featureIn(std::string_view about, const std::string& name);

// Name, unit and range of a plane. The range of a plane with one value per pixel is the one that
// its file gives or, if the file gives none, that of the values at pixels with a return.
FeatureFacts factsOf(const render::range::Plane& plane, const render::range::RangeImage& image);

// Combines the facts about a feature from several images: the unit of those that have one, and the
// range over all. `differ` receives whether two have different units; the result then has none.
// REQUIRES: `same_name` is not empty.
FeatureFacts joined(const std::vector<FeatureFacts>& same_name, bool& differ);

}  // namespace merlin::cli
