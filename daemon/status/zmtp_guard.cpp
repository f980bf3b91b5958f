#include "daemon/status/zmtp_guard.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::status {
namespace {

constexpr std::size_t kGreeting = 64, kVersionAt = 10, kSignatureEnd = 9;
constexpr std::uint8_t kMore = 1, kLong = 2, kCommand = 4;
constexpr std::size_t kMechanismAt = 12;
constexpr std::string_view kCurve{"CURVE\0", 6};
constexpr std::string_view kReady = "\5READY";
// Sizes of the bodies of PING and PONG encrypted by CURVE: an 8-byte name, an 8-byte nonce, a
// 16-byte authenticator and a byte of flags before the 7 and 5 bytes of PING and PONG.
constexpr std::uint64_t kCurvePing = 40, kCurvePong = 38;

Error malformed(std::string what) { return {Errc::kMalformed, std::move(what)}; }

std::uint64_t lengthIn(std::string_view header) {
  std::uint64_t length = 0;
  for (const char c : header.substr(1)) length = length << 8 | static_cast<std::uint8_t>(c);
  return length;
}

}  // namespace

Result<ZmtpGuard::Accepted> ZmtpGuard::follow(std::string_view input, std::size_t most) {
  Accepted accepted;
  while (accepted.bytes < input.size()) {
    const auto byte = static_cast<std::uint8_t>(input[accepted.bytes]);
    if (greeting_ < kGreeting) {
      if (const auto greeted = greet(byte); !greeted) return greeted.error();
      ++accepted.bytes;
    } else if (in_body_) {
      const auto rest = input.substr(accepted.bytes);
      const std::size_t n = std::min<std::size_t>(rest.size(), body_left_);
      if (command_ && name_.size() < kReady.size())
        name_ += rest.substr(0, std::min(n, kReady.size() - name_.size()));
      body_left_ -= n;
      accepted.bytes += n;
      if (body_left_ > 0) continue;
      if (const auto ended = endFrame(); !ended) return ended.error();
    } else {
      if (header_.empty() && accepted.frames == most) break;
      if (header_.empty()) ++accepted.frames;
      header_ += static_cast<char>(byte);
      ++accepted.bytes;
      if (const auto begun = begin(); !begun) return begun.error();
    }
  }
  return accepted;
}

Result<Ok> ZmtpGuard::greet(std::uint8_t byte) {
  const std::size_t at = greeting_++;
  const bool signature = (at == 0 && byte != 0xFF) || (at == kSignatureEnd && byte != 0x7F);
  if (signature || (at == kVersionAt && byte < 3))
    return malformed("it does not begin with a greeting of ZMTP 3 (ZeroMQ 4 or newer)");
  if (at >= kMechanismAt && at < kMechanismAt + kCurve.size())
    curve_ &= byte == static_cast<std::uint8_t>(kCurve[at - kMechanismAt]);
  return Ok{};
}

// Begins a frame; does nothing until its header is complete.
Result<Ok> ZmtpGuard::begin() {
  const auto flags = static_cast<std::uint8_t>(header_[0]);
  if (flags & ~(kMore | kLong | kCommand)) return malformed("a frame has unknown flags");
  if (header_.size() < (flags & kLong ? 9U : 2U)) return Ok{};
  body_left_ = lengthIn(header_);
  header_.clear();
  command_ = flags & kCommand;
  name_.clear();
  in_body_ = true;
  if (body_left_ > limits_.frame_bytes) {
    return malformed(fmt::format("a frame of {} bytes; at most {} are allowed", body_left_,
                                 limits_.frame_bytes));
  }
  if (command_ && (flags & kMore)) return malformed("a command of several parts");
  if (!command_) {  // a command between two parts does not end the message
    if (++parts_ > limits_.parts)
      return malformed(fmt::format("a message of more than {} parts", limits_.parts));
    const bool opens = parts_ == 1, more = flags & kMore;
    if (limits_.requests && (opens != more || (opens && body_left_ > 0)))
      return malformed("a request that is not an empty part and one more");
    if (!more) parts_ = 0;
  }
  size_ = body_left_;
  return body_left_ == 0 ? endFrame() : Result<Ok>(Ok{});
}

// Heartbeats do not count towards total_bytes, because in a long connection they would exhaust it.
Result<Ok> ZmtpGuard::endFrame() {
  in_body_ = false;
  ready_ |= command_ && name_ == kReady;
  const bool plain_heartbeat =
      command_ && (name_.starts_with("\4PING") || name_.starts_with("\4PONG"));
  const bool encrypted_heartbeat =
      curve_ && !command_ && (size_ == kCurvePing || size_ == kCurvePong);
  if (!plain_heartbeat && !encrypted_heartbeat) total_ += size_ + 1;
  if (limits_.total_bytes > 0 && total_ > limits_.total_bytes) {
    return malformed(
        fmt::format("subscriptions of more than {} bytes in total", limits_.total_bytes));
  }
  return Ok{};
}

}  // namespace merlin::status
