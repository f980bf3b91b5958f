// The catalogue of a VRPN server's devices, made from its messages: a recording of VRPN's own
// server, and servers that lie.
#include <chrono>

#include <gtest/gtest.h>

#include "drivers/io/transcript.h"
#include "drivers/vrpn/ask_server.h"
#include "drivers/vrpn/catalog.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/vrpn_messages.h"

namespace merlin::vrpn {
namespace {

using std::chrono::milliseconds;

constexpr auto& message = test::vrpnMessage;
constexpr auto& sender = test::vrpnSender;
constexpr auto& type = test::vrpnType;

// Numbers of message types that the servers of these tests use.
constexpr std::int32_t kPose = 4, kButton = 5, kStates = 6, kChannels = 7, kPong = 8;

std::string types() {
  return type(kPose, kVrpnPoseType) + type(kButton, kVrpnButtonType) +
         type(kStates, kVrpnButtonsType) + type(kChannels, kVrpnChannelsType) +
         type(kPong, kVrpnPong);
}

// Returns the catalogue of a server that sends these bytes after its greeting.
Catalog catalogOf(const std::string& bytes) {
  Catalog catalog;
  EXPECT_TRUE(catalog.take(vrpnCookie() + bytes));
  return catalog;
}

// Returns all devices with the kinds of their messages, as "Wand0 tracker buttons, Dial analog".
std::string textOf(const Catalog& catalog) {
  std::string text;
  for (const CatalogDevice& device : catalog.devices()) {
    text += (text.empty() ? "" : ", ") + device.name + (device.sent.poses ? " tracker" : "") +
            (device.sent.buttons ? " buttons" : "") + (device.sent.channels ? " analog" : "");
  }
  return text;
}

TEST(VrpnCatalog, VrpnsOwnServerHasTwoTrackers) {
  const auto recorded =
      io::readTranscript(MERLIN_SOURCE_DIR "/tests/transcripts/vrpn/vrpn_server-07.38.bytes");
  ASSERT_TRUE(recorded) << recorded.error().what;
  Catalog catalog;
  for (const auto& chunk : recorded->chunks) {
    if (chunk.to_device) continue;
    ASSERT_TRUE(catalog.take(chunk.bytes));
  }
  EXPECT_EQ(textOf(catalog), "Tracker0 tracker, Wand tracker");
  EXPECT_EQ(catalog.version(), "07.38");
  EXPECT_EQ(catalog.leftOut(), 0u) << "VRPN's own senders are no devices";
  EXPECT_TRUE(catalog.described().poses);
  EXPECT_FALSE(catalog.described().buttons || catalog.described().channels);
  EXPECT_EQ(catalog.instance(), "");
}

TEST(VrpnCatalog, WhatADeviceIsShowsByWhatItSends) {
  const std::string described =
      sender(0, kVrpnControl) + sender(1, "Wand0") + sender(2, "Box") + sender(3, "Dial") + types();
  EXPECT_EQ(textOf(catalogOf(described)), "Wand0, Box, Dial") << "nothing was sent";
  const Catalog catalog =
      catalogOf(described + message(1, kPose, "x") + message(1, kButton, "x") +
                message(2, kStates, "x") + message(3, kChannels, "x") + message(2, kPong, "") +
                message(9, kPose, "x") + message(0, kPose, "x") + message(3, 99, "x"));
  EXPECT_EQ(textOf(catalog), "Wand0 tracker buttons, Box buttons, Dial analog");
  EXPECT_TRUE(catalog.described().poses && catalog.described().buttons &&
              catalog.described().channels);
}

TEST(VrpnCatalog, BytesMayComeInAnyPieces) {
  const std::string bytes = vrpnCookie() + sender(1, "Wand0") + types() + message(1, kPose, "odd") +
                            message(1, kButton, "x");
  for (std::size_t n = 0; n <= bytes.size(); ++n) {
    Catalog catalog;
    ASSERT_TRUE(catalog.take(bytes.substr(0, n)));
    EXPECT_EQ(catalog.greeted(), n >= kVrpnCookieLength) << n;
    EXPECT_EQ(catalog.version(), n >= kVrpnCookieLength ? "07.38" : "") << n;
    ASSERT_TRUE(catalog.take(bytes.substr(n)));
    EXPECT_EQ(textOf(catalog), "Wand0 tracker buttons") << n;
  }
}

TEST(VrpnCatalog, NamesThatNoConfigurationCanHaveAreCountedOnly) {
  const Catalog catalog =
      catalogOf(sender(1, "") + sender(2, "Wand@lab") + sender(3, "\x1B[31mred") +
                sender(4, "two\nlines") + sender(5, std::string(100, 'x')) + sender(6, "\xFF\xFE") +
                sender(7, std::string(99, 'y')) + message(8, kVrpnDescribeSender, "short") +
                sender(9, "say \"hi\" \\") + sender(10, "\xC2\x9Bm"));
  ASSERT_EQ(catalog.devices().size(), 2u);
  EXPECT_EQ(catalog.devices()[0].name, std::string(99, 'y'));
  EXPECT_EQ(catalog.devices()[1].name, "say \"hi\" \\");
  EXPECT_EQ(catalog.leftOut(), 8u);
}

TEST(VrpnCatalog, ANumberThatGetsAnotherNameIsAnotherDevices) {
  EXPECT_EQ(textOf(catalogOf(types() + sender(1, "A") + sender(1, "B") + message(1, kPose, "x"))),
            "A, B tracker");
  EXPECT_EQ(textOf(catalogOf(types() + sender(1, "A") + sender(1, "x@y") + message(1, kPose, "x"))),
            "A");
  EXPECT_EQ(textOf(catalogOf(types() + sender(1, "A") + sender(2, "A") + message(2, kPose, "x"))),
            "A tracker");
  EXPECT_EQ(
      textOf(catalogOf(types() + sender(1, "A") + type(kPose, "other") + message(1, kPose, "x") +
                       type(3, kVrpnChannelsType) + message(1, 3, "x"))),
      "A analog");
}

TEST(VrpnCatalog, AServerThatDescribesWithoutEndFillsNoMemory) {
  std::string bytes = vrpnCookie();
  for (int i = 0; i < 5000; ++i)
    bytes += sender(i, "device" + std::to_string(i)) + type(i, kVrpnPoseType);
  for (int i = 0; i < 5000; ++i) bytes += sender(9000 + i, "device0");
  Catalog catalog;
  ASSERT_TRUE(catalog.take(bytes));
  EXPECT_EQ(catalog.devices().size(), Catalog::kMostDevices);
  EXPECT_EQ(catalog.leftOut(), 10'000 - Catalog::kMostDevices);
  ASSERT_TRUE(catalog.take(message(3, 63, "") + message(4, 64, "")));
  EXPECT_TRUE(catalog.devices()[3].sent.poses);
  EXPECT_FALSE(catalog.devices()[4].sent.poses) << "a server has 64 numbers for a type";
}

TEST(VrpnCatalog, NorDoesOneThatGivesOneNumberEveryName) {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += sender(1, "device" + std::to_string(i));
  const Catalog catalog = catalogOf(bytes);
  EXPECT_EQ(catalog.devices().size(), Catalog::kMostDevices);
  EXPECT_EQ(catalog.leftOut(), 5000 - Catalog::kMostDevices);
}

TEST(VrpnCatalog, AServerOfMerlinSaysWhoseItIs) {
  EXPECT_EQ(catalogOf(type(9, "MERLIN instance lab-2") + sender(1, "Ball0")).instance(), "lab-2");
}

TEST(VrpnCatalog, WhatWasUnderstoodStaysWhenTheServerTurnsToNonsense) {
  const std::string good = vrpnCookie() + sender(1, "Wand0");
  Catalog broken, left, foreign;
  EXPECT_EQ(broken.take(good + std::string(24, '\xFF')).error().code, Errc::kMalformed);
  EXPECT_EQ(textOf(broken), "Wand0");
  EXPECT_EQ(left.take(good + message(0, kVrpnDisconnect, "")).error().code, Errc::kClosed);
  EXPECT_EQ(textOf(left), "Wand0");
  const auto refused = foreign.take("HTTP/1.1 400 Bad Request\r\n");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            "the greeting \"HTTP/1.1 400 Bad Request\" is not that of a server of VRPN 7");
}

// Damage may turn the description of a type into that of a sender, hence one more device.
TEST(VrpnCatalog, OneDamagedByteAddsNoMoreThanADevice) {
  const std::string good = vrpnCookie() + sender(1, "Wand0") + types() + message(1, kPose, "x");
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char flip : {'\x80', '\x01', '\x20'}) {
      std::string bytes = good;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      Catalog catalog;
      (void)catalog.take(bytes);
      EXPECT_LE(catalog.devices().size(), 2u) << i;
    }
  }
}

class AskServer : public testing::Test {
 protected:
  Result<Ok> ask(const std::string& bytes) {
    stream_.feed(bytes);
    return askServer(stream_, clock_, clock_.now() + milliseconds(400), catalog_);
  }

  test::FakeClock clock_;
  test::FakeStream stream_{clock_, nullptr};
  Catalog catalog_;
};

TEST_F(AskServer, GreetsAndListensUntilTheTimeIsOver) {
  const Timestamp began = clock_.now();
  ASSERT_TRUE(ask(vrpnCookie() + sender(1, "Wand0") + types() + message(1, kButton, "x")));
  EXPECT_EQ(textOf(catalog_), "Wand0 buttons");
  EXPECT_EQ(clock_.now() - began, milliseconds(400)) << "a device may say more";
  EXPECT_EQ(stream_.written(), vrpnCookie() + sender(0, kVrpnControl));
}

TEST_F(AskServer, WhoDoesNotGreetIsNoServer) {
  const auto silent = ask("");
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, Errc::kTimeout);
  EXPECT_EQ(ask(vrpnCookie().substr(0, 23)).error().code, Errc::kTimeout);
}

TEST_F(AskServer, AConnectionThatEndsIsSaidAndWhatCameStays) {
  EXPECT_EQ(ask(vrpnCookie() + sender(1, "Wand0") + message(0, kVrpnDisconnect, "")).error().code,
            Errc::kClosed);
  EXPECT_EQ(textOf(catalog_), "Wand0");
  stream_.close();
  EXPECT_EQ(ask("").error().code, Errc::kClosed);
}

TEST_F(AskServer, AServerThatNeverStopsIsLeftAfterAMebibyte) {
  const Timestamp began = clock_.now();
  std::string flood = vrpnCookie() + sender(1, "Wand0") + types();
  while (flood.size() < 3 << 20) flood += message(1, kChannels, std::string(1000, 'x'));
  ASSERT_TRUE(ask(flood));
  EXPECT_EQ(clock_.now(), began);
  std::vector<std::byte> rest(flood.size());
  const auto left = stream_.read(rest, milliseconds(0));
  ASSERT_TRUE(left);
  EXPECT_GT(*left, std::size_t{3 << 19});
}

}  // namespace
}  // namespace merlin::vrpn
