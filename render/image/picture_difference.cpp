#include "render/image/picture_difference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace merlin::render::image {
namespace {

constexpr double kChanged = 0.15;  // threshold, as a fraction of a channel's range

}  // namespace

PictureDifference differenceOf(const Image& a, const Image& b,
                               const std::array<float, 3>& background) {
  PictureDifference difference{{a.width, a.height, std::vector<std::uint8_t>(a.pixels.size(), 0)}};
  std::size_t covered = 0, changed = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    int most = 0, from_background = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int of_a = a.pixels[i + k], of_b = b.pixels[i + k];
      const auto empty = static_cast<int>(std::lround(255 * background[k]));
      most = std::max(most, std::abs(of_a - of_b));
      from_background = std::max({from_background, std::abs(of_a - empty), std::abs(of_b - empty)});
    }
    const bool is_changed = most > kChanged * 255;
    covered += from_background > 1 ? 1 : 0;  // tolerates GL's rounding
    changed += is_changed ? 1 : 0;
    std::fill_n(difference.image.pixels.begin() + static_cast<std::ptrdiff_t>(i), 3,
                static_cast<std::uint8_t>(is_changed ? 255 : 0));
  }
  if (covered > 0)
    difference.changed_percent = 100 * static_cast<double>(changed) / static_cast<double>(covered);
  return difference;
}

}  // namespace merlin::render::image
