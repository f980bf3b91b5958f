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
  double scale = 1;         // factor by which all charts are scaled
  std::size_t reduced = 0;  // number of charts that are scaled by a smaller factor

  // Returns the upper left texel of the square of kGutter x kGutter texels that shows a colour.
  std::array<int, 2> squareOf(std::size_t colour) const noexcept;
  // Converts a point of a chart's image (x, y: texels, as in Chart) to texture coordinates of the
  // atlas.
  std::array<float, 2> coordinatesOf(const Chart& chart, const ChartCell& cell, double x,
                                     double y) const noexcept;
  std::array<float, 2> coordinatesOf(std::size_t colour) const noexcept;
};

// Packs all charts into an atlas; if they do not fit, scales all of them down evenly until they do.
// Returns nothing if they do not fit at any scale.
std::optional<Layout> layOut(const Charts& charts, const AtlasLimits& limits);

}  // namespace merlin::render::mesh
