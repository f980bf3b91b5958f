#include "daemon/cli/watch/cell_grid.h"

#include <algorithm>

#include "daemon/base/utf8.h"

namespace merlin::cli {
namespace {

// Returns whether every terminal shows this character in one cell. Known are Latin, Greek and
// Cyrillic letters and the block elements of charts; other characters may be combining marks or
// have double width.
bool hasOneCell(char32_t c) {
  const bool latin = c >= 0x20 && c < 0x300 && !(c >= 0x7F && c < 0xA0) && c != 0xAD;
  const bool greek_or_cyrillic = c >= 0x370 && c < 0x483;
  const bool block = c >= 0x2580 && c < 0x25A0;
  return latin || greek_or_cyrillic || block;
}

void appendUtf8(std::string& text, char32_t c) {
  const auto add = [&](char32_t byte) { text += static_cast<char>(byte); };
  if (c < 0x80) return add(c);
  if (c < 0x800) {
    add(0xC0U | c >> 6);
  } else {
    add(0xE0U | c >> 12);
    add(0x80U | (c >> 6 & 0x3FU));
  }
  add(0x80U | (c & 0x3FU));
}

}  // namespace

CellGrid::CellGrid(int rows, int columns)
    : rows_(std::max(rows, 0)),
      columns_(std::max(columns, 0)),
      cells_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_)) {}

int CellGrid::put(int row, int column, std::string_view text, CellStyle style) {
  while (!text.empty()) {
    const char32_t c = takeCharacter(text);
    put(row, column++, {hasOneCell(c) ? c : U'?', style});
  }
  return column;
}

void CellGrid::put(int row, int column, Cell cell) {
  if (row >= 0 && row < rows_ && column >= 0 && column < columns_)
    cells_[index(row, column)] = cell;
}

std::string CellGrid::line(int row) const {
  std::string text;
  std::size_t end = 0;  // end of `text` without the blanks at its end
  for (int column = 0; column < columns_; ++column) {
    appendUtf8(text, at(row, column).glyph);
    if (at(row, column).glyph != U' ') end = text.size();
  }
  text.resize(end);
  return text;
}

}  // namespace merlin::cli
