// Draws a part of a picture, with what its wrapping puts beside it, into an atlas. Private to
// render/mesh/atlas.
#pragma once

#include <cstdint>
#include <vector>

#include "render/mesh/atlas/charts.h"

namespace merlin::render::mesh {

// The pixels of an atlas: RGB, rows from top to bottom.
struct AtlasPixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels{};
};

// A rectangle of the atlas, and the part of it that shows a chart; around that the picture goes on.
struct ChartCell {
  int x = 0, y = 0, width = 0, height = 0;  // the rectangle [texels]
  int inner_width = 0, inner_height = 0;    // of the chart, kGutter texels inside the rectangle
};

// Each texel is the mean of the pixels that it covers, by area; where the chart is not scaled, its
// pixels are copied. O(texels + pixels). REQUIRES: the cell lies in the atlas.
void paintChart(const Chart& chart, const ChartCell& cell, AtlasPixels& atlas);

void paintColour(const Colour& colour, int x, int y, int width, int height, AtlasPixels& atlas);

}  // namespace merlin::render::mesh
