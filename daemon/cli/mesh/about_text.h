// Writes and reads lines "key=value" of the text "about" of a model: the unit and the origin of its
// coordinates, and the unit and the range of its features.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "render/mesh/origin.h"
#include "render/range/range_image.h"

namespace merlin::cli {

// What is known about a feature of a mesh.
struct FeatureFacts {
  std::string name, unit;
  std::size_t dimension = 1;
  // Range that the file states, otherwise the range of the values. Equal: unknown.
  float low = 0, high = 0;
};

// Returns the value of the first line "KEY=VALUE" of `about`; empty if there is none.
std::string valueIn(std::string_view about, const std::string& key);

// Returns the line "mesh.origin=X Y Z", with a line feed; empty if the origin is 0 0 0.
std::string aboutOrigin(const render::mesh::Origin& origin);
// Returns the origin in the line "mesh.origin=" (aboutOrigin()) or "points.origin="
// (aboutPoints()); 0 0 0 if there is no such line or its numbers are invalid.
render::mesh::Origin originIn(std::string_view about);

// Returns the lines "feature.NAME.unit=UNIT" (if the unit is known) and "feature.NAME.range=LOW
// HIGH" for each feature of dimension 1.
std::string aboutFeatures(const std::vector<FeatureFacts>& features);
// Returns what the lines of aboutFeatures() state about the feature `name`; unit or range are
// unknown if there is no such line.
FeatureFacts featureIn(std::string_view about, const std::string& name);

// Returns name, unit and range of a plane of `image`. The range of a plane with one value per pixel
// is the one that its file states or, without one, the range of the values at pixels with a return.
FeatureFacts factsOf(const render::range::Plane& plane, const render::range::RangeImage& image);

// Combines the facts about a feature from several images: the unit of those that have one, and the
// range over all. `differ` is set to whether the images have different units; the result then has
// no unit. REQUIRES: `same_name` is not empty.
FeatureFacts joined(const std::vector<FeatureFacts>& same_name, bool& differ);

}  // namespace merlin::cli
