#include "daemon/serve/vrpn_protocol.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>

#include "daemon/base/bytes.h"

namespace merlin::serve {
namespace {

constexpr std::size_t kHeader = 24;
constexpr std::string_view kMagic = "vrpn: ver. 07.38";

void appendBe32(std::string& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(v >> shift & 0xFF));
}
void appendBeDouble(std::string& out, double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  appendBe32(out, static_cast<std::uint32_t>(bits >> 32));
  appendBe32(out, static_cast<std::uint32_t>(bits));
}
std::uint32_t loadBe32(std::string_view bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v = v << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return v;
}
std::size_t padded(std::size_t payload) { return (payload + 7) / 8 * 8; }

}  // namespace

std::string vrpnCookie() {
  std::string cookie(kMagic);
  cookie += "  0";
  cookie.resize(kVrpnCookieLength);
  return cookie;
}

bool vrpnCookieFits(std::string_view cookie) {
  const auto major = kMagic.substr(0, kMagic.rfind('.') + 1);
  return cookie.size() == kVrpnCookieLength && cookie.starts_with(major);
}

std::string encodeVrpn(const VrpnMessage& m) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(kHeader + m.payload.size()));
  appendBe32(out, static_cast<std::uint32_t>(m.seconds));
  appendBe32(out, static_cast<std::uint32_t>(m.microseconds));
  appendBe32(out, static_cast<std::uint32_t>(m.sender));
  appendBe32(out, static_cast<std::uint32_t>(m.type));
  appendBe32(out, m.sequence);
  out += m.payload;
  out.resize(kHeader + padded(m.payload.size()));
  return out;
}

VrpnFront readVrpn(std::string_view input) {
  VrpnFront front;
  if (input.size() < kHeader) return front;
  const std::size_t length = loadBe32(input, 0);
  front.broken = length < kHeader || kHeader + padded(length - kHeader) > kVrpnLongest;
  if (front.broken) return front;
  const std::size_t whole = kHeader + padded(length - kHeader);
  if (input.size() < whole) return front;
  VrpnMessage m;
  m.seconds = static_cast<std::int32_t>(loadBe32(input, 4));
  m.microseconds = static_cast<std::int32_t>(loadBe32(input, 8));
  m.sender = static_cast<std::int32_t>(loadBe32(input, 12));
  m.type = static_cast<std::int32_t>(loadBe32(input, 16));
  m.sequence = loadBe32(input, 20);
  m.payload = input.substr(kHeader, length - kHeader);
  front.message = std::move(m);
  front.bytes = whole;
  return front;
}

std::string vrpnName(std::string_view name) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(name.size() + 1));
  out += name;
  out.push_back('\0');
  return out;
}

std::optional<std::string> readVrpnName(std::string_view payload) {
  if (payload.size() < 5) return std::nullopt;
  const std::size_t length = loadBe32(payload, 0);
  if (length < 1 || length > payload.size() - 4) return std::nullopt;
  return std::string(payload.substr(4, length - 1));
}

std::string vrpnPose(std::int32_t sensor, std::span<const float> p, std::span<const float> q) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(sensor));
  appendBe32(out, 0);
  for (const float v : p) appendBeDouble(out, static_cast<double>(v));
  for (const std::size_t i : {1U, 2U, 3U, 0U}) appendBeDouble(out, static_cast<double>(q[i]));
  return out;
}

std::string vrpnChannels(std::span<const double> channels) {
  std::string out;
  appendBeDouble(out, static_cast<double>(channels.size()));
  for (const double v : channels) appendBeDouble(out, v);
  return out;
}

std::string vrpnButton(std::int32_t button, bool down) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(button));
  appendBe32(out, down ? 1 : 0);
  return out;
}

std::string vrpnButtons(std::uint32_t down, std::int32_t count) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(count));
  for (std::int32_t i = 0; i < count; ++i) appendBe32(out, down >> i & 1);
  return out;
}

std::optional<VrpnCallback> readVrpnCallback(std::string_view datagram) {
  datagram = datagram.substr(0, datagram.find('\0'));
  const std::size_t blank = datagram.find(' ');
  if (blank == std::string_view::npos || blank == 0) return std::nullopt;
  const std::string_view host = datagram.substr(0, blank), number = datagram.substr(blank + 1);
  const bool plain = std::all_of(host.begin(), host.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.';
  });
  int port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  const bool whole = error == std::errc{} && end == number.data() + number.size();
  if (!plain || !whole || port < 1024 || port > 65535) return std::nullopt;
  return VrpnCallback{std::string(host), port};
}

}  // namespace merlin::serve
