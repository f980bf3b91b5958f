// Parses the bytes that a VRPN server sends into messages. Pure. drivers/port/vrpn_line describes
// the wire format and has the inverse.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/port/vrpn_line.h"

namespace merlin::vrpn {

struct Message {
  VrpnHeader header;
  std::string_view payload;  // cut after Parser::kMostPayload; valid until the next byte is fed
};

// Checks that the first kVrpnCookieLength bytes are the cookie of a VRPN 7 server. Errors:
// kMalformed, quoting the bytes.
Result<Ok> checkGreeting(std::string_view cookie);

// Parses the bytes that follow the cookie.
class Parser {
 public:
  // Bytes of the payload with the maximum number of channels, which is the longest that is read:
  // the payload of all buttons has 1028 bytes, the description of a sender or type at most 104, a
  // pose 64.
  static constexpr std::size_t kMostPayload = 8 + 8 * kVrpnChannels;
  // Limit of the length of a message with its header [bytes]. A server cannot send longer ones:
  // VRPN's own buffer has 64000 bytes.
  static constexpr std::size_t kLongest = 65536;

  // Takes one byte; returns a message when `byte` completes one. Never blocks, never allocates.
  std::optional<Message> feed(std::byte byte) noexcept;

  // True after an invalid length. The beginning of the next message is then unknown: feed() returns
  // nothing any more, and the connection must be closed.
  bool broken() const noexcept { return broken_; }
  bool inside() const noexcept { return length_ > 0; }  // in the middle of a message
  void reset() noexcept;                                // for a new connection

 private:
  std::array<char, kVrpnHeaderLength + kMostPayload> bytes_{};  // beginning of the message
  std::size_t length_ = 0;                                      // bytes received of the message
  VrpnStart start_;                                             // valid once the header is complete
  bool broken_ = false;
};

// Passes a byte to the parser; returns the message that it completes, or nothing. Allocates only
// for an error. Errors: kMalformed (the parser is broken), kClosed (the server ends the
// connection).
Result<std::optional<Message>> takeByte(Parser& parser, std::byte byte);

}  // namespace merlin::vrpn
