// Servers for other programs in a real merlind. A server that cannot start does not stop the wall,
// and a client can neither exhaust merlind's memory nor prevent its end.
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/sanitizer.h"
#include "daemon/net/connection_server.h"
#include "drivers/port/vrpn_line.h"
#include "tests/support/free_port.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

UniqueFd connectTo(int port) {
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_in address = loopback(port);
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}

MerlindOptions devicesThatServe(const Json& serve) {
  MerlindOptions options;
  options.role = "devices";
  options.also = {{"serve", serve}};
  return options;
}

std::string stateOf(Merlind& merlind, const std::string& server) {
  const Json status = merlind.status();
  if (!status.is_object() || !status.contains("servers")) return "no status";
  return status["servers"].value(server, Json::object()).value("state", "");
}

long residentKb(pid_t pid) {
  const std::string status = readText("/proc/" + std::to_string(pid) + "/status");
  const std::size_t at = status.find("VmRSS:");
  return at == std::string::npos ? -1 : std::stol(status.substr(at + 6));
}

TEST(Servers, OneWhosePortIsTakenIsToldAndServesOnceItIsFree) {
  const TempDir dir;
  auto taken = net::listenTcp("127.0.0.1", 0);
  ASSERT_TRUE(taken);
  auto forgotten = net::listenLocal(dir / "spnav.sock", 0600);  // in use, as by a running spacenavd
  ASSERT_TRUE(forgotten);
  Merlind merlind(dir, "", "servers",
                  devicesThatServe({{"vrpn_port", net::portOf(taken->get())},
                                    {"spnav_socket", dir / "spnav.sock"}}));
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  EXPECT_TRUE(eventually([&] { return stateOf(merlind, "VRPN") == "failed"; }));
  EXPECT_EQ(stateOf(merlind, "space mouse"), "failed");
  EXPECT_TRUE(merlind.process().saysEventually("VRPN: failed ("));
  taken->reset();
  forgotten->reset();
  EXPECT_TRUE(eventually([&] {
    return stateOf(merlind, "VRPN") == "ok" && stateOf(merlind, "space mouse") == "ok";
  })) << merlind.process().output();
  EXPECT_EQ(merlind.process().kill(SIGTERM), 0);
}

// libspnav's own example, in Debian's copy, sends its name, asks for the protocol and the device,
// and prints the events.
TEST(Servers, TheExampleOfLibspnavSeesTheEmulatedBallTurn) {
  const std::string source = "/usr/share/doc/libspnav-dev/examples/simple/simple.c";
  if (!std::filesystem::exists(source)) GTEST_SKIP() << source << " is not installed";
  const TempDir dir;
  const Outcome built =
      run({"cc", "-DBUILD_AF_UNIX", source, "-lspnav", "-lm", "-o", dir / "simple"});
  ASSERT_EQ(built.status, 0) << built.output;
  MerlindOptions options = devicesThatServe({{"spnav_socket", dir / "spnav.sock"}});
  options.script = "turning";
  Merlind merlind(dir, "", "libspnav", options);
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk)) << merlind.process().output();
  Process simple({"stdbuf", "-oL", dir / "simple"}, {{"SPNAV_SOCKET", dir / "spnav.sock"}});
  ASSERT_TRUE(simple.saysEventually("protocol version: 1")) << simple.output();
  ASSERT_TRUE(simple.saysEventually("Device: Spaceball")) << simple.output();
  ASSERT_TRUE(simple.saysEventually("motion event: t(")) << simple.output();
  // The ball turns about one axis, so at least one event has a value other than zero.
  EXPECT_TRUE(eventually([&] {
    std::istringstream lines(simple.output());
    for (std::string line; std::getline(lines, line);) {
      if (line.find("motion event") != std::string::npos &&
          line.find("t(0, 0, 0) r(0, 0, 0)") == std::string::npos && line.back() == ')')
        return true;
    }
    return false;
  })) << simple.output();
}

// Returns a plain socket on which the handshake of a ZeroMQ client is complete; an invalid
// descriptor if the server refuses the client.
UniqueFd zmqClient(const std::string& path) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const timeval patience{2, 0};
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::string opening("\xff\0\0\0\0\0\0\0\1\x7f\3\0NULL", 16);
  opening.resize(64);
  opening += std::string("\4\x1c\5READY\vSocket-Type\0\0\0\6DEALER", 30);
  std::string heard;
  char bytes[256];
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::send(fd.get(), opening.data(), opening.size(), MSG_NOSIGNAL) < 0)
    return UniqueFd();
  while (heard.find("READY") == std::string::npos) {
    const ssize_t n = ::recv(fd.get(), bytes, sizeof bytes, 0);
    if (n <= 0) return UniqueFd();
    heard.append(bytes, static_cast<std::size_t>(n));
  }
  return fd;
}

// A process that holds up to 16 connections and keeps them busy, for at most a minute.
class BusyHolder {
 public:
  explicit BusyHolder(const std::string& path) {
    int ends[2];
    EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    const UniqueFd hears(ends[0]), says(ends[1]);
    pid_ = ::fork();
    if (pid_ == 0) hold(path, says.get());
    char held = 0;
    EXPECT_EQ(::read(hears.get(), &held, 1), 1);
    held_ = held;
  }
  ~BusyHolder() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  BusyHolder(const BusyHolder&) = delete;
  BusyHolder& operator=(const BusyHolder&) = delete;
  int held() const { return held_; }

 private:
  [[noreturn]] static void hold(const std::string& path, int says) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::vector<UniqueFd> places;
    for (int i = 0; i < 16; ++i) {
      if (UniqueFd place = zmqClient(path); place.valid()) places.push_back(std::move(place));
    }
    const char held = static_cast<char>(places.size());
    (void)!::write(says, &held, 1);
    char answers[256];
    for (int round = 0; round < 300; ++round) {
      for (const UniqueFd& place : places) {
        (void)::send(place.get(), "\4\7\4PING\0\x10", 9, MSG_NOSIGNAL | MSG_DONTWAIT);
        (void)::recv(place.get(), answers, sizeof answers, MSG_DONTWAIT);
      }
      ::poll(nullptr, 0, 200);
    }
    ::_exit(0);
  }
  pid_t pid_ = -1;
  int held_ = 0;
};

TEST(Servers, ProcessesThatKeepEveryPlaceBusyDoNotKeepStatusOut) {
  const TempDir dir;
  Merlind merlind(dir, "", "busy", devicesThatServe(Json::object()));
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  const std::string command = dir / (merlind.instance() + "-devices.command");
  const BusyHolder one(command), other(command);
  ASSERT_EQ(one.held() + other.held(), 32);
  for (int i = 0; i < 3; ++i) {
    const Json status = merlind.status();
    ASSERT_TRUE(status.is_object() && status.contains("servers")) << merlind.process().output();
  }
}

TEST(Servers, AMessageThatDoesNotEndIsClosed) {
  const TempDir dir;
  Merlind merlind(dir, "", "endless", devicesThatServe(Json::object()));
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  const UniqueFd fd = zmqClient(dir / (merlind.instance() + "-devices.command"));
  ASSERT_TRUE(fd.valid());
  // Sends message parts that each announce another part, and heartbeats with a time-out of 0, with
  // which libzmq does not close the connection.
  for (int i = 0; i < 4; ++i) (void)::send(fd.get(), "\1\1x\4\7\4PING\0\0", 12, MSG_NOSIGNAL);
  char bytes[256];
  ssize_t n = 1;
  while (n > 0) n = ::recv(fd.get(), bytes, sizeof bytes, 0);
  EXPECT_TRUE(n == 0 || errno == ECONNRESET || errno == EPIPE) << "it is still open";
}

// Sends `bytes` repeatedly for three seconds, at most 40 MB; returns the number of bytes sent.
std::size_t flood(const UniqueFd& fd, const std::string& bytes) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
  timeval limit{0, 50'000};
  ::setsockopt(fd.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  std::size_t sent = 0;
  while (sent < 40'000'000 && std::chrono::steady_clock::now() < end) {
    const ssize_t n = ::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n < 0 && errno != EAGAIN) break;
    sent += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
  }
  return sent;
}

TEST(Servers, AVrpnClientThatFloodsTakesNoMemoryAndMerlindStopsAtOnce) {
  const TempDir dir;
  const int port = freePort();
  Merlind merlind(dir, "", "flooded", devicesThatServe({{"vrpn_port", port}}));
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  UniqueFd client;
  ASSERT_TRUE(eventually([&] { return (client = connectTo(port)).valid(); }));
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk)) << "all that it needs is in memory";
  const long before = residentKb(merlind.process().pid());
  std::string bytes;
  VrpnHeader unknown;
  unknown.type = 999;
  for (int i = 0; i < 1000; ++i) appendVrpn(unknown, "", bytes);
  const std::string cookie = vrpnCookie();
  ASSERT_EQ(::send(client.get(), cookie.data(), cookie.size(), 0), ssize_t{24});
  const std::size_t sent = flood(client, bytes);
  const long after = residentKb(merlind.process().pid());
#if !defined(MERLIN_ANY_SANITIZER)  // a sanitizer's own memory would be counted too
  EXPECT_LT(after - before, 8192) << sent << " bytes were sent";
#endif
  const auto asked = std::chrono::steady_clock::now();
  EXPECT_EQ(merlind.process().kill(SIGTERM), 0) << merlind.process().output();
  const auto took = std::chrono::steady_clock::now() - asked;
  std::printf("%zu bytes in 3 s; memory %ld -> %ld kB; stopped in %.2f s\n", sent, before, after,
              std::chrono::duration<double>(took).count());
  EXPECT_LT(took, std::chrono::seconds(10)) << "by arithmetic it was an hour";
}

}  // namespace
}  // namespace merlin::test
