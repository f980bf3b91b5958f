#include "daemon/serve/spnav_protocol.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace merlin::serve {
namespace {

constexpr std::uint32_t kHandshake = 0x7FAA5500, kHandshakeMask = 0xFFFFFF00;
constexpr std::uint32_t kRequestMask = 0xFFFF0000;
constexpr std::uint32_t kMotion = 1, kButton = 2, kDevice = 4, kRawAxis = 0x10, kRawButton = 0x20;
constexpr std::int32_t kFailed = -1;
constexpr std::size_t kChunk = 24;  // bytes of text per answer

enum Request : std::uint32_t {
  kSetName = 0x1000,
  kSetSensitivity,
  kGetSensitivity,
  kSetMask,
  kGetMask,
  kDeviceName = 0x2000,
  kDevicePath,
  kDeviceAxes,
  kDeviceButtons,
  kDeviceUsb,
  kDeviceType,
  // Configuration: the request before each of these sets the same value.
  kGetSensitivityOfAll = 0x3001,
  kGetSensitivityOfAxes = 0x3003,
  kGetDeadZone = 0x3005,
  kGetInverted = 0x3007,
  kGetAxisMap = 0x3009,
  kGetButtonMap = 0x300B,
  kGetButtonAction = 0x300D,
  kGetKeyMap = 0x300F,
  kGetSwapYZ = 0x3011,
  kGetLed = 0x3013,
  kGetGrab = 0x3015,
  kSetSerialDevice = 0x3016,
  kGetSerialDevice = 0x3017,
  kGetRepeat = 0x3019,
};

template <std::size_t N>
void append(std::string& out, const std::array<std::int32_t, N>& words) {
  out.append(reinterpret_cast<const char*>(words.data()), sizeof words);
}

}  // namespace

SpnavDevice spnavDevice(std::string_view identity, std::string_view port) {
  SpnavDevice device;
  if (!identity.empty()) device.name = identity.substr(0, identity.find(','));
  if (const auto path = port.substr(std::min(port.size(), port.find(':') + 1));
      path.starts_with('/') && !path.starts_with("//"))
    device.path = path;
  struct KnownModel {
    const char* model;
    int type, buttons;
  };
  // Buttons are numbered as in drivers/spaceball: button 9 of a 2003 is pick, button 3 of a 3003 is
  // rezero.
  constexpr KnownModel kModels[] = {
      {"1003", 0x100, 9}, {"2003", 0x100, 9}, {"3003", 0x101, 3}, {"4000", 0x102, 12}};
  for (const KnownModel& known : kModels) {
    if (device.name.find(known.model) == std::string::npos) continue;
    device.type = known.type;
    device.buttons = known.buttons;
  }
  return device;
}

SpnavClient::Taken SpnavClient::receive(std::string_view input, std::size_t most,
                                        std::string& out) {
  Taken taken;
  const std::size_t before = out.size();
  for (; taken.messages < most; ++taken.messages) {
    const std::string_view rest = input.substr(taken.bytes);
    Words words{};
    const std::size_t size = version_ > 0 ? sizeof words : 4;
    if (rest.size() < size) break;
    std::memcpy(words.data(), rest.data(), size);
    taken.bytes += size;
    const auto first = static_cast<std::uint32_t>(words[0]);
    if (version_ > 0) {
      request(words, out);
    } else if ((first & kHandshakeMask) == kHandshake) {
      version_ = std::min<int>(static_cast<int>(first & 0xFF), 1);
      append(out, std::array{static_cast<std::int32_t>(kHandshake | unsigned(version_))});
    } else if (const auto s = std::bit_cast<float>(first); std::isfinite(s)) {
      sensitivity_ = s;
    }
  }
  taken.answered = out.size() > before;
  return taken;
}

void SpnavClient::request(Words words, std::string& out) {
  const auto number = static_cast<std::uint32_t>(words[0]) & ~kRequestMask;
  const std::int32_t argument = words[1];
  std::fill(words.begin() + 1, words.end(), 0);
  switch (number) {
    case kSetName:
    case kSetSerialDevice: return;  // these have no answer
    case kSetSensitivity:
      if (const auto s = std::bit_cast<float>(argument); std::isfinite(s))
        sensitivity_ = s;
      else
        words[7] = kFailed;
      break;
    case kGetSensitivity: words[1] = std::bit_cast<std::int32_t>(sensitivity_); break;
    case kSetMask: mask_ = static_cast<std::uint32_t>(argument); break;
    case kGetMask: words[1] = static_cast<std::int32_t>(mask_); break;
    case kDeviceName: return sendText(words[0], device_.name, out);
    case kDevicePath: return sendText(words[0], device_.path, out);
    case kDeviceAxes: words[1] = 6; break;
    case kDeviceButtons: words[1] = device_.buttons; break;
    case kDeviceType: words[1] = device_.type; break;
    case kGetSerialDevice: return sendText(words[0], device_.path, out);
    default:  // also kDeviceUsb: the ball is not a USB device
      words[1] = argument;
      if (!configuration(number, words)) words[7] = kFailed;
  }
  append(out, words);
}

// Answers a query of spacenavd's configuration: MERLIN passes on everything as the device sends it.
// `words[1]` is the axis or button of the query. False for an unknown query and for requests that
// set something, because the ball is configured in MERLIN.
bool SpnavClient::configuration(std::uint32_t number, Words& words) const {
  constexpr auto kOne = std::bit_cast<std::int32_t>(1.0F);
  const std::int32_t of = std::exchange(words[1], 0);
  const bool axis = of >= 0 && of < 6, button = of >= 0 && of < device_.buttons;
  const auto answer = [&](bool fits, std::int32_t value) {
    words[1] = of;
    words[2] = value;
    return fits;
  };
  switch (number) {
    case kGetSensitivityOfAll: words[1] = kOne; return true;
    case kGetSensitivityOfAxes: std::fill(words.begin() + 1, words.begin() + 7, kOne); return true;
    case kGetDeadZone: return answer(axis, 0);
    case kGetAxisMap: return answer(axis, of);
    case kGetButtonMap: return answer(button, of);
    case kGetButtonAction:
    case kGetKeyMap: return answer(button, 0);
    case kGetInverted:
    case kGetSwapYZ:
    case kGetLed:
    case kGetGrab: return true;
    case kGetRepeat: words[1] = -1; return true;  // no key repeat
    default: return false;
  }
}

// Sends a text in answers of 24 bytes; the last word has the number of bytes left and, from the
// second answer on, a flag for a continuation.
void SpnavClient::sendText(std::int32_t request, const std::string& text, std::string& out) const {
  for (std::size_t at = 0; at == 0 || at < text.size(); at += kChunk) {
    Words words{};
    words[0] = request;
    const std::size_t left = text.size() - at;
    std::memcpy(&words[1], text.data() + at, std::min(left, kChunk));
    words[7] = static_cast<std::int32_t>(left | (at > 0 ? 0x10000 : 0));
    append(out, words);
  }
}

void SpnavClient::sample(const BallSample& s, bool motion, std::string& out) {
  for (std::uint32_t i = 0; i < 32; ++i) {
    const std::uint32_t bit = 1U << i;
    if (!((s.buttons ^ buttons_) & bit) || !(mask_ & kButton)) continue;
    const bool down = s.buttons & bit;
    append(out, Words{down ? 1 : 2, static_cast<std::int32_t>(i), down ? 1 : 0});
  }
  sendRaw(s, out);
  buttons_ = s.buttons;
  const bool moves = std::any_of(std::begin(s.raw), std::end(s.raw), [](auto v) { return v != 0; });
  if (motion && (moves || moving_) && (mask_ & kMotion)) {
    Words words{0};
    for (std::size_t i = 0; i < 6; ++i) {
      const float scaled = std::clamp(sensitivity_ * static_cast<float>(s.raw[i]), -1e9F, 1e9F);
      words[1 + i] = static_cast<std::int32_t>(std::lround(scaled));
    }
    words[7] = static_cast<std::int32_t>(s.period_us / 1000);
    append(out, words);
    moving_ = moves;
  }
}

// Appends raw axis and raw button events for a client whose mask requests them.
void SpnavClient::sendRaw(const BallSample& s, std::string& out) {
  for (std::int32_t i = 0; i < 6 && (mask_ & kRawAxis); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (s.raw[at] != axes_[at]) append(out, Words{5, i, s.raw[at]});
  }
  for (std::int32_t i = 0; i < 32 && (mask_ & kRawButton); ++i) {
    if ((s.buttons ^ buttons_) >> i & 1)
      append(out, Words{6, i, static_cast<std::int32_t>(s.buttons >> i & 1)});
  }
  std::copy(std::begin(s.raw), std::end(s.raw), axes_.begin());
}

void SpnavClient::device(bool there, const SpnavDevice& device, std::string& out) {
  device_ = device;
  if (version_ < 1 || !(mask_ & kDevice)) return;
  append(out, Words{3, there ? 0 : 1, 0, device_.type});
}

}  // namespace merlin::serve
