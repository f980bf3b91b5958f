// PJLink class 1, the protocol by which projectors are controlled over TCP (port 4352): converts
// commands to bytes, and received bytes to answers. No I/O, no clock.
//
// Lines end with CR. The projector speaks first:
//   "PJLINK 0"       it asks for no password
//   "PJLINK 1 RRRR"  it does: the first command is preceded by the MD5 digest, in hexadecimal, of
//                    RRRR (its random text, usually 8 digits) and the password
//   "PJLINK ERRA"    instead of the answer to that command: the password is wrong
// A command is "%1POWR 1", its answer "%1POWR=OK", "%1POWR=ERR3", or, to the question "%1POWR ?",
// "%1POWR=0". The projector closes a connection that is idle for 30 s.
//
// Sources: README.md of this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::pjlink {

inline constexpr std::size_t kMostLine = 136;  // bytes of a line, with its end

enum class Command { kPowerOn, kPowerOff, kInput, kAskPower, kAskErrors, kAskLamps, kAskName };

// Returns a command as it is sent, without the final CR, for example "%1POWR ?". `input`: the input
// that kInput selects, such as "31".
std::string commandText(Command command, std::string_view input);

struct Answer {
  // kValue: OK, or the requested value. The others are ERR1 to ERR4.
  enum class Code { kValue, kUndefined, kOutOfRange, kUnavailable, kFailure };
  Code code = Code::kValue;
  std::string value;  // "OK", "0"
};

// Returns a text for messages, such as "ERR3, not available at this time". REQUIRES: code is not
// kValue.
const char* errorText(Answer::Code code);

// The dialogue of one connection. Thread-bound.
class Session {
 public:
  // `password`: empty if there is none.
  explicit Session(std::string password) : password_(std::move(password)) {}

  // Returns whether the projector has sent its greeting, so that commands may be sent.
  bool isOpen() const { return open_; }
  // Returns whether nothing has arrived after the last complete line.
  bool isAtLineStart() const { return line_.empty(); }

  // Returns the bytes to send for a command. REQUIRES: isOpen(), and the last command has been
  // answered.
  std::string request(Command command, std::string_view input);

  // Takes received bytes; returns the answer that they complete, nothing if they complete none.
  // After an error the connection is useless. Errors: kInvalidArgument (the password is wrong or
  // missing), kMalformed (not PJLink: a line that is too long, a greeting or an answer of another
  // form or to another command, or bytes that nobody asked for).
  Result<std::optional<Answer>> feed(std::string_view bytes);

 private:
  Result<std::optional<Answer>> take(std::string_view line);
  Result<Ok> greet(std::string_view line);

  std::string password_;
  std::string line_;      // beginning of the line that is incomplete
  std::string expected_;  // "%1POWR=" while the answer to POWR is awaited
  std::string digest_;    // digest that precedes the first command
  bool open_ = false;
};

}  // namespace merlin::pjlink
