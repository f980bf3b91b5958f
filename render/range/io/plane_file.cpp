#include "render/range/io/plane_file.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/image/image_file.h"
#include "render/range/io/netpbm.h"

namespace merlin::render::range {
namespace {

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

// One value per pixel three times, as grey.
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

bool isGrey(const std::vector<std::uint8_t>& rgb) {
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

}  // namespace

Result<Plane> readPlane(const std::string& name, const std::string& path, const RangeImage& image) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  if (isNetpbm(file->text())) {
    auto stored = parseNetpbm(file->text());
    if (!stored) return planeError(path, stored.error());
    if (const auto fault = sizeFault(path, stored->width, stored->height, image)) return *fault;
    return planeOf(name, *std::move(stored));
  }
  const auto picture = image::readImage(path);
  if (!picture && picture.error().code == Errc::kUnsupported)
    return Error{Errc::kUnsupported, path +
                                         ": is none of PGM, PPM, PNG and JPEG, of which features "
                                         "are read"};
  if (!picture) return picture.error();
  const auto width = static_cast<std::size_t>(picture->width);
  const auto height = static_cast<std::size_t>(picture->height);
  if (const auto fault = sizeFault(path, width, height, image)) return *fault;
  return planeOf(name, *picture);
}

}  // namespace merlin::render::range
