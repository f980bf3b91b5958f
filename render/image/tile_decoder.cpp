#include "render/image/tile_decoder.h"

#include <cassert>

#include <fmt/format.h>
#include <turbojpeg.h>
#include <zlib.h>

namespace merlin::render::image {
namespace {

bool startsJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 4 && bytes[0] == 0xFF && bytes[1] == 0xD8;
}

bool endsJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 4 && bytes[bytes.size() - 2] == 0xFF && bytes[bytes.size() - 1] == 0xD9;
}

}  // namespace

TileDecoder::TileDecoder(const TileForm& form) : form_(form), jpeg_(nullptr, &tjDestroy) {
  if (form.coding == TileCoding::kJpeg) jpeg_.reset(tjInitDecompress());
}

Result<Ok> TileDecoder::decode(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> rgba) {
  assert(rgba.size() == 4 * form_.pixelBytes());
  if (bytes.size() > form_.mostBytes()) {
    return Error{Errc::kMalformed, fmt::format("has {} bytes; up to {} are supported", bytes.size(),
                                               form_.mostBytes())};
  }
  return form_.coding == TileCoding::kJpeg ? decodeJpeg(bytes, rgba) : inflate(bytes, rgba);
}

// The tables that all tiles share are a JPEG stream of their own; put in front of the tile's
// stream, they make it complete.
Result<Ok> TileDecoder::decodeJpeg(std::span<const std::uint8_t> bytes,
                                   std::span<std::uint8_t> rgba) {
  if (!startsJpeg(bytes)) return Error{Errc::kMalformed, "is not JPEG"};
  const std::vector<std::uint8_t>& tables = form_.jpeg_tables;
  if (startsJpeg(tables) && endsJpeg(tables)) {
    whole_.assign(tables.begin(), tables.end() - 2);
    whole_.insert(whole_.end(), bytes.begin() + 2, bytes.end());
    bytes = whole_;
  }
  const auto broken = [&] {
    return Error{Errc::kMalformed, fmt::format("JPEG: {}", tjGetErrorStr2(jpeg_.get()))};
  };
  int width = 0, height = 0, sampling = 0, space = 0;
  if (!jpeg_ || tjDecompressHeader3(jpeg_.get(), bytes.data(), bytes.size(), &width, &height,
                                    &sampling, &space) != 0)
    return broken();
  if (width != form_.side || height != form_.side) {
    return Error{Errc::kMalformed, fmt::format("decodes to {} x {} pixels instead of {} x {}",
                                               width, height, form_.side, form_.side)};
  }
  // The accurate DCT: the same pixels on every processor.
  if (tjDecompress2(jpeg_.get(), bytes.data(), bytes.size(), rgba.data(), width, 0, height,
                    TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
    return broken();
  return Ok{};
}

Result<Ok> TileDecoder::inflate(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> rgba) {
  const auto n = static_cast<std::size_t>(form_.samples);
  samples_.resize(form_.pixelBytes() * n);
  uLongf length = samples_.size();
  const int done = ::uncompress(samples_.data(), &length, bytes.data(), bytes.size());
  if (done != Z_OK && done != Z_BUF_ERROR)
    return Error{Errc::kMalformed, fmt::format("deflate: {}", ::zError(done))};
  if (done != Z_OK || length != samples_.size()) {
    return Error{Errc::kMalformed,
                 fmt::format("deflate: does not decode to {} bytes ({} x {} pixels of {})",
                             samples_.size(), form_.side, form_.side, n)};
  }
  const auto side = static_cast<std::size_t>(form_.side);
  for (std::size_t y = 0; y < side; ++y) {
    std::uint8_t* const row = &samples_[y * side * n];
    for (std::size_t i = n; form_.differences && i < side * n; ++i)
      row[i] = static_cast<std::uint8_t>(row[i] + row[i - n]);
    for (std::size_t x = 0; x < side; ++x) {
      const std::uint8_t* const from = &row[x * n];
      std::uint8_t* const to = &rgba[4 * (y * side + x)];
      for (std::size_t k = 0; k < 3; ++k) to[k] = from[n == 1 ? 0 : k];
      to[3] = n == 4 ? from[3] : 255;
    }
  }
  return Ok{};
}

}  // namespace merlin::render::image
