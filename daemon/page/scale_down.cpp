#include "daemon/page/scale_down.h"

#include <algorithm>
#include <array>
#include <vector>

namespace merlin::page {
namespace {

// Returns the first of `from` old columns (or rows) that new column n of `to` covers.
int begin(int n, int from, int to) {
  return static_cast<int>(static_cast<std::int64_t>(n) * from / to);
}

}  // namespace

render::image::Image scaleDown(std::span<const std::uint8_t> pixels, int from_width,
                               int from_height, int width) {
  const double factor = std::min({1.0, static_cast<double>(width) / from_width,
                                  4.0 * width / static_cast<double>(from_height)});
  const int to_width = std::max(1, static_cast<int>(factor * from_width + 0.5));
  const int to_height = std::max(1, static_cast<int>(factor * from_height + 0.5));
  render::image::Image image{to_width, to_height, {}};
  if (factor == 1) {
    image.pixels.assign(pixels.begin(), pixels.end());
    return image;
  }
  image.pixels.reserve(std::size_t{4} * static_cast<std::size_t>(to_width) *
                       static_cast<std::size_t>(to_height));
  std::vector<std::array<std::uint32_t, 3>> sums(static_cast<std::size_t>(to_width));
  for (int row = 0; row < to_height; ++row) {
    const int top = begin(row, from_height, to_height),
              end = begin(row + 1, from_height, to_height);
    std::ranges::fill(sums, std::array<std::uint32_t, 3>{});
    for (int y = top; y < end; ++y) {
      const std::uint8_t* at = &pixels[std::size_t{4} * static_cast<std::size_t>(y) *
                                       static_cast<std::size_t>(from_width)];
      for (int column = 0; column < to_width; ++column) {
        auto& sum = sums[static_cast<std::size_t>(column)];
        const int count =
            begin(column + 1, from_width, to_width) - begin(column, from_width, to_width);
        for (int i = 0; i < count; ++i, at += 4) {
          for (std::size_t c = 0; c < 3; ++c) sum[c] += at[c];
        }
      }
    }
    for (int column = 0; column < to_width; ++column) {
      const int count = (end - top) * (begin(column + 1, from_width, to_width) -
                                       begin(column, from_width, to_width));
      for (const std::uint32_t sum : sums[static_cast<std::size_t>(column)])
        image.pixels.push_back(static_cast<std::uint8_t>(sum / static_cast<std::uint32_t>(count)));
      image.pixels.push_back(255);
    }
  }
  return image;
}

}  // namespace merlin::page
