#include "drivers/port/evdev_line.h"

#include <algorithm>

namespace merlin {
namespace {

constexpr std::uint8_t kBegin = 0xE5;

std::int32_t readInt(const std::uint8_t* at) noexcept {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | at[i];
  return static_cast<std::int32_t>(value);
}

void appendInt(std::int32_t value, std::string& out) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (int i = 0; i < 4; ++i) out += static_cast<char>(bits >> 8 * i & 0xFF);
}

bool hasText(EvdevRecord::Kind kind) noexcept {
  return kind == EvdevRecord::kName || kind == EvdevRecord::kKey;
}

}  // namespace

std::optional<EvdevRecord> EvdevParser::feed(std::byte byte) noexcept {
  bytes_[length_++] = static_cast<std::uint8_t>(byte);
  const bool begins =
      bytes_[0] == kBegin &&
      (length_ < 2 || (bytes_[1] >= EvdevRecord::kName && bytes_[1] <= EvdevRecord::kReport));
  if (!begins) {
    ++bad_bytes_;
    if (!lost_) ++bad_packets_;
    lost_ = true;
    // The check rejects a record at its second byte, so the buffer has at most two bytes here.
    bytes_[0] = bytes_[1];
    --length_;
    return std::nullopt;
  }
  if (length_ < kSize) return std::nullopt;
  length_ = 0;
  lost_ = false;
  EvdevRecord record;
  record.kind = static_cast<EvdevRecord::Kind>(bytes_[1]);
  record.code = static_cast<std::uint16_t>(bytes_[2] | bytes_[3] << 8);
  if (hasText(record.kind)) {
    std::copy_n(bytes_.begin() + 4, EvdevRecord::kText, record.text.begin());
  } else {
    record.value = readInt(&bytes_[4]);
    record.low = readInt(&bytes_[8]);
    record.high = readInt(&bytes_[12]);
    record.resolution = readInt(&bytes_[16]);
  }
  return record;
}

void EvdevParser::reset() noexcept {
  length_ = 0;
  lost_ = false;
}

void append(const EvdevRecord& record, std::string& out) {
  out += static_cast<char>(kBegin);
  out += static_cast<char>(record.kind);
  out += static_cast<char>(record.code & 0xFF);
  out += static_cast<char>(record.code >> 8);
  if (hasText(record.kind)) {
    out.append(record.text.data(), EvdevRecord::kText);
    return;
  }
  appendInt(record.value, out);
  appendInt(record.low, out);
  appendInt(record.high, out);
  appendInt(record.resolution, out);
  out.append(EvdevRecord::kText - 16, '\0');
}

}  // namespace merlin
