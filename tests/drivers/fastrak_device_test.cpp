#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "drivers/fastrak/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/device_bench.h"

namespace merlin::fastrak {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct Tracker : test::DeviceBench {
  explicit Tracker(const emulate::EmulatorSettings& emulated = {},
                   const FastrakSettings& settings = {})
      : DeviceBench("fastrak", emulated, "visit"), device(makeDevice(settings, clock, sink)) {}

  void type(std::string_view bytes) {
    emulator->receive(std::as_bytes(std::span(bytes)), clock.now());
  }

  std::unique_ptr<Device> device;
};

std::string record(int station, char error) {
  Record r;
  r.station = station;
  r.error = error;
  return encode(r, kDriverList, {});
}

TEST(FastrakDevice, OpensWithinASecondAndSaysWhatItIs) {
  const std::pair<const char*, const char*> kModels[] = {
      {"1", "Fastrak, firmware 3.00, stations 1"},
      {"2", "Fastrak, firmware 3.00, stations 1 2"},
      {"3", "Fastrak, firmware 3.00, stations 1 2 3"},
      {"4", "Fastrak, firmware 3.00, stations 1 2 3 4"},
  };
  for (const auto& [model, expected] : kModels) {
    Tracker tracker({.model = model});
    const auto identity = tracker.device->open(tracker.stream);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, expected);
    EXPECT_LT(tracker.clock.now() - tracker.start, seconds(1));
  }
}

TEST(FastrakDevice, SpeaksTheDialogueOfTheFactSheet) {  // section 8
  FastrakSettings settings;
  settings.hemisphere[1] = {0, -0.5F, 1};
  settings.centimetres = false;
  Tracker tracker({.model = "2"}, settings);
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  EXPECT_EQ(tracker.stream.written(),
            "cSl1\rUH1,1,0,0\rR1\rO1,2,11,0\rH2,0,-0.5,1\rR2\rO2,2,11,0\rfC");
}

TEST(FastrakDevice, StreamsAHundredAndTwentyRecordsASecond) {
  Tracker tracker({.baud = 38400});
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(10)));
  ASSERT_NEAR(static_cast<double>(tracker.sink.tracker.size()), 1200, 1);
  for (std::size_t i = 0; i < tracker.sink.tracker.size(); ++i) {
    EXPECT_EQ(tracker.sink.tracker[i].counter, i + 1);
    EXPECT_EQ(tracker.sink.tracker[i].station, 1u);
  }
  EXPECT_EQ(tracker.device->counters().samples, tracker.sink.tracker.size());
  EXPECT_EQ(tracker.device->counters().bad_bytes, 0u);
}

TEST(FastrakDevice, StationsShareTheRateAndCountForThemselves) {
  Tracker tracker({.model = "3"});
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(3)));
  std::array<std::uint32_t, 5> seen{};
  for (const TrackerSample& s : tracker.sink.tracker) EXPECT_EQ(s.counter, ++seen.at(s.station));
  for (const std::size_t station : {1u, 2u, 3u}) EXPECT_NEAR(seen[station], 120, 1);
}

TEST(FastrakDevice, MeasuresTheHandInMetresInEitherUnit) {
  for (const bool centimetres : {true, false}) {
    Tracker tracker({.model = "2"}, {.centimetres = centimetres});
    ASSERT_TRUE(tracker.device->open(tracker.stream));
    ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(10)));
    for (const TrackerSample& s : tracker.sink.tracker) {
      const auto motion = tracker.script.at(fromNanoseconds(s.received_ns) - tracker.start);
      for (std::size_t i = 0; i < 3; ++i) {
        const float aside = i == 1 && s.station == 2 ? 0.2F : 0.0F;
        // 5 sigma of the tracker's noise
        ASSERT_NEAR(s.position_m[i], motion.position_m[i] + aside, 0.004);
      }
      float dot = 0, square = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        dot += s.orientation_wxyz[i] * motion.orientation_wxyz[i];
        square += s.orientation_wxyz[i] * s.orientation_wxyz[i];
      }
      ASSERT_NEAR(square, 1, 1e-5);
      ASSERT_LT(2 * std::acos(std::min(std::abs(dot), 1.0F)), 0.0175);  // 1 degree
    }
  }
}

TEST(FastrakDevice, MeasuresTheSameInEveryForm) {
  using Numbers = FastrakSettings::Numbers;
  for (const Numbers numbers : {Numbers::kBinary, Numbers::kText, Numbers::kShort}) {
    for (const int form : {0, 1, 2, 3, 4, 5, 6, 7}) {
      FastrakSettings settings;
      settings.numbers = numbers;
      settings.angles = form & 1;
      settings.stylus = form & 2;
      settings.centimetres = form & 4;
      Tracker tracker({.baud = 115200, .model = "2"}, settings);
      ASSERT_TRUE(tracker.device->open(tracker.stream));
      ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(2)));
      EXPECT_GT(tracker.sink.tracker.size(), 230u);
      EXPECT_EQ(tracker.device->counters().bad_bytes, 0u);
      for (const TrackerSample& s : tracker.sink.tracker) {
        const auto motion = tracker.script.at(fromNanoseconds(s.received_ns) - tracker.start);
        ASSERT_NEAR(s.position_m[0], motion.position_m[0], 0.005);
        float dot = 0;
        for (std::size_t i = 0; i < 4; ++i)
          dot += s.orientation_wxyz[i] * motion.orientation_wxyz[i];
        ASSERT_LT(2 * std::acos(std::min(std::abs(dot), 1.0F)), 0.02);
      }
    }
  }
}

TEST(FastrakDevice, AlignsItsFrameAndLooksStraightAhead) {
  FastrakSettings settings;
  // The new x axis is the old y, the new y the old -x.
  settings.alignment_cm[0] = {50, 0, 0, 50, 100, 0, -50, 0, 0};
  settings.boresight_wxyz[1] = {0.6F, 0, 0, 0.8F};
  for (const bool centimetres : {true, false}) {
    settings.centimetres = centimetres;
    Tracker tracker({.model = "2"}, settings);
    ASSERT_TRUE(tracker.device->open(tracker.stream));
    ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(2)));
    for (const TrackerSample& s : tracker.sink.tracker) {
      const auto m = tracker.script.at(fromNanoseconds(s.received_ns) - tracker.start);
      if (s.station == 1) {
        ASSERT_NEAR(s.position_m[0], m.position_m[1], 0.005);
        ASSERT_NEAR(s.position_m[1], 0.5F - m.position_m[0], 0.005);
        ASSERT_NEAR(s.position_m[2], m.position_m[2], 0.005);
      } else {  // q * conj(0.6, 0, 0, 0.8)
        const auto& q = m.orientation_wxyz;
        ASSERT_NEAR(std::abs(s.orientation_wxyz[0]), std::abs(0.6F * q[0] + 0.8F * q[3]), 0.02);
        ASSERT_NEAR(std::abs(s.orientation_wxyz[3]), std::abs(0.6F * q[3] - 0.8F * q[0]), 0.02);
      }
    }
  }
}

TEST(FastrakDevice, AnAlignmentOfWhoeverHadTheBoxBeforeIsReset) {
  Tracker tracker;
  for (const char c : std::string("A1,50,0,0,50,100,0,-50,0,0\r"))
    tracker.emulator->receive(std::as_bytes(std::span(&c, 1)), tracker.clock.now());
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
  ASSERT_FALSE(tracker.sink.tracker.empty());
  const TrackerSample& s = tracker.sink.tracker.back();
  const auto m = tracker.script.at(fromNanoseconds(s.received_ns) - tracker.start);
  EXPECT_NEAR(s.position_m[0], m.position_m[0], 0.005);
  EXPECT_NEAR(s.position_m[1], m.position_m[1], 0.005);
}

TEST(FastrakDevice, AStylussButtonComesWithItsRecords) {
  FastrakSettings settings;
  settings.stylus = true;
  Tracker tracker({}, settings);
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  EXPECT_NE(tracker.stream.written().find("e1,0\rN1,0.00,0.00,0.00\rO1,2,11,16,0\r"),
            std::string::npos);
  tracker.stream.mute();
  Record r;
  constexpr std::array<int, 4> kItems = {2, 11, 16, 0};
  for (const bool pressed : {true, false}) {
    r.stylus = pressed;
    tracker.stream.feed(encode(r, kItems, {}));
    ASSERT_TRUE(tracker.device->poll(tracker.stream));
    EXPECT_EQ(tracker.sink.tracker.back().stylus, pressed ? 1 : 0);
  }
}

TEST(FastrakDevice, NormalisesAQuaternionThatIsNearlyOne) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  tracker.stream.mute();
  Record r;
  r.orientation_wxyz = {0, 0, 1.015F, 0};
  tracker.stream.feed(encode(r, kDriverList, {}));
  ASSERT_TRUE(tracker.device->poll(tracker.stream));
  ASSERT_EQ(tracker.sink.tracker.size(), 1u);
  EXPECT_FLOAT_EQ(tracker.sink.tracker[0].orientation_wxyz[2], 1);
}

TEST(FastrakDevice, IsLostAfterHalfASecondOfSilence) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
  tracker.stream.mute();
  EXPECT_LE(tracker.timeToFail(*tracker.device, seconds(5)), milliseconds(500));
}

TEST(FastrakDevice, IsLostWhenItsBoxStartsAgainAndComesBack) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
  tracker.type("\x19");
  EXPECT_LE(tracker.timeToFail(*tracker.device, seconds(5)), milliseconds(500));
  // The box is silent for one second, during which open() keeps asking.
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  EXPECT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
}

TEST(FastrakDevice, AsksASilentBoxTwiceAndSaysSo) {
  Tracker tracker;
  tracker.stream.mute();
  const auto first = tracker.device->open(tracker.stream);
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error().code, Errc::kTimeout);
  EXPECT_EQ(first.error().what, "no answer to S within 0.4 s");
  EXPECT_LT(tracker.clock.now() - tracker.start, seconds(2));
  EXPECT_EQ(tracker.stream.written(), "cScS");
}

// The driver resets a box only after four failed attempts: a reset makes it silent for ten seconds.
TEST(FastrakDevice, ReinitialisesABoxThatDidNotAnswerFourTimes) {
  Tracker tracker;
  tracker.stream.mute();
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(tracker.device->open(tracker.stream));
  EXPECT_EQ(tracker.stream.written(), "cScScScScScScScS");

  tracker.stream.plug(tracker.emulator.get());
  const auto fifth = tracker.device->open(tracker.stream);
  ASSERT_TRUE(fifth) << fifth.error().what;
  EXPECT_EQ(tracker.stream.written().find('\x19'), 16u);
  EXPECT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));

  // The box has answered before, so it must not be reset again.
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  EXPECT_EQ(tracker.stream.written().rfind('\x19'), 16u);
}

TEST(FastrakDevice, AsksForTenSecondsWhileABoxStarts) {
  Tracker tracker;
  tracker.stream.mute();
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(tracker.device->open(tracker.stream));
  const auto before = tracker.stream.written().size();
  const Timestamp from = tracker.clock.now();
  EXPECT_FALSE(tracker.device->open(tracker.stream));
  EXPECT_GE(tracker.clock.now() - from, seconds(10));
  EXPECT_LE(tracker.clock.now() - from, milliseconds(11'500));
  const std::string written = tracker.stream.written().substr(before);
  EXPECT_TRUE(
      written.starts_with("\x19"
                          "cScS"));
  EXPECT_EQ(written.size(), 1 + 2 * 17u);  // one every 0.6 s
}

TEST(FastrakDevice, SaysThatNoReceiverIsPluggedIn) {
  Tracker tracker;
  tracker.type("l1,0\r");
  const auto identity = tracker.device->open(tracker.stream);
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().what, "no station is active: is a receiver plugged in?");
  // After the reset (^Y) the box looks for receivers again.
  EXPECT_TRUE(tracker.device->open(tracker.stream));
}

TEST(FastrakDevice, SaysWhatAnsweredInstead) {
  Tracker tracker;
  tracker.stream.mute();
  struct Parrot final : emulate::Emulator {
    void receive(std::span<const std::byte> bytes, Timestamp) override {
      if (bytes[0] == std::byte{'S'}) pending = std::string(60, 'x');
    }
    void advance(Timestamp, std::string& out) override { out += std::exchange(pending, {}); }
    Timestamp nextDue() const override { return Timestamp::max(); }
    std::string pending;
  } parrot;
  tracker.stream.plug(&parrot);
  const auto identity = tracker.device->open(tracker.stream);
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, Errc::kMalformed);
  EXPECT_EQ(identity.error().what, "unexpected answer \"" + std::string(24, 'x') + "...\" to S");
}

TEST(FastrakDevice, ComplainsOfTheFirstStationWithAnError) {
  Tracker tracker({.model = "2"});
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  tracker.stream.mute();
  const struct {
    int station;
    char error;
    const char* complaint;
  } kCases[] = {{1, ' ', ""},
                {2, 'k', "station 2 reports error k (receiver too far or unplugged: low signal)"},
                {1, ' ', "station 2 reports error k (receiver too far or unplugged: low signal)"},
                {1, 'a', "station 1 reports error a (fault of a transmitter driver)"},
                {2, ' ', "station 1 reports error a (fault of a transmitter driver)"},
                {1, ' ', ""}};
  for (const auto& [station, error, complaint] : kCases) {
    tracker.stream.feed(record(station, error));
    ASSERT_TRUE(tracker.device->poll(tracker.stream));
    EXPECT_STREQ(tracker.device->complaint(), complaint);
    EXPECT_EQ(tracker.sink.tracker.back().error, error);
  }
}

TEST(FastrakDevice, StreamsOnPastGarbageAndCountsIt) {
  Tracker tracker({.baud = 115200, .garbage_every = 10});
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(10)));
  // A burst of garbage does not destroy the records around it.
  EXPECT_GE(tracker.sink.tracker.size(), 1195u);
  EXPECT_EQ(tracker.device->counters().bad_packets, 120u);
  EXPECT_GT(tracker.device->counters().bad_bytes, 120u * 5);
  EXPECT_LT(tracker.device->counters().bad_bytes, 120u * 8);
}

TEST(FastrakDevice, OpensAgainAndCountsOn) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
  const auto first = tracker.sink.tracker.size();
  tracker.stream.feed(record(1, ' ').substr(0, 20));  // a record that is cut off
  ASSERT_TRUE(tracker.device->poll(tracker.stream));
  ASSERT_TRUE(tracker.device->open(tracker.stream));  // the box keeps streaming meanwhile
  ASSERT_TRUE(tracker.pollFor(*tracker.device, seconds(1)));
  EXPECT_NEAR(static_cast<double>(tracker.sink.tracker.size() - first), 120, 1);
  EXPECT_EQ(tracker.sink.tracker.back().counter, tracker.sink.tracker.size());
  EXPECT_EQ(tracker.device->counters().bad_bytes, 0u);
}

TEST(FastrakDevice, EndsAtOnceWhenTheLineIsClosed) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  tracker.stream.interrupt();
  const auto polled = tracker.device->poll(tracker.stream);
  ASSERT_FALSE(polled);
  EXPECT_EQ(polled.error().code, Errc::kClosed);
  EXPECT_EQ(tracker.device->open(tracker.stream).error().code, Errc::kClosed);
}

TEST(FastrakDevice, AllocatesNothingWhileItStreams) {
  Tracker tracker;
  ASSERT_TRUE(tracker.device->open(tracker.stream));
  tracker.stream.mute();
  tracker.sink.tracker.reserve(100);
  std::string bytes;
  for (int i = 0; i < 50; ++i) bytes += record(1 + i % 4, i % 3 ? ' ' : 'k') + (i % 7 ? "" : "xyz");
  tracker.stream.feed(bytes + "0");
  const long before = test::allocations;
  while (tracker.sink.tracker.size() < 50) ASSERT_TRUE(tracker.device->poll(tracker.stream));
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_EQ(tracker.device->counters().bad_packets, 8u);
}

}  // namespace
}  // namespace merlin::fastrak
