#include "daemon/rfb/card.h"

#include <algorithm>
#include <string>
#include <vector>

#include "render/testcard/area.h"
#include "render/testcard/font.h"

namespace merlin::rfb {
namespace {

using render::testcard::Area;
using render::testcard::grey;
using render::testcard::kGlyphSize;

// Returns the longest start of the first line of `text` that has at most `most` bytes; it ends at
// the end of a word if possible.
std::string_view firstLine(std::string_view text, std::size_t most) {
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.size() <= most) return line;
  const std::size_t space = line.substr(0, most + 1).rfind(' ');
  return line.substr(0, space == std::string_view::npos ? most : space);
}

std::vector<std::string_view> linesOf(std::string_view text, std::size_t most) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    lines.push_back(firstLine(text, most));
    text.remove_prefix(lines.back().size());
    if (!text.empty() && (text.front() == ' ' || text.front() == '\n')) text.remove_prefix(1);
  }
  return lines;
}

}  // namespace

void drawCard(std::string_view text, std::span<std::uint8_t> canvas, int width, int height) {
  const int scale = std::clamp(width / 400, 1, 4);
  const int glyph = kGlyphSize * scale;
  const auto lines = linesOf(text, static_cast<std::size_t>(std::max(1, width / glyph - 2)));
  Area area(canvas, width, 0, 0, width, height);
  area.fillAll(grey(48));
  int y = (height - static_cast<int>(lines.size()) * 2 * glyph) / 2;
  for (const std::string_view line : lines) {
    const int x = (width - render::testcard::textWidth(line, scale)) / 2;
    area.text(x, y, scale, line, grey(230));
    y += 2 * glyph;
  }
}

}  // namespace merlin::rfb
