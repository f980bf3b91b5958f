#include "render/testcard/card.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "render/testcard/area.h"
#include "render/testcard/font.h"

namespace merlin::render::testcard {
namespace {

constexpr Colour kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kYellow{255, 255, 0};
constexpr Colour kCorners[] = {kRed, kGreen, kBlue, kYellow};
constexpr Colour kStrip{70, 0, 70}, kStripEdge{255, 0, 255}, kMark{255, 90, 0};
constexpr int kGridColumns = 16;
constexpr int kGreySteps = 17;

// Returns the largest scale, at least 1, at which a text fits into these shares of the area's width
// and height.
int scaleFor(const Area& a, std::string_view text, double width_share, double height_share) {
  const double columns = std::max(textWidth(text, 1), kGlyphSize);
  const double scale =
      std::min(width_share * a.width() / columns, height_share * a.height() / kGlyphSize);
  return std::max(1, static_cast<int>(scale));
}

// Returns the part of its plane that a tile shows; without a plane, the whole tile.
CardPart partOf(const CardTile& t) {
  if (t.part.width > 0) return t.part;
  const double w = t.width, h = t.height;
  return {0, 0, w, h, w, h};
}

// Returns the pixel of a line at `place` of a plane, of which the tile shows `length` from `from`
// on with `size` pixels. The first and the last line are on the outermost pixels. Nothing if the
// line is beyond the tile.
std::optional<int> pixelOf(double place, double from, double length, int size) {
  constexpr double kRounding = 1e-6;
  const double at = (place - from) / length * size;
  if (at < -kRounding || at > size + kRounding) return std::nullopt;
  return std::clamp(static_cast<int>(std::floor(at)), 0, size - 1);
}

// Rounds to an even number of intervals, so that there is a line in the middle.
int evenly(double distances) {
  return std::max(2, 2 * static_cast<int>(std::lround(distances / 2)));
}

void drawGridLines(Area& a, const CardPart& p) {
  const int columns = evenly(kGridColumns * p.plane_width / p.width);
  const int rows = evenly(columns * p.plane_height / p.plane_width);
  for (int k = 0; k <= columns; ++k) {
    const auto x = pixelOf(p.plane_width * k / columns, p.left, p.width, a.width());
    if (x) a.fill(*x, 0, 1, a.height(), grey(200));
  }
  for (int k = 0; k <= rows; ++k) {
    const auto y = pixelOf(p.plane_height * k / rows, p.top, p.height, a.height());
    if (y) a.fill(0, *y, a.width(), 1, grey(200));
  }
}

// Draws circles that are round on the screen, whose pixels need not be square.
void drawCircles(Area& a, const CardPart& p) {
  const double w = a.width(), h = a.height();
  const Pitch pitch{w / p.width, h / p.height};
  const double r = std::min(p.width, p.height) / 2, small = r / 4;
  const double thick = std::max(1.0, std::min(w, h) / 480);
  a.ring(w / 2, h / 2, {r * pitch.x, r * pitch.y}, thick, kWhite);
  const Pitch radii{small * pitch.x, small * pitch.y};
  for (const double x : {radii.x, w - radii.x}) {
    for (const double y : {radii.y, h - radii.y}) a.ring(x, y, radii, thick, kWhite);
  }
}

void drawGrid(Area& a, const CardTile& tile) {
  a.fillAll(kBlack);
  const int w = a.width(), h = a.height();
  const CardPart part = partOf(tile);
  a.line(0, 0, w - 1, h - 1, grey(80));
  a.line(0, h - 1, w - 1, 0, grey(80));
  drawGridLines(a, part);
  a.fill((w - 1) / 2, 0, 2 - w % 2, h, kGreen);
  a.fill(0, (h - 1) / 2, w, 2 - h % 2, kGreen);
  drawCircles(a, part);
  a.frame(0, 0, w, h, kWhite);
  a.label(w / 2, h / 2, scaleFor(a, tile.name, 0.25, 0.05), tile.name, kWhite);
}

void drawCornerMarks(Area& a) {
  const int w = a.width(), h = a.height();
  const int arm = std::max(4, std::min(w, h) / 8), thick = std::max(1, arm / 10);
  for (int corner = 0; corner < 4; ++corner) {
    const bool right = corner % 2 != 0, low = corner / 2 != 0;
    const Colour colour = kCorners[corner];
    a.fill(right ? w - 1 - arm : 1, low ? h - 1 - thick : 1, arm, thick, colour);
    a.fill(right ? w - 1 - thick : 1, low ? h - 1 - arm : 1, thick, arm, colour);
  }
}

std::string overlapText(const CardTile& t) {
  std::string text;
  for (const auto& [name, size] : {std::pair{"left", t.left}, std::pair{"right", t.right},
                                   std::pair{"top", t.top}, std::pair{"bottom", t.bottom}}) {
    if (size > 0) text += fmt::format("{}{} {} px", text.empty() ? "overlap " : ", ", name, size);
  }
  return text;
}

void drawEdges(Area& a, const CardTile& t) {
  a.fillAll(kBlack);
  const int w = a.width(), h = a.height();
  a.fill(0, 0, t.left, h, kStrip);
  a.fill(w - t.right, 0, t.right, h, kStrip);
  a.fill(0, 0, w, t.top, kStrip);
  a.fill(0, h - t.bottom, w, t.bottom, kStrip);
  if (t.left > 0) a.fill(t.left - 1, 0, 1, h, kStripEdge);
  if (t.right > 0) a.fill(w - t.right, 0, 1, h, kStripEdge);
  if (t.top > 0) a.fill(0, t.top - 1, w, 1, kStripEdge);
  if (t.bottom > 0) a.fill(0, h - t.bottom, w, 1, kStripEdge);
  a.frame(0, 0, w, h, kWhite);
  drawCornerMarks(a);
  const int scale = scaleFor(a, t.name, 0.4, 0.08);
  a.label(w / 2, h / 2, scale, t.name, kWhite);
  const std::string overlap = overlapText(t);
  if (overlap.empty()) return;
  a.label(w / 2, h / 2 + 12 * scale, std::min(scale, scaleFor(a, overlap, 0.7, 0.04)), overlap,
          kStripEdge);
}

Colour channel(int band, int value) {
  const auto v = static_cast<std::uint8_t>(value);
  const Colour bands[] = {grey(value), {v, 0, 0}, {0, v, 0}, {0, 0, v}};
  return bands[band];
}

// Draws ramps along the plane, so that neighbours show the same grey at their seam and where they
// overlap.
void drawRamps(Area& a, const CardPart& p) {
  const int w = a.width(), h = a.height();
  const auto from = [h](int band) { return band * h / 6; };
  const double first = p.left / p.width * w, last = p.plane_width / p.width * w - 1;  // [px]
  for (int x = 0; x < w; ++x) {
    const double along = std::clamp((first + x) / last, 0.0, 1.0);
    const int value = static_cast<int>(std::lround(255 * along));
    for (int band = 0; band < 4; ++band)
      a.fill(x, from(band), 1, from(band + 1) - from(band), channel(band, value));
    const auto stepOf = [&](int steps) {
      return std::min(static_cast<int>((first + x) / (last + 1) * steps), steps - 1);
    };
    a.fill(x, from(4), 1, from(5) - from(4), grey(255 * stepOf(kGreySteps) / (kGreySteps - 1)));
    // The values are 0, 2 ... 14 on the left half, 241, 243 ... 255 on the right one.
    const int patch = stepOf(16);
    a.fill(x, from(5), 1, h - from(5), grey(patch < 8 ? 2 * patch : 241 + 2 * (patch - 8)));
  }
}

void drawNames(Area& a, const CardTile& t, std::size_t number) {
  constexpr Colour kBackgrounds[] = {{70, 20, 20}, {20, 55, 20}, {20, 30, 90},
                                     {70, 60, 10}, {60, 20, 70}, {15, 60, 65}};
  const int w = a.width(), h = a.height();
  a.fillAll(kBackgrounds[number % std::size(kBackgrounds)]);
  a.frame(0, 0, w, h, kWhite);
  const int arrow = h / 12;  // height of an arrow that points up [px]
  for (int y = 0; y < arrow; ++y) a.fill(w / 2 - y, h / 24 + y, 2 * y + 1, 1, kWhite);
  const int scale = scaleFor(a, t.name, 0.8, 0.3);
  a.text(w / 2 - textWidth(t.name, scale) / 2, h * 2 / 5 - kGlyphSize * scale / 2, scale, t.name,
         kWhite);
  int y = h * 3 / 5;
  for (const std::string& line : t.lines) {
    const int small = std::min(scale, scaleFor(a, line, 0.8, 0.07));
    a.text(w / 2 - textWidth(line, small) / 2, y, small, line, grey(220));
    y += kGlyphSize * small * 3 / 2;
  }
}

// Draws black and white sectors around a point. The size of the spot in which they blur into grey
// shows how sharp the picture is.
void drawStar(Area& a, int cx, int cy, int radius) {
  constexpr int kSectors = 36;
  for (int y = -radius; y < radius; ++y) {
    for (int x = -radius; x < radius; ++x) {
      const double dx = x + 0.5, dy = y + 0.5;
      if (dx * dx + dy * dy > 1.0 * radius * radius) continue;
      const double turn = std::atan2(dy, dx) / (2 * std::numbers::pi) + 0.5;
      const bool white = static_cast<int>(turn * kSectors * 2) % 2 == 0;
      a.set(cx + x, cy + y, white ? kWhite : kBlack);
    }
  }
}

// Patterns of single pixels.
enum class Fine { kCheckers, kColumns, kRows };

void drawFine(Area& a, int left, int top, int size, Fine kind) {
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int count = kind == Fine::kCheckers ? x + y : kind == Fine::kColumns ? x : y;
      a.set(left + x, top + y, count % 2 == 0 ? kWhite : kBlack);
    }
  }
}

void drawFocus(Area& a, const CardTile& t) {
  const int w = a.width(), h = a.height(), radius = std::max(4, std::min(w, h) / 9);
  a.fillAll(grey(60));
  a.frame(0, 0, w, h, kWhite);
  const int xs[] = {radius * 5 / 4, w / 2, w - radius * 5 / 4};
  const int ys[] = {radius * 5 / 4, h / 2, h - radius * 5 / 4};
  constexpr Fine kinds[] = {Fine::kColumns, Fine::kCheckers, Fine::kRows};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int x = xs[column], y = ys[row];
      if (row % 2 == column % 2)
        drawStar(a, x, y, radius);
      else
        drawFine(a, x - radius, y - radius, 2 * radius, kinds[row]);
    }
  }
  a.label(w / 2, (ys[0] + ys[1]) / 2, 1, t.name + " 0123456789 sharp?", kWhite);
  a.label(w / 2, (ys[1] + ys[2]) / 2, 2, t.name + " 0123456789", kWhite);
}

// Draws a triangle in a corner of the area.
void drawMark(Area& a, std::size_t corner) {
  const int w = a.width(), h = a.height(), size = std::max(4, std::min(w, h) / 6);
  const bool right = corner % 2 != 0, low = corner / 2 != 0;
  for (int y = 0; y < size; ++y) {
    const int length = size - y;
    a.fill(right ? w - length : 0, low ? h - 1 - y : y, length, 1, kMark);
  }
}

}  // namespace

std::optional<Card> cardNamed(std::string_view name) {
  const auto found = std::ranges::find(kCardNames, name);
  if (found == std::end(kCardNames)) return std::nullopt;
  return static_cast<Card>(found - std::begin(kCardNames));
}

void drawCard(Card card, std::span<const CardTile> tiles, std::optional<MarkedCorner> mark,
              std::span<std::uint8_t> canvas, int canvas_width) {
  static_assert(std::size(kCardNames) == kCards);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const CardTile& t = tiles[i];
    Area area(canvas, canvas_width, t.x, t.y, t.width, t.height);
    switch (card) {
      case Card::kGrid: drawGrid(area, t); break;
      case Card::kEdges: drawEdges(area, t); break;
      case Card::kRamps: drawRamps(area, partOf(t)); break;
      case Card::kNames: drawNames(area, t, i); break;
      case Card::kFocus: drawFocus(area, t); break;
      case Card::kAllBlack: area.fillAll(kBlack); break;
      case Card::kAllGrey: area.fillAll(grey(128)); break;
      case Card::kAllWhite: area.fillAll(kWhite); break;
    }
    const bool marked = card == Card::kGrid || card == Card::kEdges;
    if (marked && mark && mark->tile == i) drawMark(area, mark->corner);
  }
}

}  // namespace merlin::render::testcard
