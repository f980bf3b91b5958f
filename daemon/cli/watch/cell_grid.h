// CellGrid: text on a terminal's screen, cell by cell, before it is sent to a terminal. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::cli {

enum class CellStyle : std::uint8_t { kPlain, kHeading, kGood, kWarning, kBad, kDim };

struct Cell {
  char32_t glyph = U' ';
  CellStyle style = CellStyle::kPlain;
  bool operator==(const Cell&) const = default;
};

// Thread-bound.
class CellGrid {
 public:
  // A grid of blanks. A negative number of rows or columns counts as none.
  CellGrid(int rows, int columns);

  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  // REQUIRES: the cell is inside the grid.
  const Cell& at(int row, int column) const { return cells_[index(row, column)]; }

  // Writes UTF-8 text from this cell to the right, one cell for each character; what lies outside
  // the grid is left out. A character that may take no cell or two on a terminal, a control
  // character, and a byte that is not UTF-8 become '?'. Returns the column after the text.
  int put(int row, int column, std::string_view text, CellStyle style = CellStyle::kPlain);
  void put(int row, int column, Cell cell);  // nothing if it lies outside

  // A row as UTF-8 without the blanks at its end.
  std::string line(int row) const;

 private:
  std::size_t index(int row, int column) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int rows_, columns_;
  std::vector<Cell> cells_;
};

}  // namespace merlin::cli
