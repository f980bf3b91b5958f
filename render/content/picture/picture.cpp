#include "render/content/picture/picture.h"

#include <algorithm>
#include <utility>

namespace merlin::render::content {

Result<Ok> readPictureTile(image::PyramidReader& reader, PictureKind kind,
                           const image::TilePlace& place, TilePixels& pixels) {
  using image::kTileSide;
  pixels.resize(image::kTileBytes);
  const auto read = reader.readTile(place, pixels);
  const image::PyramidLevel& level = reader.file().levels()[static_cast<std::size_t>(place.level)];
  const std::int64_t there = level.width - std::int64_t{place.column} * kTileSide;
  if (!read || kind == PictureKind::kPlane || there >= kTileSide) return read;
  TilePixels left(image::kTileBytes);
  if (const auto also = reader.readTile({place.level, 0, place.row}, left); !also) return also;
  const std::size_t filled = 4 * static_cast<std::size_t>(there);
  constexpr std::size_t kRow = std::size_t{4} * kTileSide;
  // The rest of the tile continues with the panorama's first pixels, at most with its whole width.
  const std::size_t count = std::min(kRow - filled, 4 * static_cast<std::size_t>(level.width));
  for (std::size_t y = 0; y < kTileSide; ++y)
    std::copy_n(&left[y * kRow], count, &pixels[y * kRow + filled]);
  return Ok{};
}

Result<std::shared_ptr<const Picture>> makePicture(std::shared_ptr<const image::PyramidFile> file,
                                                   ShowAs as) {
  auto picture = std::make_shared<Picture>();
  const bool panorama = as == ShowAs::kPanorama || (as == ShowAs::kAsMarked && file->isPanorama());
  picture->kind = panorama ? PictureKind::kPanorama : PictureKind::kPlane;
  picture->file = std::move(file);
  image::PyramidReader reader(picture->file);
  const image::PyramidLevel& coarsest = picture->file->levels().back();
  const int level = static_cast<int>(picture->file->levels().size()) - 1;
  for (std::int32_t row = 0; row < coarsest.rows; ++row) {
    for (std::int32_t column = 0; column < coarsest.columns; ++column) {
      TilePixels pixels;
      const auto read = readPictureTile(reader, picture->kind, {level, column, row}, pixels);
      if (!read) return read.error();
      picture->coarsest.push_back(std::move(pixels));
    }
  }
  return std::shared_ptr<const Picture>(std::move(picture));
}

Result<std::shared_ptr<const Picture>> openPicture(const std::string& path, ShowAs as) {
  auto file = image::PyramidFile::open(path);
  if (!file) return file.error();
  return makePicture(*std::move(file), as);
}

std::shared_ptr<const Picture> noPicture() {
  auto picture = std::make_shared<Picture>();
  picture->file = image::PyramidFile::ofOnePixel();
  TilePixels black(image::kTileBytes);
  for (std::size_t i = 3; i < black.size(); i += 4) black[i] = 255;
  picture->coarsest.push_back(std::move(black));
  picture->is_nothing = true;
  return picture;
}

}  // namespace merlin::render::content
