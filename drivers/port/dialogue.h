// Dialogue: the small steps that every device's set-up is made of, over a ByteStream.
//
// Thread-bound, borrowed by a Device for the length of one open(). Each step has its own limit, so
// that a dead line costs a bounded time; errors name the step.
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

  Result<Ok> send(std::string_view bytes);

  // Exactly `count` bytes, the first within `timeout`, the others within it too or as long as they
  // come in a row (no gap of 100 ms), so that a slow line is given its time and a dead one is not.
  // `step` names what is waited for, in errors: kTimeout says how many bytes came, and the first.
  Result<std::string> readExactly(std::size_t count, Duration timeout, std::string_view step);

  // Bytes up to and without `end`, at most `limit` of them; in time as above.
  Result<std::string> readUntil(char end, std::size_t limit, Duration timeout,
                                std::string_view step);

  // Throws input away until none has come for `quiet`, for `most` at most; returns how many bytes.
  Result<std::size_t> drain(Duration quiet, Duration most);

 private:
  // The next byte, or kTimeout once `deadline` has passed.
  Result<char> next(Timestamp deadline);

  ByteStream& stream_;
  const Clock& clock_;
};

// Bytes as a person reads them in an error: printable ones as they are, others as \xNN; cut at 24.
std::string quoteBytes(std::string_view bytes);

}  // namespace merlin
