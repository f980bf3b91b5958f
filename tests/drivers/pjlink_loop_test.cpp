// Projectors over TCP on the loopback interface: one that obeys, one with a password, and others
// that are slow, refuse, vanish, send junk or close the connection.
#include <csignal>

#include <gtest/gtest.h>

#include "drivers/io/tcp_stream.h"
#include "drivers/pjlink/projector_loop.h"
#include "tests/support/emulated_projector.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::pjlink {
namespace {

using std::chrono::milliseconds;
using test::eventually;
using test::ProjectorServer;

// A ProjectorLoop with its own thread, connected to this port.
struct Running {
  explicit Running(const std::string& port, const std::string& password_file = {},
                   Duration answer_time = std::chrono::seconds(20))
      : loop(
            {.name = "left", .address = "127.0.0.1", .password_file = password_file, .input = {}},
            [port] { return io::openTcp("127.0.0.1", port); }, clock, answer_time) {
    std::signal(SIGPIPE, SIG_IGN);  // merlind ignores the signal too
    thread = std::jthread([this](const std::stop_token& stop) { loop.run(stop); });
  }
  bool becomes(Health health) {
    return eventually([&] { return loop.state().health == health; });
  }
  bool becomes(Power power) {
    return eventually([&] { return loop.state().power == power; });
  }
  SystemClock clock;
  ProjectorLoop loop;
  std::jthread thread;
};

TEST(ProjectorLoop, SwitchesAProjectorOnAndOff) {
  ProjectorServer server;
  server.set([](auto& p) { p.warm_up = p.cool_down = Duration::zero(); });
  Running r(server.port);
  ASSERT_TRUE(r.becomes(Power::kOff));
  r.loop.want(true);
  EXPECT_TRUE(r.becomes(Power::kOn));
  r.loop.want(false);
  EXPECT_TRUE(r.becomes(Power::kOff));
  EXPECT_EQ(r.loop.state().health, Health::kOk);
  EXPECT_EQ(r.loop.state().reason, "");
}

TEST(ProjectorLoop, APasswordThatWasMendedTakesEffect) {
  const test::TempDir folder;
  const std::string file = folder.path() + "/password";
  test::writeText(file, "wrong\n");
  ProjectorServer server("right");
  Running r(server.port, file);
  ASSERT_TRUE(r.becomes(Health::kPassword));
  EXPECT_EQ(r.loop.state().reason, "refuses the password (ERRA)");
  test::writeText(file, "right\n");
  r.loop.want(true);
  EXPECT_TRUE(r.becomes(Health::kOk));
}

TEST(ProjectorLoop, AProjectorThatSaysNothingIsUnreachable) {
  ProjectorServer server;
  server.manner = ProjectorServer::kSilent;
  Running r(server.port, {}, milliseconds(50));
  ASSERT_TRUE(r.becomes(Health::kUnreachable));
  EXPECT_EQ(r.loop.state().reason, "does not answer within 0.05 s");
  EXPECT_EQ(r.loop.state().power, Power::kUnknown);
}

// An answer that arrives byte by byte must not extend the time-out.
TEST(ProjectorLoop, AProjectorThatDripsIsUnreachable) {
  ProjectorServer server;
  server.manner = ProjectorServer::kDripping;
  Running r(server.port, {}, milliseconds(200));
  EXPECT_TRUE(r.becomes(Health::kUnreachable)) << r.loop.state().reason;
}

TEST(ProjectorLoop, AProjectorThatVanishesInAnAnswerIsAskedAgain) {
  ProjectorServer server;
  server.manner = ProjectorServer::kHalf;
  Running r(server.port);
  ASSERT_TRUE(r.becomes(Health::kUnreachable));
  EXPECT_EQ(r.loop.state().reason, "closes the connection (the other end hung up)");
  server.manner = ProjectorServer::kPolite;
  r.loop.want(true);
  EXPECT_TRUE(r.becomes(Health::kOk));
}

TEST(ProjectorLoop, JunkWithoutEndIsCutOff) {
  ProjectorServer server;
  server.manner = ProjectorServer::kJunk;
  Running r(server.port);
  ASSERT_TRUE(r.becomes(Health::kFailed));
  EXPECT_TRUE(r.loop.state().reason.starts_with("sends a line of more than 136 bytes, \"xxx"))
      << r.loop.state().reason;
}

TEST(ProjectorLoop, OneThatClosesAfterEachAnswerIsServedAllTheSame) {
  ProjectorServer server;
  server.manner = ProjectorServer::kOneAnswer;
  Running r(server.port);
  r.loop.want(true);
  EXPECT_TRUE(eventually([&] { return r.loop.state().identity == "Epsilon"; }));
  EXPECT_TRUE(r.becomes(Power::kWarming));
  EXPECT_EQ(r.loop.state().health, Health::kOk);
  EXPECT_GE(server.connections, 5) << "power, on, errors, lamps, name";
}

TEST(ProjectorLoop, ARefusalIsItsHealth) {
  ProjectorServer server;
  server.set([](auto& p) { p.refusal = "ERR4"; });
  Running r(server.port);
  r.loop.want(true);
  ASSERT_TRUE(r.becomes(Health::kRefused));
  EXPECT_EQ(r.loop.state().reason,
            "refuses to be switched on (ERR4, the projector has failed); it is tried "
            "again");
}

TEST(ProjectorLoop, APortWhereNobodyListensIsSaid) {
  std::string port;
  {
    const ProjectorServer gone;
    port = gone.port;
  }
  Running r(port);
  ASSERT_TRUE(r.becomes(Health::kUnreachable));
  EXPECT_EQ(r.loop.state().reason, "tcp://127.0.0.1:" + port + ": Connection refused");
}

}  // namespace
}  // namespace merlin::pjlink
