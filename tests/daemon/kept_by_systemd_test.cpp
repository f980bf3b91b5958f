// Tests daemon/kept_by_systemd: the messages to systemd's socket, and the files that systemd
// returns.
#include "daemon/kept_by_systemd.h"

#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

// Takes the place of systemd: the receiving end of NOTIFY_SOCKET.
class Systemd {
 public:
  Systemd() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = dir_ / "notify";
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  ~Systemd() { ::unsetenv("NOTIFY_SOCKET"); }  // NOLINT(concurrency-mt-unsafe)
  Systemd(const Systemd&) = delete;
  Systemd& operator=(const Systemd&) = delete;

  // Returns the next message and the file that came with it; empty if there is no message.
  std::pair<std::string, UniqueFd> heard() const {
    char text[512] = {};
    alignas(cmsghdr) char control[CMSG_SPACE(8 * sizeof(int))] = {};
    iovec part{text, sizeof text - 1};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    if (::recvmsg(socket_.get(), &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC) < 0) return {};
    UniqueFd file;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
      if (c->cmsg_type != SCM_RIGHTS) continue;
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(c), sizeof fd);
      file = UniqueFd(fd);
    }
    return {text, std::move(file)};
  }

 private:
  test::TempDir dir_;
  UniqueFd socket_;
};

ino_t inodeOf(int fd) {
  struct stat status {};
  EXPECT_EQ(::fstat(fd, &status), 0);
  return status.st_ino;
}

TEST(KeptBySystemd, GivesAFileUnderItsNameInPlaceOfTheOneBefore) {
  const Systemd systemd;
  const test::TempDir dir;
  test::writeText(dir / "card", "");
  const UniqueFd card(::open((dir / "card").c_str(), O_RDONLY | O_CLOEXEC));
  KeptBySystemd kept;
  EXPECT_TRUE(kept.keep("card0", card.get()));
  EXPECT_EQ(systemd.heard().first, "FDSTOREREMOVE=1\nFDNAME=card0");
  const auto [said, file] = systemd.heard();
  EXPECT_EQ(said, "FDSTORE=1\nFDNAME=card0");
  ASSERT_TRUE(file.valid());
  EXPECT_EQ(inodeOf(file.get()), inodeOf(card.get()));
  kept.forget("card0");
  EXPECT_EQ(systemd.heard().first, "FDSTOREREMOVE=1\nFDNAME=card0");
  EXPECT_EQ(systemd.heard().first, "");
}

TEST(KeptBySystemd, WithoutSystemdNothingIsKept) {
  KeptBySystemd kept;
  EXPECT_FALSE(kept.keep("card0", STDIN_FILENO));
  kept.forget("card0");
  EXPECT_FALSE(kept.take("card0").valid());
}

// Runs in a child process, in which the files can have the numbers that systemd gives them.
TEST(KeptBySystemd, TakesOverWhatTheProcessBeforeItKeptAndForgetsTheRest) {
  const Systemd systemd;
  const test::TempDir dir;
  test::writeText(dir / "used", "");
  test::writeText(dir / "unused", "");
  const pid_t child = ::fork();
  if (child == 0) {
    const int used = ::open((dir / "used").c_str(), O_RDONLY);
    const int unused = ::open((dir / "unused").c_str(), O_RDONLY);
    const ino_t inode = inodeOf(used);
    // Copied from high numbers, so that neither file is overwritten before it is copied.
    const int high = ::fcntl(used, F_DUPFD, 100), higher = ::fcntl(unused, F_DUPFD, 100);
    ::dup2(high, 3);
    ::dup2(higher, 4);
    ::setenv("LISTEN_PID", std::to_string(::getpid()).c_str(), 1);
    ::setenv("LISTEN_FDS", "2", 1);
    ::setenv("LISTEN_FDNAMES", "card0:card1", 1);
    KeptBySystemd kept;
    const UniqueFd taken = kept.take("card0");
    const bool good = taken.get() == 3 && inodeOf(3) == inode && !kept.take("card0").valid() &&
                      !kept.take("card7").valid() && std::getenv("LISTEN_FDS") == nullptr;
    kept.forgetUntaken();
    const bool closed = ::fcntl(4, F_GETFD) < 0 && ::fcntl(3, F_GETFD) >= 0;
    ::_exit(good && closed ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(systemd.heard().first, "FDSTOREREMOVE=1\nFDNAME=card1") << "the one that was not taken";
  EXPECT_EQ(systemd.heard().first, "");
}

}  // namespace
}  // namespace merlin
