#include "daemon/net/network_allowed.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.h"

namespace merlin::net {

Result<Ok> networkAllowed() {
  const UniqueFd probe(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (probe.valid()) return Ok{};
  const int error = errno;
  if (error == EAFNOSUPPORT || error == EPERM || error == EACCES) {
    return Error{Errc::kUnsupported,
                 fmt::format("network sockets are forbidden ({}); under systemd, the unit's "
                             "drop-in network.conf allows them",
                             std::strerror(error))};
  }
  return Error{Errc::kIo, fmt::format("cannot open a network socket: {}", std::strerror(error))};
}

}  // namespace merlin::net
