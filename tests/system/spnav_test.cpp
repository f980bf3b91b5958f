// Our space-mouse socket against Debian's libspnav, the real one; and its protocol by the byte.
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>
#include <spnav.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "daemon/serve/spnav_server.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::serve {
namespace {

BallSample pushed(std::array<std::int16_t, 6> raw, std::uint32_t buttons = 0) {
  BallSample s{};
  std::copy(raw.begin(), raw.end(), s.raw);
  s.buttons = buttons;
  s.period_us = 50'000;
  return s;
}

std::string bytesOf(const std::string& text) {  // hex, blanks ignored
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    bytes.push_back(static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16)));
    i += 2;
  }
  return bytes;
}

std::string feed(SpnavClient& client, const std::string& bytes) {
  std::string out;
  client.receive(std::as_bytes(std::span(bytes)), out);
  return out;
}

TEST(SpnavProtocol, AMotionIsEightWords) {
  SpnavClient client({});
  std::string out;
  client.sample(pushed({256, -512, 1000, -1, 39, -10}), true, out);
  EXPECT_EQ(out,
            bytesOf("00000000 00010000 00FEFFFF E8030000 FFFFFFFF 27000000 F6FFFFFF 32000000"));
}

TEST(SpnavProtocol, VersionOneIsEchoedAndAnswersRequests) {
  SpnavClient client({});
  EXPECT_EQ(feed(client, bytesOf("0155AA7F")), bytesOf("0155AA7F"));
  EXPECT_EQ(client.version(), 1);
  const std::string axes = bytesOf("0220AA7F") + std::string(28, '\0');
  std::string answer = bytesOf("0220AA7F 06000000") + std::string(24, '\0');
  EXPECT_EQ(feed(client, axes), answer);
  std::string in_parts;
  for (const char c : axes) in_parts += feed(client, std::string(1, c));
  EXPECT_EQ(in_parts, answer);
  // a request that is not served is answered -1; setting a name is not answered
  EXPECT_EQ(feed(client, bytesOf("0030AA7F") + std::string(28, '\0')),
            bytesOf("0030AA7F") + std::string(24, '\0') + bytesOf("FFFFFFFF"));
  EXPECT_EQ(feed(client, bytesOf("0010AA7F") + std::string(28, 'x')), "");
}

TEST(SpnavProtocol, ALongNameComesInPieces) {
  SpnavDevice device;
  device.name = std::string(25, 'n');
  SpnavClient client(device);
  feed(client, bytesOf("0155AA7F"));
  const std::string out = feed(client, bytesOf("0020AA7F") + std::string(28, '\0'));
  ASSERT_EQ(out.size(), 64u);
  EXPECT_EQ(out.substr(28, 4), bytesOf("19000000"));
  EXPECT_EQ(out.substr(60, 4), bytesOf("01000100"));
}

TEST(SpnavProtocol, ARestIsToldOnceAndASlowClientLosesNoButton) {
  SpnavClient client({});
  std::string out;
  client.sample(pushed({}), true, out);
  EXPECT_EQ(out, "");
  client.sample(pushed({1, 0, 0, 0, 0, 0}, 1), false, out);
  EXPECT_EQ(out.size(), 32u);  // the press
  client.sample(pushed({1, 0, 0, 0, 0, 0}, 1), true, out);
  client.sample(pushed({}, 1), true, out);
  client.sample(pushed({}, 1), true, out);
  EXPECT_EQ(out.size(), 96u);
}

TEST(SpnavProtocol, RandomBytesAreSurvived) {
  SpnavClient client({});
  std::string out;
  std::uint64_t state = 1;
  for (int i = 0; i < 200'000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const std::byte b = static_cast<std::byte>(state >> 56);
    client.receive(std::span(&b, 1), out);
    out.clear();
  }
}

struct Served : testing::Test {
  Served() : segment(std::make_unique<shm::DevicesSegment>()) {
    DeviceHealth health{};
    health.state = HealthState::kOk;
    segment->health[shm::kBall].publish(health);
    auto started = SpnavServer::start(path, {}, *segment);
    EXPECT_TRUE(started) << started.error().what;
    if (started) server = *std::move(started);
    ::setenv("SPNAV_SOCKET", path.c_str(), 1);
  }
  test::TempDir dir;
  std::string path = dir / "spnav.sock";
  std::unique_ptr<shm::DevicesSegment> segment;
  std::unique_ptr<SpnavServer> server;
};

TEST_F(Served, LibspnavSeesTheBall) {
  ASSERT_NE(::spnav_open(), -1);
  EXPECT_EQ(::spnav_protocol(), 1);
  EXPECT_EQ(::spnav_dev_axes(), 6);
  EXPECT_EQ(::spnav_dev_buttons(), 12);
  char name[64] = "";
  ::spnav_dev_name(name, sizeof name);
  EXPECT_STREQ(name, "MERLIN ball");
  EXPECT_EQ(::spnav_dev_type(), 0x101);
  EXPECT_EQ(::spnav_client_name("test"), 0);

  segment->ball.publish(pushed({256, -512, 1000, -1, 39, -10}));
  spnav_event event{};
  const auto next = [&](int type) {
    return test::eventually([&] { return ::spnav_poll_event(&event) == type; });
  };
  ASSERT_TRUE(next(SPNAV_EVENT_MOTION));
  EXPECT_EQ(event.motion.x, 256);
  EXPECT_EQ(event.motion.y, -512);
  EXPECT_EQ(event.motion.z, 1000);
  EXPECT_EQ(event.motion.rx, -1);
  EXPECT_EQ(event.motion.ry, 39);
  EXPECT_EQ(event.motion.rz, -10);
  EXPECT_EQ(event.motion.period, 50u);

  segment->ball.publish(pushed({}, 0x100));
  ASSERT_TRUE(next(SPNAV_EVENT_BUTTON));
  EXPECT_EQ(event.button.bnum, 8);
  EXPECT_EQ(event.button.press, 1);
  segment->ball.publish(pushed({}, 0));
  ASSERT_TRUE(next(SPNAV_EVENT_BUTTON));
  EXPECT_EQ(event.button.press, 0);
  EXPECT_EQ(::spnav_sensitivity(2.0), 0);
  EXPECT_EQ(::spnav_close(), 0);
}

TEST_F(Served, ASecondServerIsRefusedAndADeadOnesSocketIsReplaced) {
  const auto second = SpnavServer::start(path, {}, *segment);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
  server.reset();
  EXPECT_NE(::access(path.c_str(), F_OK), 0) << "gone with its server";
  test::writeText(path, "");  // what a killed one leaves behind answers nobody
  EXPECT_TRUE(SpnavServer::start(path, {}, *segment));
}

}  // namespace
}  // namespace merlin::serve
