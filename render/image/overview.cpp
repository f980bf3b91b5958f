#include "render/image/overview.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace merlin::render::image {
namespace {

// Copies the part of a tile that lies within the image.
void copyTile(const TilePlace& place, const std::vector<std::uint8_t>& tile, Image& to) {
  const int left = place.column * kTileSide, top = place.row * kTileSide;
  const int width = std::min(kTileSide, to.width - left),
            height = std::min(kTileSide, to.height - top);
  for (int y = 0; y < height; ++y) {
    const auto from = static_cast<std::size_t>(4 * y * kTileSide);
    const std::size_t at =
        4 * (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(to.width) +
             static_cast<std::size_t>(left));
    std::copy_n(&tile[from], 4 * width, &to.pixels[at]);
  }
}

}  // namespace

Result<Image> readOverview(std::shared_ptr<const PyramidFile> file) {
  const auto levels = file->levels();
  std::size_t chosen = levels.size() - 1;
  while (chosen > 0 && std::max(levels[chosen].width, levels[chosen].height) < kOverviewSide)
    --chosen;
  const PyramidLevel& level = levels[chosen];
  Image image{static_cast<int>(level.width), static_cast<int>(level.height), {}};
  image.pixels.resize(std::size_t{4} * static_cast<std::size_t>(image.width) *
                      static_cast<std::size_t>(image.height));
  PyramidReader reader(std::move(file));
  std::vector<std::uint8_t> tile(kTileBytes);
  TilePlace place{static_cast<int>(chosen), 0, 0};
  for (place.row = 0; place.row < level.rows; ++place.row) {
    for (place.column = 0; place.column < level.columns; ++place.column) {
      if (const auto read = reader.readTile(place, tile); !read) return read.error();
      copyTile(place, tile, image);
    }
  }
  return image;
}

}  // namespace merlin::render::image
