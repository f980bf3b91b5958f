// A tracker whose poses arrive as OSC messages: forms of addresses and arguments, the opening of
// the port, faults.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "drivers/osc/device.h"
#include "drivers/port/plausible.h"
#include "tests/support/count_allocations.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/osc_packets.h"
#include "tests/support/recording_sink.h"

namespace merlin::osc {
namespace {

using std::chrono::milliseconds;
using test::datagram;
using test::oscBundle;
using test::oscMessage;
using test::OscValue;

const std::vector<OscValue> kAtRest = {0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F};

class OscTest : public testing::Test {
 protected:
  void connect(const OscSettings& settings, const std::string& packet) {
    device_.emplace(settings, clock_, sink_);
    stream_.feed(datagram(packet));
    const auto identity = device_->open(stream_);
    ASSERT_TRUE(identity) << identity.error().what;
    identity_ = *identity;
  }
  void feed(const std::string& packet) {
    stream_.feed(datagram(packet));
    ASSERT_TRUE(device_->poll(stream_));
  }
  Error refused(const OscSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    const Timestamp began = clock_.now();
    const auto opened = device_->open(stream_);
    EXPECT_FALSE(opened);
    EXPECT_LE(clock_.now() - began, milliseconds(2000));
    return opened ? Error{} : opened.error();
  }
  const TrackerSample& newest() const { return sink_.tracker.back(); }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<OscDevice> device_;
  std::string identity_;
};

TEST_F(OscTest, APoseIsTheSampleOfItsStation) {
  OscSettings settings;
  settings.stations = {"", "wand"};
  settings.scale = 0.001;
  connect(settings,
          oscMessage("/tracker/wand/pose", {1000.0F, -500, 250.0, 0.0F, 0.6F, 0.0F, 0.8F}));
  EXPECT_EQ(identity_, "OSC tracker, /tracker/wand/pose");
  ASSERT_EQ(sink_.tracker.size(), 1u);
  EXPECT_EQ(newest().station, 2u);
  EXPECT_EQ(newest().counter, 1u);
  EXPECT_FLOAT_EQ(newest().position_m[0], 1);
  EXPECT_FLOAT_EQ(newest().position_m[1], -0.5F);
  EXPECT_FLOAT_EQ(newest().position_m[2], 0.25F);
  const float wxyz[] = {0.8F, 0, 0.6F, 0};
  for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(newest().orientation_wxyz[i], wxyz[i]) << i;
  EXPECT_EQ(newest().error, ' ');
  EXPECT_STREQ(device_->complaint(), "");
}

TEST_F(OscTest, TheSendersFrameMayLieOtherwise) {
  OscSettings settings;
  settings.placement = {{3, -1, -2}, {0.5, 0, 0}};
  connect(settings, oscMessage("/tracker/1/pose", {1.0F, 2.0F, 3.0F, 0.6F, 0.0F, 0.0F, 0.8F}));
  const float position[] = {3.5F, -1, -2}, wxyz[] = {0.8F, 0, -0.6F, 0};
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(newest().position_m[i], position[i]) << i;
  for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(newest().orientation_wxyz[i], wxyz[i]) << i;
}

// A rotation in the sender's frame followed by the placement must equal the placement followed by
// the rotation in MERLIN's frame.
TEST(TrackerPlacement, TurnsPlacesAndRotationsAlikeAlsoIfItMirrors) {
  using Vector = std::array<float, 3>;
  const auto turned = [](const float(&q)[4], const Vector& v) {  // q v q*
    const Vector u{q[1], q[2], q[3]};
    const auto cross = [](const Vector& a, const Vector& b) {
      return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
    };
    const Vector first = cross(u, v);
    Vector t{first[0] + q[0] * v[0], first[1] + q[0] * v[1], first[2] + q[0] * v[2]};
    t = cross(u, t);
    return Vector{v[0] + 2 * t[0], v[1] + 2 * t[1], v[2] + 2 * t[2]};
  };
  for (const std::array<int, 3>& axes :
       {std::array{1, 2, 3}, std::array{3, -1, -2}, std::array{2, 1, 3}, std::array{-1, -2, -3}}) {
    const TrackerPlacement placement{axes, {}};
    TrackerSample sample{};
    const float q[4] = {0.5F, 0.1F, -0.7F, 0.5F};
    std::copy(std::begin(q), std::end(q), std::begin(sample.orientation_wxyz));
    const auto placed = [&](const Vector& v) {
      TrackerSample point{};
      std::copy(v.begin(), v.end(), std::begin(point.position_m));
      place(placement, point);
      return Vector{point.position_m[0], point.position_m[1], point.position_m[2]};
    };
    place(placement, sample);
    const Vector v{0.3F, -1, 2};
    const Vector there = placed(turned(q, v)), here = turned(sample.orientation_wxyz, placed(v));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(there[i], here[i], 1e-5) << axes[0];
  }
  SettingFaults faults;
  checkPlacement({{1, -1, 3}, {}}, "/osc", faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].pointer, "/osc/axes");
  EXPECT_EQ(faults[0].what,
            "is 1, -1, 3; needed is each of 1, 2 and 3 once, with or without a minus");
}

// A person holds the station at the origin and on two axes. With the computed placement, these
// three places must lie at the origin and on the axes.
TEST(TrackerPlacement, FollowsFromThreePlaces) {
  const auto solved = placementOf({1, 2, 3}, {1.02, 2, 3.5}, {0.4, 1.95, 3});
  ASSERT_TRUE(solved) << solved.error().what;
  EXPECT_EQ(solved->axes, (std::array{3, -1, -2}));
  const auto placed = [&](std::array<float, 3> at) {
    TrackerSample sample{};
    std::ranges::copy(at, sample.position_m);
    place(*solved, sample);
    return std::array{sample.position_m[0], sample.position_m[1], sample.position_m[2]};
  };
  EXPECT_EQ(placed({1, 2, 3}), (std::array<float, 3>{0, 0, 0}));
  EXPECT_EQ(placed({1, 2, 3.5F}), (std::array<float, 3>{0.5F, 0, 0}));
  EXPECT_EQ(placed({0, 2, 3}), (std::array<float, 3>{0, 1, 0}));
  EXPECT_EQ(placed({1, 1, 3}), (std::array<float, 3>{0, 0, 1})) << "right-handed";
  EXPECT_EQ(
      placementOf({0, 0, 0}, {1, 0.5, 0}, {0, 1, 0}).error().what,
      "the x axis lies 27 degrees off the nearest axis that is sent (20 are allowed): hold the "
      "station more exactly, or turn the axes in the tracker's server");
  EXPECT_EQ(placementOf({0, 0, 0}, {1, 0, 0}, {-1, 0.1, 0}).error().what,
            "the x axis and the y axis both lie along the axis 1 that is sent");
}

TEST_F(OscTest, TheRealPartMayComeFirst) {
  OscSettings settings;
  settings.quaternion = OscSettings::Quaternion::kWxyz;
  connect(settings, oscMessage("/tracker/1/pose", {0.0F, 0.0F, 0.0F, 0.8F, 0.6F, 0.0F, 0.0F}));
  EXPECT_FLOAT_EQ(newest().orientation_wxyz[0], 0.8F);
  EXPECT_FLOAT_EQ(newest().orientation_wxyz[1], 0.6F);
}

TEST_F(OscTest, APositionAloneIsNotTurned) {
  connect({}, oscMessage("/tracker/3/pose", {1.0F, 2.0F, 3.0F}));
  EXPECT_EQ(newest().station, 3u);
  EXPECT_FLOAT_EQ(newest().position_m[2], 3);
  EXPECT_FLOAT_EQ(newest().orientation_wxyz[0], 1);
}

TEST_F(OscTest, StationsOfABundleCountEachForItself) {
  const std::string both =
      oscBundle({oscMessage("/tracker/1/pose", kAtRest), oscMessage("/tracker/4/pose", kAtRest)});
  connect({}, both);
  feed(both);
  ASSERT_EQ(sink_.tracker.size(), 4u);
  EXPECT_EQ(sink_.tracker[2].station, 1u);
  EXPECT_EQ(sink_.tracker[2].counter, 2u);
  EXPECT_EQ(sink_.tracker[3].station, 4u);
  EXPECT_EQ(sink_.tracker[3].counter, 2u);
}

TEST_F(OscTest, WithoutItsPlaceInTheAddressTheStationIsTheFirstArgument) {
  OscSettings settings;
  settings.address = "/pose";
  settings.stations = {"7", "head"};
  const auto named = [&](OscValue name, std::vector<OscValue> rest) {
    rest.insert(rest.begin(), std::move(name));
    return oscMessage("/pose", rest);
  };
  connect(settings, named(std::string("head"), kAtRest));
  EXPECT_EQ(newest().station, 2u);
  feed(named(7, {1.0F, 1.0F, 1.0F}));
  EXPECT_EQ(newest().station, 1u);
  feed(named(std::string("7"), kAtRest));
  EXPECT_EQ(newest().station, 1u);
  feed(oscMessage("/pose", kAtRest));  // the message has no name, so it is for the first station
  EXPECT_EQ(newest().station, 1u);
  EXPECT_EQ(newest().counter, 3u);
  feed(named(8, kAtRest));
  feed(named(7.5F, kAtRest));
  feed(named(std::numeric_limits<float>::quiet_NaN(), kAtRest));
  EXPECT_EQ(sink_.tracker.size(), 4u);
  feed(named(7.0F, {7.0F, 8.0F, 9.0F}));  // from a sender that can send floats only
  ASSERT_EQ(sink_.tracker.size(), 5u);
  EXPECT_EQ(newest().station, 1u);
  EXPECT_FLOAT_EQ(newest().position_m[0], 7);
  EXPECT_EQ(device_->counters().bad_packets, 0u);
}

TEST_F(OscTest, OpeningSaysWhatComesInsteadOfAPose) {
  EXPECT_EQ(refused().what, "no OSC message comes to the port");
  stream_.feed(datagram("no OSC at all..."));
  EXPECT_EQ(refused().what, "datagrams come that are not OSC");
  stream_.feed(datagram(oscMessage("/wand", kAtRest)) + datagram(oscMessage("/head", kAtRest)) +
               datagram(oscMessage("/wand", kAtRest)));
  const Error other = refused();
  EXPECT_EQ(other.code, Errc::kMalformed);
  EXPECT_EQ(other.what, "messages come to /wand, /head; expected are poses at /tracker/1/pose");
  stream_.feed(datagram(oscMessage("/tracker/1/pose", {1.0F, 2.0F})));
  EXPECT_EQ(refused().what, "messages of poses have neither 3 nor 7 numbers");
}

// A wall on another machine would refuse such samples without a message.
TEST_F(OscTest, APoseThatIsPlacedBeyondTheTrackersReachIsDroppedAndSaid) {
  OscSettings settings;
  settings.placement.origin_m = {0, 24, 0};
  stream_.feed(datagram(oscMessage("/tracker/1/pose", {0.0F, 1.5F, 0.0F})));
  EXPECT_EQ(refused(settings).what,
            "poses lie beyond 25 m with \"origin_m\" added: is \"origin_m\" right?");
  EXPECT_TRUE(sink_.tracker.empty());
  connect(settings, oscMessage("/tracker/1/pose", {0.0F, 0.5F, 0.0F}));
  EXPECT_FLOAT_EQ(newest().position_m[1], 24.5F);
}

TEST_F(OscTest, APoseThatNoTrackerCanMeasureIsDroppedAndSaid) {
  connect({}, oscMessage("/tracker/1/pose", kAtRest));
  const auto pose = [](float x, float w) {
    return oscMessage("/tracker/1/pose", {x, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, w});
  };
  const std::pair<std::string, const char*> bad[] = {
      {pose(1500, 1), "poses come from beyond 25 m: is \"scale\" right?"},
      {pose(std::numeric_limits<float>::quiet_NaN(), 1),
       "poses come with values that are not numbers"},
      {pose(0, 0), "the orientations that come are not unit quaternions"},
      {oscMessage("/tracker/1/pose", {std::string("x"), 1.0F, 2.0F}),
       "messages of poses have neither 3 nor 7 numbers"},
      {oscMessage("/other", kAtRest), "OSC messages come, but none to the address of a station"},
      {"not OSC.", "datagrams come that are not OSC"},
      {test::oscText("#bundle") + test::oscWord(0) + test::oscWord(0) + test::oscWord(0xFFFFFFFC),
       "datagrams come that are not OSC"}};
  for (const auto& [packet, complaint] : bad) {
    for (const Timestamp until = clock_.now() + milliseconds(2100); clock_.now() < until;) {
      clock_.advance(milliseconds(100));
      feed(packet);
    }
    EXPECT_STREQ(device_->complaint(), complaint);
  }
  EXPECT_EQ(sink_.tracker.size(), 1u);
  feed(oscMessage("/tracker/1/pose", kAtRest));
  EXPECT_STREQ(device_->complaint(), "");
}

TEST_F(OscTest, SilenceOfThreeSecondsEndsTheConnection) {
  connect({}, oscMessage("/tracker/1/pose", kAtRest));
  const Timestamp heard = clock_.now();
  Result<Ok> polled = Ok{};
  while ((polled = device_->poll(stream_))) {
  }
  EXPECT_EQ(polled.error().code, Errc::kTimeout);
  EXPECT_EQ(polled.error().what, "nothing has come to the port for 3.0 s");
  EXPECT_LE(clock_.now() - heard, milliseconds(3250));
  EXPECT_STREQ(device_->complaint(), "no pose has come for 2 s");
}

TEST_F(OscTest, PosesAllocateNothing) {
  connect({}, oscMessage("/tracker/1/pose", kAtRest));
  sink_.tracker.reserve(1000);
  std::string bytes;
  for (int i = 0; i < 400; ++i) bytes += datagram(oscMessage("/tracker/2/pose", kAtRest));
  stream_.feed(bytes + datagram(oscMessage("/else", kAtRest)));
  const long before = test::allocations;
  while (sink_.tracker.size() < 401) ASSERT_TRUE(device_->poll(stream_));
#ifndef MERLIN_THREAD_SANITIZER
  EXPECT_EQ(test::allocations, before);
#endif
}

TEST_F(OscTest, DamagedDatagramsGiveNoSampleThatIsNotPlausible) {
  connect({}, oscMessage("/tracker/1/pose", kAtRest));
  Random random(9);
  const std::string good = oscBundle(
      {oscMessage("/tracker/1/pose", kAtRest), oscMessage("/tracker/2/pose", {1.0F, 2.0F, 3.0F})});
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string bytes = good;
      bytes[i] = static_cast<char>(value);
      feed(bytes);
    }
    feed(good.substr(0, i + 1));
  }
  EXPECT_GT(device_->counters().bad_packets, 1000u);
  for (const TrackerSample& s : sink_.tracker) ASSERT_TRUE(plausible(s));
}

TEST(OscSettings, AddressesAndStationsThatCannotBeAreNamed) {
  LineSettings line;
  line.driver = "osc";
  line.port = "udp:9000";
  const auto faultsOf = [&](const OscSettings& settings) {
    std::vector<std::string> at;
    for (const SettingFault& fault : validate(settings, line)) at.push_back(fault.pointer);
    return at;
  };
  using Pointers = std::vector<std::string>;
  EXPECT_EQ(faultsOf({}), Pointers{});
  OscSettings s;
  s.address = "/rigid-body/{station}";
  s.stations = {"", "wand"};
  EXPECT_EQ(faultsOf(s), Pointers{});
  for (const char* address : {"", "/", "pose", "/a b", "/a*", "/{name}", "/{station}/{station}"}) {
    OscSettings bad;
    bad.address = address;
    EXPECT_EQ(faultsOf(bad), Pointers{"/osc/address"}) << address;
  }
  using Names = std::vector<std::string>;
  for (const Names& names : {Names{}, Names{"", ""}, Names{"a", "a"}, Names{"a/b"},
                             Names{"1", "2", "3", "4", "5"}, Names{"a b"}}) {
    OscSettings bad;
    bad.stations = names;
    EXPECT_EQ(faultsOf(bad), Pointers{"/osc/stations"}) << testing::PrintToString(names);
  }
  line.port = "tcp://lab:9000";
  EXPECT_EQ(faultsOf({}), Pointers{"/port"});
}

}  // namespace
}  // namespace merlin::osc
