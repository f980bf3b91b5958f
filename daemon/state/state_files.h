// Port: where the state is kept. Implemented by StateFolder and by a fake in tests.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::state {

// Thread-bound to one thread at a time.
class StateFiles {
 public:
  virtual ~StateFiles() = default;

  // What was written last, and the one before it. Errors: kNotFound (there is none), kIo,
  // kMalformed (not a regular file).
  virtual Result<std::string> read() = 0;
  virtual Result<std::string> readPrevious() = 0;

  // Replaces what was written last, which becomes the previous one. After an error, and whenever
  // the process or the machine stops, one or the other is there whole. Waits for the disk. Errors:
  // kNotFound, kIo.
  virtual Result<Ok> write(const std::string& text) = 0;

  // What was written last cannot be used and must not become the previous one: puts it aside.
  // Errors: kIo.
  virtual Result<Ok> putAside() = 0;

  // For messages.
  virtual const std::string& name() const = 0;
};

}  // namespace merlin::state
