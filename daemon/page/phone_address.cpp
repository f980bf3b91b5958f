#include "daemon/page/phone_address.h"

#include <array>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.h"
#include "daemon/page/host_names.h"
#include "daemon/page/settings.h"

namespace merlin::page {

Result<std::string> phoneAddress(const std::string& origin, const PagePlace& place) {
  const std::size_t scheme = origin.find("://");
  if (scheme != std::string::npos) {
    const auto host = hostOf(std::string_view(origin).substr(scheme + 3));
    if (host && !isLoopbackHost(*host)) return origin + "/";
  }
  if (isLoopback(place.address)) {
    return Error{
        Errc::kNotFound,
        fmt::format("a phone cannot reach the page: it listens only at {}, which no other machine "
                    "reaches. Set \"address\": \"0.0.0.0\" in /page of the configuration, or "
                    "put a proxy before the page, and restart it; daemon/page/README.md says who "
                    "can then read the traffic",
                    place.address)};
  }
  std::string address = place.address;
  if (address == "0.0.0.0") {
    if (place.networks.empty())
      return Error{Errc::kNotFound,
                   "a phone cannot reach the page: this machine is not connected to a network"};
    address = place.networks.front();
  }
  return fmt::format("http://{}:{}/", address, place.port);
}

// Uses ioctl(), because getifaddrs() needs sockets of a family that the page's unit forbids.
std::vector<std::string> networkAddresses() {
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  std::array<ifreq, 32> interfaces{};
  ifconf list{};
  list.ifc_len = static_cast<int>(sizeof interfaces);
  list.ifc_req = interfaces.data();
  std::vector<std::string> addresses;
  if (!socket.valid() || ::ioctl(socket.get(), SIOCGIFCONF, &list) != 0) return addresses;
  const auto count = static_cast<std::size_t>(list.ifc_len) / sizeof(ifreq);
  for (std::size_t i = 0; i < count; ++i) {
    sockaddr_in at{};
    std::memcpy(&at, &interfaces[i].ifr_addr, sizeof at);
    ifreq flags = interfaces[i];
    if (::ioctl(socket.get(), SIOCGIFFLAGS, &flags) != 0) continue;
    if ((flags.ifr_flags & IFF_UP) == 0 || (flags.ifr_flags & IFF_LOOPBACK) != 0) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    if (::inet_ntop(AF_INET, &at.sin_addr, text.data(), text.size()))
      addresses.emplace_back(text.data());
  }
  return addresses;
}

}  // namespace merlin::page
