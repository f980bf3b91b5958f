#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "drivers/cyberglove/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/device_bench.h"

namespace merlin::cyberglove {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Layout kLayout{22, false, true};

struct Glove : test::DeviceBench {
  explicit Glove(const emulate::EmulatorSettings& emulated = {}, const char* script_name = "visit",
                 const CybergloveSettings& settings = {})
      : DeviceBench("cyberglove", emulated, script_name),
        device(makeDevice(settings, clock, sink)) {}

  std::unique_ptr<Device> device;
};

// Returns a record of 22 sensors at raw 100, with the other fields of `like`.
std::string record(const Record& like) {
  Record r = like;
  r.values.fill(100);
  return encode(r, kLayout);
}

TEST(CybergloveDevice, OpensWithinASecondAndSaysWhatItIs) {
  for (const char* model : {"22", "18"}) {
    Glove glove({.model = model});
    const auto identity = glove.device->open(glove.stream);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, "CyberGlove, "s + model + " sensors");
    EXPECT_LT(glove.clock.now() - glove.start, seconds(1));
  }
}

TEST(CybergloveDevice, SpeaksTheDialogueOfTheFactSheet) {  // section 8
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  EXPECT_EQ(glove.stream.written(),
            "\x03?i?G?S?KM\x7F\xFF\x7FN\x16U\x01"s + "D\0"s + "F\x01J\x01T\x04\x80\x00\x01S"s);
}

TEST(CybergloveDevice, SetsTheRateAndFilterThatItWasTold) {
  CybergloveSettings settings;
  settings.rate_hz = 60;
  settings.filter = false;
  Glove glove({}, "still", settings);
  ASSERT_TRUE(glove.device->open(glove.stream));
  EXPECT_NE(glove.stream.written().find("F\0J\x01T\x07\x80\x00\x01S"s), std::string::npos);
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(2)));
  EXPECT_NEAR(static_cast<double>(glove.sink.glove.size()), 120, 1);
}

TEST(CybergloveDevice, StreamsAHundredRecordsASecond) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(10)));
  ASSERT_NEAR(static_cast<double>(glove.sink.glove.size()), 1000, 1);
  for (std::size_t i = 0; i < glove.sink.glove.size(); ++i) {
    EXPECT_EQ(glove.sink.glove[i].counter, i + 1);
    EXPECT_EQ(glove.sink.glove[i].sensors, 22u);
    EXPECT_EQ(glove.sink.glove[i].flags, GloveSample::kPlugged);
  }
  EXPECT_EQ(glove.device->counters().samples, glove.sink.glove.size());
  EXPECT_EQ(glove.device->counters().bad_bytes, 0u);
  EXPECT_STREQ(glove.device->complaint(), "");
}

TEST(CybergloveDevice, MeasuresWhatTheScriptDoes) {
  Glove glove;
  const CybergloveSettings settings;
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(20)));
  for (const GloveSample& sample : glove.sink.glove) {
    const auto motion = glove.script.at(fromNanoseconds(sample.received_ns) - glove.start);
    for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
      // Rounding by half a count, plus 5 sigma of the sensor's noise and of a tremor.
      const double slack = slot == 7 ? 0 : 3.5 * std::abs(settings.gain[slot]) + 0.06;
      ASSERT_NEAR(sample.angle_rad[slot], motion.glove_rad[slot], slack) << "slot " << slot;
    }
  }
}

TEST(CybergloveDevice, IsLostAfterHalfASecondOfSilence) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(1)));
  glove.stream.mute();
  EXPECT_LE(glove.timeToFail(*glove.device, seconds(5)), milliseconds(500));
}

TEST(CybergloveDevice, IsLostWhenWhatComesIsNoRecord) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  glove.stream.mute();
  const Timestamp from = glove.clock.now();
  Result<Ok> polled = Ok{};
  while (polled) {
    glove.stream.feed("\x83\x00noise"s);
    glove.clock.advance(milliseconds(50));
    polled = glove.device->poll(glove.stream);
    ASSERT_LT(glove.clock.now() - from, seconds(2));
  }
  EXPECT_EQ(polled.error().code, Errc::kTimeout);
  EXPECT_LE(glove.clock.now() - from, milliseconds(550));
}

TEST(CybergloveDevice, WaitsFivePeriodsOfASlowStream) {
  CybergloveSettings settings;
  settings.rate_hz = 2;
  Glove glove({}, "still", settings);
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(10)));
  EXPECT_NEAR(static_cast<double>(glove.sink.glove.size()), 20, 1);
  glove.stream.mute();
  const Duration time = glove.timeToFail(*glove.device, seconds(5));
  EXPECT_LE(time, milliseconds(2750));
  EXPECT_GE(time, milliseconds(2000));
}

TEST(CybergloveDevice, ComplainsOfAGloveThatIsNotPluggedIn) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  glove.stream.mute();
  const struct {
    std::string bytes;
    const char* complaint;
  } kCases[] = {
      {record({.unplugged = true}), "glove not plugged in"},
      {record({}), ""},
      {record({.status = 0x80}), "glove not plugged in"},
      {record({.too_fast = true}),
       "the requested record rate is higher than the glove can measure"},
      {record({}), ""},
      {"eg\0"s, "glove not plugged in"},
  };
  for (const auto& [bytes, complaint] : kCases) {
    glove.stream.feed(bytes);
    ASSERT_TRUE(glove.device->poll(glove.stream));
    EXPECT_STREQ(glove.device->complaint(), complaint);
  }
  EXPECT_EQ(glove.sink.glove.size(), 5u);
  Result<Ok> polled = Ok{};
  while (polled) polled = glove.device->poll(glove.stream);
  EXPECT_EQ(polled.error().what, "no record for 0.5 s: glove not plugged in");
}

TEST(CybergloveDevice, PassesTheWristSwitchOn) {
  CybergloveSettings settings;
  settings.slot7 = Slot7Rule::kSwitch;
  Glove glove({}, "still", settings);
  ASSERT_TRUE(glove.device->open(glove.stream));
  glove.stream.mute();
  glove.stream.feed(record({.status = 0x87}));
  ASSERT_TRUE(glove.device->poll(glove.stream));
  ASSERT_EQ(glove.sink.glove.size(), 1u);
  EXPECT_EQ(glove.sink.glove[0].flags, 7u);
  EXPECT_FLOAT_EQ(glove.sink.glove[0].angle_rad[7], 1);
}

TEST(CybergloveDevice, SaysWhatAnsweredInstead) {
  Glove glove;
  glove.stream.mute();
  const auto nothing = glove.device->open(glove.stream);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Errc::kTimeout);
  EXPECT_EQ(nothing.error().what, "no answer to ?i within 0.3 s");
  EXPECT_LT(glove.clock.now() - glove.start, seconds(1));
}

// An emulator that answers each query from a table, which may have answers that no real glove
// gives.
struct Liar final : emulate::Emulator {
  void receive(std::span<const std::byte> bytes, Timestamp) override {
    const std::string query(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const auto& [asked, answer] : answers) {
      if (query == asked) pending += answer;
    }
  }
  void advance(Timestamp, std::string& out) override { out += std::exchange(pending, {}); }
  Timestamp nextDue() const override { return Timestamp::max(); }

  std::vector<std::pair<std::string, std::string>> answers;
  std::string pending;
};

TEST(CybergloveDevice, RefusesAnswersThatMakeNoGlove) {
  const std::pair<std::string, std::string> info{"?i", "CyberGlove\0"s}, state{"?G", "?G\3\0"s},
      sensors{"?S", "?S\x16\0"s}, mask{"?K", "?K\x7F\xFF\x7F\0"s};
  const struct {
    std::vector<std::pair<std::string, std::string>> answers;
    const char* what;
  } kCases[] = {
      {{{"?i", "Spaceball\0"s}}, "not a CyberGlove: it identifies itself as \"Spaceball\""},
      {{info, {"?G", "?X\3\0"s}}, "unexpected answer \"?X\\x03\\x00\" to ?G"},
      {{info, state, {"?S", "?S\x12\0"s}, mask},
       "the glove reports 18 sensors, and its sensor mask has 22 (0x7FFF7F); the two must be equal "
       "and not 0"},
      {{info, {"?G", "?G\1\0"s}, {"?S", "?S\0\0"s}, {"?K", "?K\0\0\0\0"s}},
       "the glove reports 0 sensors, and its sensor mask has 0 (0x000000); the two must be equal "
       "and "
       "not 0: glove not plugged in"},
      {{info, state, sensors, mask, {"M\x7F\xFF\x7F", "en\0"s}}, "unexpected answer \"en\" to M"},
  };
  for (const auto& [answers, what] : kCases) {
    Glove glove;
    Liar liar;
    liar.answers = answers;
    glove.stream.plug(&liar);
    const auto identity = glove.device->open(glove.stream);
    ASSERT_FALSE(identity);
    EXPECT_EQ(identity.error().code, Errc::kMalformed);
    EXPECT_EQ(identity.error().what, what);
  }
}

// A glove that begins to answer at the first query. Before that answer it sends what it was sending
// earlier, and the answers to earlier queries.
struct Returning final : emulate::Emulator {
  Returning(emulate::Emulator& box, std::string left_over)
      : box_(box), left(std::move(left_over)) {}
  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    if (bytes[0] == std::byte{'?'}) silent = false;
    box_.receive(bytes, now);
  }
  void advance(Timestamp now, std::string& out) override {
    if (!silent) out += std::exchange(left, {});
    box_.advance(now, out);
  }
  Timestamp nextDue() const override { return box_.nextDue(); }

  emulate::Emulator& box_;
  std::string left;
  bool silent = true;
};

TEST(CybergloveDevice, IsNotMistakenForAnotherDeviceAsItComesBack) {
  for (const std::string& left : {record({}).substr(8), record({}) + record({}),
                                  "CyberGlove\0?G\3\0"s, std::string(600, 'x')}) {
    Glove glove;
    Returning box(*glove.emulator, left);
    glove.stream.plug(&box);
    const auto identity = glove.device->open(glove.stream);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_LT(glove.clock.now() - glove.start, seconds(1));
    ASSERT_TRUE(glove.pollFor(*glove.device, seconds(1)));
    EXPECT_EQ(glove.device->counters().bad_bytes, 0u);
  }
}

// Imitates the vendor's firmware of 1993, which ends the answer to a set command with an extra NUL.
struct ThirdByte final : emulate::Emulator {
  explicit ThirdByte(emulate::Emulator& box) : box_(box) {}
  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    box_.receive(bytes, now);
  }
  void advance(Timestamp now, std::string& out) override {
    std::string answer;
    box_.advance(now, answer);
    out += answer;
    if (answer.size() == 2) out.push_back('\0');
  }
  Timestamp nextDue() const override { return box_.nextDue(); }

  emulate::Emulator& box_;
};

TEST(CybergloveDevice, TakesTheThirdByteOfOldFirmware) {
  Glove glove;
  ThirdByte old(*glove.emulator);
  glove.stream.plug(&old);
  const auto identity = glove.device->open(glove.stream);
  ASSERT_TRUE(identity) << identity.error().what;
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(1)));
  EXPECT_EQ(glove.device->counters().bad_bytes, 0u);
}

TEST(CybergloveDevice, StreamsOnPastGarbageAndCountsIt) {
  Glove glove({.garbage_every = 5});
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(10)));
  // Each burst of garbage destroys the record that it hits.
  EXPECT_GE(glove.sink.glove.size(), 780u);
  EXPECT_LT(glove.sink.glove.size(), 850u);
  EXPECT_GT(glove.device->counters().bad_packets, 150u);
  EXPECT_GT(glove.device->counters().bad_bytes, 150u * 25);
}

TEST(CybergloveDevice, OpensAgainAndCountsOn) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(1)));
  const auto first = glove.sink.glove.size();
  glove.stream.feed(record({}).substr(0, 20));  // a record that is cut off
  ASSERT_TRUE(glove.device->poll(glove.stream));
  ASSERT_TRUE(glove.device->open(glove.stream));  // the device keeps streaming meanwhile
  ASSERT_TRUE(glove.pollFor(*glove.device, seconds(1)));
  EXPECT_NEAR(static_cast<double>(glove.sink.glove.size() - first), 100, 1);
  EXPECT_EQ(glove.sink.glove.back().counter, glove.sink.glove.size());
  EXPECT_EQ(glove.device->counters().samples, glove.sink.glove.size());
  EXPECT_EQ(glove.device->counters().bad_bytes, 0u);
}

TEST(CybergloveDevice, EndsAtOnceWhenTheLineIsClosed) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  glove.stream.interrupt();
  const auto polled = glove.device->poll(glove.stream);
  ASSERT_FALSE(polled);
  EXPECT_EQ(polled.error().code, Errc::kClosed);
  EXPECT_EQ(glove.device->open(glove.stream).error().code, Errc::kClosed);
}

TEST(CybergloveDevice, AllocatesNothingWhileItStreams) {
  Glove glove;
  ASSERT_TRUE(glove.device->open(glove.stream));
  glove.stream.mute();
  glove.sink.glove.reserve(100);
  std::string bytes;
  for (int i = 0; i < 50; ++i) bytes += record({.too_fast = i % 3 == 0}) + (i % 7 ? "" : "xyz\0"s);
  glove.stream.feed(bytes);
  const long before = test::allocations;
  while (glove.sink.glove.size() < 50) ASSERT_TRUE(glove.device->poll(glove.stream));
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_EQ(glove.device->counters().bad_packets, 8u);
}

}  // namespace
}  // namespace merlin::cyberglove
