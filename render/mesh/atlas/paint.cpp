#include "render/mesh/atlas/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace merlin::render::mesh {
namespace {

// A pixel in a row or column of a picture, and its share (0..1) in a texel of the atlas.
struct Tap {
  std::size_t pixel;
  float share;
};

// One axis of a cell (its columns or rows) and of the chart's pixels shown along it.
struct Axis {
  std::int64_t first;  // the chart's first pixel
  int size, inner, cell;
  int picture;
  image::Wrap wrap;
};

std::vector<std::vector<Tap>> tapsOf(const Axis& axis) {
  std::vector<std::vector<Tap>> taps(static_cast<std::size_t>(axis.cell));
  const double pixels = static_cast<double>(axis.size) / axis.inner;  // pixels that a texel covers
  for (int i = 0; i < axis.cell; ++i) {
    const double low = pixels * (i - kGutter), high = pixels * (i - kGutter + 1);
    const auto last = static_cast<std::int64_t>(std::ceil(high));
    for (auto p = static_cast<std::int64_t>(std::floor(low)); p < last; ++p) {
      const auto at = static_cast<double>(p);
      const double covered = std::min(high, at + 1) - std::max(low, at);
      if (covered <= 1e-6) continue;
      const int pixel = image::wrapped(axis.first + p, axis.picture, axis.wrap);
      taps[static_cast<std::size_t>(i)].push_back(
          {static_cast<std::size_t>(pixel), static_cast<float>(covered / pixels)});
    }
  }
  return taps;
}

Colour mixed(const image::ImageFile& picture, std::span<const Tap> row,
             std::span<const Tap> column) {
  std::array<float, 3> sum{};
  for (const Tap& y : row) {
    const std::uint8_t* const line =
        &picture.pixels[3 * y.pixel * static_cast<std::size_t>(picture.width)];
    for (const Tap& x : column) {
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += y.share * x.share * static_cast<float>(line[3 * x.pixel + k]);
    }
  }
  Colour colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = static_cast<std::uint8_t>(std::min(sum[k] + 0.5F, 255.0F));
  return colour;
}

std::uint8_t* texelAt(AtlasPixels& atlas, int x, int y) {
  return &atlas.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                            static_cast<std::size_t>(x))];
}

}  // namespace

void paintChart(const Chart& chart, const ChartCell& cell, AtlasPixels& atlas) {
  const image::ImageFile& picture = *chart.texture.picture;
  const auto columns = tapsOf(
      {chart.x, chart.width, cell.inner_width, cell.width, picture.width, chart.texture.wrap_u});
  const auto rows = tapsOf({chart.y, chart.height, cell.inner_height, cell.height, picture.height,
                            chart.texture.wrap_v});
  for (int y = 0; y < cell.height; ++y) {
    std::uint8_t* texel = texelAt(atlas, cell.x, cell.y + y);
    for (const auto& column : columns) {
      const Colour colour = mixed(picture, rows[static_cast<std::size_t>(y)], column);
      texel = std::copy(colour.begin(), colour.end(), texel);
    }
  }
}

void paintColour(const Colour& colour, int x, int y, int width, int height, AtlasPixels& atlas) {
  for (int row = y; row < y + height; ++row) {
    std::uint8_t* texel = texelAt(atlas, x, row);
    for (int i = 0; i < width; ++i) texel = std::copy(colour.begin(), colour.end(), texel);
  }
}

}  // namespace merlin::render::mesh
