#include "render/image/jpeg_writer.h"

#include <cassert>
#include <memory>

#include <fmt/format.h>
#include <turbojpeg.h>

namespace merlin::render::image {

Result<std::string> encodeJpeg(int width, int height, std::span<const std::uint8_t> pixels,
                               int quality) {
  constexpr int kMostSide = 65'500;
  assert(width >= 1 && height >= 1);
  assert(pixels.size() ==
         std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (width > kMostSide || height > kMostSide) {
    return Error{Errc::kUnsupported, fmt::format("a picture of {} x {} pixels is too large for "
                                                 "JPEG: at most {} on each side",
                                                 width, height, kMostSide)};
  }
  const std::unique_ptr<void, int (*)(void*)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) return Error{Errc::kIo, "JPEG: no memory for the encoder"};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int done = tjCompress2(encoder.get(), pixels.data(), width, 0, height, TJPF_RGBX, &bytes,
                               &size, TJSAMP_420, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
  if (done != 0) return Error{Errc::kIo, fmt::format("JPEG: {}", tjGetErrorStr2(encoder.get()))};
  return std::string(reinterpret_cast<const char*>(bytes), size);
}

}  // namespace merlin::render::image
