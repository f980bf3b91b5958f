// Port: where the state is kept. Implemented by StateFolder and by a fake in tests.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::state {

// Thread-bound to one thread at a time.
class StateFiles {
 public:
  virtual ~StateFiles() = default;

  // Return the text that was written last, and the one before it. Errors: kNotFound (there is
  // none), kIo, kMalformed (not a regular file).
  virtual Result<std::string> read() = 0;
  virtual Result<std::string> readPrevious() = 0;

  // Replaces the text that was written last, which becomes the previous one. Even after an error,
  // or if the process or the machine stops at any moment, at least one of the two is complete.
  // Waits for the disk. Errors: kNotFound, kIo.
  virtual Result<Ok> write(const std::string& text) = 0;

  // Puts the text that was written last aside, because it is unusable and must not become the
  // previous one. Errors: kIo.
  virtual Result<Ok> putAside() = 0;

  // Name of the place, for messages.
  virtual const std::string& name() const = 0;
};

}  // namespace merlin::state
