// A command of a role's socket, and the answer to a request. No I/O.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::status {

// A command. Its function returns the JSON value that becomes "result"; an Error becomes
// {"ok": false, "error": ...}. Called in the server's thread.
struct Command {
  std::string name, help;
  std::function<Result<std::string>()> run;
  // Instead of `run`, for a command that needs the request's "argument", a text.
  std::function<Result<std::string>(const std::string& argument)> run_with = nullptr;
};

// The answer to a request {"command": NAME, "argument": TEXT}: {"ok": true, "result": ...} or
// {"ok": false, "error": "..."}. Runs the command, in the calling thread. REQUIRES: the request has
// at most 4 KiB, so that deep nesting cannot overflow the stack.
std::string answerTo(std::string_view request, std::span<const Command> commands);

// The answer to a request that failed.
std::string failure(std::string_view what);

}  // namespace merlin::status
