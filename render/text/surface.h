// Surface: pixels that text and plates are drawn into. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::render::text {

struct Rect {
  int x = 0, y = 0, width = 0, height = 0;  // from the upper left corner [px]

  bool operator==(const Rect&) const = default;
};

// Returns the intersection of two rectangles; one without pixels if they do not overlap.
Rect common(const Rect& a, const Rect& b) noexcept;
// Returns the rectangle without a margin of `by` pixels on each side.
Rect shrunk(const Rect& r, int by) noexcept;

struct Point {
  int x = 0, y = 0;  // [px]
};

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  std::uint8_t alpha = 255;  // 255: opaque
};
// Returns the colour with its alpha multiplied by `share`, 0..1.
Colour faded(Colour colour, float share) noexcept;

// Borrows the pixels: RGBA, premultiplied by alpha, rows from the top without gaps. Each call
// except fillWhole() blends its colour over the pixels inside the clip, and changes none outside.
// Reentrant.
class Surface {
 public:
  // REQUIRES: rgba.size() is 4 * width * height.
  Surface(std::span<std::uint8_t> rgba, int width, int height) noexcept;

  // Returns a surface of the same pixels that draws only inside `clip`.
  Surface clippedTo(const Rect& clip) const noexcept;
  const Rect& clip() const noexcept { return clip_; }

  void fill(const Rect& area, Colour colour) const noexcept;
  // Sets all pixels to this colour, also outside the clip, without blending. As quick as a memset.
  void fillWhole(Colour colour) const noexcept;
  // Draws a disc with a smooth edge in the middle of `area`.
  void disc(const Rect& area, int diameter_px, Colour colour) const noexcept;
  // Blends `colour` over one pixel with a coverage of 0..255. Outside the clip nothing happens.
  void cover(int x, int y, std::uint8_t coverage, Colour colour) const noexcept;
  // Blends `colour` over a row of pixels that begins at `at`, with one coverage of 0..255 for each.
  void coverRow(Point at, std::span<const std::uint8_t> coverage, Colour colour) const noexcept;

 private:
  std::uint8_t* pixelAt(int x, int y) const noexcept;

  std::span<std::uint8_t> rgba_;
  int width_;
  Rect clip_;
};

// Returns x / 255, rounded. REQUIRES: x <= 255 * 255.
constexpr std::uint8_t by255(std::uint32_t x) noexcept {
  return static_cast<std::uint8_t>((x + 128 + ((x + 128) >> 8)) >> 8);
}

}  // namespace merlin::render::text
