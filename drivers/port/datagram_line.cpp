#include "drivers/port/datagram_line.h"

#include <algorithm>
#include <cassert>

namespace merlin {
namespace {

constexpr std::uint8_t kMark = 0xDA, kCheck = 0x67;

using Header = std::array<std::uint8_t, kDatagramHeader>;

std::size_t lengthOf(const Header& header) noexcept {
  return static_cast<std::size_t>(header[2] | header[3] << 8);
}

std::uint8_t checkOf(const Header& header) noexcept {
  unsigned check = kCheck;
  for (std::size_t i = 2; i < header.size(); ++i) check ^= header[i];
  return static_cast<std::uint8_t>(check);
}

}  // namespace

DatagramParser::DatagramParser() : bytes_(kLongestDatagram) {}

// Whether the bytes received so far may be the beginning of a header.
bool DatagramParser::headerFits() const noexcept {
  if (header_length_ > 0 && header_[0] != kMark) return false;
  if (header_length_ < 4) return true;
  if (lengthOf(header_) == 0 || lengthOf(header_) > kLongestDatagram) return false;
  return header_length_ < kDatagramHeader || header_[1] == checkOf(header_);
}

void DatagramParser::dropFirst() noexcept {
  ++bad_bytes_;
  if (!lost_) ++bad_packets_;
  lost_ = true;
  std::copy(header_.begin() + 1, header_.begin() + static_cast<std::ptrdiff_t>(header_length_),
            header_.begin());
  --header_length_;
}

std::optional<Datagram> DatagramParser::feed(std::byte byte) noexcept {
  if (header_length_ < kDatagramHeader) {
    header_[header_length_++] = std::to_integer<std::uint8_t>(byte);
    while (header_length_ > 0 && !headerFits()) dropFirst();
    wanted_ = lengthOf(header_);
    length_ = 0;
    return std::nullopt;
  }
  bytes_[length_++] = byte;
  if (length_ < wanted_) return std::nullopt;
  header_length_ = 0;
  lost_ = false;
  Datagram datagram;
  for (std::size_t i = 0; i < 4; ++i)
    datagram.sender |= static_cast<std::uint32_t>(header_[4 + i]) << 8 * i;
  datagram.bytes = std::span<const std::byte>(bytes_).first(wanted_);
  return datagram;
}

void DatagramParser::reset() noexcept {
  header_length_ = 0;
  lost_ = false;
}

void append(const Datagram& datagram, std::string& out) {
  assert(!datagram.bytes.empty() && datagram.bytes.size() <= kLongestDatagram);
  Header header{kMark};
  for (std::size_t i = 0; i < 2; ++i)
    header[2 + i] = static_cast<std::uint8_t>(datagram.bytes.size() >> 8 * i & 0xFF);
  for (std::size_t i = 0; i < 4; ++i)
    header[4 + i] = static_cast<std::uint8_t>(datagram.sender >> 8 * i & 0xFF);
  header[1] = checkOf(header);
  out.append(reinterpret_cast<const char*>(header.data()), header.size());
  out.append(reinterpret_cast<const char*>(datagram.bytes.data()), datagram.bytes.size());
}

}  // namespace merlin
