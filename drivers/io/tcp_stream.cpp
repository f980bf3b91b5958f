#include "drivers/io/tcp_stream.h"

#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/fd_stream.h"

namespace merlin::io {
namespace {

constexpr int kConnectTime_ms = 1000;
// Size of the buffer for received bytes that are not read yet; a line that is read at a limited
// rate soon exceeds it.
constexpr int kReceiveBuffer = 64 << 10;

void setOption(int fd, int level, int option, int value) {
  (void)::setsockopt(fd, level, option, &value, sizeof value);
}

// Connects a new socket `fd` to the address. Returns 0 or an errno value.
int connectTo(const addrinfo& address, UniqueFd& fd) {
  fd.reset(::socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid()) return errno;
  // The buffer's size must be set before connect(), which determines the window.
  setOption(fd.get(), SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
  if (::connect(fd.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd item{fd.get(), POLLOUT, 0};
  if (::poll(&item, 1, kConnectTime_ms) != 1) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

Result<std::unique_ptr<ByteStream>> openTcp(const std::string& host, const std::string& service) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), service.c_str(), &hints, &found); error != 0)
    return Error{Errc::kNotFound,
                 fmt::format("tcp://{}:{}: {}", host, service, gai_strerror(error))};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  UniqueFd fd;
  int error = ENOENT;
  for (const addrinfo* a = found; a && error != 0; a = a->ai_next) error = connectTo(*a, fd);
  if (error != 0) {
    return Error{error == ETIMEDOUT ? Errc::kTimeout : Errc::kIo,
                 fmt::format("tcp://{}:{}: {}", host, service, std::strerror(error))};
  }
  setOption(fd.get(), IPPROTO_TCP, TCP_NODELAY, 1);
  setOption(fd.get(), SOL_SOCKET, SO_KEEPALIVE, 1);
  setOption(fd.get(), IPPROTO_TCP, TCP_KEEPIDLE, 2);
  setOption(fd.get(), IPPROTO_TCP, TCP_KEEPINTVL, 1);
  setOption(fd.get(), IPPROTO_TCP, TCP_KEEPCNT, 3);
  const int raw = fd.get();
  auto owner = std::make_shared<UniqueFd>(std::move(fd));  // shared: std::function must copy
  return std::unique_ptr<ByteStream>(std::make_unique<FdStream>(raw, [owner] { owner->reset(); }));
}

}  // namespace merlin::io
