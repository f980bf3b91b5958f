// ByteStream: the interface by which a driver reads and writes its device's line. A driver does no
// other input or output.
//
// Implemented in drivers/io (serial lines, ptys, TCP, transcripts) and by
// tests/support/fake_stream. Thread-bound, except interrupt(), which any thread may call.
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

  // Blocks until a byte arrives or `timeout` passes; returns the number of bytes read, 1 to
  // buffer.size(). Errors: kTimeout (nothing arrived; the stream remains usable), kClosed
  // (unplugged or interrupted), kIo.
  virtual Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) = 0;

  // Writes all of `bytes`, or fails. Errors: kTimeout, kClosed, kIo.
  virtual Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) = 0;

  // Makes the current read or write, and every later one, return kClosed. Thread-safe.
  virtual void interrupt() noexcept = 0;
};

// Opens a device's stream; called again for each attempt. The opener always opens the same port.
using StreamOpener = std::function<Result<std::unique_ptr<ByteStream>>()>;

}  // namespace merlin
