// Port: the only way in which a driver touches the outside world.
//
// Implemented by drivers/io/fd_stream (pty and serial lines) and tests/support/fake_stream.
// Thread-bound: one thread, one stream; interrupt() alone may come from another.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin {

class ByteStream {
 public:
  virtual ~ByteStream() = default;

  // Blocks until a byte arrives or `timeout` passes; returns how many were read, 1..buffer.size().
  // Errors: kTimeout (nothing came; the stream is fine), kClosed (unplugged or interrupted), kIo.
  virtual Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) = 0;

  // Writes all of `bytes`, or fails. Errors: kTimeout, kClosed, kIo.
  virtual Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) = 0;

  // Makes the read or write under way, and every later one, return kClosed. Thread-safe.
  virtual void interrupt() noexcept = 0;
};

// Opens a device's stream; called again for each attempt. What it opens is fixed at its making.
using StreamOpener = std::function<Result<std::unique_ptr<ByteStream>>()>;

}  // namespace merlin
