// Draws a part of a texture image into an atlas, with a margin that continues the image by its wrap
// mode. Private to render/mesh/atlas.
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

// A rectangle of the atlas with a chart inside; the margin around the chart continues the image.
struct ChartCell {
  int x = 0, y = 0, width = 0, height = 0;  // the rectangle with its margin [texels]
  // Size of the chart, which begins kGutter texels inside the rectangle.
  int inner_width = 0, inner_height = 0;
};

// Draws the chart and its margin into the cell of the atlas. Each texel is the area-weighted mean
// of the image pixels that it covers; if the chart is not scaled, its pixels are copied. O(texels +
// pixels). REQUIRES: the cell lies in the atlas.
void paintChart(const Chart& chart, const ChartCell& cell, AtlasPixels& atlas);

void paintColour(const Colour& colour, int x, int y, int width, int height, AtlasPixels& atlas);

}  // namespace merlin::render::mesh
