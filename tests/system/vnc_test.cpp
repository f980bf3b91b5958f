// merlin-rfb with real VNC clients: what they see, what they may do, and how little hostile ones
// achieve.
#include <charconv>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "daemon/base/sanitizer.h"
#include "daemon/base/unique_fd.h"
#include "render/image/image_file.h"
#include "tests/support/vnc_client.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

const std::string kRfb = MERLIN_BIN_DIR "/merlin-rfb";
using Arguments = std::vector<std::string>;

// A merlin-rfb process at a free port.
class Rfb {
 public:
  explicit Rfb(const std::string& instance, const Arguments& more = {}) {
    Arguments all = {kRfb, "--instance", instance, "--listen", "127.0.0.1:0"};
    all.insert(all.end(), more.begin(), more.end());
    process_ = std::make_unique<Process>(all);
    EXPECT_TRUE(process_->saysEventually("clients at most")) << process_->output();
    const std::string said = process_->output(), before = "at 127.0.0.1:";
    const std::size_t at = said.find(before);
    if (at != std::string::npos)
      std::from_chars(said.data() + at + before.size(), said.data() + said.size(), port_);
  }
  int port() const { return port_; }
  Process& process() { return *process_; }

  struct Child {
    pid_t pid = 0;
    std::size_t memory_kb = 0;  // excluding memory that is shared with the wall
  };
  std::vector<Child> children() const {
    std::vector<Child> found;
    const std::string pid = std::to_string(process_->pid());
    std::istringstream pids(readText("/proc/" + pid + "/task/" + pid + "/children"));
    for (Child child; pids >> child.pid;) {
      const std::string status = readText(fmt::format("/proc/{}/status", child.pid));
      const std::size_t at = status.find("RssAnon:");
      if (at != std::string::npos) child.memory_kb = std::stoul(status.substr(at + 8));
      found.push_back(child);
    }
    return found;
  }

 private:
  std::unique_ptr<Process> process_;
  int port_ = 0;
};

class RfbTest : public testing::Test {
 protected:
  std::unique_ptr<Merlind> start(const std::string& script) {
    auto wall = std::make_unique<Merlind>(dir_, makeModel(dir_, 5), "rfb",
                                          MerlindOptions{.script = script});
    EXPECT_TRUE(wall->ready()) << wall->process().output();
    return wall;
  }
  // Returns the picture of `merlin snapshot`, once the wall shows full detail.
  Image snapshot(Merlind& wall, bool whole_frame = false) {
    EXPECT_TRUE(eventually([&] { return wall.wall().full_detail == 1; }));
    Arguments command = {kMerlin, "snapshot", "--instance", wall.instance(), "-o", dir_ / "s.png"};
    if (!whole_frame) command.emplace_back("--wall");
    const Outcome done = run(command);
    EXPECT_EQ(done.status, 0) << done.output;
    const auto read = render::image::readImage(dir_ / "s.png");
    EXPECT_TRUE(read) << read.error().what;
    Image image{read->width, read->height, {}};
    for (std::size_t i = 0; i < read->pixels.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c) image.pixels.push_back(read->pixels[i + c]);
      image.pixels.push_back(255);
    }
    return image;
  }

  TempDir dir_;
};

Image cut(const Image& from, int x, int y, int width, int height) {
  Image part{width, height, {}};
  for (int row = y; row < y + height; ++row) {
    const auto at = from.pixels.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * from.width + x);
    part.pixels.insert(part.pixels.end(), at, at + 4 * width);
  }
  return part;
}

TEST_F(RfbTest, AClientSeesTheWallTheOperatorsViewOrATile) {
  const auto wall = start("still");
  const Image frame = snapshot(*wall, true), tiles = snapshot(*wall);
  ASSERT_EQ(frame.width, 1280);
  ASSERT_EQ(frame.height, 960);
  Rfb of_wall(wall->instance());
  VncClient sees_wall(of_wall.port());
  ASSERT_TRUE(sees_wall.isConnected());
  EXPECT_EQ(sees_wall.name(), fmt::format("MERLIN {}: the wall", wall->instance()));
  EXPECT_TRUE(sees_wall.shows(tiles));

  Rfb of_operator(wall->instance(), {"--view", "operator"});
  VncClient sees_operator(of_operator.port());
  ASSERT_TRUE(sees_operator.isConnected());
  EXPECT_TRUE(sees_operator.shows(cut(frame, 640, 480, 640, 480)));

  Rfb of_tile(wall->instance(), {"--tile", "left"});
  VncClient sees_tile(of_tile.port());
  ASSERT_TRUE(sees_tile.isConnected());
  EXPECT_TRUE(sees_tile.shows(cut(tiles, 0, 0, 640, 480)));

  Rfb of_none(wall->instance(), {"--tile", "attic"});
  EXPECT_TRUE(of_none.process().saysEventually(
      "this wall has no tile attic; its tiles are left, centre, right, operator"))
      << of_none.process().output();
}

TEST_F(RfbTest, InputMovesTheModelOnlyWhereItIsAllowed) {
  const auto wall = start("still");
  const Image before = snapshot(*wall);
  const auto drag = [](VncClient& client) {
    client.pointer(1, 300, 200);
    client.pointer(1, 400, 240);
    client.pointer(0, 400, 240);
    return client.refresh();
  };
  Rfb only_looks(wall->instance()), moves(wall->instance(), {"--allow-input"});
  VncClient looking(only_looks.port()), moving(moves.port());
  ASSERT_TRUE(looking.isConnected() && moving.isConnected());
  ASSERT_TRUE(looking.shows(before));
  ASSERT_TRUE(moving.shows(before));
  const std::uint64_t frames = wall->wall().frames;
  EXPECT_TRUE(drag(looking));
  looking.press('m');
  EXPECT_TRUE(looking.refresh());
  EXPECT_EQ(wall->wall().frames, frames) << "a client that may only look moved the model";

  EXPECT_TRUE(drag(moving));
  EXPECT_TRUE(moving.until([&] { return differing(moving.picture(), before, 8) > 1000; }));
  EXPECT_TRUE(eventually([&] { return wall->wall().full_detail == 1; }));
  moving.press('r');
  EXPECT_TRUE(moving.shows(before));
  EXPECT_STREQ(wall->wall().mode, "object");
  moving.press('m');
  EXPECT_TRUE(moving.until([&] { return std::string(wall->wall().mode) == "fly"; }));
}

TEST_F(RfbTest, ACardIsShownWhileMerlindIsAwayAndThenTheWallAgain) {
  auto wall = start("still");
  const Image before = snapshot(*wall);
  Rfb rfb(wall->instance());
  VncClient client(rfb.port());
  ASSERT_TRUE(client.isConnected());
  ASSERT_TRUE(client.shows(before));
  wall->process().kill(SIGKILL);
  const auto shows_card = [&] {
    const Image picture = client.picture();
    return picture.at(0, 0).red == 48 && picture.covered(picture.at(0, 0)) > 1000;
  };
  EXPECT_TRUE(client.until(shows_card));
  Process again({kMerlind, "--config", wall->config(), "--emulate"});
  ASSERT_TRUE(again.saysEventually("ready")) << again.output();
  EXPECT_TRUE(client.shows(before));
  EXPECT_EQ(again.kill(SIGTERM), 0);
  EXPECT_TRUE(client.until(shows_card));
  EXPECT_EQ(rfb.process().kill(SIGTERM), 0);
}

TEST(RfbStart, WithoutAWallShowsACardAndRefusesWhatIsNotSafe) {
  const TempDir dir;
  Rfb rfb(privateName("nobody"), {"--tile", "left"});
  VncClient client(rfb.port());
  ASSERT_TRUE(client.isConnected());
  EXPECT_TRUE(client.until([&] { return client.picture().at(0, 0).red == 48; }));
  EXPECT_TRUE(rfb.process().saysEventually(
      "for now clients see only this message: No merlind shows a wall"));

  const auto refused = [](const Arguments& arguments, int status, const std::string& why) {
    Arguments all = {kRfb};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, status) << outcome.output;
    EXPECT_NE(outcome.output.find(why), std::string::npos) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  };
  const std::string busy = fmt::format("127.0.0.1:{}", rfb.port());
  refused({"--listen", busy}, 3, fmt::format("--listen {}: another program listens there", busy));
  refused({"--listen", "0.0.0.0:0"}, 2, "a password is needed");
  refused({"--listen", "here"}, 2, "--listen here: is not ADDRESS:PORT");
  writeText(dir / "password", "secret");
  ASSERT_EQ(::chmod((dir / "password").c_str(), 0644), 0);
  refused({"--password-file", dir / "password"}, 2, "other users have access to the password");
}

TEST(RfbStart, APasswordIsAskedFor) {
  const TempDir dir;
  writeText(dir / "password", "secret");
  ASSERT_EQ(::chmod((dir / "password").c_str(), 0600), 0);
  Rfb rfb(privateName("locked"), {"--password-file", dir / "password"});
  EXPECT_FALSE(VncClient(rfb.port(), "guess").isConnected());
  EXPECT_FALSE(VncClient(rfb.port(), "").isConnected());
  VncClient client(rfb.port(), "secret");
  ASSERT_TRUE(client.isConnected());
  EXPECT_TRUE(client.refresh());
  EXPECT_TRUE(rfb.process().saysEventually("wrong password")) << rfb.process().output();
  EXPECT_EQ(rfb.process().output().find("secret"), std::string::npos);
}

UniqueFd connectTo(int port) {
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  // With a small buffer the server soon notices a client that does not read.
  const int small = 4096;
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  EXPECT_EQ(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return fd;
}

void sendBytes(const UniqueFd& fd, const std::string& bytes) {
  (void)!::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

// Returns a handshake of RFB 3.8 without a password, then `count` requests for the whole picture.
std::string requests(int count) {
  std::string all = "RFB 003.008\n\x01\x01";
  for (int i = 0; i < count; ++i)
    all += std::string("\x03\x00\x00\x00\x00\x00\x07\x80\x01\xE0", 10);
  return all;
}

// A picture takes 3.7 MB, a frame 4.9 MB, and the library some more. The address sanitizer also
// keeps freed memory.
#if defined(MERLIN_ANY_SANITIZER)
constexpr std::size_t kMostMemory_kb = 1'000'000;
#else
constexpr std::size_t kMostMemory_kb = 50'000;
#endif

// While several clients misbehave in different ways, a well-behaved client sees every change, and
// no process grows.
TEST_F(RfbTest, HostileClientsDisturbNobodyElse) {
  const auto wall = start("visit");
  Rfb rfb(wall->instance(), {"--clients", "6", "--allow-input"});
  VncClient good(rfb.port());
  ASSERT_TRUE(good.isConnected());
  ASSERT_TRUE(good.until([&] { return good.updates() > 5; }));

  std::vector<UniqueFd> hostile;
  const auto join = [&](const std::string& bytes) {
    hostile.push_back(connectTo(rfb.port()));
    sendBytes(hostile.back(), bytes);
  };
  join(requests(1000));  // this client never reads
  ASSERT_TRUE(rfb.process().saysEventually("2 of 6 places are taken"));
  const auto sees = [&](int more) {
    const int before = good.updates();
    const bool seen = good.until([&] { return good.updates() >= before + more; });
    for (const Rfb::Child& child : rfb.children()) EXPECT_LT(child.memory_kb, kMostMemory_kb);
    return seen;
  };
  // Only one frame is awaited: on a busy machine, ten may take longer than the server's patience
  // with the client that never reads.
  const int before = good.updates();
  EXPECT_TRUE(good.until([&] { return good.updates() > before && rfb.children().size() == 2; }))
      << "the other one only went on after it was disconnected";
  EXPECT_TRUE(sees(10)) << "a client that never reads";
  join(std::string(100'000, '\xFF'));
  join("GET / HTTP/1.1\r\n\r\n");
  join("RFB 003.008\n\x01\x01" + std::string(100'000, '\xA5'));
  // These clients announce a clipboard of 4 GiB, a file transfer, and far too many encodings.
  join(requests(0) + std::string("\x06\x00\x00\x00\xFF\xFF\xFF\xFF", 8));
  join(requests(0) + std::string("\x07\x03\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01/", 13));
  join(requests(0) + std::string("\x02\x00\xFF\xFF", 4) + std::string(70'000, '\x01'));
  EXPECT_TRUE(sees(10)) << "garbage";
  for (int i = 0; i < 50; ++i) join(i % 2 == 0 ? "" : "RFB 003.0");
  EXPECT_TRUE(sees(10)) << "half handshakes";
  EXPECT_LE(rfb.children().size(), 6U);

  // By then the client that never reads is disconnected, and all places are free for others.
  const auto left = [&] { return rfb.children().size() == 1; };
  EXPECT_TRUE(good.until(left)) << rfb.process().output();
  hostile.clear();
  VncClient another(rfb.port());
  ASSERT_TRUE(another.isConnected());
  EXPECT_TRUE(another.refresh());
  EXPECT_TRUE(sees(5));
  EXPECT_TRUE(wall->status().is_object());
}

}  // namespace
}  // namespace merlin::test
