// spacenavd, a program that supports the real Spaceball, reads the emulated one; the test receives
// the events from spacenavd's own socket. Skipped where spacenavd is not installed.
#include <array>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

// An event of version 0 of the protocol: type, six axes or a button, time [ms].
using Event = std::array<std::int32_t, 8>;

int connectTo(const std::string& path) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  if (::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return fd;
  ::close(fd);
  return -1;
}

// Returns true if one of the next hundred events is a twist about the vertical axis without a
// translation, false if none is or if no event arrives for ten seconds.
bool seesATwist(int client) {
  timeval limit{10, 0};
  ::setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  for (int i = 0; i < 100; ++i) {
    Event event{};
    if (::recv(client, event.data(), sizeof event, MSG_WAITALL) != ssize_t{sizeof event})
      return false;
    if (event[0] == 0 && std::abs(event[5]) > 100 && event[1] == 0 && event[2] == 0 &&
        event[3] == 0)
      return true;
  }
  return false;
}

TEST(Spacenavd, SeesTheEmulatedBallTwistedAboutItsVerticalAxis) {
  if (run({"which", "spacenavd"}).status != 0) GTEST_SKIP() << "spacenavd is not installed";
  const TempDir dir;
  Process emulator({MERLIN_BIN_DIR "/merlin", "emulate", "spaceball", "--link", dir / "ball",
                    "--script", "turning"});
  ASSERT_TRUE(emulator.saysEventually("spaceball on")) << emulator.output();
  writeText(dir / "spnavrc", "serial = " + dir / "ball" + "\n");
  // Debian's spacenavd binds run/spnav.sock relative to its working directory (/ as a service).
  std::filesystem::create_directory(dir / "run");
  const std::string start =
      "cd " + dir.path() + " && rm -f run/spnav.sock && exec spacenavd -d -v -c spnavrc";
  // spacenavd gives up on a ball that does not answer in time, as happens on a busy machine. The
  // test then starts spacenavd again, as a service manager would.
  bool twisted = false;
  std::string output;
  for (int attempt = 0; attempt < 6 && !twisted; ++attempt) {
    Process spacenavd({"sh", "-c", start});
    int client = -1;
    ASSERT_TRUE(eventually([&] {
      return spacenavd.ended() || (client = connectTo(dir / "run/spnav.sock")) >= 0;
    })) << spacenavd.output();
    ASSERT_FALSE(spacenavd.ended()) << spacenavd.output();
    twisted = seesATwist(client);
    ::close(client);
    spacenavd.kill(SIGTERM);
    output = spacenavd.output();
  }
  EXPECT_TRUE(twisted) << output;
}

}  // namespace
}  // namespace merlin::test
