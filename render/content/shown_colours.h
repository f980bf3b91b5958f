// ShownColours: a model's feature as colours of its nodes, for people who look.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

struct ShownColours {
  std::vector<std::array<std::uint8_t, 3>> rgb;  // of each node; empty: the model has no colours
  float low = 0, high = 0;                       // of one value: where the scale begins and ends
};

// Whether coloursOf() can show it. Same errors.
Result<Ok> checkShown(const Dendrogram& model, const ShownFeature& show);

// By the feature's kind:
//   dimension 3  red, green, blue, each 0..1; of "normal" -1..1
//   dimension 1  dark blue, green, yellow (viridis) over the range that is told, or from the 1st to
//                the 99th percentile of the finest vertices; "label": hues a golden angle apart
// No feature: "colour", where there is one of dimension 3. O(nodes). Reentrant.
// Errors: kInvalidArgument: no such feature, with those that there are; another dimension.
Result<ShownColours> coloursOf(const Dendrogram& model, const ShownFeature& show);

}  // namespace merlin::render
