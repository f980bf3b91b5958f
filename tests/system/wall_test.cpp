// The whole system: a real merlind, with real emulators on pseudo-terminals, real ZeroMQ and real
// EGL.
#include <algorithm>
#include <array>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/picture_files.h"
#include "tests/system/contiguous.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class Wall : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;  // shared by all tests of the suite
    model_ = makeModel(*dir_);
  }
  static void TearDownTestSuite() { delete dir_; }

  static TempDir* dir_;
  static std::string model_;
};
TempDir* Wall::dir_ = nullptr;
std::string Wall::model_;

TEST_F(Wall, RunsOnEmulatedDevicesAndEndsClean) {
  Merlind m(*dir_, model_, "runs");
  ASSERT_TRUE(m.ready()) << m.process().output();
  for (const char* device : {"glove", "tracker", "ball"})
    EXPECT_TRUE(m.healthIs(device, HealthState::kOk)) << device;
  EXPECT_TRUE(eventually([&] {
    return m.devices()->glove()->posture->newest() && m.devices()->glove()->samples->count() > 50;
  }));
  EXPECT_TRUE(eventually([&] {
    return m.devices()->ball()->samples->count() > 5 &&
           m.devices()->tracker()->stations[0]->count() > 50;
  }));

  nlohmann::json status;
  // All devices have to be ok at the same time; on a busy machine, one may be stale for a moment.
  EXPECT_TRUE(eventually([&] {
    status = m.status();
    return std::ranges::all_of(std::array{"glove", "tracker", "ball"}, [&](const char* name) {
      return status["devices"][name]["health"] == "ok";
    });
  })) << status;
  for (const char* key : {"rate_asked", "rate_held", "late_percent", "triangles", "posture"})
    EXPECT_TRUE(status.contains(key)) << key;
  EXPECT_EQ(status["renderer"]["library"], "EGL");
  EXPECT_FALSE(status["renderer"]["name"].get<std::string>().empty());

  EXPECT_EQ(m.process().kill(SIGTERM), 0) << m.process().output();
  EXPECT_TRUE(m.leftInSharedMemory().empty());
}

TEST_F(Wall, ShowsFullDetailWhenNobodyIsThere) {
  Merlind m(*dir_, model_, "still", {.script = "still"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  EXPECT_TRUE(eventually([&] { return m.wall().full_detail == 1; }));
  EXPECT_EQ(m.wall().cost, m.status()["triangles"]);
  EXPECT_EQ(m.wall().detail_step, 0u);
}

TEST_F(Wall, ANumberOfTrianglesThatCannotBeUsedIsMovedToOneThatCanAndThatIsSaid) {
  Merlind m(*dir_, model_, "by-hand", {.script = "still"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  const auto hold = [&](const char* number) {
    return run({kMerlin, "wall", "--triangles", number, "--instance", m.instance()});
  };
  EXPECT_EQ(hold("10").output, "triangles: 500 (10 is outside of what can be used)\n");
  EXPECT_EQ(hold("4000001").output,
            "triangles: 4000000 (4000001 is outside of what can be used)\n");
  EXPECT_TRUE(eventually([&] { return m.wall().held_cost == 4000000; }));
  EXPECT_NE(hold("3").status, 0);
  EXPECT_EQ(hold("500").output, "triangles: 500\n");
  EXPECT_TRUE(eventually([&] { return m.wall().held_cost == 500; }));
}

TEST_F(Wall, AFistWithTheTrackerGrabs) {
  Merlind m(*dir_, model_, "grabs", {.script = "grabbing"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  EXPECT_TRUE(eventually([&] { return m.wall().grabbed == 1; }));
  EXPECT_TRUE(eventually([&] { return m.wall().grabbed == 0; }));
}

// The emulated person makes a fist and opens it repeatedly.
TEST_F(Wall, AFistPointsAndItsEndTakesASnapshot) {
  const std::string folder = *dir_ / "taken";
  const nlohmann::json bindings = {
      {{"input", "posture.fist"}, {"action", "point_at"}},
      {{"input", "posture.fist"}, {"action", "snapshot"}, {"on", "leave"}}};
  Merlind m(
      *dir_, model_, "points",
      {.script = "grabbing", .also = {{"wall", {{"snapshots", folder}}}, {"bindings", bindings}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  const auto interaction = [&] {
    const auto wall =
        shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(m.instance(), "wall"));
    return wall ? (*wall)->interaction.read().value_or(shm::WallInteraction{})
                : shm::WallInteraction{};
  };
  EXPECT_TRUE(eventually([&] { return interaction().pointing != shm::WallInteraction::kNone; }));
  EXPECT_TRUE(m.process().saysEventually("snapshot: " + folder + "/" + m.instance() + "-"))
      << m.process().output();
  const auto first = std::filesystem::directory_iterator(folder)->path();
  expectPicture(first, 100, 1280, 960);
  EXPECT_TRUE(m.status().contains("pointer"));
  EXPECT_GE(m.status()["snapshots"], 1);
}

TEST_F(Wall, EachDeviceMayDieAndComeBackWithoutTheOthersNoticing) {
  Merlind m(*dir_, model_, "dies");
  ASSERT_TRUE(m.ready()) << m.process().output();
  const struct {
    std::string driver, name;
  } kDevices[] = {{"cyberglove", "glove"}, {"fastrak", "tracker"}, {"spaceball", "ball"}};
  const auto streams = [&](const std::string& device) {
    const auto health = m.health(device);
    return health && health->state == HealthState::kOk && health->samples > 0;
  };
  for (const auto& d : kDevices) ASSERT_TRUE(eventually([&] { return streams(d.name); })) << d.name;
  std::vector<std::unique_ptr<Process>> restarted;

  for (const auto& victim : kDevices) {
    // The status document is updated only from time to time, the shared memory at once.
    const auto status_says = [&](const char* health) {
      return m.status()["devices"][victim.name]["health"] == health;
    };
    const std::uint64_t glove_from = m.devices()->glove()->samples->count(),
                        tracker_from = m.devices()->tracker()->stations[0]->count();
    const std::int64_t drawn = m.wall().updated_ns;
    const auto children = m.children(victim.driver);
    ASSERT_EQ(children.size(), 1u);
    ::kill(children[0], SIGKILL);
    EXPECT_TRUE(m.healthIs(victim.name, HealthState::kAbsent)) << victim.name;
    EXPECT_TRUE(eventually([&] { return status_says("absent"); })) << victim.name;
    EXPECT_TRUE(m.process().saysEventually(fmt::format("the emulated {} has ended", victim.name)));

    restarted.push_back(std::make_unique<Process>(
        std::vector<std::string>{kMerlin, "emulate", victim.driver, "--link",
                                 *dir_ / fmt::format("{}-{}.pty", m.instance(), victim.name)}));
    EXPECT_TRUE(m.healthIs(victim.name, HealthState::kOk)) << victim.name;
    EXPECT_TRUE(eventually([&] { return status_says("ok"); })) << victim.name;
    // There may be more reconnects: on a busy machine, the first record of a new emulator may come
    // too late and cause another one.
    EXPECT_GE(m.health(victim.name)->reconnects, 1u);
    EXPECT_GT(m.wall().updated_ns, drawn) << "the wall never stops";

    EXPECT_GT(m.devices()->glove()->samples->count(), glove_from);
    EXPECT_GT(m.devices()->tracker()->stations[0]->count(), tracker_from);
    if (victim.name != "glove") expectContiguous(*m.devices(), "glove", glove_from);
    if (victim.name != "tracker") expectContiguous(*m.devices(), "tracker", tracker_from);
  }
  EXPECT_EQ(m.process().kill(SIGTERM), 0);
}

// The outputs are black, so a snapshot is black too.
TEST_F(Wall, BlankMakesEverythingBlackUntilSomebodyMovesIt) {
  Merlind m(*dir_, model_, "blank", {.script = "still"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  ASSERT_TRUE(eventually([&] { return m.wall().full_detail == 1; }));
  const auto merlin = [&](std::vector<std::string> words) {
    words.insert(words.begin(), kMerlin);
    words.insert(words.end(), {"--instance", m.instance()});
    const Outcome done = run(words);
    EXPECT_EQ(done.status, 0) << done.output;
  };
  const auto shows = [&](const char* what) {
    return eventually([&] { return m.status().value("shown", "") == what; });
  };
  const std::string black = *dir_ / "black.png", picture = *dir_ / "picture.png";
  merlin({"blank"});
  EXPECT_TRUE(shows("blank"));
  merlin({"snapshot", "-o", black});
  const auto image = render::image::readImage(black);
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_TRUE(std::ranges::all_of(image->pixels, [](std::uint8_t v) { return v == 0; }));
  merlin({"wall", "--move", "0 0 0 0 10 0"});
  EXPECT_TRUE(shows("picture"));
  merlin({"snapshot", "-o", picture});
  expectPicture(picture, 100, 1280, 960);
  merlin({"freeze"});
  EXPECT_TRUE(shows("frozen"));
  merlin({"freeze"});
  EXPECT_TRUE(shows("picture"));
}

TEST_F(Wall, SnapshotsAreTheFrameAndTheWall) {
  Merlind m(*dir_, model_, "snapshot");
  ASSERT_TRUE(m.ready()) << m.process().output();
  const std::string frame = *dir_ / "frame.png", wall = *dir_ / "wall.png";
  EXPECT_NE(
      run({kMerlin, "snapshot", "-o", frame, "--instance", m.instance()}).output.find("1280 x 960"),
      std::string::npos);
  EXPECT_NE(run({kMerlin, "snapshot", "--wall", "-o", wall, "--instance", m.instance()})
                .output.find("1920 x 480"),
            std::string::npos);
  expectPicture(frame, 100, 1280, 960);
  expectPicture(wall, 100, 1920, 480);
}

TEST_F(Wall, SharedMemoryIsReadByItsDumpAndByPython) {
  Merlind m(*dir_, model_, "dump", {.script = "still"});
  ASSERT_TRUE(m.ready()) << m.process().output();
  ASSERT_TRUE(m.healthIs("glove", HealthState::kOk));
  ASSERT_TRUE(eventually([&] {
    return m.devices()->glove()->posture->newest() &&
           std::string(m.devices()->glove()->posture->newest()->name) == "open";
  }));
  nlohmann::json fields;
  const auto dumped = [&] {
    const auto dump = nlohmann::json::parse(
        run({kMerlin, "shm", "dump", "--json", "--instance", m.instance()}).output);
    fields = dump["/" + m.instance() + "-devices"];
    return fields["glove.health.state"]["value"] == 2;
  };
  // On a busy machine, the emulated glove may be silent for too long at this moment.
  EXPECT_TRUE(eventually(dumped)) << fields["glove.health.state"];
  EXPECT_EQ(fields["glove.angle_rad"]["value"].size(), 23u);
  EXPECT_EQ(fields["glove.angle_rad"]["unit"], "rad");

  const Outcome python = run({"python3", kSource + "/daemon/shm/read_merlin.py",
                              m.instance() + "-devices", "posture.name", "glove.sensors"});
  EXPECT_EQ(python.status, 0) << python.output;
  EXPECT_EQ(python.output, "glove.sensors [22] \nposture.name ['open'] \n");
  EXPECT_LE(std::count(python.output.begin(), python.output.end(), '\n'), 30);
}

TEST_F(Wall, TheTwoRolesRunAsTwoProcesses) {
  Merlind devices(*dir_, model_, "roles", {.script = "turning", .role = "devices"});
  ASSERT_TRUE(devices.ready()) << devices.process().output();
  Merlind wall(*dir_, model_, "roles", {.role = "wall", .emulate = false});
  ASSERT_TRUE(wall.ready()) << wall.process().output();
  EXPECT_TRUE(eventually([&] { return wall.wall().moving == 1 && wall.wall().frames > 20; }))
      << "the ball is twisted";
  EXPECT_EQ(devices.status()["roles"].size(), 2u);
  // The wall goes on without the devices' process, and connects to the next one.
  EXPECT_EQ(devices.process().kill(SIGKILL), 128 + SIGKILL);
  EXPECT_TRUE(eventually([&] { return wall.wall().moving == 0; }));
  Merlind again(*dir_, model_, "roles", {.script = "turning", .role = "devices"});
  EXPECT_TRUE(eventually([&] { return wall.wall().moving == 1; })) << again.process().output();
  EXPECT_EQ(again.process().kill(SIGTERM), 0);
  EXPECT_EQ(wall.process().kill(SIGTERM), 0);
  EXPECT_TRUE(wall.leftInSharedMemory().empty());
}

TEST_F(Wall, ASecondOneOfTheSameNameIsRefused) {
  Merlind first(*dir_, model_, "second");
  ASSERT_TRUE(first.ready()) << first.process().output();
  Merlind second(*dir_, model_, "second");
  EXPECT_EQ(second.process().wait(), 3);
  EXPECT_NE(second.process().output().find("another merlind already runs as"), std::string::npos)
      << second.process().output();
  EXPECT_TRUE(first.healthIs("ball", HealthState::kOk));
  EXPECT_EQ(first.status()["roles"].size(), 2u) << "its sockets still answer";
  EXPECT_EQ(first.process().kill(SIGTERM), 0);
}

TEST_F(Wall, StartsAgainAfterAKill) {
  Merlind killed(*dir_, model_, "killed");
  ASSERT_TRUE(killed.ready()) << killed.process().output();
  EXPECT_EQ(killed.process().kill(SIGKILL), 128 + SIGKILL);
  EXPECT_FALSE(killed.leftInSharedMemory().empty());
  Merlind next(*dir_, model_, "killed");
  EXPECT_TRUE(next.ready()) << next.process().output();
  EXPECT_EQ(next.status()["roles"].size(), 2u);
  EXPECT_EQ(next.process().kill(SIGINT), 0);
  EXPECT_TRUE(next.leftInSharedMemory().empty());
}

// The receiving end of systemd's notification socket.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : path_(path), fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(path.begin(), path.end(), address.sun_path);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~NotifySocket() { ::close(fd_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  std::string all() {
    char buffer[512];
    for (ssize_t n = 0; (n = ::recv(fd_, buffer, sizeof buffer, 0)) > 0;)
      heard_ += std::string(buffer, static_cast<std::size_t>(n)) + "\n";
    return heard_;
  }
  bool hears(const std::string& text) {
    return eventually([&] { return all().find(text) != std::string::npos; });
  }

 private:
  std::string path_;
  int fd_;
  std::string heard_;
};

TEST_F(Wall, TellsSystemdWhenTheFirstFrameIsOutAndThatThereIsProgress) {
  NotifySocket systemd(*dir_ / "notify");
  Merlind m(*dir_, model_, "systemd",
            {.environment = {{"NOTIFY_SOCKET", *dir_ / "notify"}, {"WATCHDOG_USEC", "400000"}}});
  EXPECT_TRUE(systemd.hears("READY=1")) << m.process().output();
  EXPECT_GT(m.wall().frames, 0u);
  EXPECT_TRUE(systemd.hears("WATCHDOG=1"));
  EXPECT_LT(systemd.all().find("READY=1"), systemd.all().find("WATCHDOG=1"))
      << "a ping would arm the watchdog while the first frame takes its time";
  EXPECT_TRUE(systemd.hears("STATUS="));
  EXPECT_EQ(m.process().kill(SIGTERM), 0);
  EXPECT_TRUE(systemd.hears("STOPPING=1"));
}

}  // namespace
}  // namespace merlin::test
