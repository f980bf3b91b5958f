// ShownColours: shows a feature of a model as colours of its nodes (pseudo-colours).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::content {

struct ShownColours {
  // Colour of each node; empty: the model has no colours.
  std::vector<std::array<std::uint8_t, 3>> rgb;
  float low = 0, high = 0;  // for a feature of dimension 1: the ends of the colour scale
};

// Checks that coloursOf() can show the feature. Errors: those of coloursOf().
Result<Ok> checkShown(const lod::Dendrogram& model, const ShownFeature& show);

// Returns the colours of the model's nodes, by the feature's kind:
//   dimension 3  red, green, blue, each 0..1; for "normal" -1..1
//   dimension 1  a scale of dark blue, green, yellow (viridis) over show.range, or, if its ends are
//                equal, from the 1st to the 99th percentile of the vertices at full resolution; for
//                "label": a hue for each label, successive ones a golden angle apart
// If show.feature is empty: the feature "colour", if it has dimension 3, else no colours.
// O(nodes). Reentrant. Errors: kInvalidArgument (no such feature, or not of dimension 1 or 3; the
// message lists those that can be shown).
Result<ShownColours> coloursOf(const lod::Dendrogram& model, const ShownFeature& show);

}  // namespace merlin::render::content
