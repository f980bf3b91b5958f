#include "render/range/io/plane_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/files.h"
#include "render/image/image_file.h"
#include "render/image/png_levels.h"
#include "render/image/png_writer.h"
#include "render/range/io/netpbm.h"

namespace merlin::render::range {
namespace {

constexpr double kLargest = 65535;

Error planeError(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.what};
}

std::optional<Error> sizeFault(const std::string& path, std::size_t width, std::size_t height,
                               const RangeImage& image) {
  if (width == image.width && height == image.height) return std::nullopt;
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: has {} x {} pixels; the range image has {} x {}", path, width,
                           height, image.width, image.height)};
}

// Repeats the single value of each pixel three times, as grey.
void spread(Plane& plane) {
  std::vector<float> grey;
  grey.reserve(3 * plane.values.size());
  for (const float value : plane.values) grey.insert(grey.end(), 3, value);
  plane.values = std::move(grey);
  plane.dimension = 3;
}

void multiply(std::vector<float>& values, double factor) {
  for (float& value : values) value = static_cast<float>(value * factor);
}

Plane planeOf(const std::string& name, StoredImage stored) {
  Plane plane{name, stored.channels, std::move(stored.values), stored.header.unit, 0, 0};
  const ImageHeader& header = stored.header;
  const bool colour = name == "colour";
  if (plane.dimension == 3 || colour) {
    multiply(plane.values, 1 / stored.largest);
    if (plane.dimension == 1) spread(plane);
    plane.high = 1;
    return plane;
  }
  if (!header.minimum || !header.maximum) return plane;
  const double step = (*header.maximum - *header.minimum) / stored.largest;
  for (float& value : plane.values) value = static_cast<float>(*header.minimum + value * step);
  plane.low = static_cast<float>(*header.minimum);
  plane.high = static_cast<float>(*header.maximum);
  return plane;
}

template <typename T>
bool isGrey(const std::vector<T>& rgb) {
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    if (rgb[i] != rgb[i + 1] || rgb[i] != rgb[i + 2]) return false;
  }
  return true;
}

Plane planeOf(const std::string& name, const image::ImageFile& picture) {
  Plane plane{name, 3, {picture.pixels.begin(), picture.pixels.end()}, "", 0, 1};
  if (name == "colour" || !isGrey(picture.pixels)) {
    multiply(plane.values, 1.0 / 255);
    return plane;
  }
  plane.dimension = 1;
  for (std::size_t i = 0; i < plane.values.size() / 3; ++i) plane.values[i] = plane.values[3 * i];
  plane.values.resize(plane.values.size() / 3);
  plane.high = 255;
  return plane;
}

// Returns whether the file is a PNG with 16 bits per channel. Such files hold measured values; a
// reader of pictures would keep only the upper 8 bits, after a gamma correction.
bool isPng16(std::span<const std::byte> file) {
  constexpr std::size_t kDepthAt = 24;  // after the mark, the chunk's head, width and height
  constexpr std::string_view kPngMark = "\x89PNG";
  return file.size() > kDepthAt && file[kDepthAt] == std::byte{16} &&
         std::equal(kPngMark.begin(), kPngMark.end(), file.begin(),
                    [](char c, std::byte b) { return std::byte(c) == b; });
}

// Converts the levels of a picture. Returns one channel if red, green and blue are equal
// everywhere, as for a 16-bit PGM.
StoredImage storedOf(const image::Levels& levels) {
  StoredImage stored;
  stored.width = static_cast<std::size_t>(levels.width);
  stored.height = static_cast<std::size_t>(levels.height);
  stored.largest = kLargest;
  stored.channels = isGrey(levels.values) ? 1 : 3;
  const std::size_t step = stored.channels == 1 ? 3 : 1;
  stored.values.reserve(levels.values.size() / step);
  for (std::size_t i = 0; i < levels.values.size(); i += step)
    stored.values.push_back(levels.values[i]);
  return stored;
}

Result<Plane> readPng16(const std::string& name, const std::string& path,
                        std::span<const std::byte> file, const RangeImage& image) {
  const auto levels = image::decodeLevels(file, kMostPixels);
  if (!levels) return planeError(path, levels.error());
  StoredImage stored = storedOf(*levels);
  if (const auto fault = sizeFault(path, stored.width, stored.height, image)) return *fault;
  return planeOf(name, std::move(stored));
}

// The scale of stored values: `minimum` is stored as 0, `maximum` as `largest`.
struct StoredScale {
  double minimum = 0, maximum = kLargest, largest = kLargest;
  double step() const { return (maximum - minimum) / largest; }
};

// Returns a scale for values from `low` to `high`. If values and ends are whole numbers, there is a
// whole number of steps between neighbouring values, so that they are kept exactly.
StoredScale ofRange(double low, double high, bool whole) {
  const double span = high - low;
  const bool exact =
      whole && low == std::round(low) && high == std::round(high) && span <= kLargest;
  return {low, high, exact ? std::floor(kLargest / span) * span : kLargest};
}

StoredScale scaleOf(const Plane& plane, const RangeImage& image) {
  double low = plane.low, high = plane.high;
  bool known = low < high, whole = true;
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    if (!isReturn(image.range[p])) continue;
    const double value = plane.values[p];
    whole = whole && value == std::round(value);
    low = known ? std::min(low, value) : value;
    high = known ? std::max(high, value) : value;
    known = true;
  }
  const double from = std::min(low, 0.0);
  if (whole && plane.low == plane.high && high - from <= kLargest) return {from, from + kLargest};
  return ofRange(low, high > low ? high : low + 1, whole);
}

Result<Ok> writeGrey(const std::string& path, const Plane& plane, const RangeImage& image) {
  const StoredScale scale = scaleOf(plane, image);
  ImageHeader header;
  header.unit = plane.unit;
  if (scale.minimum != 0 || scale.maximum != kLargest || plane.low < plane.high) {
    header.minimum = scale.minimum;
    header.maximum = scale.maximum;
  }
  std::string text = fmt::format("P5\n# feature of a range image, written by MERLIN\n{}{} {}\n{}\n",
                                 linesOf(header, "# "), image.width, image.height, scale.largest);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    const double value = isReturn(image.range[p]) ? plane.values[p] : scale.minimum;
    const double stored = std::clamp((value - scale.minimum) / scale.step(), 0.0, scale.largest);
    appendBe16(text, static_cast<std::uint16_t>(std::lround(stored)));
  }
  return writeFile(path, text);
}

Result<Ok> writeColours(const std::string& path, const Plane& plane, const RangeImage& image) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * image.pixels());
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = std::clamp(plane.values[3 * p + k], 0.0F, 1.0F);
      rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
    }
    rgba.push_back(255);
  }
  return image::writePng(path, static_cast<int>(image.width), static_cast<int>(image.height), rgba);
}

}  // namespace

const char* endingOf(const Plane& plane) { return plane.dimension == 3 ? ".png" : ".pgm"; }

Result<Ok> writePlane(const std::string& path, const Plane& plane, const RangeImage& image) {
  return plane.dimension == 3 ? writeColours(path, plane, image) : writeGrey(path, plane, image);
}

Result<Plane> readPlane(const std::string& name, const std::string& path, const RangeImage& image) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  if (isNetpbm(file->text())) {
    auto stored = parseNetpbm(file->text());
    if (!stored) return planeError(path, stored.error());
    if (const auto fault = sizeFault(path, stored->width, stored->height, image)) return *fault;
    return planeOf(name, *std::move(stored));
  }
  if (isPng16(file->bytes())) return readPng16(name, path, file->bytes(), image);
  const auto picture = image::readImage(path);
  if (!picture && picture.error().code == Errc::kUnsupported)
    return Error{Errc::kUnsupported, path +
                                         ": is not a PGM, PPM, PNG or JPEG file, of which features "
                                         "are read"};
  if (!picture) return picture.error();
  const auto width = static_cast<std::size_t>(picture->width);
  const auto height = static_cast<std::size_t>(picture->height);
  if (const auto fault = sizeFault(path, width, height, image)) return *fault;
  return planeOf(name, *picture);
}

}  // namespace merlin::render::range
