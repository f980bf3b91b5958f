// Picture: a pyramid that is ready to be shown: its file, its kind, and its coarsest level,
// decoded.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/image/pyramid_file.h"

namespace merlin::render::content {

enum class PictureKind { kPlane, kPanorama };

// A tile's pixels: RGBA, image::kTileBytes.
using TilePixels = std::vector<std::uint8_t>;

// Immutable and thread-safe.
struct Picture {
  std::shared_ptr<const image::PyramidFile> file;
  PictureKind kind = PictureKind::kPlane;
  std::vector<TilePixels> coarsest;  // the tiles of the coarsest level, row by row: 16 at most
  bool is_nothing = false;           // the picture is not drawn
};

// Opens a pyramid and decodes its coarsest level: a few milliseconds. Errors: those of
// PyramidFile::open() and PyramidReader::readTile().
Result<std::shared_ptr<const Picture>> openPicture(const std::string& path, ShowAs as);
// Makes a picture of a pyramid that is open already, and decodes its coarsest level. Errors: those
// of PyramidReader::readTile().
Result<std::shared_ptr<const Picture>> makePicture(std::shared_ptr<const image::PyramidFile> file,
                                                   ShowAs as);

// Returns a picture of one pixel that is not drawn, for a wall that has nothing to show yet.
std::shared_ptr<const Picture> noPicture();

// Reads a tile into `pixels`, which gets image::kTileBytes bytes. In a panorama, a tile that
// reaches beyond the right edge continues with the pixels of the left edge. Errors: those of
// PyramidReader::readTile().
Result<Ok> readPictureTile(image::PyramidReader& reader, PictureKind kind,
                           const image::TilePlace& place, TilePixels& pixels);

}  // namespace merlin::render::content
