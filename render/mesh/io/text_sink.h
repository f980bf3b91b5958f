// TextSink: buffered, formatted output for text files.
#pragma once

#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin::render::mesh {

// Formats text and writes it in blocks; after a failed write it writes nothing more.
class TextSink {
 public:
  explicit TextSink(const WriteBytes& write) : write_(write) {}

  template <typename... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kBlock) flush();
  }

  // Prints rows of `width` numbers, separated by spaces, each row between `before` and `after`.
  void printRows(std::span<const float> values, std::size_t width, std::string_view before,
                 std::string_view after) {
    for (std::size_t i = 0; i < values.size(); i += width) {
      print("{}{}", before, values[i]);
      for (std::size_t k = 1; k < width; ++k) print(" {}", values[i + k]);
      print("{}", after);
    }
  }

  // Writes the remaining text; returns whether all writes succeeded.
  bool finish() {
    flush();
    return taken_;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;

  void flush() {
    taken_ = taken_ && write_(std::as_bytes(std::span(text_)));
    text_.clear();
  }

  const WriteBytes& write_;
  std::string text_;
  bool taken_ = true;
};

}  // namespace merlin::render::mesh
