// The limits of a server's connections (places, time, bytes, turns), tested with a protocol of
// lines.
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/net/connection_server.h"
#include "tests/support/eventually.h"
#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"

namespace merlin::net {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Peer process(int pid, int user = 1000) {
  Peer peer;
  peer.user = user;
  peer.process = pid;
  return peer;
}

// ---- admission

class Admission : public testing::Test {
 protected:
  Occupant occupant(const Peer& peer, Duration age, bool established, Duration idle) const {
    return {peer, now_ - age, now_ - idle, established};
  }
  Decision decideFor(const Peer& newcomer) const { return decide(all_, newcomer, places_, now_); }

  Timestamp now_{seconds(1000)};
  Places places_{.all = 4, .per_peer = 2};
  std::vector<Occupant> all_;
};

TEST_F(Admission, AFreePlaceIsTaken) {
  all_ = {occupant(process(1), seconds(9), true, seconds(9))};
  EXPECT_EQ(decideFor(process(1)).kind, Decision::Kind::kAdmit);
}

TEST_F(Admission, ANewcomerGetsThePlaceOfOneThatHasSaidNothing) {
  all_ = {occupant(process(1), seconds(9), true, seconds(9)),
          occupant(process(2), seconds(1), false, seconds(1)),
          occupant(process(3), seconds(9), true, seconds(9)),
          occupant(process(4), seconds(9), true, seconds(9))};
  const Decision decision = decideFor(process(5));
  EXPECT_EQ(decision.kind, Decision::Kind::kReplace);
  EXPECT_EQ(decision.victim, 1U);
}

TEST_F(Admission, AmongTheIdleTheUserWithTheMostPlacesGivesOneUp) {
  all_ = {occupant(process(1, 7), seconds(99), true, seconds(99)),
          occupant(process(2, 8), seconds(9), true, seconds(2)),
          occupant(process(3, 8), seconds(9), true, seconds(3)),
          occupant(process(4, 9), seconds(99), true, seconds(99))};
  const Decision decision = decideFor(process(5, 10));
  EXPECT_EQ(decision.kind, Decision::Kind::kReplace);
  EXPECT_EQ(decision.victim, 2U) << "the idler one of user 8";
}

TEST_F(Admission, OneThatIsBeingSetUpOrWasJustActiveKeepsItsPlace) {
  all_ = {occupant(process(1), milliseconds(10), false, milliseconds(10)),
          occupant(process(2), milliseconds(10), false, milliseconds(10)),
          occupant(process(3), seconds(9), true, milliseconds(10)),
          occupant(process(4), seconds(9), true, milliseconds(10))};
  EXPECT_EQ(decideFor(process(5)).kind, Decision::Kind::kRefuse);
}

TEST_F(Admission, APeerOverItsShareReplacesItsOwnAlone) {
  all_ = {occupant(process(1), seconds(9), true, seconds(5)),
          occupant(process(1), seconds(9), true, seconds(6)),
          occupant(process(2), seconds(9), false, seconds(9))};
  const Decision decision = decideFor(process(1));
  EXPECT_EQ(decision.kind, Decision::Kind::kReplace);
  EXPECT_EQ(decision.victim, 1U);
}

TEST_F(Admission, WhoHoldsSeveralBusyPlacesGivesOneToAProcessThatHasNone) {
  all_ = {occupant(process(1), seconds(9), true, milliseconds(10)),
          occupant(process(2), seconds(9), true, milliseconds(50)),
          occupant(process(2), milliseconds(20), false, milliseconds(20)),
          occupant(process(3), seconds(9), true, milliseconds(90))};
  const Decision decision = decideFor(process(5));
  EXPECT_EQ(decision.kind, Decision::Kind::kReplace);
  EXPECT_EQ(decision.victim, 2U) << "also one that has just come: a flood gives no more right";
  EXPECT_EQ(decideFor(process(3)).kind, Decision::Kind::kRefuse)
      << "it has as many as it would get";
}

TEST_F(Admission, AUserWithManyBusyProcessesGivesAPlaceToAnother) {
  all_ = {occupant(process(1, 7), seconds(9), true, milliseconds(10)),
          occupant(process(2, 7), seconds(9), true, milliseconds(90)),
          occupant(process(3, 7), seconds(9), true, milliseconds(50)),
          occupant(process(4, 8), seconds(9), true, milliseconds(95))};
  const Decision decision = decideFor(process(5, 9));
  EXPECT_EQ(decision.kind, Decision::Kind::kReplace);
  EXPECT_EQ(decision.victim, 1U);
  EXPECT_EQ(decideFor(process(6, 7)).kind, Decision::Kind::kRefuse);
}

// ---- the server

// A protocol that answers each line. The line "bad" is a protocol error; the first line establishes
// the connection.
class Lines final : public Session {
 public:
  Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) override {
    Taken taken;
    for (std::size_t end = 0; taken.messages < most; ++taken.messages, taken.bytes = end) {
      end = input.find('\n', taken.bytes) + 1;
      if (end == 0) break;
      if (input.substr(taken.bytes, end - taken.bytes) == "bad\n")
        return Error{Errc::kMalformed, "a bad line"};
      output += input.substr(taken.bytes, end - taken.bytes);
      established_ = true;
    }
    return taken;
  }
  bool established() const noexcept override { return established_; }

 private:
  bool established_ = false;
};

class Server : public testing::Test {
 protected:
  // Connects a client to the server; returns the client's end of the connection.
  UniqueFd connect(const Peer& peer, bool* admitted = nullptr) {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    const bool added =
        server_.add(UniqueFd(ends[0]), peer, [](const Peer&) { return std::make_unique<Lines>(); });
    if (admitted) *admitted = added;
    return UniqueFd(ends[1]);
  }
  static void send(const UniqueFd& fd, std::string_view text) {
    ASSERT_EQ(::send(fd.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  // Returns the bytes received so far, followed by "(closed)" if the server closed the connection.
  static std::string received(const UniqueFd& fd) {
    std::string all;
    char bytes[4096];
    for (;;) {
      const ssize_t n = ::recv(fd.get(), bytes, sizeof bytes, MSG_DONTWAIT);
      if (n == 0 || (n < 0 && errno == ECONNRESET)) return all + "(closed)";
      if (n < 0) return all;
      all.append(bytes, static_cast<std::size_t>(n));
    }
  }
  void round() { server_.round(Duration::zero()); }

  test::FakeClock clock_;
  ServerLimits limits_{.places = {.all = 4, .per_peer = 2},
                       .opening = seconds(2),
                       .input_bytes = 64,
                       .output_bytes = 256,
                       .messages_per_round = 2,
                       .messages_per_s = 10,
                       .messages_burst = 6,
                       .bytes_per_s = 1000,
                       .bytes_burst = 1000};
  ConnectionServer server_{"lines", limits_, clock_};
};

TEST_F(Server, AnswersAndTellsEachClient) {
  const UniqueFd a = connect(process(1)), b = connect(process(2));
  send(a, "one\n");
  round();
  EXPECT_EQ(received(a), "one\n");
  server_.sendToAll([](Session&, std::string& output) { output += "news\n"; });
  EXPECT_EQ(received(a), "news\n");
  EXPECT_EQ(received(b), "") << "not established yet";
}

TEST_F(Server, WhoDoesNotOpenTheProtocolInTimeIsClosed) {
  const UniqueFd silent = connect(process(1)), speaks = connect(process(2));
  send(speaks, "hello\n");
  round();
  clock_.advance(seconds(2));
  round();
  EXPECT_EQ(received(silent), "(closed)");
  EXPECT_EQ(received(speaks), "hello\n");
  EXPECT_EQ(server_.report().silent, 1U);
  EXPECT_EQ(server_.report().last,
            "closed a connection of user 1000, process 1: it did not complete the handshake within "
            "2.0 s");
}

TEST_F(Server, EachClientHasItsTurnWhateverAnotherSends) {
  const UniqueFd flood = connect(process(1)), other = connect(process(2));
  send(flood, "1\n2\n3\n4\n5\n");
  send(other, "me\n");
  round();
  EXPECT_EQ(received(flood), "1\n2\n") << "two messages a round";
  EXPECT_EQ(received(other), "me\n");
  round();
  round();
  EXPECT_EQ(received(flood), "3\n4\n5\n");
}

TEST_F(Server, MessagesBeyondItsRateWait) {
  const UniqueFd flood = connect(process(1));
  send(flood, "1\n2\n3\n4\n5\n6\n7\n8\n");
  for (int i = 0; i < 9; ++i) round();
  EXPECT_EQ(received(flood), "1\n2\n3\n4\n5\n6\n") << "a burst of six";
  clock_.advance(milliseconds(101));
  round();
  EXPECT_EQ(received(flood), "7\n") << "then ten a second";
}

TEST_F(Server, AMessageThatDoesNotEndClosesTheConnection) {
  const UniqueFd client = connect(process(1));
  send(client, std::string(200, 'x'));
  round();
  round();
  EXPECT_EQ(received(client), "(closed)");
  EXPECT_EQ(server_.report().broken, 1U);
}

TEST_F(Server, WhatBreaksTheProtocolClosesTheConnection) {
  const UniqueFd client = connect(process(1));
  send(client, "bad\n");
  round();
  EXPECT_EQ(received(client), "(closed)");
  EXPECT_EQ(server_.report().last, "closed a connection of user 1000, process 1: a bad line");
}

TEST_F(Server, WhoDoesNotReadIsClosed) {
  const UniqueFd client = connect(process(1));
  send(client, "hello\n");
  round();
  for (int i = 0; i < 100000 && server_.connections() > 0; ++i)
    server_.sendToAll([](Session&, std::string& output) { output += std::string(200, 'n'); });
  EXPECT_EQ(server_.report().slow, 1U);
}

TEST_F(Server, ANewcomerGetsAnIdlePlace) {
  std::vector<UniqueFd> clients;
  for (int pid = 1; pid <= 4; ++pid) clients.push_back(connect(process(pid)));
  bool admitted = true;
  const UniqueFd early = connect(process(5), &admitted);
  EXPECT_FALSE(admitted) << "all are just being set up";
  clock_.advance(milliseconds(300));
  const UniqueFd late = connect(process(6), &admitted);
  EXPECT_TRUE(admitted);
  EXPECT_EQ(server_.connections(), 4U);
  const ServerReport report = server_.report();
  EXPECT_EQ(report.refused, 1U);
  EXPECT_EQ(report.replaced, 1U);
  EXPECT_EQ(report.sentAway(), 2U);
}

TEST_F(Server, SeesThatAClientHasGone) {
  UniqueFd client = connect(process(1));
  client.reset();
  round();
  EXPECT_EQ(server_.connections(), 0U);
  EXPECT_EQ(server_.report().sentAway(), 0U);
}

// A session that forwards its input to a socket of the test.
class Relay final : public Session {
 public:
  explicit Relay(int far) : far_(far) {}
  Result<Taken> receive(std::string_view input, std::size_t, std::string&) override {
    const ssize_t n = ::send(far_, input.data(), input.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    return Taken{n > 0 ? static_cast<std::size_t>(n) : 0, 0};
  }
  bool established() const noexcept override { return true; }
  int farFd() const noexcept override { return far_; }
  Result<Ok> readFar(std::size_t room, std::string& output) override {
    std::string bytes(room, '\0');
    const ssize_t n = ::recv(far_, bytes.data(), room, MSG_DONTWAIT);
    if (n == 0) return Error{Errc::kClosed, "gone"};
    if (n > 0) output.append(bytes, 0, static_cast<std::size_t>(n));
    return Ok{};
  }

 private:
  int far_;
};

TEST_F(Server, ARelayPassesBothWaysAndEndsWithItsFarSide) {
  int far[2], near[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, far), 0);
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, near), 0);
  const UniqueFd inner(far[0]), client(near[1]);
  UniqueFd outer(far[1]);
  server_.add(UniqueFd(near[0]), process(1),
              [&](const Peer&) { return std::make_unique<Relay>(inner.get()); });
  send(client, "to");
  send(outer, "from");
  round();
  EXPECT_EQ(received(outer), "to");
  EXPECT_EQ(received(client), "from");
  outer.reset();
  round();
  EXPECT_EQ(received(client), "(closed)");
}

// ---- listening sockets

class Listening : public testing::Test {
 protected:
  UniqueFd connectTo(const std::string& path) {
    UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      fd.reset();
    return fd;
  }
  test::TempDir dir_;
};

TEST_F(Listening, AClientIsAcceptedAndKnownByItsProcess) {
  const std::string path = dir_ / "s";
  auto listener = listenLocal(path, 0600);
  ASSERT_TRUE(listener) << listener.error().what;
  const SystemClock clock;
  ConnectionServer server("s", {}, clock);
  Peer seen;
  server.listen(*std::move(listener), [&](const Peer& peer) {
    seen = peer;
    return std::make_unique<Lines>();
  });
  const UniqueFd client = connectTo(path);
  ASSERT_TRUE(client.valid());
  server.round(seconds(5));
  EXPECT_EQ(server.connections(), 1U);
  EXPECT_EQ(seen.process, ::getpid());
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
}

TEST_F(Listening, WhoConnectsAllTheTimeIsAcceptedAtARate) {
  const std::string path = dir_ / "s";
  test::FakeClock clock;
  ServerLimits limits;
  limits.accepts_per_s = 100;
  limits.accepts_burst = 20;
  ConnectionServer server("s", limits, clock);
  server.listen(*listenLocal(path, 0600), [](const Peer&) { return std::make_unique<Lines>(); });
  std::vector<UniqueFd> clients;
  for (int i = 0; i < 100; ++i) clients.push_back(connectTo(path));
  const auto came = [&] {
    for (int i = 0; i < 5; ++i) server.round(Duration::zero());
    const ServerReport report = server.report();
    return report.accepted + report.refused;
  };
  EXPECT_EQ(came(), 20U) << "a burst";
  clock.advance(milliseconds(99));
  EXPECT_EQ(came(), 20U) << "ten at once";
  clock.advance(milliseconds(2));
  EXPECT_EQ(came(), 30U);
  clock.advance(milliseconds(500));
  EXPECT_EQ(came(), 50U) << "a burst again";
}

// Runs in a child process, so that the limit on descriptors affects only the child.
TEST_F(Listening, WithoutDescriptorsNobodyIsNamedAsRefused) {
  const std::string path = dir_ / "s";
  const SystemClock clock;
  ConnectionServer server("s", {}, clock);
  server.listen(*listenLocal(path, 0600), [](const Peer&) { return std::make_unique<Lines>(); });
  const UniqueFd client = connectTo(path);
  ASSERT_TRUE(client.valid());
  auto pipe = makePipe();
  ASSERT_TRUE(pipe);
  const auto child = startChild();
  ASSERT_TRUE(child);
  if (*child == 0) {
    const int next = ::dup(0);
    ::close(next);
    const auto most = static_cast<rlim_t>(next);
    const rlimit none{most, most};
    ::setrlimit(RLIMIT_NOFILE, &none);
    server.round(seconds(5));
    const std::string said = server.report().last;
    ::_exit(::write(pipe->to.get(), said.data(), said.size()) > 0 ? 0 : 1);
  }
  pipe->to.reset();
  std::string said(200, '\0');
  const ssize_t n = ::read(pipe->from.get(), said.data(), said.size());
  waitForChild(*child);
  ASSERT_GT(n, 0);
  said.resize(static_cast<std::size_t>(n));
  EXPECT_EQ(said, "refused a connection: Too many open files");
}

TEST_F(Listening, OnlyADeadProgramsSocketIsReplaced) {
  const std::string path = dir_ / "s";
  {
    const auto first = listenLocal(path, 0600);
    ASSERT_TRUE(first);
    const auto second = listenLocal(path, 0600);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, Errc::kBusy);
  }
  EXPECT_TRUE(listenLocal(path, 0600)) << "left behind";
  const std::string file = dir_ / "f";
  std::ofstream(file) << "precious";
  const auto refused = listenLocal(file, 0600);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  std::string content;
  std::ifstream(file) >> content;
  EXPECT_EQ(content, "precious");
}

TEST_F(Listening, ATakenPortIsBusy) {
  const auto first = listenTcp("127.0.0.1", 0);
  ASSERT_TRUE(first) << first.error().what;
  const auto second = listenTcp("127.0.0.1", portOf(first->get()));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
}

}  // namespace
}  // namespace merlin::net
