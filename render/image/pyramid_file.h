// PyramidFile: a picture of any size as a tiled pyramid in one BigTIFF file, as `merlin image
// import` makes it: each level has half the width and height of the previous one.
//
// Only this form is read, by a parser of our own that knows a dozen fields: a file from outside can
// then neither loop nor take memory beyond what is stated here. The pixels are decoded by TurboJPEG
// and zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/image/random_access.h"
#include "render/image/tiff_directory.h"
#include "render/image/tile_decoder.h"

namespace merlin::render::image {

// Side of the tiles in which a pyramid is read, whatever the file's own tiles are [px].
inline constexpr int kTileSide = 256;
inline constexpr std::int64_t kMostCoarsest = 16;  // tiles of the coarsest level
inline constexpr std::size_t kTileBytes = std::size_t{4} * kTileSide * kTileSide;

// What `merlin image import` writes as the file's description, without and with --panorama.
inline constexpr const char* kPictureMark = "MERLIN picture";
inline constexpr const char* kPanoramaMark = "MERLIN panorama";

struct PyramidLevel {
  std::int64_t width = 0, height = 0;  // [px]
  std::int64_t columns = 0, rows = 0;  // number of tiles of kTileSide
};

// The place of a tile: its level (0 is the finest), its column and row from the upper left.
struct TilePlace {
  int level = 0;
  std::int32_t column = 0, row = 0;
  auto operator<=>(const TilePlace&) const = default;
};

// Immutable and thread-safe.
class PyramidFile {
 public:
  // Reads the file's directories, a few kilobytes. `name`: for messages. Errors, each with the name
  // and the place: kUnsupported (another kind of file, or of TIFF), kMalformed (damaged, or not a
  // pyramid), kIo, kNotFound.
  static Result<std::shared_ptr<const PyramidFile>> open(const std::string& path);
  static Result<std::shared_ptr<const PyramidFile>> open(UniqueFd file, const std::string& name);
  static Result<std::shared_ptr<const PyramidFile>> read(std::unique_ptr<const RandomAccess> file,
                                                         const std::string& name);

  // Returns a pyramid of one pixel without a file. No tile of it may be read.
  static std::shared_ptr<const PyramidFile> ofOnePixel();

  // Returns the levels, at least one: level l is level 0 scaled by exactly 2^-l, rounded up or down
  // at the right and lower edge. The coarsest level has at most 16 tiles.
  std::span<const PyramidLevel> levels() const noexcept { return levels_; }
  bool isPanorama() const noexcept { return panorama_; }  // marked by kPanoramaMark
  const std::string& name() const noexcept { return name_; }
  const FileStamp& stamp() const noexcept {
    return stamp_;
  }  // state of the file when it was opened

  static constexpr std::int64_t kMostSide = 0x7FFF'FFFF;  // [px]

 private:
  friend class PyramidReader;
  PyramidFile() = default;
  static Result<std::shared_ptr<const PyramidFile>> ofFile(Result<std::unique_ptr<FileAccess>> file,
                                                           const std::string& name);
  Result<Ok> readLevels();
  Result<Ok> addLevel(const TiffDirectory& directory);
  Result<std::vector<TiffDirectory>> directories() const;
  Error levelError(std::size_t level, const std::string& what) const;

  std::unique_ptr<const RandomAccess> file_;
  std::string name_;
  FileStamp stamp_;
  TileForm form_;
  bool panorama_ = false;
  std::vector<PyramidLevel> levels_;
  struct Tables {
    TiffTable offsets, sizes;
    std::vector<std::uint8_t> jpeg_tables;
    std::int64_t columns = 0;  // number of the file's own tiles in a row
  };
  std::vector<Tables> tables_;  // by level
};

// Reads tiles. Thread-bound: one for each thread. Takes up to 4 MB.
class PyramidReader {
 public:
  explicit PyramidReader(std::shared_ptr<const PyramidFile> file);
  PyramidReader(const PyramidReader&) = delete;
  PyramidReader& operator=(const PyramidReader&) = delete;
  ~PyramidReader() = default;

  // Reads one tile of kTileSide as RGBA, rows from top to bottom; beyond the level's right and
  // lower edge the edge's pixels are repeated. A tile that the file leaves out (offset and size 0)
  // is black. REQUIRES: `place` lies within the level; rgba.size() == kTileBytes. Errors:
  // kMalformed, kIo, with the file's name, the level and the tile.
  Result<Ok> readTile(const TilePlace& place, std::span<std::uint8_t> rgba);

  const PyramidFile& file() const noexcept { return *file_; }

 private:
  Result<Ok> readOwn(int level, std::int64_t column, std::int64_t row);
  void repeatEdges(const TilePlace& place, std::span<std::uint8_t> rgba) const;

  std::shared_ptr<const PyramidFile> file_;
  TileForm form_;
  TileDecoder decoder_;
  // The file's own tile that was read last: encoded, and decoded.
  std::vector<std::uint8_t> bytes_, own_;
  int own_level_ = -1;  // level of the tile in own_; -1: there is none
  std::int64_t own_column_ = 0, own_row_ = 0;
};

}  // namespace merlin::render::image
