// Adapter: a ByteStream over a file descriptor, shared by ptys and serial lines.
#pragma once

#include <functional>
#include <memory>

#include "daemon/base/unique_fd.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

class FdStream final : public ByteStream {
 public:
  // `fd` is open and non-blocking; `close` runs once, at destruction, and closes it.
  FdStream(int fd, std::function<void()> close);
  ~FdStream() override;
  FdStream(const FdStream&) = delete;
  FdStream& operator=(const FdStream&) = delete;

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override;
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override;
  void interrupt() noexcept override;

 private:
  // Waits until the descriptor is ready for `events`. Errors: kTimeout, kClosed, kIo.
  Result<Ok> await(short events, Duration timeout);

  int fd_;
  std::function<void()> close_;
  UniqueFd wake_;  // an eventfd that interrupt() signals and nobody clears
};

}  // namespace merlin::io
