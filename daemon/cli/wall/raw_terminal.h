// RawTerminal: switches the terminal to a mode that passes each key on at once without an echo, and
// to a screen of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// Only one object may exist at a time. The destructor restores the terminal, as does a signal other
// than SIGKILL that ends the process. Job control (Ctrl-Z) is off meanwhile. Blocks the signals of
// stopSignals().
class RawTerminal {
 public:
  // Checks that a RawTerminal can be made. Errors: kUnsupported (standard input or output is not a
  // terminal).
  static Result<Ok> check();
  RawTerminal();  // REQUIRES: check() returned Ok
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  // Waits up to `timeout_ms` for keys and returns their bytes; an empty text if there are none.
  // Returns nothing if a signal of stopSignals() has arrived or the terminal is gone.
  std::optional<std::string> read(int timeout_ms);

  // Shows these lines in place of those of the last call.
  void show(const std::vector<std::string>& lines);

 private:
  UniqueFd signals_;
};

}  // namespace merlin::cli
