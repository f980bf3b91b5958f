#include "daemon/serve/vrpn_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace merlin::serve {
namespace {

constexpr Duration kVrpnRound = std::chrono::milliseconds(50);
constexpr double kDatagrams = 20;  // answered per second, and in a burst
constexpr std::int32_t kButtons = 12;

// The numbers that the server gives to its senders, which VRPN identifies by number; each client is
// first sent their names. The senders are the control, then the hands, the trackers and the balls.
class Senders {
 public:
  explicit Senders(const shm::DeviceSlots& devices)
      : hands_(devices.hands.size()), trackers_(devices.trackers.size()) {
    names_.emplace_back(kVrpnControl);
    const auto add = [&](const char* kind, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) names_.push_back(fmt::format("{}{}", kind, i));
    };
    add("Hand", hands_);
    add("Tracker", trackers_);
    add("Ball", devices.balls.size());
  }

  const std::vector<std::string>& names() const { return names_; }
  std::int32_t hand(std::size_t i) const { return number(i); }
  std::int32_t tracker(std::size_t i) const { return number(hands_ + i); }
  std::int32_t ball(std::size_t i) const { return number(hands_ + trackers_ + i); }

 private:
  static std::int32_t number(std::size_t device) { return static_cast<std::int32_t>(device) + 1; }

  std::size_t hands_, trackers_;
  std::vector<std::string> names_;
};

enum Type : std::int32_t { kPing, kPong, kPose, kChannels, kButtonChange, kButtonStates };
constexpr const char* kTypes[] = {kVrpnPing,         kVrpnPong,       kVrpnPoseType,
                                  kVrpnChannelsType, kVrpnButtonType, kVrpnButtonsType};

net::ServerLimits vrpnLimits() {
  net::ServerLimits l;
  l.places = {.all = 16, .per_peer = 12};  // all clients have the same address
  l.input_bytes = kVrpnLongest;
  l.output_bytes = 1 << 18;  // holds one second of all devices' messages
  l.messages_per_s = l.messages_burst = 500;
  return l;
}

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

Result<UniqueFd> listenUdp(int port) {
  UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const sockaddr_in address = loopback(port);
  if (fd.valid() &&
      ::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return fd;
  const int error = errno;
  return Error{error == EADDRINUSE ? Errc::kBusy : Errc::kIo,
               fmt::format("UDP port {}: {}", port, std::strerror(error))};
}

}  // namespace

// Marks a client's port as connected until it is destroyed: a client repeats its request every
// second until we connect, and must get only one connection.
class PortClaim {
 public:
  PortClaim(std::set<int>& ports, int port) : ports_(ports), port_(port) { ports_.insert(port_); }
  ~PortClaim() { ports_.erase(port_); }
  PortClaim(const PortClaim&) = delete;
  PortClaim& operator=(const PortClaim&) = delete;

 private:
  std::set<int>& ports_;
  int port_;
};

// The connection to one client: the numbers that the client gave to senders and types, and the
// state of the buttons that were sent to it.
class VrpnSession final : public net::Session {
 public:
  VrpnSession(const shm::DeviceSlots& devices, const std::string& instance, const Clock& clock,
              std::unique_ptr<PortClaim> port = nullptr)
      : devices_(devices),
        named_(devices),
        instance_(instance),
        clock_(clock),
        port_(std::move(port)),
        buttons_(devices.balls.size()) {}

  Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) override;
  bool established() const noexcept override { return greeted_; }
  void open(std::string& output) override;

  // `at_ns`: CLOCK_MONOTONIC; clients expect the time of day.
  void send(std::int32_t sender, std::int32_t type, std::string_view payload, std::int64_t at_ns,
            std::string& output);
  // Sends each button of a ball that has changed for this client. `ball`: index of the ball.
  void sendButtons(std::size_t ball, const BallSample& sample, std::string& output);
  const Senders& senders() const { return named_; }

 private:
  void handle(const VrpnMessage& message, std::string& output);
  void describe(const VrpnMessage& message);

  const shm::DeviceSlots& devices_;
  const Senders named_;
  const std::string& instance_;
  const Clock& clock_;
  std::unique_ptr<PortClaim> port_;  // if we connected to the client
  bool greeted_ = false;             // its cookie has arrived
  // The numbers by which the client identifies our senders and the ping message; its other
  // descriptions are ignored.
  std::map<std::int32_t, std::int32_t> senders_;
  std::optional<std::int32_t> ping_;
  std::uint32_t sequence_ = 0;
  std::vector<std::uint32_t> buttons_;  // by ball
};

Result<net::Session::Taken> VrpnSession::receive(std::string_view input, std::size_t most,
                                                 std::string& output) {
  Taken taken;
  if (!greeted_) {
    if (input.size() < kVrpnCookieLength) return taken;
    if (!vrpnCookieFits(input.substr(0, kVrpnCookieLength)))
      return Error{Errc::kMalformed, "its cookie does not match VRPN 7"};
    greeted_ = true;
    taken.bytes = kVrpnCookieLength;
  }
  while (taken.messages < most) {
    const VrpnFront front = readVrpn(input.substr(taken.bytes));
    if (front.broken) return Error{Errc::kMalformed, "it sent a message with an invalid length"};
    if (!front.message) break;
    handle(*front.message, output);
    taken.bytes += front.bytes;
    ++taken.messages;
  }
  return taken;
}

void VrpnSession::open(std::string& output) {
  const std::int64_t now_ns = toNanoseconds(clock_.now());
  output += vrpnCookie();
  for (std::size_t i = 0; i < named_.names().size(); ++i)
    send(static_cast<std::int32_t>(i), kVrpnDescribeSender, vrpnName(named_.names()[i]), now_ns,
         output);
  for (std::int32_t i = 0; i < std::ssize(kTypes); ++i)
    send(i, kVrpnDescribeType, vrpnName(kTypes[i]), now_ns, output);
  send(std::ssize(kTypes), kVrpnDescribeType, vrpnName(kVrpnInstance + instance_), now_ns, output);
  // Sends the state of all buttons, because one may already be pressed.
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    const auto ball = devices_.balls[i].samples->newest();
    buttons_[i] = ball ? ball->buttons : 0;
    send(named_.ball(i), kButtonStates, vrpnButtons(buttons_[i], kButtons), now_ns, output);
  }
}

void VrpnSession::send(std::int32_t sender, std::int32_t type, std::string_view payload,
                       std::int64_t at_ns, std::string& output) {
  const auto wall =
      std::chrono::system_clock::now().time_since_epoch() - (clock_.now() - fromNanoseconds(at_ns));
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(wall).count();
  VrpnHeader header;
  header.seconds = static_cast<std::int32_t>(us / 1'000'000);
  header.microseconds = static_cast<std::int32_t>(us % 1'000'000);
  header.sender = sender;
  header.type = type;
  header.sequence = ++sequence_;
  appendVrpn(header, payload, output);
}

void VrpnSession::handle(const VrpnMessage& m, std::string& output) {
  if (m.header.type == kVrpnDescribeSender) return describe(m);
  if (m.header.type == kVrpnDescribeType) {
    if (readVrpnName(m.payload) == kTypes[kPing])
      ping_ = m.header.sender;
    else if (ping_ == m.header.sender)
      ping_.reset();
    return;
  }
  const auto sender = senders_.find(m.header.sender);
  if (m.header.type == ping_ && sender != senders_.end())
    send(sender->second, kPong, {}, toNanoseconds(clock_.now()), output);
}

void VrpnSession::describe(const VrpnMessage& m) {
  constexpr std::size_t kMostNumbers =
      64;  // limits memory: a client could give the same name many numbers
  senders_.erase(m.header.sender);
  const auto name = readVrpnName(m.payload);
  const auto& names = named_.names();
  const auto known = std::find(names.begin(), names.end(), name.value_or(""));
  if (known != names.end() && senders_.size() < kMostNumbers)
    senders_[m.header.sender] = static_cast<std::int32_t>(known - names.begin());
}

void VrpnSession::sendButtons(std::size_t ball, const BallSample& s, std::string& output) {
  std::uint32_t& known = buttons_[ball];
  for (std::int32_t b = 0; b < kButtons; ++b) {
    if (((s.buttons ^ known) >> b & 1) == 0) continue;
    send(named_.ball(ball), kButtonChange, vrpnButton(b, s.buttons >> b & 1), s.received_ns,
         output);
  }
  known = s.buttons;
}

Result<std::unique_ptr<VrpnServer>> VrpnServer::start(int port, const shm::DeviceSlots& devices,
                                                      ThreadWatch& watch, const Clock& clock,
                                                      std::string instance) {
  auto tcp = net::listenTcp("127.0.0.1", port);
  if (!tcp) return tcp.error();
  auto udp = listenUdp(net::portOf(tcp->get()));
  if (!udp) return udp.error();
  return std::unique_ptr<VrpnServer>(new VrpnServer({*std::move(tcp), *std::move(udp)}, devices,
                                                    watch, clock, std::move(instance)));
}

VrpnServer::VrpnServer(Sockets sockets, const shm::DeviceSlots& devices, ThreadWatch& watch,
                       const Clock& clock, std::string instance)
    : udp_(std::move(sockets.udp)),
      port_(net::portOf(sockets.tcp.get())),
      devices_(devices),
      clock_(clock),
      instance_(std::move(instance)),
      server_("VRPN", vrpnLimits(), clock),
      datagrams_(kDatagrams, kDatagrams),
      waker_(
          [&] {
            std::vector<const std::atomic<std::uint32_t>*> words;
            for (const auto& hand : devices.hands) words.push_back(&hand.samples->wakeWord());
            for (const auto& ball : devices.balls) words.push_back(&ball.samples->wakeWord());
            for (const auto& tracker : devices.trackers) {
              for (const auto* channel : tracker.stations) words.push_back(&channel->wakeWord());
            }
            return words;
          }(),
          watch, "samples for VRPN") {
  for (const auto& hand : devices.hands) seen_hands_.push_back(hand.samples->count());
  for (const auto& ball : devices.balls) seen_balls_.push_back(ball.samples->count());
  for (const auto& tracker : devices.trackers) {
    auto& seen = seen_trackers_.emplace_back();
    for (std::size_t i = 0; i < kStations; ++i) seen[i] = tracker.stations[i]->count();
  }
  server_.listen(std::move(sockets.tcp), [this](const net::Peer&) {
    return std::make_unique<VrpnSession>(devices_, instance_, clock_);
  });
  thread_ = net::ServerThread(watch, "VRPN", [this] { round(); });
}

VrpnServer::~VrpnServer() { thread_.stop(); }

void VrpnServer::round() {
  const int wakers[] = {waker_.fd(), udp_.get()};
  server_.round(kVrpnRound, wakers);
  waker_.clear();
  answerDatagrams();
  sendSamples();
}

// Connects to clients that ask by UDP; only on this machine, whatever host the datagram names, so
// that the server cannot be used as a reflector.
void VrpnServer::answerDatagrams() {
  char datagram[256];
  for (int i = 0; i < 64; ++i) {  // further datagrams wait for the next round
    const ssize_t n = ::recv(udp_.get(), datagram, sizeof datagram, 0);
    if (n < 0) return;
    const auto callback = readVrpnCallback({datagram, static_cast<std::size_t>(n)});
    if (callback && datagrams_.take(1, clock_.now())) connectBack(callback->port);
  }
}

void VrpnServer::connectBack(int port) {
  if (port == port_ || connected_back_.count(port)) return;
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  const sockaddr_in address = loopback(port);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(fd.get(), generic, sizeof address) != 0 && errno != EINPROGRESS) return;
  net::Peer peer;
  peer.address = INADDR_LOOPBACK;
  server_.add(std::move(fd), peer, [this, port](const net::Peer&) {
    return std::make_unique<VrpnSession>(devices_, instance_, clock_,
                                         std::make_unique<PortClaim>(connected_back_, port));
  });
}

template <typename T>
void VrpnServer::each(const shm::Channel<T>& channel, std::uint64_t& seen,
                      const std::function<void(VrpnSession&, const T&, std::string&)>& send) {
  const std::uint64_t count = channel.count();
  if (count - seen > shm::kHistory / 2) seen = count - 1;
  for (; seen < count; ++seen) {
    const auto sample = channel.at(seen);
    if (!sample) continue;
    server_.sendToAll([&](net::Session& session, std::string& output) {
      send(static_cast<VrpnSession&>(session), *sample, output);
    });
  }
}

void VrpnServer::sendSamples() {
  for (std::size_t n = 0; n < devices_.hands.size(); ++n) {
    each<HandSample>(*devices_.hands[n].samples, seen_hands_[n],
                     [n](VrpnSession& client, const HandSample& s, std::string& out) {
                       const std::int32_t hand = client.senders().hand(n);
                       client.send(hand, kPose, vrpnPose(0, s.position_m, s.orientation_wxyz),
                                   s.received_ns, out);
                       const std::vector<double> joints(std::begin(s.joint_rad),
                                                        std::end(s.joint_rad));
                       client.send(hand, kChannels, vrpnChannels(joints), s.received_ns, out);
                     });
  }
  for (std::size_t n = 0; n < devices_.trackers.size(); ++n) {
    for (std::size_t i = 0; i < kStations; ++i) {
      each<TrackerSample>(
          *devices_.trackers[n].stations[i], seen_trackers_[n][i],
          [n, i](VrpnSession& client, const TrackerSample& s, std::string& out) {
            client.send(client.senders().tracker(n), kPose,
                        vrpnPose(static_cast<std::int32_t>(i), s.position_m, s.orientation_wxyz),
                        s.received_ns, out);
          });
    }
  }
  for (std::size_t n = 0; n < devices_.balls.size(); ++n) {
    each<BallSample>(*devices_.balls[n].samples, seen_balls_[n],
                     [n](VrpnSession& client, const BallSample& s, std::string& out) {
                       std::vector<double> axes(std::begin(s.translation), std::end(s.translation));
                       axes.insert(axes.end(), std::begin(s.rotation), std::end(s.rotation));
                       client.send(client.senders().ball(n), kChannels, vrpnChannels(axes),
                                   s.received_ns, out);
                       client.sendButtons(n, s, out);
                     });
  }
}

}  // namespace merlin::serve
