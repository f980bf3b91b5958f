// MERLIN's space-mouse socket, tested with Debian's libspnav and, byte by byte, by its protocol.
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

#include <gtest/gtest.h>
#include <spnav.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/serve/spnav_server.h"
#include "tests/support/eventually.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::serve {
namespace {

BallSample pushed(std::array<std::int16_t, 6> raw, std::uint32_t buttons = 0) {
  BallSample s{};
  std::copy(raw.begin(), raw.end(), s.raw);
  s.buttons = buttons;
  s.period_us = 50'000;
  return s;
}

std::string bytesOf(const std::string& text) {  // `text`: hexadecimal digits; blanks are ignored
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    bytes.push_back(static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16)));
    i += 2;
  }
  return bytes;
}

std::string feed(SpnavClient& client, const std::string& bytes) {
  std::string out;
  client.receive(bytes, 100, out);
  return out;
}

TEST(SpnavProtocol, AMotionIsEightWords) {
  SpnavClient client({});
  std::string out;
  client.sample(pushed({256, -512, 1000, -1, 39, -10}), true, out);
  EXPECT_EQ(out,
            bytesOf("00000000 00010000 00FEFFFF E8030000 FFFFFFFF 27000000 F6FFFFFF 32000000"));
}

TEST(SpnavProtocol, VersionOneIsEchoedAndAnswersRequests) {
  SpnavClient client({});
  EXPECT_EQ(feed(client, bytesOf("0155AA7F")), bytesOf("0155AA7F"));
  EXPECT_EQ(client.version(), 1);
  const std::string axes = bytesOf("0220AA7F") + std::string(28, '\0');
  std::string answer = bytesOf("0220AA7F 06000000") + std::string(24, '\0');
  EXPECT_EQ(feed(client, axes), answer);
  std::string out;
  for (std::size_t n = 0; n < axes.size(); ++n)
    EXPECT_EQ(client.receive(axes.substr(0, n), 100, out).bytes, 0U) << "not whole";
  // An unsupported request is answered with -1; a request that sets a name is not answered.
  EXPECT_EQ(feed(client, bytesOf("0030AA7F") + std::string(28, '\0')),
            bytesOf("0030AA7F") + std::string(24, '\0') + bytesOf("FFFFFFFF"));
  EXPECT_EQ(feed(client, bytesOf("0010AA7F") + std::string(28, 'x')), "");
}

// libspnav 1.0 sends the client's name without the upper 16 bits of the request word, so that the
// word looks like a request to set the sensitivity.
TEST(SpnavProtocol, ANameWithoutItsTagIsANameAndNoSensitivity) {
  SpnavClient client({});
  feed(client, bytesOf("0155AA7F"));
  EXPECT_EQ(feed(client, bytesOf("00100000") + "a program's name        " + std::string(4, '\0')),
            "");
  std::string out;
  client.sample(pushed({256, 0, 0, 0, 0, 0}), true, out);
  EXPECT_EQ(out.substr(4, 4), bytesOf("00010000"));
}

TEST(SpnavProtocol, RawEventsAreToldToWhoAsksForThem) {
  SpnavClient client({});
  feed(client, bytesOf("0155AA7F") + bytesOf("0310AA7F 30000000") + std::string(24, '\0'));
  std::string out;
  client.sample(pushed({7, 0, 0, 0, 0, -1}, 2), true, out);
  EXPECT_EQ(out, bytesOf("05000000 00000000 07000000") + std::string(20, '\0') +
                     bytesOf("05000000 05000000 FFFFFFFF") + std::string(20, '\0') +
                     bytesOf("06000000 01000000 01000000") + std::string(20, '\0'));
}

// The queries of libspnav's spnav_config.h are answered with the values that hold for a ball
// configured in MERLIN.
TEST(SpnavProtocol, QuestionsAboutTheConfigurationAreAnsweredAndRequestsToChangeItRefused) {
  SpnavClient client(spnavDevice("Spaceball 2003, firmware 2.43", "serial:/dev/ttyS0"));
  feed(client, bytesOf("0155AA7F"));
  const auto ask = [&](const std::string& words) {
    const std::string bytes = bytesOf(words);
    return feed(client, bytes + std::string(32 - bytes.size(), '\0'));
  };
  const auto answer = [](const std::string& words, const std::string& last) {
    const std::string bytes = bytesOf(words);
    return bytes + std::string(28 - bytes.size(), '\0') + bytesOf(last);
  };
  const std::string done = "00000000", failed = "FFFFFFFF";
  EXPECT_EQ(ask("0130AA7F"), answer("0130AA7F 0000803F", done));                    // sensitivity 1
  EXPECT_EQ(ask("0930AA7F 05000000"), answer("0930AA7F 05000000 05000000", done));  // axis 5
  EXPECT_EQ(ask("0930AA7F 06000000").substr(28), bytesOf(failed));  // there are axes 0..5 only
  EXPECT_EQ(ask("0B30AA7F 08000000"), answer("0B30AA7F 08000000 08000000", done));  // button 8
  EXPECT_EQ(ask("0B30AA7F 09000000").substr(28), bytesOf(failed));
  EXPECT_EQ(ask("1130AA7F"), answer("1130AA7F", done));  // the Y and Z axes are not swapped
  EXPECT_EQ(ask("1930AA7F"), answer("1930AA7F FFFFFFFF", done));  // there is no repeat interval
  EXPECT_EQ(ask("1730AA7F").substr(4, 10), "/dev/ttyS0");
  // A request to swap them is refused.
  EXPECT_EQ(ask("1030AA7F 01000000").substr(28), bytesOf(failed));
  EXPECT_EQ(ask("1630AA7F"), "") << "a text is not answered";
}

TEST(SpnavProtocol, TheDeviceIsTheOneThatIsThere) {
  const SpnavDevice d = spnavDevice("Spaceball 2003, firmware 2.43", "serial:/dev/ttyS0");
  EXPECT_EQ(d.name, "Spaceball 2003");
  EXPECT_EQ(d.path, "/dev/ttyS0");
  EXPECT_EQ(d.type, 0x100);
  EXPECT_EQ(d.buttons, 9);
  EXPECT_EQ(spnavDevice("Spaceball 4000 FLX", "pty:/x").type, 0x102);
  EXPECT_EQ(spnavDevice("", "").name, "MERLIN ball");
  EXPECT_EQ(spnavDevice("Spaceball 2003", "tcp://ball:4001").path, "") << "is no path";
}

TEST(SpnavProtocol, ALongNameComesInPieces) {
  SpnavDevice device;
  device.name = std::string(25, 'n');
  SpnavClient client(device);
  feed(client, bytesOf("0155AA7F"));
  const std::string out = feed(client, bytesOf("0020AA7F") + std::string(28, '\0'));
  ASSERT_EQ(out.size(), 64u);
  EXPECT_EQ(out.substr(28, 4), bytesOf("19000000"));
  EXPECT_EQ(out.substr(60, 4), bytesOf("01000100"));
}

TEST(SpnavProtocol, ARestIsToldOnceAndASlowClientLosesNoButton) {
  SpnavClient client({});
  std::string out;
  client.sample(pushed({}), true, out);
  EXPECT_EQ(out, "");
  client.sample(pushed({1, 0, 0, 0, 0, 0}, 1), false, out);
  EXPECT_EQ(out.size(), 32u);  // the button event
  client.sample(pushed({1, 0, 0, 0, 0, 0}, 1), true, out);
  client.sample(pushed({}, 1), true, out);
  client.sample(pushed({}, 1), true, out);
  EXPECT_EQ(out.size(), 96u);
}

TEST(SpnavProtocol, RandomBytesAreSurvived) {
  SpnavClient client({});
  std::string input, out;
  std::uint64_t state = 1;
  for (int i = 0; i < 200'000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    input.push_back(static_cast<char>(state >> 56));
    input.erase(0, client.receive(input, 100, out).bytes);
    out.clear();
  }
}

struct Served : testing::Test {
  Served() {
    DeviceHealth health{};
    health.state = HealthState::kOk;
    std::snprintf(health.identity, sizeof health.identity, "Spaceball 3003, firmware 2.13");
    std::snprintf(health.port, sizeof health.port, "pty:/tmp/ball");
    segment->health[test::kBall].publish(health);
    auto started = SpnavServer::start(path, segment.slots(), threads, clock);
    EXPECT_TRUE(started) << started.error().what;
    if (started) server = *std::move(started);
    ::setenv("SPNAV_SOCKET", path.c_str(), 1);
  }
  test::TempDir dir;
  std::string path = dir / "spnav.sock";
  SystemClock clock;
  ThreadWatch threads;
  test::LocalDevices segment;
  std::unique_ptr<SpnavServer> server;
};

// Publishes a ball sample with another x every 10 ms.
class MovingBall {
 public:
  explicit MovingBall(shm::DevicesSegment& segment)
      : thread_([&segment](const std::stop_token& stop) {
          SystemClock clock;
          for (std::int16_t i = 1;
               clock.sleepUntil(clock.now() + std::chrono::milliseconds(10), stop);
               i = static_cast<std::int16_t>(i % 1000 + 1))
            segment.ball[0].publish(pushed({i, 1, 1, 1, 1, 1}));
        }) {}

 private:
  std::jthread thread_;
};

TEST_F(Served, AHundredHandshakesAndQuestionsAreRightWhileTheBallMoves) {
  const MovingBall moving(*segment);
  int right = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_NE(::spnav_open(), -1);
    if (i % 2) ::spnav_client_name("a program");
    char name[64] = "";
    const bool asked = ::spnav_protocol() == 1 && ::spnav_dev_name(name, sizeof name) > 0 &&
                       std::string(name) == "Spaceball 3003" && ::spnav_dev_buttons() == 3 &&
                       ::spnav_dev_axes() == 6 && ::spnav_dev_type() == 0x101;
    spnav_event event{};
    const bool moved = test::eventually(
        [&] { return ::spnav_poll_event(&event) == SPNAV_EVENT_MOTION && event.motion.x > 0; });
    right += asked && moved;
    ::spnav_close();
  }
  EXPECT_EQ(right, 100);
}

// Makes a plain connection to the server's socket.
UniqueFd connectedTo(const std::string& path) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}

using Event = std::array<std::int32_t, 8>;
Event nextEvent(const UniqueFd& fd) {
  timeval limit{10, 0};
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  Event event{-1};
  if (::recv(fd.get(), event.data(), sizeof event, MSG_WAITALL) != ssize_t{sizeof event})
    event[0] = -1;
  return event;
}

TEST_F(Served, AClickWhileAClientConnectsIsToldToIt) {
  const UniqueFd fd = connectedTo(path);
  ASSERT_TRUE(test::eventually([&] { return server->report().connections == 1; }));
  segment->ball[0].publish(pushed({}, 1));
  segment->ball[0].publish(pushed({}, 0));
  EXPECT_EQ(nextEvent(fd), (Event{1, 0, 1}));
  EXPECT_EQ(nextEvent(fd), (Event{2, 0, 0}));
}

TEST_F(Served, AProgramThatAsksAllTheTimeSeesTheBallAllTheSame) {
  const MovingBall moving(*segment);
  const UniqueFd fd = connectedTo(path);
  const std::string hello = bytesOf("0155AA7F");
  ASSERT_EQ(::send(fd.get(), hello.data(), hello.size(), 0), 4);
  std::int32_t echo = 0;
  ASSERT_EQ(::recv(fd.get(), &echo, sizeof echo, MSG_WAITALL), 4);
  const std::string axes = bytesOf("0220AA7F") + std::string(28, '\0');
  EXPECT_TRUE(test::eventually([&] {
    (void)::send(fd.get(), axes.data(), axes.size(), MSG_NOSIGNAL);
    const Event event = nextEvent(fd);
    return event[0] == 0 && event[1] > 0;
  }));
}

// The last motion event says that the ball is at rest; a client that reads late must receive it.
TEST_F(Served, AClientThatReadsLateHearsThatTheBallRests) {
  const UniqueFd fd = connectedTo(path);
  ASSERT_TRUE(test::eventually([&] { return server->report().connections == 1; }));
  // Publish until the socket is full and the server omits motion events.
  int queued = 0, before = -1, same = 0;
  ASSERT_TRUE(test::eventually([&] {
    for (int i = 0; i < 16; ++i) segment->ball[0].publish(pushed({1, 2, 3, 4, 5, 6}));
    before = std::exchange(queued, 0);
    ::ioctl(fd.get(), FIONREAD, &queued);
    same = queued > 4096 && queued == before ? same + 1 : 0;
    return same == 50;
  }));
  segment->ball[0].publish(pushed({}));
  // Once another client has received two echoes, the server has seen the sample.
  const UniqueFd other = connectedTo(path);
  for (int i = 0; i < 2; ++i) {
    const std::string question = bytesOf("0055AA7F");
    std::int32_t echo = 0;
    ASSERT_EQ(::send(other.get(), question.data(), question.size(), 0), 4);
    ASSERT_EQ(::recv(other.get(), &echo, sizeof echo, MSG_WAITALL), 4);
  }
  Event event = nextEvent(fd);
  const auto rests = [&] { return event[0] == 0 && event[1] == 0 && event[6] == 0; };
  for (int i = 0; i < 100'000 && !rests() && event[0] != -1; ++i) event = nextEvent(fd);
  EXPECT_TRUE(rests()) << event[0];
}

// Programs from before 2021 connect and read, without sending anything.
TEST_F(Served, AClientOfVersionZeroIsToldWithoutAWord) {
  const UniqueFd fd = connectedTo(path);
  const MovingBall moving(*segment);
  const Event event = nextEvent(fd);
  EXPECT_EQ(event[0], 0);
  EXPECT_GT(event[1], 0);
}

// A process that holds connections and sends nothing, until this object is destroyed.
class SilentProcess {
 public:
  SilentProcess(const std::string& path, int connections) : pid_(::fork()) {
    if (pid_ != 0) return;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    for (int i = 0; i < connections; ++i) {
      const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
      (void)::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
    ::pause();
    ::_exit(0);
  }
  ~SilentProcess() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  SilentProcess(const SilentProcess&) = delete;
  SilentProcess& operator=(const SilentProcess&) = delete;

 private:
  pid_t pid_;
};

TEST_F(Served, SilentClientsDoNotKeepOthersOut) {
  const SilentProcess a(path, 20), b(path, 20), c(path, 20);
  ASSERT_TRUE(test::eventually(
      [&] { return server->report().connections == 32 && server->report().refused > 0; }));
  // A connection may be replaced one second after it was last used.
  ASSERT_TRUE(test::eventually([&] {
    const UniqueFd newcomer = connectedTo(path);
    return test::eventually([&] { return server->report().replaced > 0; }, std::chrono::seconds(1));
  }));
  ASSERT_NE(::spnav_open(), -1);
  EXPECT_EQ(::spnav_protocol(), 1);
  EXPECT_EQ(::spnav_dev_axes(), 6);
  ::spnav_close();
}

TEST_F(Served, AFileThatIsNoSocketStays) {
  const std::string file = dir / "precious";
  test::writeText(file, "data");
  const auto refused = SpnavServer::start(file, segment.slots(), threads, clock);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(test::readText(file), "data");
}

TEST_F(Served, ASocketThatIsRemovedIsMadeAgain) {
  const std::string file = dir / "again";
  const auto made = SpnavServer::start(file, segment.slots(), threads, clock);
  ASSERT_TRUE(made) << made.error().what;
  std::filesystem::remove(file);
  EXPECT_TRUE(test::eventually([&] { return std::filesystem::is_socket(file); }));
}

TEST_F(Served, LibspnavSeesTheBall) {
  ASSERT_NE(::spnav_open(), -1);
  EXPECT_EQ(::spnav_protocol(), 1);
  EXPECT_EQ(::spnav_dev_axes(), 6);
  EXPECT_EQ(::spnav_dev_buttons(), 3);
  char name[64] = "";
  ::spnav_dev_name(name, sizeof name);
  EXPECT_STREQ(name, "Spaceball 3003");
  EXPECT_EQ(::spnav_dev_type(), 0x101);
  EXPECT_EQ(::spnav_client_name("test"), 0);

  segment->ball[0].publish(pushed({256, -512, 1000, -1, 39, -10}));
  spnav_event event{};
  const auto next = [&](int type) {
    return test::eventually([&] { return ::spnav_poll_event(&event) == type; });
  };
  ASSERT_TRUE(next(SPNAV_EVENT_MOTION));
  const auto& m = event.motion;
  EXPECT_EQ((std::array{m.x, m.y, m.z, m.rx, m.ry, m.rz}),
            (std::array{256, -512, 1000, -1, 39, -10}));
  EXPECT_EQ(event.motion.period, 50u);

  segment->ball[0].publish(pushed({}, 0x100));
  ASSERT_TRUE(next(SPNAV_EVENT_BUTTON));
  EXPECT_EQ(event.button.bnum, 8);
  EXPECT_EQ(event.button.press, 1);
  segment->ball[0].publish(pushed({}, 0));
  ASSERT_TRUE(next(SPNAV_EVENT_BUTTON));
  EXPECT_EQ(event.button.press, 0);
  EXPECT_EQ(::spnav_sensitivity(2.0), 0);
  EXPECT_EQ(::spnav_close(), 0);
}

TEST_F(Served, ASecondServerIsRefusedAndADeadOnesSocketIsReplaced) {
  const auto second = SpnavServer::start(path, segment.slots(), threads, clock);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
  server.reset();
  EXPECT_NE(::access(path.c_str(), F_OK), 0) << "gone with its server";
  // The socket that a killed server leaves behind accepts no connections.
  { const UniqueFd dead = *net::listenLocal(path, 0600); }
  EXPECT_TRUE(SpnavServer::start(path, segment.slots(), threads, clock));
}

}  // namespace
}  // namespace merlin::serve
