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

// Error for a line whose other end was closed or unplugged: kClosed.
Error hungUp();

// Error for a call that has just failed and set errno: kClosed, as hungUp() says it, if the device
// or the peer is gone, otherwise kIo.
Error ioError(const char* call);

}  // namespace merlin::io
