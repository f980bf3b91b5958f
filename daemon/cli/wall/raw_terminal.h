// RawTerminal: a terminal that passes every key on at once and echoes none, on a screen of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// One at a time. The terminal is as it was before when this is destroyed, and also when the process
// is ended by a signal (but SIGKILL). Job control (Ctrl-Z) is off meanwhile. Blocks the signals of
// stopSignals().
class RawTerminal {
 public:
  // Errors: kUnsupported: standard input or output is not a terminal.
  static Result<Ok> check();
  RawTerminal();  // REQUIRES: check()
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  // Waits for keys, `timeout_ms` at most: their bytes, or none. Nothing after a signal that ends
  // the program, or when the terminal is gone.
  std::optional<std::string> read(int timeout_ms);

  // Shows these lines instead of the last ones.
  void show(const std::vector<std::string>& lines);

 private:
  UniqueFd signals_;
};

}  // namespace merlin::cli
