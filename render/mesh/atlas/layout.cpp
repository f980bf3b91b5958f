#include "render/mesh/atlas/layout.h"

#include <algorithm>
#include <cmath>

#include "render/mesh/atlas/pack.h"

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kColoursInRow = 32;
constexpr double kSmaller = 0.9;  // factor by which all charts are scaled down at each try
constexpr int kMostTries = 88;    // limit of tries; the smallest scale is about 1e-4

int roundedUp(int n) { return (n + kGutter - 1) / kGutter * kGutter; }

int scaled(int size, double scale) {
  return std::max(1, static_cast<int>(std::floor(size * scale + 0.5)));
}

// Returns the additional scale of a single chart: a chart with many repeats is reduced, so that all
// others can stay larger.
double ownScale(const Chart& chart, const AtlasLimits& limits) {
  const image::ImageFile& picture = *chart.texture.picture;
  const int most = std::max({limits.most_chart_side, picture.width, picture.height});
  return std::min(1.0, static_cast<double>(most) / std::max(chart.width, chart.height));
}

std::vector<ChartCell> cellsOf(const Charts& charts, double scale, const AtlasLimits& limits) {
  std::vector<ChartCell> cells;
  for (const Chart& chart : charts.charts) {
    ChartCell cell;
    const double both = scale * ownScale(chart, limits);
    cell.inner_width = scaled(chart.width, both);
    cell.inner_height = scaled(chart.height, both);
    cell.width = roundedUp(cell.inner_width + 2 * kGutter);
    cell.height = roundedUp(cell.inner_height + 2 * kGutter);
    cells.push_back(cell);
  }
  return cells;
}

RectangleSize sizeOfColours(std::size_t colours) {
  const std::size_t columns = std::min(colours, kColoursInRow);
  const std::size_t rows = (colours + kColoursInRow - 1) / kColoursInRow;
  return {kGutter * static_cast<int>(columns), kGutter * static_cast<int>(rows)};
}

// Lays the charts out at this scale; returns nothing if they do not fit. Packs in units of kGutter,
// so that all cells begin at multiples of it.
std::optional<Layout> tryToLayOut(const Charts& charts, double scale, const AtlasLimits& limits) {
  Layout layout;
  layout.cells = cellsOf(charts, scale, limits);
  std::vector<RectangleSize> sizes;
  for (const ChartCell& c : layout.cells) sizes.push_back({c.width / kGutter, c.height / kGutter});
  if (!charts.colours.empty()) {
    const RectangleSize all = sizeOfColours(charts.colours.size());
    sizes.push_back({all.width / kGutter, all.height / kGutter});
  }
  const auto packing = pack(sizes, limits.most_side / kGutter);
  if (!packing) return std::nullopt;
  layout.width = kGutter * packing->size.width;
  layout.height = kGutter * packing->size.height;
  for (std::size_t i = 0; i < layout.cells.size(); ++i) {
    layout.cells[i].x = kGutter * packing->places[i].x;
    layout.cells[i].y = kGutter * packing->places[i].y;
    layout.reduced += ownScale(charts.charts[i], limits) < 1;
  }
  layout.colours_x = kGutter * packing->places.back().x;
  layout.colours_y = kGutter * packing->places.back().y;
  layout.scale = scale;
  return layout;
}

}  // namespace

std::array<int, 2> Layout::squareOf(std::size_t colour) const noexcept {
  return {colours_x + kGutter * static_cast<int>(colour % kColoursInRow),
          colours_y + kGutter * static_cast<int>(colour / kColoursInRow)};
}

std::array<float, 2> Layout::coordinatesOf(const Chart& chart, const ChartCell& cell, double x,
                                           double y) const noexcept {
  const double u =
      cell.x + kGutter + (x - static_cast<double>(chart.x)) * cell.inner_width / chart.width;
  const double v =
      cell.y + kGutter + (y - static_cast<double>(chart.y)) * cell.inner_height / chart.height;
  return {static_cast<float>(u / width), static_cast<float>(1 - v / height)};
}

std::array<float, 2> Layout::coordinatesOf(std::size_t colour) const noexcept {
  const auto [x, y] = squareOf(colour);
  return {static_cast<float>((x + 0.5 * kGutter) / width),
          static_cast<float>(1 - (y + 0.5 * kGutter) / height)};
}

std::optional<Layout> layOut(const Charts& charts, const AtlasLimits& limits) {
  for (int smaller = 0; smaller < kMostTries; ++smaller) {
    const double scale = std::pow(kSmaller, smaller);
    if (auto layout = tryToLayOut(charts, scale, limits)) return layout;
  }
  return std::nullopt;
}

}  // namespace merlin::render::mesh
