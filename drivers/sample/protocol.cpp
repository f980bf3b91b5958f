#include "drivers/sample/protocol.h"

#include <charconv>

#include <fmt/format.h>

namespace merlin::sample {
namespace {

constexpr int kAllButtons = 0xFFF;  // the twelve of BallSample

}  // namespace

std::optional<Record> Parser::feed(std::byte byte) noexcept {
  const char c = static_cast<char>(byte);
  if (c != '\n') {
    if (length_ < line_.size()) line_[length_] = c;
    ++length_;
    return std::nullopt;
  }
  const auto record = length_ <= line_.size() ? read() : std::nullopt;
  if (!record) {
    ++bad_packets_;
    bad_bytes_ += length_ + 1;
  }
  length_ = 0;
  return record;
}

std::optional<Record> Parser::read() const noexcept {
  const char* at = line_.data();
  const char* const end = at + length_;
  std::array<int, 7> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ' ')) return std::nullopt;
    const auto parsed = std::from_chars(at, end, numbers[i]);
    if (parsed.ec != std::errc()) return std::nullopt;
    at = parsed.ptr;
  }
  Record record;
  for (std::size_t i = 0; i < 6; ++i) {
    if (numbers[i] < -1000 || numbers[i] > 1000) return std::nullopt;
    record.axes[i] = numbers[i];
  }
  if (at != end || numbers[6] < 0 || numbers[6] > kAllButtons) return std::nullopt;
  record.buttons = static_cast<std::uint32_t>(numbers[6]);
  return record;
}

std::string encode(const Record& r) {
  return fmt::format("{} {}\n", fmt::join(r.axes, " "), r.buttons);
}

}  // namespace merlin::sample
