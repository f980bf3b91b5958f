// The VRPN protocol byte by byte, as in VRPN's sources, and MERLIN's server over real sockets.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "daemon/serve/vrpn_protocol.h"
#include "daemon/serve/vrpn_server.h"
#include "tests/support/eventually.h"
#include "tests/support/local_devices.h"

namespace merlin::serve {
namespace {

using namespace std::string_literals;

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    char pair[3];
    std::snprintf(pair, sizeof pair, "%02X", static_cast<unsigned char>(c));
    text += pair;
  }
  return text;
}

std::string encoded(const VrpnHeader& header, std::string_view payload = {}) {
  std::string bytes;
  appendVrpn(header, payload, bytes);
  return bytes;
}

TEST(VrpnProtocol, TheCookieIsTwentyFourBytes) {
  EXPECT_EQ(hex(vrpnCookie()), "7672706E3A207665722E2030372E33382020300000000000");
  EXPECT_TRUE(vrpnCookieFits(vrpnCookie()));
  EXPECT_TRUE(vrpnCookieFits("vrpn: ver. 07.33  0\0\0\0\0\0"s)) << "a minor version only";
  EXPECT_FALSE(vrpnCookieFits("vrpn: ver. 06.38  0\0\0\0\0\0"s));
  EXPECT_EQ(vrpnVersion("vrpn: ver. 07.33  0\0\0\0\0\0"s), "07.33");
}

TEST(VrpnProtocol, ASenderIsDescribedByItsName) {
  VrpnHeader header;
  header.seconds = 1700000000;
  header.sender = 1;
  header.type = -1;
  header.sequence = 7;
  const std::string bytes = encoded(header, vrpnName("Fastrak0"));
  EXPECT_EQ(hex(bytes),
            "000000256553F1000000000000000001FFFFFFFF00000007"
            "000000094661737472616B3000"
            "000000");
  const VrpnFront back = readVrpn(bytes);
  ASSERT_TRUE(back.message);
  EXPECT_EQ(back.bytes, bytes.size());
  EXPECT_EQ(back.message->header.sequence, 7u);
  EXPECT_EQ(readVrpnName(back.message->payload), "Fastrak0");
}

TEST(VrpnProtocol, APoseIsSevenDoubles) {
  const float p[] = {0.254F, -0.1397F, 0.08255F}, q[] = {0.5F, 0, 0, 0.75F};
  const std::string pose = vrpnPose(2, p, q);
  ASSERT_EQ(pose.size(), 64u);
  EXPECT_EQ(hex(pose.substr(0, 8)), "0000000200000000");
  EXPECT_EQ(hex(pose.substr(8, 3)), "3FD041");   // 0.254
  EXPECT_EQ(hex(pose.substr(16, 3)), "BFC1E1");  // -0.1397
  EXPECT_EQ(hex(pose.substr(32, 8)), "0000000000000000");
  EXPECT_EQ(hex(pose.substr(48, 8)), "3FE8000000000000");  // qz
  EXPECT_EQ(hex(pose.substr(56, 8)), "3FE0000000000000");  // qw last
  const auto back = readVrpnPose(pose);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->sensor, 2);
  EXPECT_EQ(back->position[1], static_cast<double>(-0.1397F));
  EXPECT_EQ(back->orientation_wxyz, (std::array<double, 4>{0.5, 0, 0, 0.75}));
  EXPECT_FALSE(readVrpnPose(pose.substr(0, 63)));
  EXPECT_FALSE(readVrpnPose(pose + '\0'));
}

TEST(VrpnProtocol, ChannelsAndButtons) {
  const double two[] = {1.0, -2.0};
  EXPECT_EQ(hex(vrpnChannels(two)), "40000000000000003FF0000000000000C000000000000000");
  EXPECT_EQ(hex(vrpnButton(8, true)), "0000000800000001");
}

TEST(VrpnProtocol, CallbacksAreReadWithCare) {
  const auto good = readVrpnCallback("127.0.0.1 59207\0"s);
  ASSERT_TRUE(good);
  EXPECT_EQ(good->port, 59207);
  for (const char* bad : {"", "host", "host 80", "host 70000", "ho;st 5000", " 5000", "host 5000x"})
    EXPECT_FALSE(readVrpnCallback(bad)) << bad;
}

TEST(VrpnProtocol, EveryPrefixWaitsAndEveryBadLengthIsSaid) {
  const std::string whole = encoded({}, vrpnName("x"));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const VrpnFront front = readVrpn(whole.substr(0, n));
    EXPECT_FALSE(front.message) << n;
    EXPECT_FALSE(front.broken);
  }
  EXPECT_EQ(readVrpn(whole + "more").bytes, whole.size());
  std::string wild = whole;
  wild[0] = '\x7F';
  EXPECT_TRUE(readVrpn(wild).broken);
  const std::string longest(kVrpnLongest - 24, '\0');
  EXPECT_FALSE(readVrpn(encoded({}, longest).substr(0, 100)).broken);
  EXPECT_TRUE(readVrpn(encoded({}, longest + "x").substr(0, 100)).broken);
  for (std::size_t n = 0; n < 12; ++n) (void)readVrpnName(whole.substr(24, n));
}

// A client that begins as VRPN's own client does: with a cookie, descriptions and a ping.
struct Client {
  explicit Client(int fd_) : fd(fd_) {
    timeval limit{10, 0};
    ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    std::string hello = vrpnCookie();
    hello += described(0, -1, "Ball0") + described(3, -2, "vrpn_Base ping_message");
    EXPECT_GT(::send(fd.get(), hello.data(), hello.size(), 0), 0);
  }
  static std::string described(int id, int type, const char* name) {
    VrpnHeader header;
    header.sender = id;
    header.type = type;
    return encoded(header, vrpnName(name));
  }
  void ping() {
    VrpnHeader header;
    header.sender = 0;
    header.type = 3;
    const std::string bytes = encoded(header);
    EXPECT_GT(::send(fd.get(), bytes.data(), bytes.size(), 0), 0);
  }
  struct Received {
    VrpnHeader header;
    std::string payload;
  };
  // Returns the next message whose type has this name in the server's descriptions.
  std::optional<Received> next(const std::string& type) {
    for (VrpnFront front; !front.broken;) {
      if (!cookie_seen && input.size() >= 24) {
        EXPECT_TRUE(vrpnCookieFits(input.substr(0, 24)));
        input.erase(0, 24);
        cookie_seen = true;
      }
      front = cookie_seen ? readVrpn(input) : VrpnFront{};
      std::optional<Received> m;
      if (front.message) m = {front.message->header, std::string(front.message->payload)};
      input.erase(0, front.bytes);
      if (!m) {
        char buffer[4096];
        const ssize_t n = ::recv(fd.get(), buffer, sizeof buffer, 0);
        if (n <= 0) return std::nullopt;
        input.append(buffer, static_cast<std::size_t>(n));
      } else if (m->header.type == -1) {
        senders[m->header.sender] = *readVrpnName(m->payload);
      } else if (m->header.type == -2) {
        types[m->header.sender] = *readVrpnName(m->payload);
      } else if (types[m->header.type] == type) {
        return m;
      }
    }
    return std::nullopt;
  }
  UniqueFd fd;
  std::string input;
  bool cookie_seen = false;
  std::map<int, std::string> senders, types;
};

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

void checkSamples(Client& client, shm::DevicesSegment& segment) {
  client.ping();
  const auto pong = client.next("vrpn_Base pong_message");
  ASSERT_TRUE(pong);
  EXPECT_EQ(client.senders[pong->header.sender], "Ball0");
  BallSample ball{};
  ball.translation[2] = 0.5F;
  ball.buttons = 4;
  segment.ball[0].publish(ball);
  const auto analog = client.next("vrpn_Analog Channel");
  ASSERT_TRUE(analog);
  EXPECT_EQ(client.senders[analog->header.sender], "Ball0");
  const double channels[] = {0, 0, 0.5, 0, 0, 0};
  EXPECT_EQ(analog->payload, vrpnChannels(channels));
  const auto button = client.next("vrpn_Button Change");
  ASSERT_TRUE(button);
  EXPECT_EQ(button->payload, vrpnButton(2, true));
  TrackerSample tracker{};
  tracker.station = 3;
  tracker.position_m[0] = 1;
  tracker.orientation_wxyz[0] = 1;
  segment.tracker[0].stations[2].publish(tracker);
  const auto pose = client.next("vrpn_Tracker Pos_Quat");
  ASSERT_TRUE(pose);
  EXPECT_EQ(client.senders[pose->header.sender], "Tracker0");
  EXPECT_EQ(pose->payload, vrpnPose(2, tracker.position_m, tracker.orientation_wxyz));
  EXPECT_GT(pose->header.seconds, 1'600'000'000) << "the time of day";
}

TEST(VrpnServer, SaysWhoseItIs) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock, "lab");
  ASSERT_TRUE(server) << server.error().what;
  const sockaddr_in address = loopback((*server)->port());
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  Client client(::dup(fd.get()));
  ASSERT_TRUE(client.next("vrpn_Button States"));
  EXPECT_EQ(client.types.rbegin()->second, "MERLIN instance lab");
}

TEST(VrpnServer, ServesAClientThatConnects) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const sockaddr_in address = loopback((*server)->port());
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  Client connected(::dup(fd.get()));
  checkSamples(connected, *segment);
}

TEST(VrpnServer, ConnectsBackToAClientThatAsksByUdp) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const UniqueFd listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in here = loopback(0);
  socklen_t size = sizeof here;
  ASSERT_EQ(::bind(listener.get(), reinterpret_cast<sockaddr*>(&here), sizeof here), 0);
  ASSERT_EQ(::listen(listener.get(), 1), 0);
  ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&here), &size);
  const std::string ask = "127.0.0.1 " + std::to_string(ntohs(here.sin_port));
  const UniqueFd udp(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in there = loopback((*server)->port());
  ASSERT_GT(::sendto(udp.get(), ask.c_str(), ask.size() + 1, 0,
                     reinterpret_cast<const sockaddr*>(&there), sizeof there),
            0);
  Client client(::accept(listener.get(), nullptr, nullptr));
  checkSamples(client, *segment);
}

UniqueFd connectedTo(const VrpnServer& server) {
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_in address = loopback(server.port());
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}

TEST(VrpnServer, AClientHearsOfAButtonThatIsHeldAlready) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  BallSample ball{};
  ball.buttons = 5;
  segment->ball[0].publish(ball);
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  Client client(::dup(connectedTo(**server).get()));
  const auto states = client.next("vrpn_Button States");
  ASSERT_TRUE(states);
  EXPECT_EQ(hex(states->payload.substr(0, 16)), "0000000C000000010000000000000001");
}

// Each message of the flood is well-formed. The server reads them at a limited pace and serves
// other clients meanwhile.
TEST(VrpnServer, AFloodOfOneClientNeitherGrowsNorKeepsAnyoneWaiting) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const UniqueFd flood = connectedTo(**server);
  VrpnHeader empty;
  empty.type = 999;
  std::string bytes = vrpnCookie();
  while (bytes.size() < 1 << 20) appendVrpn(empty, {}, bytes);
  std::size_t taken = 0;
  for (int i = 0; i < 64; ++i) {
    const ssize_t n = ::send(flood.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n > 0) taken += static_cast<std::size_t>(n);
  }
  EXPECT_LT(taken, std::size_t{16} << 20) << "what sockets hold, not more";
  Client other(::dup(connectedTo(**server).get()));
  checkSamples(other, *segment);
  server->reset();  // must return at once, else the test hangs
}

TEST(VrpnServer, SilentClientsGiveTheirPlacesUp) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  std::vector<UniqueFd> silent;
  for (int i = 0; i < 16; ++i) silent.push_back(connectedTo(**server));
  EXPECT_TRUE(test::eventually([&] { return (*server)->report().silent >= 12; }));
  Client client(::dup(connectedTo(**server).get()));
  checkSamples(client, *segment);
}

// UDP datagrams cost their sender nothing, so the connections that they ask for must not take the
// places of other clients.
TEST(VrpnServer, DatagramsThatAskForSilentConnectionsKeepNobodyOut) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const UniqueFd udp(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in there = loopback((*server)->port());
  // The kernel accepts connections to these sockets, but nothing is ever sent on them.
  std::vector<UniqueFd> listeners;
  for (int i = 0; i < 20; ++i) {
    listeners.push_back(*net::listenTcp("127.0.0.1", 0));
    const std::string ask = "127.0.0.1 " + std::to_string(net::portOf(listeners.back().get()));
    ASSERT_GT(::sendto(udp.get(), ask.c_str(), ask.size() + 1, 0,
                       reinterpret_cast<const sockaddr*>(&there), sizeof there),
              0);
  }
  ASSERT_TRUE(test::eventually([&] { return (*server)->report().accepted >= 12; }));
  EXPECT_TRUE(test::eventually([&] { return (*server)->report().connections == 0; }))
      << "closed after 2 s";
  Client client(::dup(connectedTo(**server).get()));
  checkSamples(client, *segment);
}

TEST(VrpnServer, IsNotItsOwnClient) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const auto listener = net::listenTcp("127.0.0.1", 0);
  const UniqueFd udp(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in there = loopback((*server)->port());
  for (const int port : {(*server)->port(), net::portOf(listener->get())}) {
    const std::string ask = "127.0.0.1 " + std::to_string(port);
    ::sendto(udp.get(), ask.c_str(), ask.size() + 1, 0, reinterpret_cast<const sockaddr*>(&there),
             sizeof there);
  }
  ASSERT_TRUE(test::eventually([&] { return (*server)->report().accepted > 0; }));
  EXPECT_EQ((*server)->report().accepted, 1U)
      << "the other port's alone, which was asked for later";
}

TEST(VrpnServer, OnePortIsConnectedToOnceHoweverOftenItIsAskedFor) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto server = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(server) << server.error().what;
  const auto listener = net::listenTcp("127.0.0.1", 0);
  ASSERT_TRUE(listener);
  const UniqueFd udp(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in there = loopback((*server)->port());
  const std::string ask = "127.0.0.1 " + std::to_string(net::portOf(listener->get()));
  // Asks for a connection to the same port until the server has closed the first connection because
  // nothing was sent on it.
  EXPECT_TRUE(test::eventually([&] {
    ::sendto(udp.get(), ask.c_str(), ask.size() + 1, 0, reinterpret_cast<const sockaddr*>(&there),
             sizeof there);
    EXPECT_LE((*server)->report().connections, 1U);
    return (*server)->report().silent > 0;
  }));
}

TEST(VrpnServer, APortThatIsTakenIsRefused) {
  const SystemClock clock;
  ThreadWatch threads;
  const test::LocalDevices segment;
  const auto first = VrpnServer::start(0, segment.slots(), threads, clock);
  ASSERT_TRUE(first);
  const auto second = VrpnServer::start((*first)->port(), segment.slots(), threads, clock);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
}

}  // namespace
}  // namespace merlin::serve
