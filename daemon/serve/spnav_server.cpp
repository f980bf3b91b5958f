#include "daemon/serve/spnav_server.h"

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace merlin::serve {
namespace {

constexpr long kRound_ns = 20'000'000;  // a handshake must be answered within 300 ms
constexpr std::size_t kMostClients = 32;
constexpr std::size_t kMostPending = 4096;  // of a client that does not read: it is let go

std::optional<sockaddr_un> addressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return std::nullopt;
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

UniqueFd newSocket() {
  return UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

}  // namespace

Result<std::unique_ptr<SpnavServer>> SpnavServer::start(const std::string& path,
                                                        const SpnavDevice& device,
                                                        const shm::DevicesSegment& segment) {
  const auto address = addressOf(path);
  if (!address) return Error{Errc::kInvalidArgument, path + ": is too long for a socket's name"};
  const auto* generic = reinterpret_cast<const sockaddr*>(&*address);
  if (::connect(newSocket().get(), generic, sizeof *address) == 0) {
    return Error{Errc::kBusy, path + ": another program serves this socket (spacenavd?)"};
  }
  UniqueFd listener = newSocket();
  ::unlink(path.c_str());
  if (::bind(listener.get(), generic, sizeof *address) != 0 || ::listen(listener.get(), 8) != 0 ||
      ::chmod(path.c_str(), 0666) !=
          0) {  // any user's programs may read the ball, as with spacenavd
    return Error{Errc::kIo, fmt::format("{}: {}", path, std::strerror(errno))};
  }
  return std::unique_ptr<SpnavServer>(new SpnavServer(path, std::move(listener), device, segment));
}

SpnavServer::SpnavServer(std::string path, UniqueFd listener, SpnavDevice device,
                         const shm::DevicesSegment& segment)
    : path_(std::move(path)),
      listener_(std::move(listener)),
      device_(std::move(device)),
      segment_(segment),
      seen_(segment.ball.count()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

SpnavServer::~SpnavServer() {
  thread_.request_stop();
  thread_.join();
  ::unlink(path_.c_str());
}

void SpnavServer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    segment_.ball.wait(seen_, {0, kRound_ns});
    acceptClients();
    tellHealth();
    tellSamples();
    std::erase_if(clients_, [](Client& client) { return !serve(client); });
  }
}

void SpnavServer::acceptClients() {
  for (;;) {
    UniqueFd fd(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd.valid()) return;
    if (clients_.size() < kMostClients) {
      clients_.push_back({std::move(fd), SpnavClient(device_), {}});
    }
  }
}

void SpnavServer::tellHealth() {
  const auto health = segment_.health[shm::kBall].read();
  if (!health) return;  // not known yet, or being written: as before
  const bool there = health->state == HealthState::kOk;
  if (there == there_) return;
  there_ = there;
  for (Client& client : clients_) client.protocol.device(there, client.pending);
}

void SpnavServer::tellSamples() {
  const std::uint64_t count = segment_.ball.count();
  if (count - seen_ > shm::kHistory / 2) seen_ = count - 1;
  for (; seen_ < count; ++seen_) {
    const auto sample = segment_.ball.at(seen_);
    if (!sample) continue;
    for (Client& client : clients_)
      client.protocol.sample(*sample, client.pending.empty(), client.pending);
  }
}

bool SpnavServer::serve(Client& client) {
  std::byte bytes[256];
  for (;;) {
    const ssize_t n = ::recv(client.fd.get(), bytes, sizeof bytes, MSG_DONTWAIT);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) return false;
    if (n < 0) break;
    client.protocol.receive(std::span(bytes, static_cast<std::size_t>(n)), client.pending);
  }
  if (client.pending.empty()) return true;
  const ssize_t n = ::send(client.fd.get(), client.pending.data(), client.pending.size(),
                           MSG_DONTWAIT | MSG_NOSIGNAL);
  if (n > 0) client.pending.erase(0, static_cast<std::size_t>(n));
  return client.pending.size() <= kMostPending;
}

}  // namespace merlin::serve
