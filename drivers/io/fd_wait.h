// FdWait: waits for a file descriptor, and can be interrupted from another thread.
#pragma once

#include <poll.h>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::io {

class FdWait {
 public:
  FdWait();

  // Waits until the descriptor is ready for `events`. Errors: kTimeout, kClosed (the other end hung
  // up, or interrupt() was called), kIo.
  Result<Ok> await(int fd, short events, Duration timeout);

  // Makes the current wait, and every later one, return kClosed. Thread-safe.
  void interrupt() noexcept;

 private:
  UniqueFd wake_;  // eventfd that interrupt() signals; it is never cleared
};

// Returns the error kClosed of a line whose other end was closed or unplugged.
Error hungUp();

// Returns the error of a system call that has just failed and set errno: kClosed with the text of
// hungUp() if the device or the peer is gone, otherwise kIo. `call`: its name, for the message.
Error ioError(const char* call);

}  // namespace merlin::io
