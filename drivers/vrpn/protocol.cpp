#include "drivers/vrpn/protocol.h"

#include <fmt/format.h>

#include "drivers/port/dialogue.h"

namespace merlin::vrpn {

Result<Ok> checkGreeting(std::string_view cookie) {
  if (vrpnCookieFits(cookie)) return Ok{};
  return Error{
      Errc::kMalformed,
      fmt::format("the greeting \"{}\" is not that of a server of VRPN 7", quoteBytes(cookie))};
}

std::optional<Message> Parser::feed(std::byte byte) noexcept {
  if (broken_) return std::nullopt;
  if (length_ < bytes_.size()) bytes_[length_] = static_cast<char>(byte);
  ++length_;
  const std::string_view stored(bytes_.data(), bytes_.size());
  if (length_ == kVrpnHeaderLength) {
    start_ = readVrpnStart(stored);
    broken_ = start_.bytes == 0 || start_.bytes > kLongest;
  }
  if (broken_ || length_ < kVrpnHeaderLength || length_ < start_.bytes) return std::nullopt;
  length_ = 0;
  return Message{start_.header, stored.substr(kVrpnHeaderLength).substr(0, start_.payload)};
}

void Parser::reset() noexcept {
  length_ = 0;
  broken_ = false;
}

Result<std::optional<Message>> takeByte(Parser& parser, std::byte byte) {
  const auto message = parser.feed(byte);
  if (parser.broken())
    return Error{Errc::kMalformed, "the server sent a message with an invalid length"};
  if (message && message->header.type == kVrpnDisconnect)
    return Error{Errc::kClosed, "the server has ended the connection"};
  return message;
}

}  // namespace merlin::vrpn
