#include "render/correct/io/pfm.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace merlin::render::correct {
namespace {

constexpr std::size_t kLongestHead = 256;  // [bytes]

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Reads the white-space-separated words of a header.
class Head {
 public:
  explicit Head(std::string_view text) : text_(text) {}

  // Returns the next word; empty at the end of the text.
  std::string_view word() {
    while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
    const std::size_t from = at_;
    while (at_ < text_.size() && !isSpace(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  template <typename T>
  std::optional<T> number() {
    const std::string_view w = word();
    T value{};
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc{} || end != w.data() + w.size()) return std::nullopt;
    return value;
  }
  // Returns the position of the floats, after one white space character [bytes].
  std::size_t end() const { return at_ + 1; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

float floatAt(const std::byte* bytes, bool little) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = little ? 3 - i : i;
    bits = bits << 8 | std::to_integer<std::uint32_t>(bytes[at]);
  }
  return std::bit_cast<float>(bits);
}

}  // namespace

Result<FloatMap> parsePfm(std::span<const std::byte> bytes, std::size_t most_cells) {
  Head head({reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kLongestHead)});
  const std::string_view kind = head.word();
  if (kind == "Pf")
    return Error{Errc::kUnsupported, "is a PFM with one float a cell (Pf); a warp has three (PF)"};
  const auto columns = head.number<std::uint32_t>(), rows = head.number<std::uint32_t>();
  const auto scale = head.number<float>();
  if (kind != "PF" || !columns || !rows || !scale || !std::isfinite(*scale) || *scale == 0 ||
      *columns == 0 || *rows == 0) {
    return Error{
        Errc::kMalformed,
        "is not a PFM: it does not begin with PF, columns, rows and a scale that is not 0"};
  }
  if (*columns > most_cells / *rows) {
    return Error{Errc::kUnsupported,
                 fmt::format("has {} x {} cells; the maximum is {}", *columns, *rows, most_cells)};
  }
  const std::size_t cells = std::size_t{*columns} * *rows;
  if (bytes.size() < head.end() || bytes.size() - head.end() != 12 * cells) {
    return Error{Errc::kMalformed, fmt::format("has {} bytes of floats; {} x {} cells need {}",
                                               bytes.size() - std::min(bytes.size(), head.end()),
                                               *columns, *rows, 12 * cells)};
  }
  FloatMap map{static_cast<int>(*columns), static_cast<int>(*rows), {}};
  map.cells.resize(cells);
  const std::byte* from = bytes.data() + head.end();
  for (std::size_t row = *rows; row-- > 0;) {
    for (std::size_t column = 0; column < *columns; ++column) {
      for (float& value : map.cells[row * *columns + column]) {
        value = floatAt(from, *scale < 0);
        from += 4;
      }
    }
  }
  return map;
}

std::string pfmBytes(const FloatMap& map) {
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", map.columns, map.rows);
  const auto columns = static_cast<std::size_t>(map.columns);
  for (auto row = static_cast<std::size_t>(map.rows); row-- > 0;) {
    for (std::size_t column = 0; column < columns; ++column) {
      for (const float value : map.cells[row * columns + column]) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift);
      }
    }
  }
  return bytes;
}

}  // namespace merlin::render::correct
