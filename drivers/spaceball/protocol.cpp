#include "drivers/spaceball/protocol.h"

#include <algorithm>

#include "daemon/base/bytes.h"

namespace merlin::spaceball {
namespace {

constexpr std::uint8_t kCarriageReturn = 0x0D;
constexpr std::uint8_t kLineFeed = 0x0A;
constexpr std::uint8_t kXon = 0x11;
constexpr std::uint8_t kXoff = 0x13;

constexpr std::size_t kDisplacementLength = 15;  // 'D' + period + 6 axes
constexpr std::size_t kKeysLength = 3;

// Letters that start a reply or the banner; any other letter at a packet's start means damage.
constexpr std::string_view kReplies = "@CEFMNPZHQBSYA?-\"%cR";

// Returns the byte for which `^c` stands; nothing if the device never sends `^c`.
std::optional<std::uint8_t> unescape(std::uint8_t c) noexcept {
  switch (c) {
    case 'M': return kCarriageReturn;
    case 'Q': return kXon;
    case 'S': return kXoff;
    case '^': return '^';
    default: return std::nullopt;
  }
}

void appendEscaped(std::string& out, std::uint8_t c) {
  switch (c) {
    case kCarriageReturn: out += "^M"; break;
    case kXon: out += "^Q"; break;
    case kXoff: out += "^S"; break;
    case '^': out += "^^"; break;
    default: out.push_back(static_cast<char>(c));
  }
}

std::string packet(const std::string& plain) {
  std::string out;
  for (const char c : plain) appendEscaped(out, static_cast<std::uint8_t>(c));
  return out + '\r';
}

}  // namespace

std::optional<Packet> Parser::feed(std::byte byte) noexcept {
  auto c = std::to_integer<std::uint8_t>(byte);
  if (c == kCarriageReturn) return finish();
  if (c == kXon || c == kXoff) return std::nullopt;
  if (c == kLineFeed && length_ == 0 && !escaped_) return std::nullopt;  // the banner's CR LF
  if (!escaped_ && c == '^') {
    escaped_ = true;
    return std::nullopt;
  }
  if (escaped_) {
    escaped_ = false;
    const auto plain = unescape(c);
    bad_ |= !plain;
    c = plain.value_or(0);
  }
  if (length_ < kLongest) payload_[length_] = c;
  ++length_;
  return std::nullopt;
}

std::optional<Packet> Parser::finish() noexcept {
  const bool damaged = bad_ || escaped_ || length_ > kLongest;
  std::optional<Packet> packet;
  if (!damaged && length_ > 0) packet = read();
  if (!packet && (length_ > 0 || damaged)) {
    ++bad_packets_;
    bad_bytes_ += length_ + 1;
  }
  length_ = 0;
  escaped_ = bad_ = false;
  return packet;
}

// REQUIRES: 0 < length_ <= kLongest.
std::optional<Packet> Parser::read() const noexcept {
  switch (payload_[0]) {
    case 'D': {
      if (length_ != kDisplacementLength) return std::nullopt;
      Displacement d;
      d.period = loadBe16(&payload_[1]);
      for (std::size_t i = 0; i < d.axes.size(); ++i) {
        d.axes[i] = static_cast<std::int16_t>(loadBe16(&payload_[3 + 2 * i]));
      }
      return d;
    }
    case 'K':
    case '.':
      // Both data bytes carry 01 in bits 7..6 (a '.' packet's second has button 7 in bit 7).
      if (length_ != kKeysLength || (payload_[1] & 0xC0) != 0x40 || !(payload_[2] & 0x40)) {
        return std::nullopt;
      }
      if (payload_[0] == 'K' && (payload_[2] & 0x80)) return std::nullopt;
      return Keys{payload_[0] == '.', payload_[1], payload_[2]};
    default:
      if (kReplies.find(static_cast<char>(payload_[0])) == std::string_view::npos) {
        return std::nullopt;
      }
      return Text{{reinterpret_cast<const char*>(payload_.data()), length_}};
  }
}

Model modelOf(std::string_view firmware_version) noexcept {
  for (const char* v : {"2.35", "2.62", "2.63"}) {
    if (firmware_version == v) return Model::k3003;
  }
  for (const char* v : {"2.43", "2.45"}) {
    if (firmware_version == v) return Model::k4000;
  }
  return firmware_version == "2.02" ? Model::k1003 : Model::k2003;
}

const char* meaningOf(std::string_view packet) noexcept {
  constexpr const char* kErrors[] = {"reports a fault of its sensor chip",
                                     "reports a wrong checksum of its memory",
                                     "reports that its sensor chip does not answer",
                                     "reports that it could not send in time",
                                     "reports an overflow of its receive buffer",
                                     "reports a receive error",
                                     "",
                                     "reports a command that is too long",
                                     "reports that it ignored a command",
                                     "reports an unknown command"};
  if (packet.size() < 3) return "reports an error";
  const unsigned bits =
      (static_cast<unsigned>(packet[2]) & 0x3F) | (static_cast<unsigned>(packet[1]) & 0x07) << 7;
  for (unsigned i = 0; i < std::size(kErrors); ++i) {
    if (bits >> i & 1) return kErrors[i];
  }
  return "";
}

const char* nameOf(Model model) noexcept {
  switch (model) {
    case Model::k2003: return "Spaceball 2003";
    case Model::k3003: return "Spaceball 3003";
    case Model::k4000: return "Spaceball 4000 FLX";
    case Model::k1003: return "Spaceball 1003";
  }
  return "Spaceball";
}

std::uint32_t buttonsOf(const Keys& keys, Model model) noexcept {
  const std::uint32_t b1 = keys.b1, b2 = keys.b2;
  if (keys.flx) return (b2 & 0x3F) | (b2 & 0x80) >> 1 | (b1 & 0x1F) << 7;
  if (model == Model::k3003) return (b2 >> 4 & 3) | (b1 >> 5 & 1) << 2;
  return (b2 & 0x0F) | (b1 & 0x1F) << 4;
}

std::string encode(const Displacement& d) {
  std::string plain = "D";
  appendBe16(plain, d.period);
  for (const std::int16_t axis : d.axes) appendBe16(plain, static_cast<std::uint16_t>(axis));
  return packet(plain);
}

std::string encodeKeys(std::uint32_t buttons, Model model) {
  std::uint32_t b1 = 0x40, b2 = 0x40;
  if (model == Model::k4000) {
    b1 |= 0x20 | (buttons >> 7 & 0x1F);  // 0x20: right-handed
    b2 |= (buttons & 0x3F) | (buttons & 0x40) << 1;
  } else if (model == Model::k3003) {
    b1 |= (buttons >> 2 & 1) << 5;
    b2 |= (buttons & 3) << 4;
  } else {
    b1 |= buttons >> 4 & 0x1F;
    b2 |= buttons & 0x0F;
  }
  return packet({model == Model::k4000 ? '.' : 'K', static_cast<char>(b1), static_cast<char>(b2)});
}

}  // namespace merlin::spaceball
