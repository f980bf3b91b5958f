#include "drivers/fastrak/protocol.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "daemon/base/bytes.h"

namespace merlin::fastrak {
namespace {

constexpr std::size_t kPosition = 3;  // index of the position, after '0', station and error
constexpr std::size_t kTextWidth = 7;
// Greatest accepted azimuth, elevation or roll, with a margin for rounding.
constexpr float kWidest_deg = 180.5F;

bool isErrorLetter(std::uint8_t c) noexcept {
  return c == ' ' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// Parses all of `text`, except blanks at its ends, as a number.
std::optional<int> number(std::string_view text, int base) noexcept {
  text = trimmed(text);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool isStation(char c) noexcept { return c >= '1' && c <= '4'; }

constexpr float kHalfScale = 8192;  // a 14-bit number's counts for 300 cm, 180 degrees or 1
constexpr std::uint8_t kPhase = 0x80;

void appendNumbers(std::string& out, std::span<const float> values, bool binary, int decimals) {
  for (const float v : values) {
    if (binary) {
      appendLeFloat(out, v);
    } else {
      out += fmt::format("{:7.{}f}", v, decimals);
    }
  }
}

float shortRange(bool centimetres) noexcept { return centimetres ? 300 : 118.110F; }

// Parses a decimal number of kTextWidth characters that begins with a sign or a blank.
bool readDecimal(const std::uint8_t* at, float& value) noexcept {
  const char* first = reinterpret_cast<const char*>(at);
  const char* const end = first + kTextWidth;
  while (first != end && (*first == ' ' || *first == '+')) ++first;
  const auto parsed = std::from_chars(first, end, value, std::chars_format::fixed);
  return parsed.ec == std::errc{} && parsed.ptr == end;
}

// Reads a 14-bit number in two's complement: seven bits per byte, the lower ones first.
float load14(const std::uint8_t* at) noexcept {
  const int bits = (at[0] & 0x7F) | (at[1] & 0x7F) << 7;
  return static_cast<float>(bits >= 8192 ? bits - 16384 : bits);
}

// Appends 14-bit numbers: seven bits per byte, the lower ones first. `full`: full scale.
void append14(std::string& out, std::span<const float> values, float full) {
  for (const float v : values) {
    const float counts = std::clamp(v / full * kHalfScale, -kHalfScale, kHalfScale - 1);
    const auto bits = static_cast<std::uint32_t>(std::lround(counts));
    out.push_back(static_cast<char>(bits & 0x7F));
    out.push_back(static_cast<char>(bits >> 7 & 0x7F));
  }
}

// Returns column `i` of the rotation matrix, which is the direction of the receiver's axis i.
std::array<float, 3> axisOf(const std::array<float, 4>& q, int i) noexcept {
  const auto [w, x, y, z] = q;
  if (i == 0) return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  if (i == 1) return {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
}

void appendItem(std::string& out, int item, const Record& record, const Form& form) {
  switch (item) {
    case 0: out += ' '; break;
    case 1: out += "\r\n"; break;
    case 2: appendNumbers(out, record.position, form.binary, 2); break;
    case 4: appendNumbers(out, anglesOf(record.orientation_wxyz), form.binary, 2); break;
    case 11: appendNumbers(out, record.orientation_wxyz, form.binary, 4); break;
    case 5:
    case 6:
    case 7: appendNumbers(out, axisOf(record.orientation_wxyz, item - 5), form.binary, 4); break;
    case 16: out += record.stylus ? " 1" : " 0"; break;
    case 18: append14(out, record.position, shortRange(form.centimetres)); break;
    case 19: append14(out, anglesOf(record.orientation_wxyz), 180); break;
    case 20: append14(out, record.orientation_wxyz, 1); break;
    default: break;
  }
}

}  // namespace

std::size_t Layout::length() const noexcept {
  const std::size_t count = angles ? 6 : 7;
  const std::size_t width = numbers == Numbers::kBinary ? 4
                            : numbers == Numbers::kText ? kTextWidth
                                                        : 2;
  return kPosition + count * width + (stylus ? 2 : 0) + 1;
}

std::string Layout::items() const {
  const bool small = numbers == Numbers::kShort;
  const char* orientation = angles ? (small ? "19" : "4") : (small ? "20" : "11");
  return fmt::format("{},{},{}0", small ? "18" : "2", orientation, stylus ? "16," : "");
}

void Parser::reset() noexcept {
  length_ = 0;
  locked_ = true;
}

void Parser::expect(const Layout& layout) noexcept {
  layout_ = layout;
  record_length_ = layout.length();
  reset();
}

std::optional<Record> Parser::feed(std::byte byte, std::int64_t received_ns) noexcept {
  window_[length_] = std::to_integer<std::uint8_t>(byte);
  received_ns_[length_] = received_ns;
  ++length_;
  while (!plausible()) drop();
  if (length_ < record_length_ + (locked_ ? 0 : 1)) return std::nullopt;
  return take();
}

// Returns whether the window is a record or may be the beginning of one; true if it is empty.
bool Parser::plausible() const noexcept {
  if (length_ > 0 && window_[0] != '0') return false;
  if (length_ > 1 && !isStation(static_cast<char>(window_[1]))) return false;
  if (length_ > 2 && !isErrorLetter(window_[2])) return false;
  if (length_ < record_length_) return true;
  if (window_[record_length_ - 1] != ' ') return false;
  if (length_ > record_length_ && window_[record_length_] != '0') return false;
  Record record;
  return readNumbers(record);
}

bool Parser::readNumbers(Record& record) const noexcept {
  std::array<float, 7> v{};
  const std::size_t count = layout_.angles ? 6 : 7;
  const std::uint8_t* at = &window_[kPosition];
  for (std::size_t i = 0; i < count; ++i) {
    switch (layout_.numbers) {
      case Layout::Numbers::kBinary:
        v[i] = loadLeFloat(at);
        at += 4;
        break;
      case Layout::Numbers::kText: {
        if (!readDecimal(at, v[i])) return false;
        at += kTextWidth;
        break;
      }
      case Layout::Numbers::kShort: {
        if (((at[0] & kPhase) != 0) != (i == 0) || (at[1] & kPhase) != 0) return false;
        const float full = i < 3 ? shortRange(layout_.centimetres) : layout_.angles ? 180.0F : 1.0F;
        v[i] = load14(at) / kHalfScale * full;
        at += 2;
      }
    }
    if (i < 3 && !(std::abs(v[i]) <= layout_.furthest)) return false;  // also rejects NaN
  }
  if (layout_.stylus) {
    if (at[0] != ' ' || (at[1] != '0' && at[1] != '1')) return false;
    record.stylus = at[1] == '1';
  }
  std::copy_n(v.begin(), 3, record.position.begin());
  if (layout_.angles) {
    record.orientation_wxyz = quaternionOf({v[3], v[4], v[5]});
    return std::abs(v[3]) <= kWidest_deg && std::abs(v[4]) <= kWidest_deg &&
           std::abs(v[5]) <= kWidest_deg;  // false if NaN
  }
  std::copy_n(v.begin() + 3, 4, record.orientation_wxyz.begin());
  const float square = v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6];
  return square >= 0.98F * 0.98F && square <= 1.02F * 1.02F;  // false if NaN
}

void Parser::drop() noexcept {
  bad_packets_ += locked_ ? 1 : 0;
  locked_ = false;
  ++bad_bytes_;
  shift(1);
}

// REQUIRES: a whole record at the window's start.
Record Parser::take() noexcept {
  Record record;
  record.station = window_[1] - '0';
  record.error = static_cast<char>(window_[2]);
  (void)readNumbers(record);
  record.received_ns = received_ns_[0];
  locked_ = true;
  shift(record_length_);
  return record;
}

void Parser::shift(std::size_t count) noexcept {
  const auto n = static_cast<std::ptrdiff_t>(count);
  std::copy(window_.begin() + n, window_.end(), window_.begin());
  std::copy(received_ns_.begin() + n, received_ns_.end(), received_ns_.begin());
  length_ -= count;
}

std::optional<Status> parseStatus(std::string_view reply) {
  if (reply.size() != kStatusLength || reply[0] != '2' || !isStation(reply[1]) || reply[2] != 'S' ||
      !reply.ends_with("\r\n")) {
    return std::nullopt;
  }
  const auto flags = number(reply.substr(3, 3), 16);
  if (!flags) return std::nullopt;
  const std::string_view test = reply.substr(6, 3);
  const auto test_error = trimmed(test).empty() ? 0 : number(test, 10);
  if (!test_error) return std::nullopt;
  Status status;
  status.binary = *flags & 1;
  status.centimetres = *flags & 2;
  status.compensation = *flags & 4;
  status.continuous = *flags & 8;
  status.test_error = *test_error;
  status.firmware = trimmed(reply.substr(15, 6));
  status.configuration = trimmed(reply.substr(21, 32));
  return status;
}

std::optional<Stations> parseStations(std::string_view reply) noexcept {
  if (reply.size() != kStationsLength || reply[0] != '2' || !isStation(reply[1]) ||
      reply[2] != 'l' || !reply.ends_with("\r\n")) {
    return std::nullopt;
  }
  Stations stations{};
  for (std::size_t i = 0; i < kStations; ++i) {
    const char c = reply[3 + i];
    if (c != '0' && c != '1') return std::nullopt;
    stations[i] = c == '1';
  }
  return stations;
}

bool isItem(int item) noexcept {
  constexpr int kItems[] = {0, 1, 2, 4, 5, 6, 7, 11, 16, 18, 19, 20};
  return std::find(std::begin(kItems), std::end(kItems), item) != std::end(kItems);
}

std::string encode(const Record& record, std::span<const int> items, const Form& form) {
  std::string out = {'0', static_cast<char>('0' + record.station), record.error};
  bool marked = false;
  for (const int item : items) {
    const std::size_t at = out.size();
    appendItem(out, item, record, form);
    if (item < 18 || marked) continue;
    out[at] = static_cast<char>(static_cast<std::uint8_t>(out[at]) | kPhase);
    marked = true;  // only the first byte of a record's 14-bit numbers
  }
  return out;
}

std::string encode(const Status& status) {
  const int flags = 0x3F0 | (status.binary ? 1 : 0) | (status.centimetres ? 2 : 0) |
                    (status.compensation ? 4 : 0) | (status.continuous ? 8 : 0);
  return fmt::format("21S{:03X}{:3}      {:>6.6}{:32.32}\r\n", flags, status.test_error,
                     status.firmware, status.configuration);
}

std::string encode(const Stations& stations, int asked_station) {
  std::string out = fmt::format("2{}l", asked_station);
  for (const bool active : stations) out += active ? '1' : '0';
  return out + "\r\n";
}

std::array<float, 3> anglesOf(const std::array<float, 4>& q) noexcept {
  const auto [w, x, y, z] = q;
  const float degrees = 180 / std::numbers::pi_v<float>;
  return {degrees * std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
          degrees * std::asin(std::clamp(2 * (w * y - z * x), -1.0F, 1.0F)),
          degrees * std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))};
}

std::array<float, 4> quaternionOf(const std::array<float, 3>& angles_deg) noexcept {
  std::array<float, 3> c{}, s{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float half = angles_deg[i] * std::numbers::pi_v<float> / 360;
    c[i] = std::cos(half);
    s[i] = std::sin(half);
  }
  return {c[0] * c[1] * c[2] + s[0] * s[1] * s[2], c[0] * c[1] * s[2] - s[0] * s[1] * c[2],
          c[0] * s[1] * c[2] + s[0] * c[1] * s[2], s[0] * c[1] * c[2] - c[0] * s[1] * s[2]};
}

std::string_view meaningOf(char error) noexcept {
  if (error >= 'a' && error <= 'c') return "fault of a transmitter driver";
  if (error >= 'd' && error <= 'f') return "fault of a receiver's gain";
  switch (error) {
    case 'g': return "fault of a coil";
    case 'j': return "receiver too near: saturated";
    case 'k': return "receiver too far or unplugged: low signal";
    case 'l': return "a receiver without a signal";
    case 'm': return "wrong memory checksum";
    case 's': return "unit vector reset";
    case 't':
    case 'u': return "compensation";
    case 'v': return "no synchronisation";
    case 'w': return "fault while writing its memory";
    case 'x': return "outside the motion box";
    case 'y': return "outside the angles allowed";
    default: return "";
  }
}

}  // namespace merlin::fastrak
