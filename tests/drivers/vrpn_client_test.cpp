// A tracker of a VRPN server: its messages, and the driver's dialogue with servers that conform to
// the protocol and with some that do not.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "drivers/vrpn/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"
#include "tests/support/vrpn_messages.h"

namespace merlin::vrpn {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto& message = test::vrpnMessage;
constexpr auto& sender = test::vrpnSender;
constexpr auto& type = test::vrpnType;

// Numbers of senders and message types that the servers of these tests use.
constexpr std::int32_t kOther = 4, kTracker = 7, kPoseNumber = 11, kPongNumber = 12;

std::string pose(std::int32_t sensor, std::array<float, 3> p,
                 std::array<float, 4> wxyz = {1, 0, 0, 0}) {
  return message(kTracker, kPoseNumber, vrpnPose(sensor, p, wxyz));
}
std::string descriptions() {
  return sender(0, kVrpnControl) + sender(kOther, "Wand") + sender(kTracker, "Tracker0") +
         type(kPoseNumber, kVrpnPoseType) + type(kPongNumber, kVrpnPong);
}

std::vector<std::int32_t> typesOf(Parser& parser, std::string_view bytes) {
  std::vector<std::int32_t> types;
  for (const char c : bytes) {
    if (const auto m = parser.feed(static_cast<std::byte>(c))) types.push_back(m->header.type);
  }
  return types;
}

TEST(VrpnParser, EveryPrefixWaitsAndThePaddingBelongsToTheMessage) {
  const std::string bytes = pose(2, {1, 2, 3}) + message(1, 5, "odd") + message(1, 6, "");
  for (std::size_t n = 0; n <= bytes.size(); ++n) {
    Parser parser;
    const std::size_t messages =
        (n >= 88 ? 1U : 0U) + (n >= 88 + 32 ? 1U : 0U) + (n >= 88 + 32 + 24 ? 1U : 0U);
    EXPECT_EQ(typesOf(parser, bytes.substr(0, n)).size(), messages) << n;
    EXPECT_EQ(parser.inside(), n != 0 && n != 88 && n != 120 && n != 144) << n;
  }
}

TEST(VrpnParser, ALongMessageIsPassedOverAndTheNextOneIsRead) {
  Parser parser;
  const std::string longest(Parser::kLongest - kVrpnHeaderLength, 'x');
  EXPECT_EQ(typesOf(parser, message(1, 5, longest) + message(1, 6, "")),
            (std::vector<std::int32_t>{5, 6}));
  EXPECT_FALSE(parser.broken());
  EXPECT_EQ(typesOf(parser, message(1, 5, longest + "x") + message(1, 6, "")).size(), 0u);
  EXPECT_TRUE(parser.broken());
}

TEST(VrpnParser, ALengthThatNoMessageHasEndsTheReading) {
  for (const char* length : {"\0\0\0\x17", "\xFF\xFF\xFF\xFF", "\x7F\xFF\xFF\xFF", "\0\0\0\0"}) {
    Parser parser;
    std::string bytes = message(1, 5, "");
    bytes.replace(0, 4, std::string(length, 4));
    EXPECT_TRUE(typesOf(parser, bytes + message(1, 6, "")).empty());
    EXPECT_TRUE(parser.broken());
    parser.reset();
    EXPECT_EQ(typesOf(parser, message(1, 6, "")).size(), 1u);
  }
}

class VrpnTest : public testing::Test {
 protected:
  void connect(const VrpnSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    stream_.feed(vrpnCookie() + descriptions());
    stream_.feed(pose(settings.stations[0], {1, 2, 3}));
    const auto identity = device_->open(stream_);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, "VRPN tracker Tracker0 at server version 07.38");
    ASSERT_EQ(sink_.tracker.size(), 1u);
  }
  // Returns the number of samples that the driver makes of these bytes.
  std::size_t samplesOf(const std::string& bytes) {
    const std::size_t before = sink_.tracker.size();
    stream_.feed(bytes);
    const auto polled = device_->poll(stream_);
    EXPECT_TRUE(polled) << polled.error().what;
    return sink_.tracker.size() - before;
  }
  std::string openFails(const std::string& server, Errc code, VrpnSettings settings = {}) {
    device_.emplace(std::move(settings), clock_, sink_);
    stream_.feed(server);
    const auto opened = device_->open(stream_);
    EXPECT_FALSE(opened);
    if (opened) return {};
    EXPECT_EQ(opened.error().code, code);
    return opened.error().what;
  }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<VrpnDevice> device_;
};

TEST_F(VrpnTest, IntroducesItselfAndPublishesTheDevicesPoses) {
  connect();
  EXPECT_EQ(stream_.written().substr(0, kVrpnCookieLength), vrpnCookie());
  Parser parser;
  EXPECT_EQ(typesOf(parser, stream_.written().substr(kVrpnCookieLength)),
            (std::vector<std::int32_t>{kVrpnDescribeSender, kVrpnDescribeSender, kVrpnDescribeType,
                                       kVrpnDescribeType, kVrpnDescribeType, 0}))
      << "and a ping";
  clock_.advance(milliseconds(40));
  EXPECT_EQ(samplesOf(pose(2, {0.5F, -1, 2}, {0.5F, 0.5F, 0.5F, -0.5F})), 1u);
  const TrackerSample& s = sink_.tracker.back();
  EXPECT_EQ(s.station, 3u);
  EXPECT_EQ(s.counter, 1u);
  EXPECT_EQ(s.error, ' ');
  EXPECT_EQ(s.stylus, 0);
  EXPECT_EQ(s.received_ns, toNanoseconds(clock_.now()));
  EXPECT_FLOAT_EQ(s.position_m[0], 0.5F);
  EXPECT_FLOAT_EQ(s.position_m[1], -1);
  EXPECT_FLOAT_EQ(s.orientation_wxyz[0], 0.5F);
  EXPECT_FLOAT_EQ(s.orientation_wxyz[3], -0.5F);
  EXPECT_EQ(samplesOf(pose(0, {1, 1, 1})), 1u);
  EXPECT_EQ(sink_.tracker.back().counter, 2u) << "each station counts its own";
  EXPECT_EQ(device_->counters().samples, 3u);
  EXPECT_EQ(device_->counters().bad_packets, 0u);
}

TEST_F(VrpnTest, ASampleIsAsOldAsItsFirstByte) {
  connect();
  const std::string bytes = pose(0, {1, 2, 3});
  EXPECT_EQ(samplesOf(bytes.substr(0, 1)), 0u);
  const Timestamp first = clock_.now();
  clock_.advance(milliseconds(30));
  EXPECT_EQ(samplesOf(bytes.substr(1)), 1u);
  EXPECT_EQ(sink_.tracker.back().received_ns, toNanoseconds(first));
}

TEST_F(VrpnTest, SensorsAreTheStationsThatTheConfigurationSaysInItsUnit) {
  VrpnSettings settings;
  settings.stations = {5, -1, 0, 9};
  settings.scale = 0.001;
  connect(settings);
  EXPECT_FLOAT_EQ(sink_.tracker[0].position_m[2], 0.003F);
  EXPECT_EQ(sink_.tracker[0].station, 1u);
  EXPECT_EQ(samplesOf(pose(0, {1500, 0, 0}) + pose(1, {0, 0, 0}) + pose(9, {0, 0, 0})), 2u);
  EXPECT_EQ(sink_.tracker[1].station, 3u);
  EXPECT_FLOAT_EQ(sink_.tracker[1].position_m[0], 1.5F);
  EXPECT_EQ(sink_.tracker[2].station, 4u);
  EXPECT_EQ(device_->counters().bad_packets, 0u) << "a server may have more sensors";
  EXPECT_EQ(samplesOf(pose(-1, {0, 0, 0})), 0u) << "is no sensor";
  EXPECT_EQ(device_->counters().bad_packets, 1u);
}

TEST_F(VrpnTest, APoseThatNoTrackerMeasuresIsDroppedAndCounted) {
  connect();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(samplesOf(pose(0, {nan, 0, 0}) + pose(0, {0, infinite, 0}) + pose(0, {0, 0, 25.1F}) +
                      pose(0, {0, 0, 0}, {nan, 0, 0, 0}) + pose(0, {0, 0, 0}, {0, 0, 0, 0}) +
                      pose(0, {0, 0, 0}, {1, 0.5F, 0, 0})),
            0u);
  EXPECT_EQ(device_->counters().bad_packets, 6u);
  EXPECT_EQ(samplesOf(message(kTracker, kPoseNumber, std::string(56, '\0')) +
                      message(kTracker, kPoseNumber, std::string(300, '\0'))),
            0u);
  EXPECT_EQ(device_->counters().bad_packets, 8u);
  EXPECT_EQ(samplesOf(pose(0, {0, 0, 24.9F}, {0, 1.01F, 0, 0})), 1u);
  EXPECT_FLOAT_EQ(sink_.tracker.back().orientation_wxyz[1], 1) << "normalised";
}

TEST_F(VrpnTest, APoseThatIsPlacedBeyondTheTrackersReachIsDroppedAndSaid) {
  VrpnSettings settings;
  settings.placement.origin_m = {0, 0, -20};
  connect(settings);
  clock_.advance(milliseconds(2500));
  EXPECT_EQ(samplesOf(pose(0, {0, 0, -6})), 0u);
  EXPECT_EQ(device_->counters().bad_packets, 1u);
  EXPECT_STREQ(device_->complaint(),
               "poses lie beyond 25 m with \"origin_m\" added: is \"origin_m\" right?");
}

TEST_F(VrpnTest, OnlyWhatTheServerCallsOurDevicesPosesIsTaken) {
  connect();
  const std::string payload =
      vrpnPose(0, std::array{1.0F, 2.0F, 3.0F}, std::array{1.F, 0.F, 0.F, 0.F});
  EXPECT_EQ(samplesOf(message(kOther, kPoseNumber, payload) + message(99, kPoseNumber, payload) +
                      message(kTracker, 99, payload) + message(kTracker, -77, payload)),
            0u);
  // A sender number that now has another name, or an unreadable one, no longer belongs to the
  // driver's device.
  EXPECT_EQ(samplesOf(sender(kTracker, "Wand") + pose(0, {1, 2, 3})), 0u);
  EXPECT_EQ(samplesOf(sender(kOther, "Tracker0") + message(kOther, kPoseNumber, payload)), 1u);
  EXPECT_EQ(
      samplesOf(type(kPoseNumber, "vrpn_Tracker Velocity") + message(kOther, kPoseNumber, payload)),
      0u);
  EXPECT_EQ(samplesOf(type(3, kVrpnPoseType) + message(kOther, 3, payload)), 1u);
  EXPECT_EQ(samplesOf(message(kOther, kVrpnDescribeSender, std::string("\0\0\0\x63x", 5)) +
                      message(kOther, 3, payload)),
            0u)
      << "99 characters are announced, and one comes";
  EXPECT_EQ(device_->counters().bad_packets, 1u);
  EXPECT_EQ(samplesOf(message(3, kVrpnDescribeType, std::string("\xFF\xFF\xFF\xFFx", 5))), 0u);
  EXPECT_EQ(device_->counters().bad_packets, 2u);
}

TEST_F(VrpnTest, AServerThatAnswersButSendsNoPoseIsAComplaintAndNoFault) {
  connect();
  EXPECT_STREQ(device_->complaint(), "");
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(samplesOf(message(kTracker, kPongNumber, "")), 0u);
    clock_.advance(milliseconds(500));
  }
  EXPECT_STREQ(device_->complaint(), "the server has the device, but no pose of it comes");
  EXPECT_EQ(samplesOf(pose(8, {0, 0, 0})), 0u);
  EXPECT_STREQ(device_->complaint(),
               "poses come only from sensors that \"stations\" does not name");
  EXPECT_EQ(samplesOf(pose(1, {0, 1200, 0})), 0u);
  EXPECT_STREQ(device_->complaint(), "poses come from beyond 25 m: is \"scale\" right?");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string& none : {pose(1, {nan, 0, 0}), pose(1, {0, 0, 0}, {1, nan, 0, 0})}) {
    EXPECT_EQ(samplesOf(pose(1, {0, 1200, 0}) + none), 0u);
    EXPECT_STREQ(device_->complaint(), "poses come with values that are not numbers");
  }
  EXPECT_EQ(samplesOf(pose(1, {0, 0, 0})), 1u);
  EXPECT_STREQ(device_->complaint(), "");
}

TEST_F(VrpnTest, ADeviceThatLeavesItsServerIsSaid) {
  connect();
  EXPECT_EQ(samplesOf(sender(kTracker, "Wand")), 0u);
  EXPECT_STREQ(device_->complaint(), "the server no longer has the device");
  EXPECT_EQ(samplesOf(sender(kTracker, "Tracker0") + pose(0, {1, 2, 3})), 1u);
  EXPECT_STREQ(device_->complaint(), "");
}

TEST_F(VrpnTest, PingsEachSecondAndGivesUpAfterThreeSecondsWithoutAByte) {
  connect();
  const Timestamp opened = clock_.now();
  const std::size_t introduced = stream_.written().size();
  Result<Ok> polled = Ok{};
  while (polled) polled = device_->poll(stream_);
  EXPECT_EQ(polled.error().code, Errc::kTimeout);
  EXPECT_EQ(polled.error().what, "the server has sent nothing for 3.0 s");
  EXPECT_EQ(clock_.now() - opened, seconds(3));
  const std::string pings = stream_.written().substr(introduced);
  ASSERT_EQ(pings.size(), 48u) << "after one second and after two";
  EXPECT_EQ(readVrpnStart(pings).header.sender, 1) << "our number of the device";
  EXPECT_EQ(readVrpnStart(pings).header.sequence + 1,
            readVrpnStart(pings.substr(24)).header.sequence);
}

TEST_F(VrpnTest, AServerThatBreaksOffOrSpeaksNonsenseIsLeft) {
  connect();
  stream_.feed(message(0, kVrpnDisconnect, ""));
  EXPECT_EQ(device_->poll(stream_).error().code, Errc::kClosed);
  sink_.tracker.clear();
  connect();
  stream_.feed(std::string(24, '\xFF'));
  const auto polled = device_->poll(stream_);
  ASSERT_FALSE(polled);
  EXPECT_EQ(polled.error().code, Errc::kMalformed);
  EXPECT_EQ(device_->counters().bad_packets, 1u);
}

TEST_F(VrpnTest, WhoDoesNotSpeakVrpn7IsRefused) {
  EXPECT_EQ(openFails("HTTP/1.1 400 Bad Request", Errc::kMalformed),
            "the greeting \"HTTP/1.1 400 Bad Request\" is not that of a server of VRPN 7");
  std::string old = vrpnCookie();
  old[12] = '6';
  EXPECT_NE(openFails(old, Errc::kMalformed).find("VRPN 7"), std::string::npos);
  EXPECT_EQ(openFails("", Errc::kTimeout), "no answer to VRPN's greeting within 2.0 s");
}

TEST_F(VrpnTest, ADeviceThatTheServerLacksIsNamedWithThoseThatItHas) {
  VrpnSettings settings;
  settings.device = "Traker0";
  const Timestamp began = clock_.now();
  EXPECT_EQ(
      openFails(vrpnCookie() + descriptions() + pose(0, {1, 2, 3}), Errc::kMalformed, settings),
      "the server has no \"Traker0\"; it has \"Wand\", \"Tracker0\"");
  EXPECT_EQ(clock_.now() - began, seconds(2)) << "a server may be slow to describe its devices";
  EXPECT_EQ(openFails(vrpnCookie(), Errc::kMalformed),
            "the server has no \"Tracker0\"; it has no device");
  std::string many = vrpnCookie();
  for (int i = 0; i < 1000; ++i) many += sender(i, "\x1B[31m" + std::to_string(i));
  const std::string what = openFails(many, Errc::kMalformed);
  EXPECT_NE(what.find("\"\\x1B[31m7\" ..."), std::string::npos) << what;
  EXPECT_EQ(what.find("[31m8"), std::string::npos);
}

TEST_F(VrpnTest, ADeviceWithoutPosesIsNotOpened) {
  EXPECT_EQ(openFails(vrpnCookie() + descriptions(), Errc::kTimeout),
            "\"Tracker0\": the server has the device, but no pose of it comes");
  EXPECT_EQ(openFails(vrpnCookie() + descriptions() + pose(8, {0, 0, 0}), Errc::kTimeout),
            "\"Tracker0\": poses come only from sensors that \"stations\" does not name");
  EXPECT_TRUE(sink_.tracker.empty());
}

TEST_F(VrpnTest, ReconnectedItForgetsTheServersNumbers) {
  connect();
  stream_.feed(vrpnCookie() + pose(0, {1, 2, 3}));
  EXPECT_FALSE(device_->open(stream_));
  stream_.feed(
      vrpnCookie() + sender(1, "Tracker0") + type(1, kVrpnPoseType) +
      message(1, 1, vrpnPose(0, std::array{1.F, 2.F, 3.F}, std::array{1.F, 0.F, 0.F, 0.F})));
  EXPECT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.tracker.back().counter, 2u) << "the counter goes on";
}

// Every byte of a stream is damaged in turn. No sample may be implausible, and the driver may end
// only by refusing the server.
TEST_F(VrpnTest, OneDamagedByteHarmsNothingElse) {
  const std::string good =
      descriptions() + pose(0, {1, 2, 3}) + pose(1, {1, 2, 3}) + pose(0, {1, 2, 3});
  for (std::size_t i = 0; i < good.size(); ++i) {
    connect();
    sink_.tracker.clear();
    std::string bytes = good;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x80);
    stream_.feed(bytes);
    Result<Ok> polled = Ok{};
    while (polled) polled = device_->poll(stream_);
    EXPECT_TRUE(polled.error().code == Errc::kTimeout || polled.error().code == Errc::kMalformed);
    EXPECT_LE(sink_.tracker.size(), 3u);
    for (const TrackerSample& s : sink_.tracker) {
      EXPECT_LE(std::abs(s.position_m[0]), 25) << i;
      EXPECT_NEAR(std::hypot(std::hypot(s.orientation_wxyz[0], s.orientation_wxyz[1]),
                             std::hypot(s.orientation_wxyz[2], s.orientation_wxyz[3])),
                  1, 1e-5)
          << i;
    }
    sink_.tracker.clear();
  }
}

TEST_F(VrpnTest, PollAllocatesNothing) {
  connect();
  sink_.tracker.reserve(10'000);
  const std::string bytes = descriptions() + pose(0, {1, 2, 3}) +
                            message(kOther, 5, std::string(3000, 'x')) + pose(8, {1, 2, 3}) +
                            pose(0, {99, 0, 0});
  std::string all;
  for (int i = 0; i < 20; ++i) all += bytes;
  stream_.feed(all);
  const std::size_t written = stream_.written().size();
  const long before = test::allocations;
  for (int i = 0; i < 70; ++i) {
    ASSERT_TRUE(device_->poll(stream_));
    clock_.advance(milliseconds(1));
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_EQ(sink_.tracker.size(), 21u);
  EXPECT_EQ(stream_.written().size(), written);
}

TEST(VrpnSettings, NamesStationsAndPortsThatCannotBe) {
  const auto faults = [](const VrpnSettings& settings, const char* port,
                         const char* driver = "vrpn") {
    std::string text;
    for (const SettingFault& f : validate(settings, {driver, port}))
      text += f.pointer + " " + f.what + "\n";
    return text;
  };
  VrpnSettings s;
  EXPECT_EQ(
      faults(s, "tcp://lab:3883") + faults(s, "") + faults(s, "replay:x") + faults(s, "pty:x"), "");
  EXPECT_EQ(faults(s, "serial:/dev/ttyS0", "fastrak"), "");
  EXPECT_EQ(
      faults(s, "serial:/dev/ttyS0"),
      "/port is \"serial:/dev/ttyS0\", at which no VRPN server can be; the driver \"vrpn\" needs "
      "tcp://HOST:PORT, usually port 3883\n");
  s.device = "Tracker0@lab";
  EXPECT_EQ(
      faults(s, "tcp://lab:3883"),
      "/vrpn/device is \"Tracker0@lab\"; needed is the name alone, \"Tracker0\": the host belongs "
      "in the port, tcp://HOST:3883\n");
  s.device = "";
  EXPECT_EQ(faults(s, ""), "/vrpn/device has 0 characters; allowed are 1 to 99\n");
  s.device = "x";
  s.stations = {-1, 4, -1, -1};
  EXPECT_EQ(faults(s, ""), "");
  s.stations = {0, 1, 2, 1};
  EXPECT_NE(faults(s, "").find("/vrpn/stations is 0, 1, 2, 1; needed is"), std::string::npos);
  s.stations = {-1, -1, -1, -1};
  EXPECT_NE(faults(s, "").find("/vrpn/stations is -1, -1"), std::string::npos);
}

}  // namespace
}  // namespace merlin::vrpn
