#include "render/testcard/area.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/testcard/font.h"

namespace merlin::render::testcard {

void Area::set(int x, int y, Colour colour) { fill(x, y, 1, 1, colour); }

void Area::fill(int x, int y, int width, int height, Colour colour) {
  const int left = std::max(x, 0), right = std::min(x + width, width_);
  const int top = std::max(y, 0), bottom = std::min(y + height, height_);
  for (int row = top; row < bottom; ++row) {
    auto at = static_cast<std::size_t>(4) *
              (static_cast<std::size_t>(y_ + row) * static_cast<std::size_t>(canvas_width_) +
               static_cast<std::size_t>(x_ + left));
    for (int column = left; column < right; ++column, at += 4) {
      canvas_[at] = colour.red;
      canvas_[at + 1] = colour.green;
      canvas_[at + 2] = colour.blue;
      canvas_[at + 3] = 255;
    }
  }
}

void Area::frame(int x, int y, int width, int height, Colour colour) {
  fill(x, y, width, 1, colour);
  fill(x, y + height - 1, width, 1, colour);
  fill(x, y, 1, height, colour);
  fill(x + width - 1, y, 1, height, colour);
}

void Area::line(int x0, int y0, int x1, int y1, Colour colour) {
  const int steps = std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1});
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    set(static_cast<int>(std::lround(x0 + t * (x1 - x0))),
        static_cast<int>(std::lround(y0 + t * (y1 - y0))), colour);
  }
}

namespace {

// Returns half the width of an ellipse at distance `y` from its middle; 0 beyond the ellipse.
double halfWidth(const Pitch& radii, double y) {
  const double share = radii.y > 0 ? y / radii.y : 1;
  return std::abs(share) < 1 ? radii.x * std::sqrt(1 - share * share) : 0;
}

}  // namespace

// Fills the pixels whose centres are between the two ellipses.
void Area::ring(double x, double y, const Pitch& outer, double thick, Colour colour) {
  const Pitch inner{std::max(outer.x - thick, 0.0), std::max(outer.y - thick, 0.0)};
  for (int row = static_cast<int>(std::floor(y - outer.y)); row <= y + outer.y; ++row) {
    const double dy = row + 0.5 - y, far = halfWidth(outer, dy), near = halfWidth(inner, dy);
    for (int column = static_cast<int>(std::ceil(near - 0.5)); column + 0.5 <= far; ++column) {
      set(static_cast<int>(std::floor(x + column + 0.5)), row, colour);
      set(static_cast<int>(std::ceil(x - column - 0.5)) - 1, row, colour);
    }
  }
}

void Area::text(int x, int y, int scale, std::string_view text, Colour colour) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto rows = glyph(text[i]);
    const int left = x + static_cast<int>(i) * kGlyphSize * scale;
    for (int row = 0; row < kGlyphSize; ++row) {
      for (int column = 0; column < kGlyphSize; ++column) {
        if ((rows[static_cast<std::size_t>(row)] >> column & 1) != 0)
          fill(left + column * scale, y + row * scale, scale, scale, colour);
      }
    }
  }
}

void Area::label(int x, int y, int scale, std::string_view words, Colour colour) {
  const int width = textWidth(words, scale), height = kGlyphSize * scale;
  fill(x - width / 2 - scale, y - height / 2 - scale, width + 2 * scale, height + 2 * scale,
       kBlack);
  text(x - width / 2, y - height / 2, scale, words, colour);
}

int textWidth(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * kGlyphSize * scale;
}

}  // namespace merlin::render::testcard
