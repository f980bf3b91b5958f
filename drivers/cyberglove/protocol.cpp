#include "drivers/cyberglove/protocol.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "daemon/base/bytes.h"
#include "drivers/cyberglove/text.h"

namespace merlin::cyberglove {
namespace {

constexpr std::size_t kStampLength = 5;
constexpr double kRateClock = 115200;  // [Hz] clock that the command `T` divides

// Returns the length of a record without its error letters: the letter, the values and the optional
// fields.
std::size_t bodyLength(const Layout& layout) noexcept {
  return 1 + layout.values + (layout.timestamp ? kStampLength : 0) + (layout.status ? 1 : 0);
}

}  // namespace

SlotList slotsOf(std::uint32_t mask) noexcept {
  SlotList list;
  for (std::uint8_t slot = 0; slot < kSlots; ++slot) {
    if (mask >> slot & 1) list.slot[list.count++] = slot;
  }
  return list;
}

std::string encodeMask(std::uint32_t mask) {
  std::string bytes;
  appendLe32(bytes, mask);
  bytes.pop_back();
  return bytes;
}

std::uint32_t decodeMask(const char* bytes) noexcept {
  std::uint32_t mask = 0;
  for (int i = 2; i >= 0; --i) mask = mask << 8 | static_cast<std::uint8_t>(bytes[i]);
  return mask;
}

void Parser::expect(const Layout& layout) noexcept {
  assert(layout.values >= 1 && layout.values <= kSlots);
  layout_ = layout;
  length_ = 0;
}

std::optional<Packet> Parser::feed(std::byte byte) noexcept {
  const auto c = std::to_integer<std::uint8_t>(byte);
  if (c == 0) return finish();
  if (length_ < kLongest) bytes_[length_] = c;
  ++length_;
  return std::nullopt;
}

std::optional<Packet> Parser::finish() noexcept {
  std::optional<Packet> packet;
  if (length_ <= kLongest) packet = read();
  if (!packet) {
    bad_packets_ += length_ > 0 ? 1 : 0;  // a NUL alone is a surplus byte, not a packet
    bad_bytes_ += length_ + 1;
  }
  length_ = 0;
  return packet;
}

// REQUIRES: length_ <= kLongest.
std::optional<Packet> Parser::read() const noexcept {
  if (layout_.text)
    return readText({reinterpret_cast<const char*>(bytes_.data()), length_}, layout_);
  if (length_ == 2 && bytes_[0] == 'e') return Refusal{static_cast<char>(bytes_[1])};
  const std::size_t body = bodyLength(layout_);
  if (length_ != body && length_ != body + 2 && length_ != body + 4) return std::nullopt;
  if (bytes_[0] != 'G' && bytes_[0] != 'S') return std::nullopt;

  Record record;
  record.single = bytes_[0] == 'G';
  std::copy_n(&bytes_[1], layout_.values, record.values.begin());
  if (layout_.timestamp) record.timestamp = unstuffTimestamp(&bytes_[1 + layout_.values]);
  if (layout_.status) record.status = bytes_[body - 1];
  if (!(record.status & Record::kAlways)) return std::nullopt;
  for (std::size_t i = body; i < length_; i += 2) {
    if (bytes_[i] != 'e' || (bytes_[i + 1] != 's' && bytes_[i + 1] != 'g')) return std::nullopt;
    (bytes_[i + 1] == 's' ? record.too_fast : record.unplugged) = true;
  }
  return record;
}

Stamp stuffTimestamp(std::uint32_t count) noexcept {
  Stamp stamp{Record::kAlways};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto byte = static_cast<std::uint8_t>(count >> 8 * i);
    stamp[1 + i] = byte == 0 ? 1 : byte;
    if (byte == 0) stamp[0] = static_cast<std::uint8_t>(stamp[0] | 1U << i);
  }
  return stamp;
}

std::uint32_t unstuffTimestamp(const std::uint8_t* stamp) noexcept {
  const std::uint32_t flags = stamp[0];
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) count |= (stamp[1 + i] ^ (flags >> i & 1)) << 8 * i;
  return count;
}

std::string encode(const Record& record, const Layout& layout) {
  if (layout.text) return encodeText(record, layout);
  std::string out(1, record.single ? 'G' : 'S');
  for (std::size_t i = 0; i < layout.values; ++i) {
    out.push_back(static_cast<char>(std::max<std::uint8_t>(record.values[i], 1)));
  }
  if (layout.timestamp) {
    for (const std::uint8_t c : stuffTimestamp(record.timestamp)) {
      out.push_back(static_cast<char>(c));
    }
  }
  if (layout.status) out.push_back(static_cast<char>(record.status));
  if (record.too_fast) out += "es";
  if (record.unplugged) out += "eg";
  out.push_back('\0');
  return out;
}

// rate = 115200 / (w1 * w2); the second word is only needed below 1.76 Hz.
std::string encodeRate(double rate_hz) {
  assert(rate_hz >= 1 && rate_hz <= kRateClock);
  const double second = rate_hz < kRateClock / 65535 ? 2 : 1;
  std::string command = "T";
  appendBe16(command, static_cast<std::uint16_t>(std::lround(kRateClock / rate_hz / second)));
  appendBe16(command, static_cast<std::uint16_t>(second));
  return command;
}

}  // namespace merlin::cyberglove
