#include "render/image/tint.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "render/image/png_writer.h"

namespace merlin::render::image {
namespace {

double decoded(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}
double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// Returns the new value for each of the 256 values.
std::array<std::uint8_t, 256> tableOf(float factor, Light light) {
  const double times = factor > 0 ? std::min(double{factor}, 1.0) : 0.0;  // 0 for NaN
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double stored = static_cast<double>(i) / 255;
    const double value =
        light == Light::kLinear ? encoded(times * decoded(stored)) : times * stored;
    table[i] = static_cast<std::uint8_t>(std::lround(255 * value));
  }
  return table;
}

}  // namespace

Result<ImageFile> tinted(const ImageFile& picture, const std::array<float, 3>& factor,
                         Light light) {
  const std::array tables = {tableOf(factor[0], light), tableOf(factor[1], light),
                             tableOf(factor[2], light)};
  ImageFile made{picture.width, picture.height, picture.pixels};
  for (std::size_t i = 0; i < made.pixels.size(); ++i)
    made.pixels[i] = tables[i % 3][made.pixels[i]];
  auto file = encodePng(made.width, made.height, made.pixels);
  if (!file) return file.error();
  made.file = *std::move(file);
  return made;
}

}  // namespace merlin::render::image
