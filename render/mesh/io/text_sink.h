// Formatted text in blocks, for files that are written as text.
#pragma once

#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin::render {

// Formatted text in blocks; remembers a refusal.
class TextSink {
 public:
  explicit TextSink(const WriteBytes& write) : write_(write) {}

  template <typename... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kBlock) flush();
  }

  // Rows of `width` numbers between `before` and `after`, each parted by a space.
  void printRows(std::span<const float> values, std::size_t width, std::string_view before,
                 std::string_view after) {
    for (std::size_t i = 0; i < values.size(); i += width) {
      print("{}{}", before, values[i]);
      for (std::size_t k = 1; k < width; ++k) print(" {}", values[i + k]);
      print("{}", after);
    }
  }

  // Whether all was taken.
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

}  // namespace merlin::render
