// Status and commands over a network: merlin contacts a real merlind as if from another machine.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zmq.hpp>

#include "daemon/status/client.h"
#include "tests/support/free_port.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;

class NetworkCommands : public testing::Test {
 protected:
  NetworkCommands() {
    writeText(dir_ / "commanders", key("commander") + "\n");
    writeText(dir_ / "readers", key("reader") + "\n");
    key("stranger");
    writeText(dir_ / "server.public", key("server") + "\n");
    daemon_ = std::make_unique<Merlind>(
        dir_, makeModel(dir_, 5), "net",
        MerlindOptions{.script = "still",  // the input of a visitor would end the black state
                       .also = {{"serve",
                                 {{"wall_endpoint", wall_},
                                  {"devices_endpoint", devices_},
                                  {"samples_endpoint", samples_},
                                  {"wall_topics_endpoint", topics_},
                                  {"samples_keys", file("server")},
                                  {"samples_clients", dir_ / "readers"},
                                  {"commands_keys", file("server")},
                                  {"commands_clients", dir_ / "commanders"},
                                  {"commands_readers", dir_ / "readers"}}}}});
    EXPECT_TRUE(daemon_->ready()) << daemon_->process().output();
  }
  std::string file(const std::string& name) const { return dir_ / (name + ".keys"); }
  // Makes a key pair in the file `name`; returns the public key.
  std::string key(const std::string& name) const {
    return run({kMerlin, "keys", "-o", file(name)}).output.substr(0, 40);
  }
  Outcome merlin(const std::string& who, const std::vector<std::string>& words,
                 std::vector<std::string> endpoints = {}) const {
    if (endpoints.empty()) endpoints = {wall_};
    std::vector<std::string> all = {kMerlin};
    for (const std::string& endpoint : endpoints) all.insert(all.end(), {"--endpoint", endpoint});
    all.insert(all.end(), {"--keys", file(who), "--server-key", dir_ / "server.public"});
    all.insert(all.end(), words.begin(), words.end());
    return run(all);
  }
  std::string shown() const { return daemon_->status()["shown"]; }

  TempDir dir_;
  std::string wall_ = fmt::format("tcp://127.0.0.1:{}", freePort());
  std::string devices_ = fmt::format("tcp://127.0.0.1:{}", freePort());
  std::string topics_ = fmt::format("tcp://127.0.0.1:{}", freePort());
  std::string samples_ = fmt::format("tcp://127.0.0.1:{}", freePort());
  std::unique_ptr<Merlind> daemon_;
};

TEST_F(NetworkCommands, AListedKeyCommandsAndReadsTheStatus) {
  const Outcome status = merlin("commander", {"status", "--json"});
  ASSERT_EQ(status.status, 0) << status.output;
  EXPECT_EQ(json::parse(status.output)["rate_asked"], 10);
  EXPECT_FALSE(json::parse(status.output).contains("posture")) << "only of the role asked";
  const Outcome blank = merlin("commander", {"blank"});
  EXPECT_EQ(blank.status, 0) << blank.output;
  EXPECT_TRUE(eventually([&] { return shown() == "blank"; }));
  const Outcome both = merlin("commander", {"status", "--json"}, {wall_, devices_});
  EXPECT_TRUE(json::parse(both.output, nullptr, false).contains("posture")) << both.output;
  const Outcome projectors = merlin("commander", {"projector_on"}, {wall_, devices_});
  EXPECT_NE(projectors.output.find("this process has no projectors"), std::string::npos)
      << projectors.output;
  const Outcome lines = merlin("commander", {"watch", "--for", "1"}, {wall_, devices_});
  EXPECT_EQ(lines.status, 0) << lines.output;
  EXPECT_NE(lines.output.find("of 10 Hz"), std::string::npos) << lines.output;
}

TEST_F(NetworkCommands, AKeyThatMayReadSendsNoCommand) {
  EXPECT_EQ(merlin("reader", {"status"}).status, 0);
  const Outcome refused = merlin("reader", {"blank"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("this key may only read: status and events"), std::string::npos)
      << refused.output;
  EXPECT_EQ(shown(), "picture");
}

TEST_F(NetworkCommands, AKeyThatIsNotListedGetsNoAnswer) {
  const Outcome refused = merlin("stranger", {"blank"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.output.find("does it list our public key?"), std::string::npos)
      << refused.output;
  // First a client without encryption, then one that uses a wrong key of the server.
  const status::KeyPair own = *status::readKeyPair(file("commander"));
  EXPECT_FALSE(status::ask(wall_, "status", seconds(1)));
  EXPECT_FALSE(status::ask({wall_, status::ClientKeys{own.public_key, own}}, "status", seconds(1)));
  EXPECT_EQ(shown(), "picture");
  EXPECT_EQ(merlin("commander", {"status"}).status, 0) << "others are still answered";
}

// The name of the key list's file does not change, so the reload finds no changed setting.
TEST_F(NetworkCommands, AKeyThatWasTakenOffTheListGetsNoAnswerAfterAReload) {
  ASSERT_EQ(merlin("commander", {"status"}).status, 0);
  writeText(dir_ / "commanders", readText(dir_ / "server.public"));
  const Outcome done = run({kMerlin, "reload", "--instance", daemon_->instance()});
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("/serve/commands_clients"), std::string::npos) << done.output;
  EXPECT_EQ(merlin("commander", {"status"}).status, 1);
  EXPECT_EQ(merlin("reader", {"status"}).status, 0);
}

// Whatever a listed client sends, the server answers the next client.
TEST_F(NetworkCommands, MessagesOfAnyFormDoNotHurt) {
  const status::KeyPair own = *status::readKeyPair(file("commander"));
  for (const std::size_t parts : {1U, 2U, 3U, 5U}) {
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::dealer);
    socket.set(zmq::sockopt::linger, 1000);
    socket.set(zmq::sockopt::curve_serverkey, readText(dir_ / "server.public").substr(0, 40));
    socket.set(zmq::sockopt::curve_publickey, own.public_key);
    socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
    socket.connect(wall_);
    for (std::size_t i = 0; i < parts; ++i) {
      socket.send(zmq::str_buffer("{\"command\":"),
                  i + 1 < parts ? zmq::send_flags::sndmore : zmq::send_flags::none);
    }
    socket.close();
    EXPECT_EQ(merlin("commander", {"status"}).status, 0) << parts;
  }
  const auto longer =
      status::ask({wall_, status::ClientKeys{readText(dir_ / "server.public").substr(0, 40), own}},
                  "notice", seconds(1), std::string(1 << 20, 'x'));
  EXPECT_FALSE(longer);
  EXPECT_EQ(merlin("commander", {"status"}).status, 0);
}

// A client whose key is listed receives the wall's events as they happen; other clients receive
// nothing.
TEST_F(NetworkCommands, TheWallsTopicsAreForListedKeys) {
  const auto hears = [&](const std::string& who, Duration patience) {
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::sub);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::subscribe, "status");
    if (!who.empty()) {
      const status::KeyPair own = *status::readKeyPair(file(who));
      socket.set(zmq::sockopt::curve_serverkey, readText(dir_ / "server.public").substr(0, 40));
      socket.set(zmq::sockopt::curve_publickey, own.public_key);
      socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
    }
    socket.set(zmq::sockopt::rcvtimeo, static_cast<int>(1000 * toSeconds(patience)));
    socket.connect(topics_);
    zmq::message_t topic, document;
    if (!socket.recv(topic) || !socket.recv(document)) return std::string();
    return json::parse(document.to_string_view(), nullptr, false).value("role", "");
  };
  EXPECT_EQ(hears("reader", seconds(30)), "wall");
  EXPECT_EQ(hears("commander", seconds(30)), "wall");
  EXPECT_EQ(hears("stranger", seconds(3)), "") << "a status comes once a second";
  EXPECT_EQ(hears("", seconds(3)), "") << "without encryption";
}

TEST_F(NetworkCommands, WhatIsMissingIsSaidAtOnce) {
  const auto says = [](std::vector<std::string> words, const std::string& part) {
    words.insert(words.begin(), kMerlin);
    const Outcome refused = run(words);
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_NE(refused.output.find(part), std::string::npos) << refused.output;
  };
  says({"--endpoint", wall_, "status"}, "merlin keys -o FILE");
  says({"--endpoint", "wall.lab:7402", "--keys", file("reader"), "--server-key",
        dir_ / "server.public", "status"},
       "\"wall.lab:7402\" is not tcp://HOST:PORT");
  says({"--endpoint", wall_, "--keys", file("reader"), "--server-key", "abc", "status"},
       "--server-key: \"abc\" is neither a public key");
  says({"--endpoint", wall_, "--keys", file("reader"), "--server-key", dir_ / "server.public",
        "config", "show"},
       "--endpoint is only for status, watch");
  says({"--keys", file("reader"), "status"}, "need --endpoint");
}

TEST_F(NetworkCommands, AnAddressWithoutKeysIsRefusedByTheCheck) {
  writeText(dir_ / "bad.json", json{{"serve", {{"wall_endpoint", wall_}}}}.dump());
  const Outcome refused = run({kMerlind, "--check-config", dir_ / "bad.json", "--role", "devices"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(
      refused.output.find("/serve/wall_endpoint also needs commands_keys (merlin keys -o FILE"),
      std::string::npos)
      << refused.output;
}

// The publisher's socket is bound to a local address and to an encrypted one. If the local socket
// has to be bound again, it must not become encrypted.
TEST_F(NetworkCommands, ALocalSocketThatIsRemovedIsThereAgainAndNotEncrypted) {
  const std::string inner = dir_ / (daemon_->instance() + "-devices.status.inner");
  std::filesystem::remove(inner);
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(inner); }));
  const auto take = [](const std::string&, const std::string&) { return false; };
  EXPECT_TRUE(status::follow({"ipc://" + dir_ / (daemon_->instance() + "-devices.status")},
                             {"status"}, seconds(10), take));
}

// The client runs as another user of this machine, who is not in the daemon's group.
TEST_F(NetworkCommands, AnotherUserMayNotOpenTheLocalSockets) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  ASSERT_EQ(::chmod(dir_.path().c_str(), 0755), 0);
  for (const char* name : {"-wall.command", "-wall.status", "-devices.command",
                           "-wall.command.inner", "-wall.command.network.inner"}) {
    const std::string path = dir_ / (daemon_->instance() + name);
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0) << path;
    EXPECT_EQ(status.st_uid, ::geteuid());
    EXPECT_EQ(status.st_gid, ::getegid());
    const pid_t child = ::fork();
    if (child == 0) {
      const bool other = ::setgid(65534) == 0 && ::setuid(65534) == 0;
      const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      path.copy(address.sun_path, sizeof address.sun_path - 1);
      const bool opened =
          ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
      ::_exit(other && !opened && errno == EACCES ? 0 : 1);
    }
    int ended = -1;
    ::waitpid(child, &ended, 0);
    EXPECT_EQ(ended, 0) << path;
  }
}

}  // namespace
}  // namespace merlin::test
