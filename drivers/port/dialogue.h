// Dialogue: sends commands over a ByteStream and reads the answers, for the set-up of a device.
//
// Thread-bound; made by a Device for one set-up. Each step has its own time limit, so that a dead
// line costs a bounded time; error messages name the step.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin {

class Dialogue {
 public:
  Dialogue(ByteStream& stream, const Clock& clock) : stream_(stream), clock_(clock) {}

  // Writes `bytes`, within 1 s. Errors: those of the stream.
  Result<Ok> send(std::string_view bytes);

  // Reads exactly `count` bytes. The first must arrive within `timeout`; each later one within
  // `timeout` as well, or within 100 ms of the byte before it, so that a slow line gets the time
  // that it needs. `step` names the expected answer in messages. Errors: kTimeout (the message
  // quotes the bytes that arrived), and those of the stream.
  Result<std::string> readExactly(std::size_t count, Duration timeout, std::string_view step);

  // Reads until the byte `end`; returns the bytes before it, at most `limit`. Time limits and
  // errors are those of readExactly(); in addition, kMalformed (more than `limit` bytes).
  Result<std::string> readUntil(char end, std::size_t limit, Duration timeout,
                                std::string_view step);

  // Discards input until none has arrived for `quiet`, for at most `most`; returns the number of
  // discarded bytes.
  Result<std::size_t> drain(Duration quiet, Duration most);

 private:
  // Returns the next byte; kTimeout once `deadline` has passed.
  Result<char> next(Timestamp deadline);

  ByteStream& stream_;
  const Clock& clock_;
};

// Returns the first 24 bytes for a message: printable ASCII unchanged, other bytes as \xNN, and
// "..." if there are more.
std::string quoteBytes(std::string_view bytes);

}  // namespace merlin
