#include "render/image/image_file.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include "daemon/base/files.h"

namespace merlin::render::image {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

// Returns an image of this size. `head`: only the header is wanted, so no memory for pixels is
// allocated.
Result<ImageFile> sized(std::uint64_t width, std::uint64_t height, bool head) {
  if (width == 0 || height == 0 || width > kMostPixels / height) {
    return Error{Errc::kUnsupported,
                 fmt::format("{} x {} pixels; 1 to 2^28 pixels are supported", width, height)};
  }
  ImageFile picture{static_cast<int>(width), static_cast<int>(height), {}, {}};
  if (!head) picture.pixels.resize(3 * width * height);
  return picture;
}

Result<ImageFile> readPng(std::string_view bytes, bool head) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto broken = [&] {
    const std::string what = image.message;
    png_image_free(&image);
    return Error{Errc::kMalformed, "PNG: " + what};
  };
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) return broken();
  image.format = PNG_FORMAT_RGB;
  auto picture = sized(image.width, image.height, head);
  if (!picture || head) {
    png_image_free(&image);
    return picture;
  }
  const png_color black{0, 0, 0};  // background of transparent pixels
  if (!png_image_finish_read(&image, &black, picture->pixels.data(), 0, nullptr)) return broken();
  return picture;
}

Result<ImageFile> readJpeg(std::string_view bytes, bool head) {
  const std::unique_ptr<void, decltype(&tjDestroy)> jpeg(tjInitDecompress(), &tjDestroy);
  const auto broken = [&] {
    return Error{Errc::kMalformed, fmt::format("JPEG: {}", tjGetErrorStr2(jpeg.get()))};
  };
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, sampling = 0, space = 0;
  if (tjDecompressHeader3(jpeg.get(), data, bytes.size(), &width, &height, &sampling, &space) != 0)
    return broken();
  auto picture = sized(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), head);
  if (!picture || head) return picture;
  // The accurate, slow DCT: the same bytes on every processor, whatever its SIMD instructions.
  if (tjDecompress2(jpeg.get(), data, bytes.size(), picture->pixels.data(), width, 0, height,
                    TJPF_RGB, TJFLAG_ACCURATEDCT) != 0)
    return broken();
  return picture;
}

Result<ImageFile> readAny(std::string_view bytes, bool head) {
  if (bytes.starts_with("\x89PNG")) return readPng(bytes, head);
  if (bytes.starts_with("\xFF\xD8")) return readJpeg(bytes, head);
  return Error{Errc::kUnsupported, "is neither PNG nor JPEG"};
}

// The two of n pixels in a row whose centres are nearest to texture coordinate `place`, and where
// it lies between them: 0 at the first, 1 at the second.
struct Between {
  int low, high;
  float share;
};

// A coordinate of a repeating image loses its whole part first, so that the pixel's index is exact.
Between between(double place, int n, Wrap wrap) noexcept {
  constexpr double kFarthest = 1e9;  // limit of a coordinate that does not repeat
  const double period = wrap == Wrap::kMirror ? 2 : 1;
  const double unit = wrap == Wrap::kClamp ? std::clamp(place, -kFarthest, kFarthest)
                                           : place - period * std::floor(place / period);
  const double x = unit * n - 0.5;
  const double low = std::floor(x);
  const auto i = static_cast<std::int64_t>(low);
  return {wrapped(i, n, wrap), wrapped(i + 1, n, wrap), static_cast<float>(x - low)};
}

}  // namespace

int wrapped(std::int64_t i, int n, Wrap wrap) noexcept {
  const std::int64_t period = wrap == Wrap::kMirror ? std::int64_t{2} * n : n;
  if (wrap == Wrap::kClamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t inside = (i % period + period) % period;
  return static_cast<int>(inside < n ? inside : period - 1 - inside);
}

std::array<float, 3> ImageFile::at(float u, float v, Wrap wrap_u, Wrap wrap_v) const noexcept {
  const Between x = between(u, width, wrap_u), y = between(1 - double{v}, height, wrap_v);
  const auto pixel = [&](int column, int row) {
    return &pixels[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(column))];
  };
  const std::uint8_t *a = pixel(x.low, y.low), *b = pixel(x.high, y.low);
  const std::uint8_t *c = pixel(x.low, y.high), *d = pixel(x.high, y.high);
  std::array<float, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float top = static_cast<float>(a[k]) + x.share * static_cast<float>(b[k] - a[k]);
    const float bottom = static_cast<float>(c[k]) + x.share * static_cast<float>(d[k] - c[k]);
    colour[k] = (top + y.share * (bottom - top)) / 255;
  }
  return colour;
}

Result<ImageFile> decodeImage(std::span<const std::uint8_t> file) {
  return readAny({reinterpret_cast<const char*>(file.data()), file.size()}, false);
}

Result<std::size_t> imageBytes(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  const auto picture = readAny(file->text(), true);
  if (!picture) return Error{picture.error().code, path + ": " + picture.error().what};
  return std::size_t{3} * static_cast<std::size_t>(picture->width) *
         static_cast<std::size_t>(picture->height);
}

Result<ImageFile> readImage(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file->bytes().data()),
                        file->bytes().size());
  auto picture = decodeImage(bytes);
  if (!picture) return Error{picture.error().code, path + ": " + picture.error().what};
  picture->file.assign(bytes.begin(), bytes.end());
  return picture;
}

}  // namespace merlin::render::image
