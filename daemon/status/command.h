// A command of a role's socket, and the answer to a request. No I/O.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::status {

// One command that a socket accepts. Its function is called in the server's thread. It returns the
// JSON value that becomes "result"; an Error becomes {"ok": false, "error": ...}.
struct Command {
  std::string name, help;
  std::function<Result<std::string>()> run;
  // If set, it is called instead of `run`, with the request's "argument", a text.
  std::function<Result<std::string>(const std::string& argument)> run_with = nullptr;
};

// Runs the command of a request {"command": NAME, "argument": TEXT} in the calling thread and
// returns the answer: {"ok": true, "result": ...} or {"ok": false, "error": "..."}. REQUIRES: the
// request has at most 4 KiB, so that deep nesting cannot overflow the stack.
std::string answerTo(std::string_view request, std::span<const Command> commands);

// Returns the answer to a request that failed: {"ok": false, "error": what}.
std::string failure(std::string_view what);

}  // namespace merlin::status
