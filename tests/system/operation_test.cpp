// A daemon that runs for months: signals, disks that fill up and come back, unusual file names.
#include <chrono>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/commands.h"
#include "daemon/status/client.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

TEST(Operation, SignalsThatAskForNothingEndNothing) {
  const TempDir dir;
  Merlind m(dir, "", "signals", {.role = "devices"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU, SIGIO, SIGPWR, SIGTSTP, SIGTTIN,
                           SIGTTOU, SIGRTMIN + 3, SIGRTMAX, SIGHUP})
    ASSERT_EQ(::kill(m.process().pid(), signal), 0);
  EXPECT_TRUE(m.process().saysEventually("was read again; nothing changed"))
      << m.process().output();
  EXPECT_FALSE(m.process().ended()) << m.process().output();
  EXPECT_TRUE(m.status()["devices"].contains("ball")) << m.status();
  EXPECT_EQ(m.process().kill(SIGTERM), 0);
}

// The log goes to a program that does not read it, such as a stopped pager; merlind must not block.
TEST(Operation, ALogThatNobodyReadsHoldsNothing) {
  const TempDir dir;
  const std::string fifo = dir / "log";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const UniqueFd log(::open(fifo.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  ASSERT_TRUE(log.valid());
  while (::write(log.get(), "x", 1) == 1) continue;  // fills the pipe to the last byte
  const std::string instance = privateName("unread");
  writeText(dir / "c.json", json{{"instance", instance}, {"run_directory", dir.path()}}.dump());
  Process merlind({"/bin/sh", "-c",
                   fmt::format("exec '{}' --config '{}/c.json' --role devices --emulate 2>'{}'",
                               kMerlind, dir.path(), fifo)});
  const auto status = [&] { return run({kMerlin, "status", "--json", "--instance", instance}); };
  ASSERT_TRUE(eventually([&] { return status().status == 0; }));
  // Each reload logs one line.
  for (int i = 0; i < 3; ++i) ASSERT_EQ(run({kMerlin, "reload", "--instance", instance}).status, 0);
  EXPECT_EQ(status().status, 0);
  char bytes[65536];
  while (::read(log.get(), bytes, sizeof bytes) > 0) continue;
  ASSERT_EQ(::kill(merlind.pid(), SIGHUP), 0);
  std::string said;
  EXPECT_TRUE(eventually([&] {
    const ssize_t n = ::read(log.get(), bytes, sizeof bytes);
    if (n > 0) said.append(bytes, static_cast<std::size_t>(n));
    return said.find("lines of the log were lost") != std::string::npos;
  })) << said;
  EXPECT_EQ(merlind.kill(SIGTERM), 0);
}

// Without these streams, the first shared memory object would get descriptor 2, and the log would
// be written into it.
TEST(Operation, ClosedStandardStreamsTakeNoPlaceOfAFile) {
  const TempDir dir;
  const std::string instance = privateName("closed");
  writeText(dir / "c.json", json{{"instance", instance}, {"run_directory", dir.path()}}.dump());
  Process merlind({"/bin/sh", "-c",
                   fmt::format("exec '{}' --config '{}/c.json' --role devices --emulate "
                               "<&- >&- 2>&-",
                               kMerlind, dir.path())});
  const auto status = [&] { return run({kMerlin, "status", "--json", "--instance", instance}); };
  ASSERT_TRUE(eventually([&] { return status().status == 0; }));
  for (const char* fd : {"0", "1", "2"}) {
    EXPECT_EQ(std::filesystem::read_symlink(fmt::format("/proc/{}/fd/{}", merlind.pid(), fd)),
              "/dev/null");
  }
  EXPECT_EQ(merlind.kill(SIGTERM), 0);
}

TEST(Operation, APictureThatCannotBeWrittenIsSaidAndSoIsItsReturn) {
  const TempDir dir;
  const std::string folder = dir / "pictures", away = dir / "away";
  std::filesystem::create_directory(folder);
  Merlind m(
      dir, makeModel(dir, 2), "png",
      {.also = {{"wall",
                 {{"outputs",
                   json::array(
                       {{{"kind", "shared_memory"}},
                        {{"kind", "png"}, {"path", folder + "/w.png"}, {"interval_s", 1}}})}}}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  std::filesystem::rename(folder, away);
  EXPECT_TRUE(m.process().saysEventually("output png failed: " + folder +
                                         "/w.png: No such file or directory"))
      << m.process().output();
  EXPECT_EQ(m.status()["outputs"]["png"]["health"], "failed");
  EXPECT_EQ(m.status()["outputs"]["shared_memory"]["health"], "ok");
  std::filesystem::rename(away, folder);
  EXPECT_TRUE(m.process().saysEventually("output png works again")) << m.process().output();
  EXPECT_EQ(m.process().kill(SIGTERM), 0);
}

// Objects may be removed by an administrator's mistake, or by logind when an ordinary user logs
// out.
TEST(Operation, WhatIsRemovedFromSharedMemoryIsMadeAgain) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "removed");
  ASSERT_TRUE(m.ready()) << m.process().output();
  const std::vector<std::string> objects = m.leftInSharedMemory();
  ASSERT_EQ(objects.size(), 8u) << "devices, flight, wall, framebuffer and their locks";
  for (const std::string& object : objects) std::filesystem::remove(object);
  EXPECT_TRUE(eventually([&] { return m.leftInSharedMemory().size() == objects.size(); }));
  EXPECT_TRUE(m.process().saysEventually("shared memory: works again")) << m.process().output();
  EXPECT_TRUE(m.status()["devices"].contains("ball")) << m.status();
  const std::string picture = dir / "frame.png";
  EXPECT_EQ(run({kMerlin, "snapshot", "--instance", m.instance(), "-o", picture}).status, 0);
  EXPECT_TRUE(std::filesystem::is_regular_file(picture));
  const Outcome second = run({kMerlind, "--config", m.config(), "--emulate"});
  EXPECT_NE(second.status, 0);
  EXPECT_NE(second.output.find("another merlind already runs as"), std::string::npos)
      << second.output;
  EXPECT_EQ(m.process().kill(SIGTERM), 0);
  EXPECT_EQ(m.leftInSharedMemory().size(), 0u);
}

// systemd would start merlind again 0.1 s after its end, and each start writes to the journal.
TEST(Operation, AStartThatFailsUnderSystemdEndsOnlyAfterFiveSeconds) {
  const TempDir dir;
  const std::string instance = privateName("fails"), config = dir / "merlin.json";
  writeText(config, json{{"instance", instance}, {"run_directory", dir.path()}}.dump());
  writeText(dir / (instance + "-devices.command"), "in the socket's place");
  const auto begin = std::chrono::steady_clock::now();
  Process merlind({kMerlind, "--config", config, "--role", "devices"},
                  {{"NOTIFY_SOCKET", dir / "nobody"}});
  EXPECT_NE(merlind.wait(), 0);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  EXPECT_NE(merlind.output().find("is not a socket and is not replaced"), std::string::npos)
      << merlind.output();
}

// Returns an argument that the command accepts.
std::string argumentFor(const CommandInfo& command) {
  if (command.name == "align") return "list";
  if (command.name == "reload") return "check";
  if (command.name == "show") return "model";
  if (command.name == "show_file") return "other.mrm";
  if (command.name == "signal") return "shared_memory";
  if (command.name == "testcard") return "off";
  if (command.name == "playlist") return "next";
  if (command.name == "operator_pointer") return "out";
  if (command.name == "move") return "0.1 -0.1 0 0 30 0";
  return command.argument.empty() ? "" : "auto";
}

// The daemon carries out every command in kCommands, in the process of the role that the list
// names.
TEST(Operation, EveryCommandOfTheListIsCarriedOut) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "commands",
            {.also = {{"wall", {{"snapshots", dir / "shots"}, {"operator", {{"panel", true}}}}}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  std::filesystem::copy(dir / "model.mrm", dir / (m.instance() + ".shown/other.mrm"));
  for (const CommandInfo& command : kCommands) {
    if (command.bindable == Bindable::kHeld) continue;  // this command needs an input that is held
    const bool by_wall = command.role == CommandOf::kWall;
    const std::string argument = argumentFor(command);
    const auto answer = status::ask(fmt::format("ipc://{}/{}-{}.command", dir.path(), m.instance(),
                                                by_wall ? "wall" : "devices"),
                                    std::string(command.name), std::chrono::seconds(10), argument);
    if (command.role != CommandOf::kPanel) {
      EXPECT_TRUE(answer) << command.name << ": " << answer.error().what;
      continue;
    }
    ASSERT_FALSE(answer);
    const bool projectors = command.name.starts_with("projector_");
    EXPECT_NE(answer.error().what.find(projectors ? "this process has no projectors"
                                                  : "this process has no panel"),
              std::string::npos)
        << answer.error().what;
  }
  EXPECT_TRUE(m.process().saysEventually("snapshot: " + dir / "shots"));
  EXPECT_TRUE(eventually([&] { return m.status()["snapshots"] == 1; })) << m.status().dump();
  for (const CommandInfo& command : kCommands) {
    if (!command.by_name) continue;
    std::vector<std::string> words = {kMerlin, std::string(command.name)};
    if (!command.argument.empty()) words.push_back(argumentFor(command));
    words.insert(words.end(), {"--instance", m.instance()});
    const Outcome done = run(words);
    EXPECT_EQ(done.status, command.role == CommandOf::kPanel ? 2 : 0) << done.output;
  }
  const Outcome wrong = run({kMerlin, "wall", "--rate", "fast", "--instance", m.instance()});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.output.find("rate: \"fast\" is not a number from 1 to 240, or auto"),
            std::string::npos)
      << wrong.output;
}

TEST(Operation, AMerlindThatStandsStillIsSaidToRunAndNotToAnswer) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "still");
  ASSERT_TRUE(m.ready()) << m.process().output();
  ::kill(m.process().pid(), SIGSTOP);
  const auto wall =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(m.instance(), "wall"));
  ASSERT_TRUE(wall);
  EXPECT_TRUE(eventually([&] { return !wall->alive(SystemClock().now()); }));
  const Outcome reset = run({kMerlin, "reset_view", "--instance", m.instance()});
  ::kill(m.process().pid(), SIGCONT);
  EXPECT_EQ(reset.status, 1) << reset.output;
  EXPECT_NE(reset.output.find("no answer within 5.0 s"), std::string::npos) << reset.output;
}

TEST(Operation, APointerWhereNoFrameIsIsRefused) {
  const TempDir dir;
  Merlind m(dir, makeModel(dir, 2), "pointer",
            {.also = {{"wall", {{"operator", {{"panel", true}}}}}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  const std::string endpoint = fmt::format("ipc://{}/{}-wall.command", dir.path(), m.instance());
  for (const char* place :
       {"-2147483648 0 0", "1000001 0 0", "0 0 2", "0 0", "0 0 0 0", "nan 0 0"}) {
    const auto answer = status::ask(endpoint, "operator_pointer", std::chrono::seconds(10), place);
    ASSERT_FALSE(answer) << place;
    EXPECT_NE(answer.error().what.find("is neither X Y 0, X Y 1 nor out"), std::string::npos)
        << answer.error().what;
  }
}

TEST(Operation, ARunDirectoryMayHaveAnyName) {
  const TempDir dir;
  Merlind m(dir, "", "quoted", {.role = "devices", .also = {{"run_directory", dir / "a\"b"}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  const Outcome flight = run({kMerlin, "flight", "--instance", m.instance()});
  EXPECT_EQ(flight.status, 0) << flight.output;
  EXPECT_NE(flight.output.find("a\"b/flight/"), std::string::npos) << flight.output;
}

}  // namespace
}  // namespace merlin::test
