#include "daemon/serve/vrpn_server.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

namespace merlin::serve {
namespace {

constexpr int kRound_ms = 4;  // what a sample may wait for, beside a tracker's own 8 ms
constexpr std::size_t kMostClients = 16;
constexpr std::size_t kMostOutput = 1 << 20;  // of a client that does not read: it is let go

// Our numbers for names; each is described to a client before anything else.
enum Sender : std::int32_t { kControl, kHand, kTracker, kBall };
constexpr const char* kSenders[] = {"VRPN Control", "Hand0", "Tracker0", "Ball0"};
enum Type : std::int32_t { kPing, kPong, kPose, kChannels, kButtonChange };
constexpr const char* kTypes[] = {"vrpn_Base ping_message", "vrpn_Base pong_message",
                                  "vrpn_Tracker Pos_Quat", "vrpn_Analog Channel",
                                  "vrpn_Button Change"};
constexpr std::int32_t kDescribeSender = -1, kDescribeType = -2;

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

// Bound to the loopback device; invalid where the port is taken.
UniqueFd boundSocket(int kind, int port) {
  UniqueFd fd(::socket(AF_INET, kind | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  if (kind == SOCK_STREAM) ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = loopback(port);
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}

int portOf(int fd) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

}  // namespace

Result<std::unique_ptr<VrpnServer>> VrpnServer::start(int port, const shm::DevicesSegment& segment,
                                                      const Clock& clock) {
  UniqueFd tcp = boundSocket(SOCK_STREAM, port);
  UniqueFd udp;
  if (tcp.valid()) udp = boundSocket(SOCK_DGRAM, portOf(tcp.get()));
  if (!tcp.valid() || !udp.valid()) {
    return Error{errno == EADDRINUSE ? Errc::kBusy : Errc::kIo,
                 fmt::format("VRPN's port {}: {}", port, std::strerror(errno))};
  }
  if (::listen(tcp.get(), 8) != 0) return Error{Errc::kIo, std::strerror(errno)};
  const int taken = portOf(tcp.get());
  return std::unique_ptr<VrpnServer>(
      new VrpnServer(std::move(tcp), std::move(udp), taken, segment, clock));
}

VrpnServer::VrpnServer(UniqueFd tcp, UniqueFd udp, int port, const shm::DevicesSegment& segment,
                       const Clock& clock)
    : tcp_(std::move(tcp)),
      udp_(std::move(udp)),
      port_(port),
      segment_(segment),
      clock_(clock),
      seen_hand_(segment.hand.count()),
      seen_ball_(segment.ball.count()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

VrpnServer::~VrpnServer() {
  thread_.request_stop();
  thread_.join();
}

void VrpnServer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<pollfd> fds = {{tcp_.get(), POLLIN, 0}, {udp_.get(), POLLIN, 0}};
    for (const Client& client : clients_) fds.push_back({client.fd.get(), POLLIN, 0});
    ::poll(fds.data(), fds.size(), clients_.empty() ? 50 : kRound_ms);
    acceptClients();
    answerDatagrams();
    tellSamples();
    std::erase_if(clients_, [this](Client& client) { return !serve(client); });
  }
}

void VrpnServer::acceptClients() {
  for (;;) {
    UniqueFd fd(::accept4(tcp_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd.valid()) return;
    greet(std::move(fd));
  }
}

// A client that asks by UDP is connected to. Only on this machine, whatever the datagram says: the
// server must be nobody's reflector.
void VrpnServer::answerDatagrams() {
  char datagram[256];
  for (;;) {
    const ssize_t n = ::recv(udp_.get(), datagram, sizeof datagram, 0);
    if (n < 0) return;
    const auto callback = readVrpnCallback({datagram, static_cast<std::size_t>(n)});
    if (!callback) continue;
    UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const sockaddr_in address = loopback(callback->port);
    const int done =
        ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    if (done == 0 || errno == EINPROGRESS) greet(std::move(fd));
  }
}

void VrpnServer::greet(UniqueFd fd) {
  if (clients_.size() >= kMostClients) return;
  const int yes = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  clients_.push_back({});
  Client& client = clients_.back();
  client.fd = std::move(fd);
  client.output = vrpnCookie();
  for (std::int32_t i = 0; i < std::ssize(kSenders); ++i)
    send(client, i, kDescribeSender, vrpnName(kSenders[i]), toNanoseconds(clock_.now()));
  for (std::int32_t i = 0; i < std::ssize(kTypes); ++i)
    send(client, i, kDescribeType, vrpnName(kTypes[i]), toNanoseconds(clock_.now()));
}

// `at_ns`: CLOCK_MONOTONIC; clients expect the time of day.
void VrpnServer::send(Client& client, std::int32_t sender, std::int32_t type, std::string payload,
                      std::int64_t at_ns) {
  const auto wall =
      std::chrono::system_clock::now().time_since_epoch() - (clock_.now() - fromNanoseconds(at_ns));
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(wall).count();
  VrpnMessage m;
  m.seconds = static_cast<std::int32_t>(us / 1'000'000);
  m.microseconds = static_cast<std::int32_t>(us % 1'000'000);
  m.sender = sender;
  m.type = type;
  m.sequence = ++client.sequence;
  m.payload = std::move(payload);
  client.output += encodeVrpn(m);
}

bool VrpnServer::serve(Client& client) {
  char bytes[4096];
  for (;;) {
    const ssize_t n = ::recv(client.fd.get(), bytes, sizeof bytes, MSG_DONTWAIT);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR && errno != ENOTCONN)) return false;
    if (n < 0) break;
    client.input.append(bytes, static_cast<std::size_t>(n));
  }
  if (!client.greeted && client.input.size() >= kVrpnCookieLength) {
    if (!vrpnCookieFits(client.input.substr(0, kVrpnCookieLength))) return false;
    client.input.erase(0, kVrpnCookieLength);
    client.greeted = true;
  }
  bool broken = false;
  while (client.greeted && !broken) {
    const auto message = takeVrpn(client.input, broken);
    if (!message) break;
    handle(client, *message);
  }
  const ssize_t n = ::send(client.fd.get(), client.output.data(), client.output.size(),
                           MSG_DONTWAIT | MSG_NOSIGNAL);
  if (n > 0) client.output.erase(0, static_cast<std::size_t>(n));
  return !broken && client.output.size() <= kMostOutput;
}

void VrpnServer::handle(Client& client, const VrpnMessage& m) {
  constexpr std::size_t kMostNames = 256;
  if (m.type == kDescribeSender || m.type == kDescribeType) {
    auto& names = m.type == kDescribeSender ? client.senders : client.types;
    const auto name = readVrpnName(m.payload);
    if (name && names.size() < kMostNames) names[m.sender] = *name;
    return;
  }
  const auto type = client.types.find(m.type);
  const auto sender = client.senders.find(m.sender);
  if (type == client.types.end() || type->second != kTypes[kPing]) return;
  for (std::int32_t i = 0; i < std::ssize(kSenders); ++i) {
    if (sender != client.senders.end() && sender->second == kSenders[i])
      send(client, i, kPong, {}, toNanoseconds(clock_.now()));
  }
}

template <typename T>
void VrpnServer::each(const shm::Channel<T>& channel, std::uint64_t& seen,
                      const std::function<void(Client&, const T&)>& tell) {
  const std::uint64_t count = channel.count();
  if (count - seen > shm::kHistory / 2) seen = count - 1;
  for (; seen < count; ++seen) {
    const auto sample = channel.at(seen);
    for (Client& client : clients_) {
      if (sample && client.greeted) tell(client, *sample);
    }
  }
}

void VrpnServer::tellSamples() {
  each<HandSample>(segment_.hand, seen_hand_, [this](Client& client, const HandSample& s) {
    send(client, kHand, kPose, vrpnPose(0, s.position_m, s.orientation_wxyz), s.received_ns);
    const std::vector<double> joints(std::begin(s.joint_rad), std::end(s.joint_rad));
    send(client, kHand, kChannels, vrpnChannels(joints), s.received_ns);
  });
  for (std::size_t i = 0; i < kStations; ++i) {
    each<TrackerSample>(
        segment_.tracker[i], seen_tracker_[i], [this, i](Client& client, const TrackerSample& s) {
          send(client, kTracker, kPose,
               vrpnPose(static_cast<std::int32_t>(i), s.position_m, s.orientation_wxyz),
               s.received_ns);
        });
  }
  each<BallSample>(segment_.ball, seen_ball_, [this](Client& client, const BallSample& s) {
    std::vector<double> axes(std::begin(s.translation), std::end(s.translation));
    axes.insert(axes.end(), std::begin(s.rotation), std::end(s.rotation));
    send(client, kBall, kChannels, vrpnChannels(axes), s.received_ns);
    for (std::int32_t b = 0; b < 12; ++b) {
      if (((s.buttons ^ client.buttons) >> b & 1) == 0) continue;
      send(client, kBall, kButtonChange, vrpnButton(b, s.buttons >> b & 1), s.received_ns);
    }
    client.buttons = s.buttons;
  });
}

}  // namespace merlin::serve
