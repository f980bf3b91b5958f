// The file of the daemon's state: StateKeeper saves and reads it, also if it is damaged, newer or
// cannot be written. The file is in StateFolder.
#include "daemon/state/state_keeper.h"

#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/state/state_folder.h"
#include "tests/support/temp_dir.h"

namespace merlin::state {
namespace {

// Files in memory; the disk can be made full.
class FakeFiles final : public StateFiles {
 public:
  struct Disk {
    std::optional<std::string> last, previous, damaged;
    std::optional<Error> fault, unreadable;
    int writes = 0;
  };
  explicit FakeFiles(Disk& disk) : d_(disk) {}
  Result<std::string> read() override {
    if (d_.unreadable) return *d_.unreadable;
    return of(d_.last);
  }
  Result<std::string> readPrevious() override { return of(d_.previous); }
  Result<Ok> write(const std::string& text) override {
    ++d_.writes;
    if (d_.fault) return *d_.fault;
    d_.previous = d_.last;
    d_.last = text;
    return Ok{};
  }
  Result<Ok> putAside() override {
    d_.damaged = std::exchange(d_.last, std::nullopt);
    return Ok{};
  }
  const std::string& name() const override { return name_; }

 private:
  static Result<std::string> of(const std::optional<std::string>& file) {
    if (!file) return Error{Errc::kNotFound, "FILE: there is none"};
    return *file;
  }
  Disk& d_;
  std::string name_ = "FILE";
};

class StateKeeping : public testing::Test {
 protected:
  // Starts the life of a daemon: it reads the state. A test may change the state, and ends the life
  // by destroying the keeper.
  std::unique_ptr<StateKeeper> keeper() {
    return std::make_unique<StateKeeper>(std::make_unique<FakeFiles>(disk_), watch_);
  }
  static void setRate(StateKeeper& keeper, double rate_hz) {
    keeper.change([&](State& state) { state.rate_hz = rate_hz; });
    keeper.settle();
  }
  std::optional<double> rateOf(const std::optional<std::string>& file) {
    const auto read = file ? parseState(*file, "f") : Result<State>(State{});
    return read ? read->rate_hz : std::nullopt;
  }

  FakeFiles::Disk disk_;
  ThreadWatch watch_;
};

TEST_F(StateKeeping, AChangeIsSavedAtOnceAndIsThereAgain) {
  {
    const auto first = keeper();
    EXPECT_EQ(disk_.writes, 0) << "what nobody changed is not written";
    setRate(*first, 20);
    EXPECT_EQ(rateOf(disk_.last), 20);
    setRate(*first, 21);
    EXPECT_EQ(rateOf(disk_.last), 21);
    EXPECT_EQ(rateOf(disk_.previous), 20);
    EXPECT_EQ(first->fault(), "");
  }
  const auto second = keeper();
  EXPECT_EQ(second->state().rate_hz, 21);
  EXPECT_TRUE(second->takeNotices().empty());
}

TEST_F(StateKeeping, OfADamagedFileThePreviousOneIsUsedAndKept) {
  {
    const auto first = keeper();
    setRate(*first, 20);
    setRate(*first, 21);
  }
  disk_.last->resize(disk_.last->size() / 2);
  const auto second = keeper();
  EXPECT_EQ(second->state().rate_hz, 20);
  const auto notices = second->takeNotices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("FILE: line"), std::string::npos) << notices[0];
  EXPECT_NE(notices[0].find("the previous state is used; the damaged file is FILE.damaged now"),
            std::string::npos)
      << notices[0];
  EXPECT_TRUE(disk_.damaged);
  setRate(*second, 22);
  EXPECT_EQ(rateOf(disk_.last), 22);
}

TEST_F(StateKeeping, OfADamagedFileWithoutAPreviousOneTheConfigurationHolds) {
  disk_.last = "{";
  EXPECT_NE(keeper()->takeNotices().at(0).find(
                "there is no previous one: the configuration's values are used"),
            std::string::npos);
}

TEST_F(StateKeeping, WhereBothAreDamagedTheConfigurationHolds) {
  disk_.last = "{";
  disk_.previous = "";
  const auto only = keeper();
  EXPECT_FALSE(only->state().rate_hz);
  EXPECT_NE(only->takeNotices().at(0).find(
                "the previous one is damaged too: the configuration's values are used"),
            std::string::npos);
  setRate(*only, 22);
  EXPECT_EQ(rateOf(disk_.last), 22);
}

TEST_F(StateKeeping, ANewerStateIsNeitherReadNorReplaced) {
  const std::string newer = R"({"merlin_state": 4})";
  disk_.last = newer;
  State older;
  older.rate_hz = 25;
  disk_.previous = stateText(older);
  const auto only = keeper();
  EXPECT_FALSE(only->state().rate_hz);
  EXPECT_NE(only->fault().find("a newer merlind wrote the file; the file is left alone"),
            std::string::npos)
      << only->fault();
  setRate(*only, 22);
  EXPECT_EQ(only->state().rate_hz, 22) << "until the daemon ends";
  EXPECT_EQ(disk_.last, newer);
  EXPECT_EQ(disk_.writes, 0);
}

TEST_F(StateKeeping, AFileThatCannotBeReadIsLeftAlone) {
  disk_.unreadable = Error{Errc::kIo, "FILE: Permission denied"};
  const auto only = keeper();
  EXPECT_TRUE(only->fault().starts_with("FILE: Permission denied; the file is left alone"));
  setRate(*only, 22);
  EXPECT_EQ(disk_.writes, 0);
}

TEST_F(StateKeeping, AFullDiskIsSaidAndTheChangeIsNotLost) {
  {
    const auto only = keeper();
    setRate(*only, 20);
    disk_.fault = Error{Errc::kIo, "FILE: No space left on device"};
    setRate(*only, 21);
    EXPECT_EQ(only->fault(), "FILE: No space left on device; saving is tried again every 5 s");
    EXPECT_EQ(only->state().rate_hz, 21);
    EXPECT_EQ(rateOf(disk_.last), 20);
    disk_.fault.reset();
  }
  EXPECT_EQ(rateOf(disk_.last), 21) << "tried again as the daemon ends";
}

TEST_F(StateKeeping, WithoutAFolderNothingIsSavedAndThatIsSaid) {
  StateKeeper only(nullptr, watch_);
  setRate(only, 20);
  EXPECT_EQ(only.state().rate_hz, 20);
  EXPECT_NE(only.fault().find("/state_file"), std::string::npos);
}

TEST(StateFolder, KeepsTheLastTwoAndPutsADamagedOneAside) {
  const test::TempDir dir;
  const std::string path = dir / "a/b/state.json";
  StateFolder folder(path);
  EXPECT_EQ(folder.read().error().code, Errc::kNotFound);
  ASSERT_TRUE(folder.write("1"));
  EXPECT_EQ(folder.readPrevious().error().code, Errc::kNotFound);
  ASSERT_TRUE(folder.write("2"));
  ASSERT_TRUE(folder.write("3"));
  EXPECT_EQ(*folder.read(), "3");
  EXPECT_EQ(*folder.readPrevious(), "2");
  struct stat last {
  }, previous{};
  EXPECT_EQ(::stat(path.c_str(), &last), 0);
  EXPECT_EQ(::stat((path + ".previous").c_str(), &previous), 0);
  EXPECT_NE(last.st_ino, previous.st_ino) << "damage of one is not damage of the other";
  ASSERT_TRUE(folder.putAside());
  EXPECT_EQ(folder.read().error().code, Errc::kNotFound);
  EXPECT_EQ(*folder.readPrevious(), "2");
  EXPECT_EQ(test::readText(path + ".damaged"), "3");
}

TEST(StateFolder, SaysWhereItCannotWriteAndKeepsWhatIsThere) {
  const test::TempDir dir;
  test::writeText(dir / "file", "x");
  StateFolder folder(dir / "file/state.json");
  const auto written = folder.write("1");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().what.find(dir / "file"), std::string::npos);
  StateFolder good(dir / "state.json");
  ASSERT_TRUE(good.write("1"));
  ASSERT_EQ(::mkdir((dir / "state.json.next").c_str(), 0700), 0);
  EXPECT_FALSE(good.write("2"));
  EXPECT_EQ(*good.read(), "1");
}

TEST(StateFolder, IsTheUsersUnlessOneIsNamed) {
  EXPECT_EQ(stateFile("/x/y.json", "wall", true), "/x/y.json");
  EXPECT_EQ(stateFile("/x/y.json", "wall", false), "/x/y.json.devices");
  ::setenv("STATE_DIRECTORY", "/var/lib/merlin:/other", 1);
  EXPECT_EQ(stateFile("", "wall", true), "/var/lib/merlin/wall.state.json");
  EXPECT_EQ(stateFile("", "wall", false), "/var/lib/merlin/wall.state.json.devices");
  ::unsetenv("STATE_DIRECTORY");
  if (::geteuid() == 0) return;
  ::setenv("XDG_STATE_HOME", "/home/x/state", 1);
  EXPECT_EQ(stateFile("", "wall", true), "/home/x/state/merlin/wall.state.json");
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", "/home/x", 1);
  EXPECT_EQ(stateFile("", "wall", true), "/home/x/.local/state/merlin/wall.state.json");
}

}  // namespace
}  // namespace merlin::state
