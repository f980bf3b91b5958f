// ZmtpGuard: checks that the bytes that a client sends to a ZeroMQ socket stay within limits. No
// I/O.
//
// It follows the framing of ZMTP 3, which is visible even if messages are encrypted: a greeting of
// 64 bytes, then frames: flags (1: more parts follow, 2: long, 4: command), a length of 1 or 8
// bytes, the body. Older versions have no such greeting and are refused, because libzmq would
// accept any bytes as one of them.
//
// Source: ZeroMQ RFC 23 (ZMTP 3.0), RFC 26 (CURVE).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::status {

struct ZmtpLimits {
  std::size_t frame_bytes = 4096;  // maximum size of a frame's body
  std::size_t parts = 2;  // maximum per message; a request has an empty part before its body
  // Maximum sum of all frames' bodies in a connection's lifetime, heartbeats excluded; limits the
  // subscriptions. 0: no limit.
  std::size_t total_bytes = 0;
  // Whether each message must be a request: an empty part, then one more. After any other form,
  // libzmq 4.3.4 forgets a client that disconnects, and then drops the next client's reply.
  bool requests = false;
};

// One direction of one connection. Thread-bound.
class ZmtpGuard {
 public:
  explicit ZmtpGuard(const ZmtpLimits& limits) : limits_(limits) {}

  struct Accepted {
    std::size_t bytes = 0;   // number of bytes at the front of the input that may be passed on
    std::size_t frames = 0;  // number of frames that begin in them, at most `most`
  };
  // Follows `input` for at most `most` frames. Errors: kMalformed (a limit was exceeded, with the
  // figures); the connection must then be closed.
  Result<Accepted> follow(std::string_view input, std::size_t most);

  // Whether this direction has contained READY, which the server sends at the end of the handshake.
  bool ready() const noexcept { return ready_; }

 private:
  Result<Ok> greet(std::uint8_t byte);
  Result<Ok> begin();  // begins a frame once its header is complete
  Result<Ok> endFrame();

  ZmtpLimits limits_;
  std::size_t greeting_ = 0;  // bytes of the greeting received so far
  bool curve_ = true;         // the greeting, as far as received, names CURVE
  std::string header_;        // header of the frame that begins, as far as received
  std::uint64_t body_left_ = 0, size_ = 0;
  std::string name_;  // the first bytes of a command's body
  bool in_body_ = false, command_ = false, ready_ = false;
  std::size_t parts_ = 0;  // parts of the current message so far
  std::uint64_t total_ = 0;
};

}  // namespace merlin::status
