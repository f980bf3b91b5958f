#include "drivers/io/fd_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>

namespace merlin::io {
namespace {

Error ioError(const char* call) {
  return {errno == EIO || errno == ENXIO || errno == ENODEV ? Errc::kClosed : Errc::kIo,
          std::string(call) + ": " + std::strerror(errno)};  // NOLINT: one thread a stream
}

}  // namespace

FdStream::FdStream(int fd, std::function<void()> close)
    : fd_(fd), close_(std::move(close)), wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

FdStream::~FdStream() { close_(); }

void FdStream::interrupt() noexcept { (void)::eventfd_write(wake_.get(), 1); }

Result<Ok> FdStream::await(short events, Duration timeout) {
  pollfd fds[] = {{fd_, events, 0}, {wake_.get(), POLLIN, 0}};
  const auto ns = std::max<std::int64_t>(timeout.count(), 0);
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  const int ready = ::ppoll(fds, 2, &limit, nullptr);
  if (ready < 0 && errno == EINTR) return Error{Errc::kTimeout, "signal"};
  if (ready < 0) return ioError("poll");
  if (ready == 0) return Error{Errc::kTimeout, "time-out"};  // short: no allocation
  if (fds[1].revents != 0) return Error{Errc::kClosed, "interrupted"};
  if ((fds[0].revents & events) != 0) return Ok{};
  return Error{Errc::kClosed, "the other end hung up"};
}

Result<std::size_t> FdStream::read(std::span<std::byte> buffer, Duration timeout) {
  if (const auto ready = await(POLLIN, timeout); !ready) return ready.error();
  const ssize_t n = ::read(fd_, buffer.data(), buffer.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n == 0) return Error{Errc::kClosed, "end of file"};
  if (errno == EAGAIN || errno == EINTR) return Error{Errc::kTimeout, "time-out"};
  return ioError("read");
}

Result<std::size_t> FdStream::write(std::span<const std::byte> bytes, Duration timeout) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (const auto ready = await(POLLOUT, timeout); !ready) return ready.error();
    const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return ioError("write");
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return done;
}

}  // namespace merlin::io
