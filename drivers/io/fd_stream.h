// FdStream: a ByteStream over a file descriptor, for serial lines, ptys and TCP connections.
#pragma once

#include <functional>
#include <memory>

#include "drivers/io/fd_wait.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

class FdStream final : public ByteStream {
 public:
  // `fd` must be open and non-blocking; `close` is called once, at destruction, and must close it.
  FdStream(int fd, std::function<void()> close);
  ~FdStream() override;
  FdStream(const FdStream&) = delete;
  FdStream& operator=(const FdStream&) = delete;

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override;
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override;
  void interrupt() noexcept override;

 private:
  int fd_;
  std::function<void()> close_;
  FdWait wait_;
};

}  // namespace merlin::io
