// StateFiles: port (an interface) for the place where the state is stored. Implemented by
// StateFolder and by a fake in tests.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::state {

// Must not be used by two threads at the same time.
class StateFiles {
 public:
  virtual ~StateFiles() = default;

  // read() returns the text that was written last, readPrevious() the text before it. Errors:
  // kNotFound (there is none), kIo, kMalformed (not a regular file).
  virtual Result<std::string> read() = 0;
  virtual Result<std::string> readPrevious() = 0;

  // Writes `text`; the text that was written last becomes the previous one. At least one of the two
  // is complete even after an error, or if the process or the machine stops at any moment. Waits
  // for the disk. Errors: kNotFound, kIo.
  virtual Result<Ok> write(const std::string& text) = 0;

  // Moves the text that was written last to another name, because it is unusable and must not
  // become the previous one. Errors: kIo.
  virtual Result<Ok> putAside() = 0;

  // Returns the name of the place, such as the path of the file, for messages.
  virtual const std::string& name() const = 0;
};

}  // namespace merlin::state
