// Pipes to child processes, their start, and the wait for their end.
#include "daemon/base/child_process.h"

#include <csignal>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace merlin {
namespace {

TEST(ChildProcess, SpeaksThroughThePipeAndIsWaitedFor) {
  auto pipe = makePipe();
  ASSERT_TRUE(pipe);
  const auto child = startChild();
  ASSERT_TRUE(child);
  if (*child == 0) ::_exit(::write(pipe->to.get(), "abc", 3) == 3 ? 7 : 1);
  pipe->to.reset();
  char bytes[8];
  EXPECT_EQ(::read(pipe->from.get(), bytes, sizeof bytes), 3);
  const int status = waitForChild(*child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(ChildProcess, NeitherEndOfAPipeReachesAnotherProgram) {
  const auto pipe = makePipe();
  ASSERT_TRUE(pipe);
  for (const UniqueFd* end : {&pipe->from, &pipe->to})
    EXPECT_TRUE(::fcntl(end->get(), F_GETFD) & FD_CLOEXEC);
}

int signalled = -1;  // write end of a pipe: the handler tells the child that a signal has arrived

// The child sends signals one by one, each when the previous one has arrived, and then ends.
TEST(ChildProcess, ASignalDoesNotEndTheWait) {
  auto pipe = makePipe();
  ASSERT_TRUE(pipe);
  signalled = pipe->to.get();
  struct sigaction tell {};
  // Without SA_RESTART the signal interrupts a wait.
  tell.sa_handler = [](int) { (void)!::write(signalled, "", 1); };
  struct sigaction before {};
  ASSERT_EQ(::sigaction(SIGUSR1, &tell, &before), 0);
  const pid_t parent = ::getpid();
  const auto child = startChild();
  ASSERT_TRUE(child);
  if (*child == 0) {
    pipe->to.reset();  // so that the child ends when the test does
    char byte = 0;
    for (int i = 0; i < 1000; ++i) {
      if (::kill(parent, SIGUSR1) != 0 || ::read(pipe->from.get(), &byte, 1) != 1) ::_exit(1);
    }
    ::_exit(3);
  }
  const int status = waitForChild(*child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
  ::sigaction(SIGUSR1, &before, nullptr);
}

// Runs in a child process, so that the limit on descriptors affects only the child.
TEST(ChildProcess, WithoutDescriptorsThePipeIsSaidToBeMissing) {
  auto pipe = makePipe();
  ASSERT_TRUE(pipe);
  const auto child = startChild();
  ASSERT_TRUE(child);
  if (*child == 0) {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_NOFILE, &none);
    const auto refused = makePipe();
    const std::string said = refused ? "none" : refused.error().what;
    ::_exit(::write(pipe->to.get(), said.data(), said.size()) > 0 ? 0 : 1);
  }
  pipe->to.reset();
  std::vector<char> bytes(200);
  const ssize_t n = ::read(pipe->from.get(), bytes.data(), bytes.size());
  waitForChild(*child);
  ASSERT_GT(n, 0);
  EXPECT_EQ(std::string(bytes.data(), static_cast<std::size_t>(n)),
            "a pipe to a child process cannot be made: Too many open files");
}

}  // namespace
}  // namespace merlin
