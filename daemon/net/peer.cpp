#include "daemon/net/peer.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace merlin::net {

Peer peerOf(int fd) {
  Peer peer;
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return peer;
  if (address.ss_family == AF_INET) {
    peer.address = ntohl(reinterpret_cast<const sockaddr_in*>(&address)->sin_addr.s_addr);
    return peer;
  }
  ucred credentials{};
  socklen_t length = sizeof credentials;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &length) == 0) {
    peer.user = credentials.uid;
    peer.process = credentials.pid;
  }
  return peer;
}

std::string peerName(const Peer& peer) {
  if (peer.user >= 0) return fmt::format("user {}, process {}", peer.user, peer.process);
  const std::uint32_t a = peer.address;
  return fmt::format("{}.{}.{}.{}", a >> 24, a >> 16 & 255, a >> 8 & 255, a & 255);
}

}  // namespace merlin::net
