// RawTerminal: a terminal that passes every key on at once and echoes none, on a screen of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// Only one may exist at a time. The terminal is restored when this is destroyed, and also when a
// signal other than SIGKILL ends the process. Job control (Ctrl-Z) is off meanwhile. Blocks the
// signals of stopSignals().
class RawTerminal {
 public:
  // Errors: kUnsupported: standard input or output is not a terminal.
  static Result<Ok> check();
  RawTerminal();  // REQUIRES: check()
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  // Waits for keys, at most `timeout_ms`, and returns their bytes, which may be none. Returns
  // nothing after a signal that ends the program, or when the terminal is gone.
  std::optional<std::string> read(int timeout_ms);

  // Shows these lines instead of the last ones.
  void show(const std::vector<std::string>& lines);

 private:
  UniqueFd signals_;
};

}  // namespace merlin::cli
