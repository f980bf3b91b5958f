#include "drivers/io/fd_wait.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <string>

#include <sys/eventfd.h>

namespace merlin::io {

Error hungUp() { return {Errc::kClosed, "the other end hung up"}; }

Error ioError(const char* call) {
  const int error = errno;
  const std::string what = std::string(call) + ": " + std::strerror(error);  // NOLINT: one thread
  constexpr int kGone[] = {EIO, ENXIO, ENODEV, EPIPE, ECONNRESET, ETIMEDOUT, EHOSTUNREACH};
  if (std::ranges::find(kGone, error) == std::end(kGone)) return {Errc::kIo, what};
  return {Errc::kClosed, hungUp().what + " (" + what + ')'};
}

FdWait::FdWait() : wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

void FdWait::interrupt() noexcept { (void)::eventfd_write(wake_.get(), 1); }

Result<Ok> FdWait::await(int fd, short events, Duration timeout) {
  pollfd fds[] = {{fd, events, 0}, {wake_.get(), POLLIN, 0}};
  const auto ns = std::max<std::int64_t>(timeout.count(), 0);
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  const int ready = ::ppoll(fds, 2, &limit, nullptr);
  if (ready < 0 && errno == EINTR) return Error{Errc::kTimeout, "signal"};
  if (ready < 0) return ioError("poll");
  // The text is so short that it needs no allocation.
  if (ready == 0) return Error{Errc::kTimeout, "time-out"};
  if (fds[1].revents != 0) return Error{Errc::kClosed, "interrupted"};
  if ((fds[0].revents & events) != 0) return Ok{};
  return hungUp();
}

}  // namespace merlin::io
