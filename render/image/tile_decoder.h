// TileDecoder: decodes one tile of a tiled TIFF picture: JPEG by TurboJPEG, deflate by zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::image {

enum class TileCoding { kJpeg, kDeflate };

struct TileForm {
  TileCoding coding = TileCoding::kJpeg;
  int side = 256;            // width and height of a tile [px]
  int samples = 3;           // 8-bit samples of a pixel: 1 grey, 3 RGB, 4 RGBA
  bool differences = false;  // deflate: each sample is stored as its difference from the
                             // one to its left ("predictor 2")
  std::vector<std::uint8_t> jpeg_tables;  // shared by all tiles; may be empty

  std::size_t pixelBytes() const noexcept {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  }
  // Returns the largest size of an encoded tile that is accepted [bytes]; its pixels and tables
  // cannot need more.
  std::size_t mostBytes() const noexcept { return 2 * pixelBytes() * 4 + 65'536; }
};

// Thread-bound. Its memory does not grow with what it decodes: twice a tile, about 2 MB for 512 x
// 512 pixels, and what the library needs.
class TileDecoder {
 public:
  // `form` must outlive this object.
  explicit TileDecoder(const TileForm& form);

  // Decodes a tile to RGBA, rows from top to bottom. REQUIRES: rgba.size() == 4 * pixelBytes().
  // About 1 ms for 256 x 256 pixels. Errors: kMalformed (damaged, or of another size); `rgba` is
  // undefined then.
  Result<Ok> decode(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> rgba);

 private:
  Result<Ok> decodeJpeg(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> rgba);
  Result<Ok> inflate(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> rgba);

  const TileForm& form_;
  std::unique_ptr<void, int (*)(void*)> jpeg_;
  std::vector<std::uint8_t> whole_;    // a JPEG tile with its tables
  std::vector<std::uint8_t> samples_;  // samples of a deflate tile
};

}  // namespace merlin::render::image
