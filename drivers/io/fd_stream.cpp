#include "drivers/io/fd_stream.h"

#include <cerrno>
#include <utility>

#include <unistd.h>

namespace merlin::io {
FdStream::FdStream(int fd, std::function<void()> close) : fd_(fd), close_(std::move(close)) {}

FdStream::~FdStream() { close_(); }

void FdStream::interrupt() noexcept { wait_.interrupt(); }

Result<std::size_t> FdStream::read(std::span<std::byte> buffer, Duration timeout) {
  if (const auto ready = wait_.await(fd_, POLLIN, timeout); !ready) return ready.error();
  const ssize_t n = ::read(fd_, buffer.data(), buffer.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n == 0) return hungUp();
  if (errno == EAGAIN || errno == EINTR) return Error{Errc::kTimeout, "time-out"};
  return ioError("read");
}

Result<std::size_t> FdStream::write(std::span<const std::byte> bytes, Duration timeout) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (const auto ready = wait_.await(fd_, POLLOUT, timeout); !ready) return ready.error();
    const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return ioError("write");
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return done;
}

}  // namespace merlin::io
