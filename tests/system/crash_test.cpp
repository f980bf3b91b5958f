// The traces that a killed merlind leaves for a person who looks for the cause of its end.
#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "drivers/io/transcript.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

// Returns the file name that follows `words` in a program's output.
std::string fileAfter(const Process& process, const std::string& words) {
  const std::string said = process.output();
  const std::size_t at = said.find(words);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + words.size();
  return said.substr(begin, said.find('\n', begin) - begin);
}

TEST(Crash, LeavesTheLastBytesOfEachDeviceAndTheLastFrame) {
  const TempDir dir;
  Merlind merlind(dir, makeModel(dir, 2), "killed");
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk));
  EXPECT_TRUE(eventually([&] { return merlind.wall().frames > 2; }));
  merlind.process().kill(SIGKILL);

  Process again({kMerlind, "--config", merlind.config(), "--emulate"});
  ASSERT_TRUE(again.saysEventually("ready")) << again.output();
  for (const char* device : {"ball", "glove", "tracker"}) {
    const std::string words = std::string("the last bytes of ") + device + " before that are in ";
    ASSERT_TRUE(again.saysEventually(words)) << again.output();
    const std::string file = fileAfter(again, words);
    const auto transcript = io::readTranscript(file);
    ASSERT_TRUE(transcript) << transcript.error().what;
    EXPECT_GT(transcript->chunks.size(), 3U) << file;
  }
  ASSERT_TRUE(again.saysEventually("the last frame before that is in ")) << again.output();
  const std::string frame = fileAfter(again, "the last frame before that is in ");
  EXPECT_EQ(readText(frame).substr(1, 3), "PNG") << frame;
  EXPECT_EQ(again.kill(SIGTERM), 0);

  Process third({kMerlind, "--config", merlind.config(), "--emulate"});
  ASSERT_TRUE(third.saysEventually("ready")) << third.output();
  EXPECT_EQ(third.kill(SIGTERM), 0);
  EXPECT_EQ(third.output().find("killed or crashed"), std::string::npos)
      << "the one before ended in order: " << third.output();
}

// The two roles run as two processes, one of which is killed.
class KilledRole : public testing::Test {
 protected:
  KilledRole() : model_(makeModel(dir_, 2)) {}

  void start(const std::string& role) {
    auto& process = role == "wall" ? wall_ : devices_;
    process = std::make_unique<Merlind>(dir_, model_, "lost",
                                        MerlindOptions{.role = role, .emulate = role == "devices"});
    ASSERT_TRUE(process->ready()) << process->process().output();
  }
  // Kills the process and returns once its heartbeat is overdue.
  static void killed(Merlind& merlind, const char* role) {
    merlind.process().kill(SIGKILL);
    const std::string name = shm::segmentName(merlind.instance(), role);
    EXPECT_TRUE(eventually([&] {
      const auto memory = SharedMemory::open(name);
      return memory && !shm::isAlive(*reinterpret_cast<const shm::Header*>(memory->data()),
                                     SystemClock().now());
    }));
  }
  Outcome merlin(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kMerlin);
    arguments.insert(arguments.end(), {"--instance", devices_->instance()});
    return run(arguments);
  }

  TempDir dir_;
  std::string model_;
  std::unique_ptr<Merlind> devices_, wall_;
};

TEST_F(KilledRole, OfTheWallIsSaidByStatusReloadAndSnapshot) {
  start("devices");
  start("wall");
  EXPECT_TRUE(eventually([&] { return wall_->wall().frames > 2; }));
  EXPECT_EQ(merlin({"snapshot", "-o", dir_ / "before.png"}).status, 0);
  killed(*wall_, "wall");

  const Outcome status = merlin({"status"});
  EXPECT_EQ(status.status, 0);
  EXPECT_TRUE(status.output.starts_with("wall     does not run; it ended ")) << status.output;
  EXPECT_NE(status.output.find("ball "), std::string::npos) << "the devices have their lines";
  const auto json = devices_->status();
  EXPECT_EQ(json["roles"].size(), 1u) << json;
  EXPECT_GE(json["lost_roles"]["wall"]["silent_s"], 1) << json;

  const Outcome reload = merlin({"reload"});
  EXPECT_EQ(reload.status, 1);
  EXPECT_NE(reload.output.find(": the role wall does not run; it ended "), std::string::npos)
      << reload.output;
  EXPECT_NE(reload.output.find("nothing changed\n"), std::string::npos) << "that of the devices";
  const std::string pid = std::to_string(devices_->process().pid());
  EXPECT_NE(reload.output.find(
                "the role devices has done the reload; the exit status is 1 until the role wall "
                "has been started again. To reload without that role: merlin reload --pid " +
                pid),
            std::string::npos)
      << reload.output;
  EXPECT_NE(merlin({"reload", "--check"}).output.find("the role devices can do the reload; "),
            std::string::npos);
  EXPECT_EQ(run({kMerlin, "reload", "--pid", pid}).output, "nothing changed\n");

  const Outcome snapshot = merlin({"snapshot", "-o", dir_ / "after.png"});
  EXPECT_EQ(snapshot.status, 1);
  EXPECT_NE(snapshot.output.find("does not run; it ended "), std::string::npos) << snapshot.output;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "after.png"));

  start("wall");
  EXPECT_EQ(merlin({"status"}).output.find("does not run"), std::string::npos);
  EXPECT_EQ(merlin({"reload"}).status, 0);
}

TEST_F(KilledRole, OfTheDevicesIsSaidAndOneThatEndedInOrderIsNot) {
  start("devices");
  start("wall");
  EXPECT_TRUE(eventually([&] { return wall_->wall().frames > 2; }));
  killed(*devices_, "devices");
  EXPECT_TRUE(merlin({"status"}).output.starts_with("devices  does not run; it ended "));
  const Outcome reload = merlin({"reload", "--json"});
  EXPECT_EQ(reload.status, 1) << reload.output;
  EXPECT_EQ(merlin({"snapshot", "-o", dir_ / "wall.png"}).status, 0);

  start("devices");
  EXPECT_EQ(devices_->process().kill(SIGTERM), 0);
  EXPECT_EQ(merlin({"status"}).output.find("does not run"), std::string::npos);
  EXPECT_EQ(merlin({"reload"}).status, 0);
}

}  // namespace
}  // namespace merlin::test
