#include "render/text/surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace merlin::render::text {
namespace {

// A premultiplied colour that is put over a pixel, and the share of the pixel that remains.
struct Source {
  std::uint8_t rgba[4];
  std::uint32_t rest;
};

Source sourceOf(Colour c, std::uint8_t coverage) {
  const std::uint32_t alpha = by255(std::uint32_t{coverage} * c.alpha);
  return {{by255(c.red * alpha), by255(c.green * alpha), by255(c.blue * alpha),
           static_cast<std::uint8_t>(alpha)},
          255 - alpha};
}

void put(const Source& source, std::uint8_t* pixel) {
  for (int c = 0; c < 4; ++c)
    pixel[c] = static_cast<std::uint8_t>(source.rgba[c] + by255(pixel[c] * source.rest));
}

}  // namespace

Rect common(const Rect& a, const Rect& b) noexcept {
  const int left = std::max(a.x, b.x), top = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width);
  const int bottom = std::min(a.y + a.height, b.y + b.height);
  return {left, top, std::max(right - left, 0), std::max(bottom - top, 0)};
}

Rect shrunk(const Rect& r, int by) noexcept {
  return {r.x + by, r.y + by, std::max(r.width - 2 * by, 0), std::max(r.height - 2 * by, 0)};
}

Colour faded(Colour colour, float share) noexcept {
  const float alpha = static_cast<float>(colour.alpha) * std::clamp(share, 0.0F, 1.0F);
  colour.alpha = static_cast<std::uint8_t>(std::lround(alpha));
  return colour;
}

Surface::Surface(std::span<std::uint8_t> rgba, int width, int height) noexcept
    : rgba_(rgba), width_(width), clip_{0, 0, width, height} {
  assert(rgba.size() ==
         std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

Surface Surface::clippedTo(const Rect& clip) const noexcept {
  Surface clipped = *this;
  clipped.clip_ = common(clip_, clip);
  return clipped;
}

void Surface::fill(const Rect& area, Colour colour) const noexcept {
  const Rect r = common(area, clip_);
  const Source source = sourceOf(colour, 255);
  for (int y = r.y; y < r.y + r.height; ++y) {
    std::uint8_t* pixel = pixelAt(r.x, y);
    for (int x = 0; x < r.width; ++x, pixel += 4) put(source, pixel);
  }
}

void Surface::fillWhole(Colour colour) const noexcept {
  const Source source = sourceOf(colour, 255);
  for (std::size_t i = 0; i < rgba_.size(); i += 4) std::copy_n(source.rgba, 4, &rgba_[i]);
}

void Surface::disc(const Rect& area, int diameter_px, Colour colour) const noexcept {
  const float radius = static_cast<float>(diameter_px) / 2;
  const int left = area.x + (area.width - diameter_px) / 2;
  const int top = area.y + (area.height - diameter_px) / 2;
  for (int y = 0; y < diameter_px; ++y) {
    for (int x = 0; x < diameter_px; ++x) {
      const float distance =
          std::hypot(static_cast<float>(x) + 0.5F - radius, static_cast<float>(y) + 0.5F - radius);
      const float covered = std::clamp(radius - distance + 0.5F, 0.0F, 1.0F);
      cover(left + x, top + y, static_cast<std::uint8_t>(std::lround(255 * covered)), colour);
    }
  }
}

void Surface::cover(int x, int y, std::uint8_t coverage, Colour colour) const noexcept {
  if (x < clip_.x || y < clip_.y || x >= clip_.x + clip_.width || y >= clip_.y + clip_.height)
    return;
  put(sourceOf(colour, coverage), pixelAt(x, y));
}

void Surface::coverRow(Point at, std::span<const std::uint8_t> coverage,
                       Colour colour) const noexcept {
  const Rect r = common({at.x, at.y, static_cast<int>(coverage.size()), 1}, clip_);
  if (r.height == 0 || r.width == 0) return;
  std::uint8_t* pixel = pixelAt(r.x, r.y);
  for (int x = r.x; x < r.x + r.width; ++x, pixel += 4) {
    const std::uint8_t covered = coverage[static_cast<std::size_t>(x - at.x)];
    if (covered > 0) put(sourceOf(colour, covered), pixel);
  }
}

std::uint8_t* Surface::pixelAt(int x, int y) const noexcept {
  return &rgba_[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x))];
}

}  // namespace merlin::render::text
