// TerminalScreen: the characters that an xterm shows after a program's output. It knows the control
// sequences that ncurses sends to such a terminal. Colours and styles are ignored.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/utf8.h"

namespace merlin::test {

class TerminalScreen {
 public:
  TerminalScreen(int rows, int columns)
      : rows_(static_cast<std::size_t>(rows)),
        columns_(static_cast<std::size_t>(columns)),
        cells_(rows_, std::vector<std::string>(columns_, " ")) {}

  // Processes further output. A sequence or character that is incomplete at the end is kept for the
  // next call.
  void feed(std::string_view bytes) {
    held_ += bytes;
    std::string_view rest = held_;
    while (!rest.empty() && step(rest)) {
    }
    held_ = std::string(rest);
  }

  // Returns a row of characters without the blanks at its end.
  std::string line(std::size_t row) const {
    std::string text;
    for (const std::string& cell : cells_[row]) text += cell;
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }
  std::string text() const {
    std::string all;
    for (std::size_t row = 0; row < rows_; ++row) all += line(row) + '\n';
    return all;
  }
  bool shows(const std::string& part) const { return text().find(part) != std::string::npos; }

 private:
  // Removes one character or control sequence from the front and carries it out; false if it is
  // incomplete.
  bool step(std::string_view& rest) {
    const auto first = static_cast<unsigned char>(rest[0]);
    if (first == 0x1B) return sequence(rest);
    if (first < 0x20) {
      control(first);
      rest.remove_prefix(1);
      return true;
    }
    const std::size_t length = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (rest.size() < length) return false;
    write(std::string(rest.substr(0, length)));
    rest.remove_prefix(length);
    return true;
  }

  void control(unsigned char c) {
    if (c == '\r') column_ = 0;
    if (c == '\b' && column_ > 0) --column_;
    if (c == '\n') index();
    if (c == '\t') column_ = std::min((column_ / 8 + 1) * 8, columns_ - 1);
  }

  void write(const std::string& glyph) {
    if (column_ >= columns_) {
      column_ = 0;
      index();
    }
    last_ = glyph;
    auto& cells = cells_[row_];
    if (inserts_) {
      cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(column_), " ");
      cells.resize(columns_);
    }
    cells[column_++] = glyph;
  }

  bool sequence(std::string_view& rest) {
    if (rest.size() < 2) return false;
    if (rest[1] != '[') {
      const bool three = rest[1] == '(' || rest[1] == ')';
      if (three && rest.size() < 3) return false;
      if (rest[1] == 'D' || rest[1] == 'E') index();
      if (rest[1] == 'E') column_ = 0;
      if (rest[1] == 'M') reverseIndex();
      rest.remove_prefix(three ? 3 : 2);
      return true;
    }
    const std::size_t end = rest.find_first_of("@ABCDGHJKLMPSTXbdhlmnrt", 2);
    if (end == std::string_view::npos) return false;
    act(rest[end], rest.substr(2, end - 2));
    rest.remove_prefix(end + 1);
    return true;
  }

  static std::vector<std::size_t> numbers(std::string_view text) {
    std::vector<std::size_t> all{0};
    for (const char c : text) {
      if (c == ';') all.push_back(0);
      if (c >= '0' && c <= '9') all.back() = all.back() * 10 + static_cast<std::size_t>(c - '0');
    }
    return all;
  }

  void act(char what, std::string_view parameters) {
    const auto all = numbers(parameters);
    const std::size_t n = std::max<std::size_t>(all[0], 1);
    auto& cells = cells_[row_];
    const auto from = static_cast<std::ptrdiff_t>(std::min(column_, columns_ - 1));
    const std::size_t left = columns_ - static_cast<std::size_t>(from);
    switch (what) {
      case 'H': place(n, all.size() > 1 ? std::max<std::size_t>(all[1], 1) : 1); break;
      case 'd': place(n, column_ + 1); break;
      case 'G': place(row_ + 1, n); break;
      case 'A': row_ -= std::min(n, row_); break;
      case 'B': row_ = std::min(row_ + n, rows_ - 1); break;
      case 'C': column_ = std::min(column_ + n, columns_ - 1); break;
      case 'D': column_ -= std::min(n, column_); break;
      case 'K': erase(row_, all[0] == 1 ? 0 : column_, all[0] == 0 ? columns_ : column_ + 1); break;
      case 'J': clear(all[0]); break;
      case 'L':
      case 'M':
        if (row_ >= top_ && row_ < bottom_) moveRows(row_, n, what == 'L');
        break;
      case 'S':
      case 'T': moveRows(top_, n, what == 'T'); break;
      case 'r': scrollOnly(n, all.size() > 1 ? all[1] : 0); break;
      case 'X': erase(row_, column_, std::min(column_ + n, columns_)); break;
      case 'b':
        for (std::size_t i = 0; i < n; ++i) write(last_);
        break;
      case 'P':
        std::rotate(cells.begin() + from,
                    cells.end() - static_cast<std::ptrdiff_t>(left) +
                        static_cast<std::ptrdiff_t>(std::min(n, left)),
                    cells.end());
        erase(row_, columns_ - std::min(n, left), columns_);
        break;
      case '@':
        cells.insert(cells.begin() + from, std::min(n, left), " ");
        cells.resize(columns_);
        break;
      case 'h':
      case 'l':
        if (parameters == "4") inserts_ = what == 'h';
        break;
      default: break;  // colours and other modes are ignored
    }
  }

  void place(std::size_t row, std::size_t column) {
    row_ = std::min(row, rows_) - 1;
    column_ = std::min(column, columns_) - 1;
  }
  // Sets the scrolling region, `first` to `last`, counted from 1. If `last` is 0, it extends to the
  // last row.
  void scrollOnly(std::size_t first, std::size_t last) {
    bottom_ = last == 0 ? rows_ : std::min(last, rows_);
    top_ = std::min(first, bottom_) - 1;
    place(1, 1);
  }
  // Moves the cursor one row down; in the last row of the scrolling region, scrolls the region up.
  void index() {
    if (row_ + 1 == bottom_)
      moveRows(top_, 1, false);
    else
      row_ = std::min(row_ + 1, rows_ - 1);
  }
  void reverseIndex() {
    if (row_ == top_)
      moveRows(top_, 1, true);
    else if (row_ > 0)
      --row_;
  }
  // Moves the rows from `from` to the end of the scrolling region down or up by `n`; blank rows
  // fill the gap.
  void moveRows(std::size_t from, std::size_t n, bool down) {
    const std::size_t count = std::min(n, bottom_ - from);
    const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto last = cells_.begin() + static_cast<std::ptrdiff_t>(bottom_);
    const auto by = static_cast<std::ptrdiff_t>(count);
    std::rotate(first, down ? last - by : first + by, last);
    const std::size_t blank = down ? from : bottom_ - count;
    for (std::size_t i = 0; i < count; ++i) erase(blank + i, 0, columns_);
  }
  void erase(std::size_t row, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < std::min(to, columns_); ++i) cells_[row][i] = " ";
  }
  void clear(std::size_t what) {
    if (what == 0) erase(row_, column_, columns_);
    for (std::size_t row = what == 0 ? row_ + 1 : 0; row < rows_; ++row) erase(row, 0, columns_);
  }

  std::size_t rows_, columns_, row_ = 0, column_ = 0;
  std::size_t top_ = 0, bottom_ = rows_;  // the rows that scroll are top_ to bottom_ - 1
  std::vector<std::vector<std::string>> cells_;
  // insert mode: a character that is written moves the rest of the row to the right
  bool inserts_ = false;
  std::string held_, last_ = " ";
};

}  // namespace merlin::test
