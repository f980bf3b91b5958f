// Two machines: one daemon reads the devices, another one draws a wall from their samples, which
// are sent encrypted over TCP. Both real programs run on this machine.
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

std::string keys(const std::string& path) {
  const Outcome made = run({kMerlin, "keys", "-o", path});
  EXPECT_EQ(made.status, 0) << made.output;
  return made.output.substr(0, 40);
}

// Counts how often a file is read after the object was made.
class ReadsOf {
 public:
  explicit ReadsOf(const std::string& file) : events_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
    EXPECT_GE(::inotify_add_watch(events_.get(), file.c_str(), IN_CLOSE_NOWRITE), 0) << file;
  }
  // Waits until the file has been read `times` times; false if no read happens for 10 s.
  bool reach(int times) {
    while (count_ < times) {
      pollfd waits{events_.get(), POLLIN, 0};
      if (::poll(&waits, 1, 10'000) != 1) return false;
      inotify_event event{};  // the event has no name, since a single file is watched
      while (count_ < times && ::read(events_.get(), &event, sizeof event) == sizeof event)
        ++count_;
    }
    return true;
  }

 private:
  UniqueFd events_;
  int count_ = 0;
};

struct TwoMachines : testing::Test {
  TwoMachines() {
    const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", 20000 + ::getpid() % 30000);
    const std::string device_key = keys(dir / "devices.keys"), wall_key = keys(dir / "wall.keys");
    writeText(dir / "clients", wall_key + "\n");
    std::filesystem::create_directory(dir / "a");
    std::filesystem::create_directory(dir / "b");
    writeText(dir / "devices.json", nlohmann::json{{"instance", devices_name},
                                                   {"run_directory", dir / "a"},
                                                   {"script", "turning"},
                                                   {"serve",
                                                    {{"samples_endpoint", endpoint},
                                                     {"samples_keys", dir / "devices.keys"},
                                                     {"samples_clients", dir / "clients"}}}}
                                        .dump());
    writeText(
        dir / "wall.json",
        nlohmann::json{
            {"instance", wall_name},
            {"run_directory", dir / "b"},
            {"wall",
             {{"model", makeModel(dir)},
              {"rate", {{"rate_hz", 10}}},
              {"input",
               {{"endpoint", endpoint}, {"server_key", device_key}, {"keys", dir / "wall.keys"}}}}}}
            .dump());
  }
  std::unique_ptr<Process> devices() {
    return std::make_unique<Process>(std::vector<std::string>{
        kMerlind, "--config", dir / "devices.json", "--role", "devices", "--emulate"});
  }
  // Expects that `merlin status` for the wall's instance also shows the devices of the other
  // machine.
  void expectStatusOfTheOthersDevices() {
    Outcome json;
    nlohmann::json status;
    EXPECT_TRUE(eventually([&] {
      json = run({kMerlin, "status", "--json", "--instance", wall_name});
      status = nlohmann::json::parse(json.output, nullptr, false);
      return json.status == 0 && status["devices"]["ball"]["health"] == "ok";
    })) << json.output;
    EXPECT_EQ(status["rate_asked"], 10) << json.output;
    const Outcome text = run({kMerlin, "status", "--instance", wall_name});
    EXPECT_EQ(text.status, 0) << text.output;
    EXPECT_NE(text.output.find("ball"), std::string::npos) << text.output;
    const Outcome watch = run({kMerlin, "watch", "--for", "1", "--instance", wall_name});
    EXPECT_EQ(watch.status, 0) << watch.output;
  }
  TempDir dir;
  std::string devices_name = privateName("there"), wall_name = privateName("here");
};

TEST_F(TwoMachines, TheWallMovesWithTheOtherMachinesBallAndOutlivesIt) {
  Process wall({kMerlind, "--config", dir / "wall.json", "--role", "wall"});
  ASSERT_TRUE(wall.saysEventually("ready")) << wall.output();
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(wall_name, "wall"));
  const auto mirror = shm::DevicesReader::open(shm::segmentName(wall_name, "devices"));
  ASSERT_TRUE(segment && mirror);
  const auto moving = [&] { return (*segment)->stats.read()->moving != 0; };
  const auto ball = [&] {
    const auto health = (*mirror)->ball()->health->read();
    return health ? health->state : HealthState::kAbsent;
  };
  ASSERT_TRUE(eventually([&] { return !moving(); }));  // the other daemon is not running yet
  for (int times = 0; times < 2; ++times) {
    auto there = devices();
    ASSERT_TRUE(eventually([&] { return ball() == HealthState::kOk; })) << wall.output();
    ASSERT_TRUE(eventually(moving)) << "the emulated person twists the ball there";
    expectStatusOfTheOthersDevices();
    there->kill(SIGTERM);
    ASSERT_TRUE(eventually([&] { return ball() == HealthState::kAbsent; }));
    ASSERT_TRUE(eventually([&] { return !moving(); })) << "nobody holds it any more";
    EXPECT_TRUE(wall.saysEventually("the link is lost")) << wall.output();
  }
  EXPECT_FALSE(wall.ended());
  EXPECT_EQ(wall.kill(SIGTERM), 0);
}

TEST_F(TwoMachines, AWallWithoutKeysIsRefusedWithTheWayOut) {
  auto config = nlohmann::json::parse(readText(dir / "wall.json"));
  config["wall"]["input"].erase("keys");
  writeText(dir / "keyless.json", config.dump());
  const Outcome checked = run({kMerlind, "--check-config", dir / "keyless.json"});
  EXPECT_EQ(checked.status, 2);
  EXPECT_NE(checked.output.find("merlin keys -o FILE"), std::string::npos) << checked.output;
  const Outcome both = run({kMerlind, "--config", dir / "wall.json"});
  EXPECT_EQ(both.status, 2) << both.output;
  EXPECT_NE(both.output.find("run it with --role wall"), std::string::npos) << both.output;
}

// The wall reads the key file twice as it starts: first to check it, then to compare or use it. The
// file is replaced after that.
TEST_F(TwoMachines, AKeyThatIsReplacedWhileTheWallStartsIsTakenByTheNextReload) {
  const std::string key = dir / "wall.keys", other = dir / "other.keys";
  keys(other);
  ReadsOf reads(key);
  Process wall({kMerlind, "--config", dir / "wall.json", "--role", "wall"});
  ASSERT_TRUE(reads.reach(2)) << wall.output();
  std::filesystem::rename(other, key);
  ASSERT_TRUE(wall.saysEventually("ready")) << wall.output();
  const Outcome reload = run({kMerlin, "reload", "--instance", wall_name});
  EXPECT_EQ(reload.status, 0) << reload.output;
  EXPECT_EQ(reload.output,
            "merlind started again, because these settings take effect only at a start:\n  "
            "/wall/input/keys\n");
  EXPECT_EQ(run({kMerlin, "reload", "--instance", wall_name}).output, "nothing changed\n");
  EXPECT_EQ(wall.kill(SIGTERM), 0) << wall.output();
}

}  // namespace
}  // namespace merlin::test
