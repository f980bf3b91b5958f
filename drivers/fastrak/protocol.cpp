#include "drivers/fastrak/protocol.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "daemon/base/bytes.h"

namespace merlin::fastrak {
namespace {

constexpr std::size_t kPosition = 3;
constexpr std::size_t kQuaternion = 15;
constexpr std::size_t kTerminator = kRecordLength - 1;

bool isErrorLetter(std::uint8_t c) noexcept {
  return c == ' ' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// The whole of `text` but blanks at its ends, as a number.
std::optional<int> number(std::string_view text, int base) noexcept {
  text = trimmed(text);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool isStation(char c) noexcept { return c >= '1' && c <= '4'; }

constexpr float kHalfScale = 8192;  // of the 14-bit form: 300 cm, 180 degrees, 1
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

// 14 bits, seven a byte, lower ones first.
void append14(std::string& out, std::span<const float> values, float full) {
  for (const float v : values) {
    const float counts = std::clamp(v / full * kHalfScale, -kHalfScale, kHalfScale - 1);
    const auto bits = static_cast<std::uint32_t>(std::lround(counts));
    out.push_back(static_cast<char>(bits & 0x7F));
    out.push_back(static_cast<char>(bits >> 7 & 0x7F));
  }
}

void appendItem(std::string& out, int item, const Record& record, const Form& form) {
  switch (item) {
    case 0: out += ' '; break;
    case 1: out += "\r\n"; break;
    case 2: appendNumbers(out, record.position, form.binary, 2); break;
    case 4: appendNumbers(out, anglesOf(record.orientation_wxyz), form.binary, 2); break;
    case 11: appendNumbers(out, record.orientation_wxyz, form.binary, 4); break;
    case 16: out += " 0"; break;
    case 18: append14(out, record.position, form.centimetres ? 300 : 118.110F); break;
    case 19: append14(out, anglesOf(record.orientation_wxyz), 180); break;
    case 20: append14(out, record.orientation_wxyz, 1); break;
    default: break;
  }
}

}  // namespace

void Parser::reset() noexcept {
  length_ = 0;
  locked_ = true;
}

std::optional<Record> Parser::feed(std::byte byte, std::int64_t received_ns) noexcept {
  window_[length_] = std::to_integer<std::uint8_t>(byte);
  received_ns_[length_] = received_ns;
  ++length_;
  while (!plausible()) drop();
  if (length_ < kRecordLength + (locked_ ? 0 : 1)) return std::nullopt;
  return take();
}

// Whether what has come so far can be a record. True of an empty window.
bool Parser::plausible() const noexcept {
  if (length_ > 0 && window_[0] != '0') return false;
  if (length_ > 1 && !isStation(static_cast<char>(window_[1]))) return false;
  if (length_ > 2 && !isErrorLetter(window_[2])) return false;
  if (length_ < kRecordLength) return true;
  if (window_[kTerminator] != ' ') return false;
  if (length_ > kRecordLength && window_[kRecordLength] != '0') return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(loadLeFloat(&window_[kPosition + 4 * i]))) return false;
  }
  float square = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const float q = loadLeFloat(&window_[kQuaternion + 4 * i]);
    square += q * q;
  }
  return square >= 0.98F * 0.98F && square <= 1.02F * 1.02F;  // false of a NaN
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
  for (std::size_t i = 0; i < 3; ++i) {
    record.position[i] = loadLeFloat(&window_[kPosition + 4 * i]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    record.orientation_wxyz[i] = loadLeFloat(&window_[kQuaternion + 4 * i]);
  }
  record.received_ns = received_ns_[0];
  locked_ = true;
  shift(kRecordLength);
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
  constexpr int kItems[] = {0, 1, 2, 4, 11, 16, 18, 19, 20};
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
    marked = true;  // only the first 16-bit byte of a record has the bit
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

}  // namespace merlin::fastrak
