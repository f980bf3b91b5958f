// The sandbox of merlin-import in a child process: what it still allows, and what it forbids.
#include "daemon/import/sandbox.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/sanitizer.h"
#include "tests/support/temp_dir.h"

namespace merlin::import {
namespace {

constexpr int kLacks = 100, kNotClosed = 101;

bool opens(const std::string& path, int flags) {
  const int fd = ::open(path.c_str(), flags, 0600);
  if (fd >= 0) ::close(fd);
  return fd >= 0;
}

// Enters the sandbox in a child process, and performs the checks there. Returns the number, counted
// from 1, of the first check that fails, or 0 if none does.
int firstFailure(const std::string& input, const std::string& folder, const Limits& limits,
                 const std::vector<std::function<bool()>>& checks) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto closed = closeSandbox({input}, folder, limits);
    if (!closed) ::_exit(kNotClosed);
    if (!closed->empty()) ::_exit(kLacks);
    for (std::size_t i = 0; i < checks.size(); ++i) {
      if (!checks[i]()) ::_exit(static_cast<int>(i) + 1);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class SandboxTest : public testing::Test {
 protected:
  void SetUp() override {
    test::writeText(input_, "input");
    test::writeText(dir_ / "other", "other");
    std::filesystem::create_directory(folder_);
  }
  void expectAll(const std::vector<std::function<bool()>>& checks, const Limits& limits = {}) {
    const int failed = firstFailure(input_, folder_, limits, checks);
    if (failed == kLacks) GTEST_SKIP() << "this system lacks Landlock or seccomp";
    EXPECT_EQ(failed, 0) << "number of the first check that failed";
  }
  test::TempDir dir_;
  std::string input_ = dir_ / "input", folder_ = dir_ / "folder";
};

TEST_F(SandboxTest, LeavesTheInputToReadAndTheFolderToWriteAndNoOtherFile) {
  expectAll({[&] { return opens(input_, O_RDONLY); }, [&] { return !opens(input_, O_WRONLY); },
             [&] { return !opens(dir_ / "other", O_RDONLY); },
             [&] { return !opens(dir_ / "new", O_WRONLY | O_CREAT); },
             [&] { return !opens("/etc/passwd", O_RDONLY); },
             [&] { return opens(folder_ + "/new", O_RDWR | O_CREAT); },
             [&] { return ::unlink((folder_ + "/new").c_str()) == 0; },
             [&] { return ::unlink((dir_ / "other").c_str()) != 0; }});
}

TEST_F(SandboxTest, LeavesNoNetworkNoProgramAndNoOtherProcess) {
  expectAll({[] { return ::socket(AF_INET, SOCK_STREAM, 0) < 0 && errno == EPERM; },
             [] { return ::socket(AF_UNIX, SOCK_STREAM, 0) < 0 && errno == EPERM; },
             [] {
               char name[] = "/bin/true";
               char* const arguments[] = {name, nullptr};
               return ::execv(name, arguments) < 0 && errno == EPERM;
             },
             [] { return ::kill(::getppid(), 0) < 0 && errno == EPERM; }});
}

TEST_F(SandboxTest, OfTheFilesBesideAModelTheVisibleOnesMayBeRead) {
  for (const char* folder : {"textures", "assets", ".private"}) {
    std::filesystem::create_directory(dir_ / folder);
    test::writeText(dir_ / folder + "/a.png", "");
  }
  test::writeText(dir_ / ".hidden", "");
  test::TempDir elsewhere;
  test::writeText(elsewhere / "secret", "");
  std::filesystem::create_directory_symlink(elsewhere.path(), dir_ / "link");
  auto files = filesBeside(input_);
  std::ranges::sort(files);
  EXPECT_EQ(files, (std::vector<std::string>{dir_ / "assets/a.png", input_, dir_ / "other",
                                             dir_ / "textures/a.png"}));
}

TEST_F(SandboxTest, LimitsFilesAndMemory) {
  expectAll(
      {
        [&] {
          if (!limitFileSize(1000)) return false;
          const int fd = ::open((folder_ + "/new").c_str(), O_WRONLY | O_CREAT, 0600);
          const std::string text(2000, 'x');
          const bool first = ::write(fd, text.data(), text.size()) == 1000;
          return first && ::write(fd, text.data(), text.size()) < 0 && errno == EFBIG;
        },
#if !defined(MERLIN_ANY_SANITIZER)
            [] {
              void* const large = std::malloc(std::size_t{1} << 30);
              const bool refused = large == nullptr;
              std::free(large);
              return refused;
            }
#endif
      },
      Limits{.memory_bytes = std::uint64_t{512} << 20});
}

}  // namespace
}  // namespace merlin::import
