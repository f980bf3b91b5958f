// Layout: the positions of the charts and the plain colours in an atlas. Private to
// render/mesh/atlas.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "render/mesh/atlas/charts.h"
#include "render/mesh/atlas/paint.h"

namespace merlin::render::mesh {

struct Layout {
  int width = 0, height = 0;     // [texels], multiples of kGutter
  std::vector<ChartCell> cells;  // one per chart
  int colours_x = 0, colours_y = 0;
  double scale = 1;         // of all charts
  std::size_t reduced = 0;  // charts that are smaller than `scale` says

  // The upper left texel of a colour's square of kGutter texels.
  std::array<int, 2> squareOf(std::size_t colour) const noexcept;
  // Converts a point of a chart's image, in texels, to texture coordinates of the atlas.
  std::array<float, 2> coordinatesOf(const Chart& chart, const ChartCell& cell, double x,
                                     double y) const noexcept;
  std::array<float, 2> coordinatesOf(std::size_t colour) const noexcept;
};

// Scales all charts down evenly until they fit into an atlas. Returns nothing if none fits.
std::optional<Layout> layOut(const Charts& charts, const AtlasLimits& limits);

}  // namespace merlin::render::mesh
