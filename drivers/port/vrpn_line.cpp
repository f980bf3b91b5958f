#include "drivers/port/vrpn_line.h"

#include <cmath>

#include "daemon/base/bytes.h"

namespace merlin {
namespace {

constexpr std::string_view kMagic = "vrpn: ver. 07.38";
constexpr std::size_t kMajor = kMagic.rfind('.') + 1;  // length of the part that must agree
constexpr std::size_t kPoseLength = 64;

std::uint32_t loadU32(std::string_view bytes, std::size_t at) noexcept {
  return loadBe32(reinterpret_cast<const std::uint8_t*>(bytes.data()) + at);
}
std::int32_t loadI32(std::string_view bytes, std::size_t at) noexcept {
  return static_cast<std::int32_t>(loadU32(bytes, at));
}
double loadDouble(std::string_view bytes, std::size_t at) noexcept {
  return loadBeDouble(reinterpret_cast<const std::uint8_t*>(bytes.data()) + at);
}
std::size_t padded(std::size_t payload) noexcept { return (payload + 7) / 8 * 8; }

// Interprets VRPN's codes for the state of a button.
bool isDown(std::int32_t state) noexcept {
  constexpr std::int32_t kOn = 1, kToggleOn = 21;
  return state == kOn || state == kToggleOn;
}

}  // namespace

std::string vrpnCookie() {
  std::string cookie(kMagic);
  cookie += "  0";
  cookie.resize(kVrpnCookieLength);
  return cookie;
}

bool vrpnCookieFits(std::string_view cookie) {
  return cookie.size() == kVrpnCookieLength && cookie.starts_with(kMagic.substr(0, kMajor));
}

std::string_view vrpnVersion(std::string_view cookie) {
  constexpr std::size_t kAt = kMagic.rfind(' ') + 1;
  return cookie.substr(kAt, kMagic.size() - kAt);
}

void appendVrpn(const VrpnHeader& header, std::string_view payload, std::string& out) {
  const std::size_t end = out.size() + kVrpnHeaderLength + padded(payload.size());
  appendBe32(out, static_cast<std::uint32_t>(kVrpnHeaderLength + payload.size()));
  appendBe32(out, static_cast<std::uint32_t>(header.seconds));
  appendBe32(out, static_cast<std::uint32_t>(header.microseconds));
  appendBe32(out, static_cast<std::uint32_t>(header.sender));
  appendBe32(out, static_cast<std::uint32_t>(header.type));
  appendBe32(out, header.sequence);
  out += payload;
  out.resize(end);
}

VrpnStart readVrpnStart(std::string_view bytes) noexcept {
  VrpnStart start;
  const std::int32_t length = loadI32(bytes, 0);
  if (length < static_cast<std::int32_t>(kVrpnHeaderLength)) return start;
  start.header.seconds = loadI32(bytes, 4);
  start.header.microseconds = loadI32(bytes, 8);
  start.header.sender = loadI32(bytes, 12);
  start.header.type = loadI32(bytes, 16);
  start.header.sequence = loadU32(bytes, 20);
  start.payload = static_cast<std::size_t>(length) - kVrpnHeaderLength;
  start.bytes = kVrpnHeaderLength + padded(start.payload);
  return start;
}

std::string vrpnName(std::string_view name) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(name.size() + 1));
  out += name;
  out.push_back('\0');
  return out;
}

std::optional<std::string_view> readVrpnName(std::string_view payload) noexcept {
  if (payload.size() < 5) return std::nullopt;
  const std::size_t length = loadU32(payload, 0);
  if (length < 1 || length > payload.size() - 4) return std::nullopt;
  return payload.substr(4, length - 1);
}

std::string vrpnPose(std::int32_t sensor, std::span<const float> p, std::span<const float> q) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(sensor));
  appendBe32(out, 0);
  for (const float v : p) appendBeDouble(out, static_cast<double>(v));
  for (const std::size_t i : {1U, 2U, 3U, 0U}) appendBeDouble(out, static_cast<double>(q[i]));
  return out;
}

std::optional<VrpnPose> readVrpnPose(std::string_view payload) noexcept {
  if (payload.size() != kPoseLength) return std::nullopt;
  VrpnPose pose;
  pose.sensor = loadI32(payload, 0);
  for (std::size_t i = 0; i < 3; ++i) pose.position[i] = loadDouble(payload, 8 + 8 * i);
  for (std::size_t i = 0; i < 4; ++i)
    pose.orientation_wxyz[(i + 1) % 4] = loadDouble(payload, 32 + 8 * i);  // x y z w on the wire
  return pose;
}

std::string vrpnButton(std::int32_t button, bool down) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(button));
  appendBe32(out, down ? 1 : 0);
  return out;
}

std::optional<VrpnButton> readVrpnButton(std::string_view payload) noexcept {
  if (payload.size() != 8) return std::nullopt;
  const std::size_t button = loadU32(payload, 0);
  if (button >= kVrpnButtons) return std::nullopt;
  return VrpnButton{button, isDown(loadI32(payload, 4))};
}

std::string vrpnButtons(std::uint32_t down, std::int32_t count) {
  std::string out;
  appendBe32(out, static_cast<std::uint32_t>(count));
  for (std::int32_t i = 0; i < count; ++i) appendBe32(out, down >> i & 1);
  return out;
}

std::optional<VrpnButtons> readVrpnButtons(std::string_view payload) noexcept {
  if (payload.size() < 4) return std::nullopt;
  VrpnButtons buttons;
  buttons.count = loadU32(payload, 0);
  if (buttons.count > kVrpnButtons || payload.size() != 4 + 4 * buttons.count) return std::nullopt;
  for (std::size_t i = 0; i < buttons.count; ++i)
    buttons.down[i] = isDown(loadI32(payload, 4 + 4 * i));
  return buttons;
}

std::string vrpnChannels(std::span<const double> channels) {
  std::string out;
  appendBeDouble(out, static_cast<double>(channels.size()));
  for (const double v : channels) appendBeDouble(out, v);
  return out;
}

// The number of channels is sent as a double; the payload is valid only if its length agrees with
// it.
std::optional<VrpnChannels> readVrpnChannels(std::string_view payload) noexcept {
  if (payload.size() < 8 || payload.size() % 8 != 0) return std::nullopt;
  VrpnChannels channels;
  channels.count = payload.size() / 8 - 1;
  const bool fits = loadDouble(payload, 0) == static_cast<double>(channels.count);
  if (channels.count > kVrpnChannels || !fits) return std::nullopt;
  for (std::size_t i = 0; i < channels.count; ++i) {
    channels.value[i] = loadDouble(payload, 8 + 8 * i);
    if (!std::isfinite(channels.value[i])) return std::nullopt;
  }
  return channels;
}

}  // namespace merlin
