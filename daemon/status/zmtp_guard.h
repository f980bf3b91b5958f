// ZmtpGuard: whether what a client sends to a ZeroMQ socket keeps within its limits. No I/O.
//
// It follows ZMTP 3 by its framing alone, which stays visible when messages are encrypted: a
// greeting of 64 bytes, then frames: flags (1: more parts follow, 2: long, 4: command), a length of
// 1 or 8 bytes, the body. Older versions, which have no such greeting, are refused: libzmq would
// take any noise for them.
//
// Source: ZeroMQ RFC 23 (ZMTP 3.0), RFC 26 (CURVE).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::status {

struct ZmtpLimits {
  std::size_t frame_bytes = 4096;  // of one body
  std::size_t parts = 2;           // of one message; a request has an empty part before its body
  // Of the bodies of all frames of a connection but heartbeats: what a subscriber may say in its
  // life. 0: no limit.
  std::size_t total_bytes = 0;
  // Each message is a request: an empty part, then one more. libzmq 4.3.4 forgets a client that
  // sends another form and goes, and then drops the next client's reply.
  bool requests = false;
};

// One direction of one connection. Thread-bound.
class ZmtpGuard {
 public:
  explicit ZmtpGuard(const ZmtpLimits& limits) : limits_(limits) {}

  struct Accepted {
    std::size_t bytes = 0;   // of the front of the input, to be passed on
    std::size_t frames = 0;  // begun in them; at most as many as were allowed
  };
  // Follows `input` for at most `most` frames. Errors: kMalformed, a limit that was passed, with
  // the figures; the connection is of no more use.
  Result<Accepted> follow(std::string_view input, std::size_t most);

  // Whether the handshake is through as this direction tells it: the server has said READY.
  bool ready() const noexcept { return ready_; }

 private:
  Result<Ok> greet(std::uint8_t byte);
  Result<Ok> begin();  // of a frame whose header is whole
  Result<Ok> endFrame();

  ZmtpLimits limits_;
  std::size_t greeting_ = 0;  // bytes of it that have come
  bool curve_ = true;         // as far as the greeting has come: it names CURVE
  std::string header_;        // of the frame that begins
  std::uint64_t body_left_ = 0, size_ = 0;
  std::string name_;  // the first bytes of a command's body
  bool in_body_ = false, command_ = false, ready_ = false;
  std::size_t parts_ = 0;  // of the message, so far
  std::uint64_t total_ = 0;
};

}  // namespace merlin::status
