// Area: a rectangle of a canvas, to draw points, lines, rings and text in. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace merlin::render::testcard {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

inline constexpr Colour kBlack{0, 0, 0}, kWhite{255, 255, 255};
constexpr Colour grey(int value) {
  const auto v = static_cast<std::uint8_t>(value);
  return {v, v, v};
}

// Two lengths in pixels, across and down.
struct Pitch {
  double x = 0, y = 0;
};

// Everything is clipped to the area. Coordinates are pixels from its upper left corner.
class Area {
 public:
  // `canvas`: RGBA, `canvas_width` pixels a row, which contains the rectangle.
  Area(std::span<std::uint8_t> canvas, int canvas_width, int x, int y, int width, int height)
      : canvas_(canvas),
        canvas_width_(canvas_width),
        x_(x),
        y_(y),
        width_(width),
        height_(height) {}

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

  void set(int x, int y, Colour colour);
  void fill(int x, int y, int width, int height, Colour colour);
  void fillAll(Colour colour) { fill(0, 0, width_, height_, colour); }
  // Draws the border of a rectangle, one pixel wide, inside the rectangle.
  void frame(int x, int y, int width, int height, Colour colour);
  void line(int x0, int y0, int x1, int y1, Colour colour);
  // Draws an elliptical ring around (x, y). These coordinates count from pixel corners: (1, 1) is
  // where the first four pixels meet. `outer`: the outer radii [px]; `thick`: width of the ring
  // [px].
  void ring(double x, double y, const Pitch& outer, double thick, Colour colour);
  // Draws text whose upper left corner is (x, y). A pixel of the font is `scale` pixels wide and
  // high, so the text is 8 * scale pixels high.
  void text(int x, int y, int scale, std::string_view text, Colour colour);
  // Draws text like text(), with (x, y) as its middle and on a black box.
  void label(int x, int y, int scale, std::string_view text, Colour colour);

 private:
  std::span<std::uint8_t> canvas_;
  int canvas_width_, x_, y_, width_, height_;
};

int textWidth(std::string_view text, int scale);

}  // namespace merlin::render::testcard
