#include "drivers/io/udp_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/fd_wait.h"
#include "drivers/io/read_ahead.h"
#include "drivers/port/datagram_line.h"

namespace merlin::io {
namespace {

// Returns a hash (FNV-1a) of a sender's address and port; recordings contain the hash instead of
// the address.
std::uint32_t numberOf(const sockaddr_storage& from) noexcept {
  std::uint32_t number = 0x811C9DC5;
  const auto add = [&](const void* data, std::size_t size) {
    const auto* const bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) number = (number ^ bytes[i]) * 0x01000193;
  };
  if (from.ss_family == AF_INET) {
    const auto& in = reinterpret_cast<const sockaddr_in&>(from);
    add(&in.sin_addr, sizeof in.sin_addr);
    add(&in.sin_port, sizeof in.sin_port);
  } else if (from.ss_family == AF_INET6) {
    const auto& in = reinterpret_cast<const sockaddr_in6&>(from);
    add(&in.sin6_addr, sizeof in.sin6_addr);
    add(&in.sin6_port, sizeof in.sin6_port);
  }
  return number;
}

class UdpStream final : public ByteStream {
 public:
  explicit UdpStream(UniqueFd fd) : fd_(std::move(fd)), received_(kLongestDatagram) {
    ahead_.bytes.reserve(kDatagramHeader + kLongestDatagram);
  }

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    if (ahead_.empty()) {
      if (const auto filled = fill(timeout); !filled) return filled.error();
    }
    return ahead_.take(buffer);
  }

  Result<std::size_t> write(std::span<const std::byte>, Duration) override {
    return Error{Errc::kIo, "nothing is written to a port that receives datagrams"};
  }

  void interrupt() noexcept override { wait_.interrupt(); }

 private:
  // Reads one datagram.
  Result<Ok> fill(Duration timeout) {
    ahead_.clear();
    if (auto ready = wait_.await(fd_.get(), POLLIN, timeout); !ready) return ready;
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    const ssize_t n = ::recvfrom(fd_.get(), received_.data(), received_.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return ioError("recvfrom");
    if (n <= 0) return Error{Errc::kTimeout, "time-out"};
    append(
        {numberOf(from), std::span<const std::byte>(received_).first(static_cast<std::size_t>(n))},
        ahead_.bytes);
    return Ok{};
  }

  UniqueFd fd_;
  FdWait wait_;
  std::vector<std::byte> received_;  // kLongestDatagram bytes
  ReadAhead ahead_;                  // the record that read() has not returned yet
};

Error bindError(const std::string& name, int error) {
  if (error == EADDRINUSE)
    return {Errc::kBusy,
            fmt::format("{}: another device of this configuration, or another program, "
                        "receives at this port; give each its own",
                        name)};
  if (error == EADDRNOTAVAIL)
    return {Errc::kNotFound, fmt::format("{}: this machine does not have this address", name)};
  const bool forbidden = error == EAFNOSUPPORT || error == EPERM;
  return {Errc::kIo, fmt::format("{}: {}{}", name, std::strerror(error),
                                 forbidden ? " (as a service, merlind needs the drop-in "
                                             "network.conf)"
                                           : "")};
}

}  // namespace

Result<std::unique_ptr<ByteStream>> openUdp(const std::string& address,
                                            const std::string& service) {
  const std::string name =
      fmt::format("udp://{}:{}",
                  address.find(':') == std::string::npos ? address : '[' + address + ']', service);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(address.c_str(), service.c_str(), &hints, &found); error != 0)
    return Error{Errc::kNotFound, fmt::format("{}: {}", name, gai_strerror(error))};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  UniqueFd fd(::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid() || ::bind(fd.get(), found->ai_addr, found->ai_addrlen) != 0)
    return bindError(name, errno);
  return std::unique_ptr<ByteStream>(std::make_unique<UdpStream>(std::move(fd)));
}

}  // namespace merlin::io
