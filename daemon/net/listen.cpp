// Makes listening sockets.
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "daemon/net/connection_server.h"
#include "daemon/net/network_allowed.h"

namespace merlin::net {
namespace {

constexpr int kBacklog = 128;

UniqueFd newSocket(int family) {
  return UniqueFd(::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

// Removes a socket at `path` that a dead program has left. Returns an error if anything else is
// there; succeeds if nothing is.
Result<Ok> makeRoom(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return Ok{};
  if (!S_ISSOCK(status.st_mode)) {
    return Error{Errc::kInvalidArgument,
                 path + ": is not a socket and is not replaced; choose another name, or remove it"};
  }
  const UniqueFd probe = newSocket(AF_UNIX);
  const int connected =
      ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  // EAGAIN: the queue of a running program is full.
  if (connected == 0 || errno == EAGAIN)
    return Error{Errc::kBusy,
                 path + ": another program serves this socket; stop it, or choose another name"};
  if (errno != ECONNREFUSED)
    return Error{Errc::kIo, fmt::format("{}: {}", path, std::strerror(errno))};
  ::unlink(path.c_str());
  return Ok{};
}

}  // namespace

Result<UniqueFd> listenLocal(const std::string& path, unsigned mode) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: the name is too long for a socket ({} bytes at most)", path,
                             sizeof address.sun_path - 1)};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  if (const auto made = makeRoom(path, address); !made) return made.error();
  UniqueFd fd = newSocket(AF_UNIX);
  // chmod() before listen(), so that the mode holds from the first connection on.
  if (!fd.valid() ||
      ::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path.c_str(), mode) != 0 || ::listen(fd.get(), kBacklog) != 0) {
    const int error = errno;
    return Error{error == EADDRINUSE ? Errc::kBusy : Errc::kIo,
                 fmt::format("{}: {}", path, std::strerror(error))};
  }
  return fd;
}

Result<UniqueFd> listenTcp(const std::string& text, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, text.c_str(), &address.sin_addr) != 1)
    return Error{Errc::kInvalidArgument, text + ": is not an IPv4 address"};
  UniqueFd fd = newSocket(AF_INET);
  if (!fd.valid()) {
    const int error = errno;
    if (const auto allowed = networkAllowed(); !allowed) return allowed.error();
    return Error{Errc::kIo, fmt::format("port {}: {}", port, std::strerror(error))};
  }
  const int yes = 1;
  ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(fd.get(), kBacklog) != 0) {
    const int error = errno;
    return Error{error == EADDRINUSE ? Errc::kBusy : Errc::kIo,
                 fmt::format("{}:{}: {}", text, port, std::strerror(error))};
  }
  return fd;
}

int portOf(int fd) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

}  // namespace merlin::net
