// What a VRPN server sends: bytes to messages. Pure. The wire format, and the way back, are
// drivers/port/vrpn_line.
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

// Whether the first kVrpnCookieLength bytes are those of a server of VRPN 7. Errors: kMalformed,
// with the bytes.
Result<Ok> checkGreeting(std::string_view cookie);

// Reads what follows the cookie.
class Parser {
 public:
  // That of the most channels. All buttons have 1028 bytes, a description of a sender or type at
  // most 104, a pose 64.
  static constexpr std::size_t kMostPayload = 8 + 8 * kVrpnChannels;
  // The longest message, with its header, that a server can send: VRPN's own buffer has 64000.
  static constexpr std::size_t kLongest = 65536;

  // Takes one byte; returns a message when `byte` completes one. Never blocks, never allocates.
  std::optional<Message> feed(std::byte byte) noexcept;

  // An invalid length was read. Where the next message begins is not known: feed() returns nothing
  // any more, and the connection has to be closed.
  bool broken() const noexcept { return broken_; }
  bool inside() const noexcept { return length_ > 0; }  // in the middle of a message
  void reset() noexcept;                                // for a new connection

 private:
  std::array<char, kVrpnHeaderLength + kMostPayload> bytes_{};  // the first of the message
  std::size_t length_ = 0;                                      // how many have come
  VrpnStart start_;                                             // once the header has come
  bool broken_ = false;
};

// Gives the parser a byte; returns the message that it completes, if it does. Allocates only for an
// error. Errors: kMalformed (the parser is broken), kClosed (the server ends the connection).
Result<std::optional<Message>> takeByte(Parser& parser, std::byte byte);

}  // namespace merlin::vrpn
