// CellGrid: the characters and styles of a terminal's screen as a grid of cells. Pure.
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
  // Makes a grid of blanks. A negative number of rows or columns counts as 0.
  CellGrid(int rows, int columns);

  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  // REQUIRES: the cell is inside the grid.
  const Cell& at(int row, int column) const { return cells_[index(row, column)]; }

  // Writes UTF-8 text from this cell to the right, one cell for each character; characters outside
  // the grid are left out. A character that may take no cell or two on a terminal, a control
  // character, or a byte that is not valid UTF-8 becomes '?'. Returns the column after the text.
  int put(int row, int column, std::string_view text, CellStyle style = CellStyle::kPlain);
  void put(int row, int column, Cell cell);  // does nothing outside the grid

  // Returns a row as UTF-8 without the blanks at its end.
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
