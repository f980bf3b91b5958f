#include "daemon/serve/vrpn_server.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace merlin::serve {
namespace {

constexpr Duration kRound = std::chrono::milliseconds(50);
constexpr Duration kAskAgain = std::chrono::milliseconds(500);  // clients ask once a second
constexpr double kDatagrams = 20;                               // a second, and at once
constexpr std::int32_t kButtons = 12;

// Our numbers for names; each is described to a client before anything else.
enum Sender : std::int32_t { kControl, kHand, kTracker, kBall };
constexpr const char* kSenders[] = {"VRPN Control", "Hand0", "Tracker0", "Ball0"};
enum Type : std::int32_t { kPing, kPong, kPose, kChannels, kButtonChange, kButtonStates };
constexpr const char* kTypes[] = {"vrpn_Base ping_message", "vrpn_Base pong_message",
                                  "vrpn_Tracker Pos_Quat",  "vrpn_Analog Channel",
                                  "vrpn_Button Change",     "vrpn_Button States"};
constexpr std::int32_t kDescribeSender = -1, kDescribeType = -2;

net::ServerLimits limits() {
  net::ServerLimits l;
  l.places = {.all = 16, .per_peer = 12};  // all clients are of one address
  l.input_bytes = kVrpnLongest;
  l.output_bytes = 1 << 20;
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

// One client: its numbers for names, and what it was told.
class VrpnSession final : public net::Session {
 public:
  VrpnSession(const shm::DevicesSegment& segment, const Clock& clock)
      : segment_(segment), clock_(clock) {}

  Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) override;
  bool established() const noexcept override { return greeted_; }
  void open(std::string& output) override;

  // `at_ns`: CLOCK_MONOTONIC; clients expect the time of day.
  void send(std::int32_t sender, std::int32_t type, std::string payload, std::int64_t at_ns,
            std::string& output);
  void tellButtons(const BallSample& sample, std::string& output);

 private:
  void handle(const VrpnMessage& message, std::string& output);

  const shm::DevicesSegment& segment_;
  const Clock& clock_;
  bool greeted_ = false;                                 // its cookie has come
  std::map<std::int32_t, std::string> senders_, types_;  // its numbers for names
  std::uint32_t sequence_ = 0;
  std::uint32_t buttons_ = 0;
};

Result<net::Session::Taken> VrpnSession::receive(std::string_view input, std::size_t most,
                                                 std::string& output) {
  Taken taken;
  if (!greeted_) {
    if (input.size() < kVrpnCookieLength) return taken;
    if (!vrpnCookieFits(input.substr(0, kVrpnCookieLength)))
      return Error{Errc::kMalformed, "its cookie is not that of VRPN 7"};
    greeted_ = true;
    taken.bytes = kVrpnCookieLength;
  }
  while (taken.messages < most) {
    const VrpnFront front = readVrpn(input.substr(taken.bytes));
    if (front.broken) return Error{Errc::kMalformed, "a message of a length that cannot be"};
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
  for (std::int32_t i = 0; i < std::ssize(kSenders); ++i)
    send(i, kDescribeSender, vrpnName(kSenders[i]), now_ns, output);
  for (std::int32_t i = 0; i < std::ssize(kTypes); ++i)
    send(i, kDescribeType, vrpnName(kTypes[i]), now_ns, output);
  // A button may be held already.
  const auto ball = segment_.ball.newest();
  buttons_ = ball ? ball->buttons : 0;
  send(kBall, kButtonStates, vrpnButtons(buttons_, kButtons), now_ns, output);
}

void VrpnSession::send(std::int32_t sender, std::int32_t type, std::string payload,
                       std::int64_t at_ns, std::string& output) {
  const auto wall =
      std::chrono::system_clock::now().time_since_epoch() - (clock_.now() - fromNanoseconds(at_ns));
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(wall).count();
  VrpnMessage m;
  m.seconds = static_cast<std::int32_t>(us / 1'000'000);
  m.microseconds = static_cast<std::int32_t>(us % 1'000'000);
  m.sender = sender;
  m.type = type;
  m.sequence = ++sequence_;
  m.payload = std::move(payload);
  output += encodeVrpn(m);
}

void VrpnSession::handle(const VrpnMessage& m, std::string& output) {
  constexpr std::size_t kMostNames = 256;
  if (m.type == kDescribeSender || m.type == kDescribeType) {
    auto& names = m.type == kDescribeSender ? senders_ : types_;
    const auto name = readVrpnName(m.payload);
    if (name && (names.size() < kMostNames || names.count(m.sender))) names[m.sender] = *name;
    return;
  }
  const auto type = types_.find(m.type);
  const auto sender = senders_.find(m.sender);
  if (type == types_.end() || type->second != kTypes[kPing]) return;
  for (std::int32_t i = 0; i < std::ssize(kSenders); ++i) {
    if (sender != senders_.end() && sender->second == kSenders[i])
      send(i, kPong, {}, toNanoseconds(clock_.now()), output);
  }
}

void VrpnSession::tellButtons(const BallSample& s, std::string& output) {
  for (std::int32_t b = 0; b < kButtons; ++b) {
    if (((s.buttons ^ buttons_) >> b & 1) == 0) continue;
    send(kBall, kButtonChange, vrpnButton(b, s.buttons >> b & 1), s.received_ns, output);
  }
  buttons_ = s.buttons;
}

Result<std::unique_ptr<VrpnServer>> VrpnServer::start(int port, const shm::DevicesSegment& segment,
                                                      ThreadWatch& watch, const Clock& clock) {
  auto tcp = net::listenTcp("127.0.0.1", port);
  if (!tcp) return tcp.error();
  auto udp = listenUdp(net::portOf(tcp->get()));
  if (!udp) return udp.error();
  return std::unique_ptr<VrpnServer>(
      new VrpnServer(*std::move(tcp), *std::move(udp), segment, watch, clock));
}

VrpnServer::VrpnServer(UniqueFd tcp, UniqueFd udp, const shm::DevicesSegment& segment,
                       ThreadWatch& watch, const Clock& clock)
    : udp_(std::move(udp)),
      port_(net::portOf(tcp.get())),
      segment_(segment),
      clock_(clock),
      server_("VRPN", limits(), clock),
      datagrams_(kDatagrams, kDatagrams),
      seen_hand_(segment.hand.count()),
      seen_ball_(segment.ball.count()),
      waker_(
          [&] {
            std::vector<const std::atomic<std::uint32_t>*> words = {&segment.hand.wakeWord(),
                                                                    &segment.ball.wakeWord()};
            for (const auto& channel : segment.tracker) words.push_back(&channel.wakeWord());
            return words;
          }(),
          watch, "samples for VRPN") {
  for (std::size_t i = 0; i < kStations; ++i) seen_tracker_[i] = segment.tracker[i].count();
  server_.listen(std::move(tcp), [this](const net::Peer&) { return makeSession(); });
  thread_ = WatchedThread(watch, "VRPN", [this](const std::stop_token& stop, Progress& progress) {
    run(stop, progress);
  });
}

VrpnServer::~VrpnServer() { thread_.stop(); }

std::unique_ptr<net::Session> VrpnServer::makeSession() const {
  return std::make_unique<VrpnSession>(segment_, clock_);
}

void VrpnServer::run(const std::stop_token& stop, Progress& progress) {
  while (!stop.stop_requested()) {
    const int wakers[] = {waker_.fd(), udp_.get()};
    server_.round(kRound, wakers);
    waker_.clear();
    answerDatagrams();
    tellSamples();
    progress.step();
  }
}

// A client that asks by UDP is connected to. Only on this machine, whatever the datagram says: the
// server must be nobody's reflector.
void VrpnServer::answerDatagrams() {
  char datagram[256];
  for (int i = 0; i < 64; ++i) {  // what is left waits for the next round
    const ssize_t n = ::recv(udp_.get(), datagram, sizeof datagram, 0);
    if (n < 0) return;
    const auto callback = readVrpnCallback({datagram, static_cast<std::size_t>(n)});
    if (callback && datagrams_.take(1, clock_.now())) connectBack(callback->port);
  }
}

void VrpnServer::connectBack(int port) {
  const Timestamp now = clock_.now();
  std::erase_if(asked_from_, [&](const auto& asked) { return now - asked.second >= kAskAgain; });
  if (!asked_from_.emplace(port, now).second) return;
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const sockaddr_in address = loopback(port);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(fd.get(), generic, sizeof address) != 0 && errno != EINPROGRESS) return;
  net::Peer peer;
  peer.address = INADDR_LOOPBACK;
  server_.add(std::move(fd), peer, [this](const net::Peer&) { return makeSession(); });
}

template <typename T>
void VrpnServer::each(const shm::Channel<T>& channel, std::uint64_t& seen,
                      const std::function<void(VrpnSession&, const T&, std::string&)>& tell) {
  const std::uint64_t count = channel.count();
  if (count - seen > shm::kHistory / 2) seen = count - 1;
  for (; seen < count; ++seen) {
    const auto sample = channel.at(seen);
    if (!sample) continue;
    server_.tell([&](net::Session& session, std::string& output) {
      tell(static_cast<VrpnSession&>(session), *sample, output);
    });
  }
}

void VrpnServer::tellSamples() {
  each<HandSample>(
      segment_.hand, seen_hand_, [](VrpnSession& client, const HandSample& s, std::string& out) {
        client.send(kHand, kPose, vrpnPose(0, s.position_m, s.orientation_wxyz), s.received_ns,
                    out);
        const std::vector<double> joints(std::begin(s.joint_rad), std::end(s.joint_rad));
        client.send(kHand, kChannels, vrpnChannels(joints), s.received_ns, out);
      });
  for (std::size_t i = 0; i < kStations; ++i) {
    each<TrackerSample>(
        segment_.tracker[i], seen_tracker_[i],
        [i](VrpnSession& client, const TrackerSample& s, std::string& out) {
          client.send(kTracker, kPose,
                      vrpnPose(static_cast<std::int32_t>(i), s.position_m, s.orientation_wxyz),
                      s.received_ns, out);
        });
  }
  each<BallSample>(segment_.ball, seen_ball_,
                   [](VrpnSession& client, const BallSample& s, std::string& out) {
                     std::vector<double> axes(std::begin(s.translation), std::end(s.translation));
                     axes.insert(axes.end(), std::begin(s.rotation), std::end(s.rotation));
                     client.send(kBall, kChannels, vrpnChannels(axes), s.received_ns, out);
                     client.tellButtons(s, out);
                   });
}

}  // namespace merlin::serve
