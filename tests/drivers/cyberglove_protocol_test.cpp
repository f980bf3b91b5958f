#include <algorithm>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/cyberglove/calibration.h"
#include "drivers/cyberglove/protocol.h"
#include "tests/support/named_packet.h"

namespace merlin::cyberglove {
namespace {

using namespace std::string_literals;

constexpr Layout kPlain18{18, false, false};
constexpr Layout kFull22{22, true, true};
constexpr Layout kDriver22{22, false, true};

struct Seen {
  std::vector<Record> records;
  std::vector<char> refusals;
};

// Feeds `bytes` to the parser and returns the packets that it found, in order.
Seen parse(Parser& parser, std::string_view bytes) {
  Seen seen;
  for (const char c : bytes) {
    const auto packet = parser.feed(static_cast<std::byte>(c));
    if (!packet) continue;
    if (const auto* r = std::get_if<Record>(&*packet)) seen.records.push_back(*r);
    if (const auto* r = std::get_if<Refusal>(&*packet)) seen.refusals.push_back(r->code);
  }
  return seen;
}

Seen parse(const Layout& layout, std::string_view bytes) {
  Parser parser;
  parser.expect(layout);
  return parse(parser, bytes);
}

std::vector<int> values(const Record& record, std::size_t count) {
  return {record.values.begin(), record.values.begin() + static_cast<std::ptrdiff_t>(count)};
}

// Fact sheet, example 1: 18 sensors. The first value is the byte 'e', which could also begin an
// error message.
const std::string kExample1 =
    "\x47\x65\x78\x57\x8F\x82\x5C\x7D\x58\xA0\x77\x5F\x98\x7B\x5A\x95\x6E\x85\x62\x00"s;
// Fact sheet, example 2: 22 sensors, time stamp, status.
const std::string kExample2 =
    "\x53\x65\x78\x57\x8F\x82\x5C\x46\x7D\x58\x42\xA0\x77\x5F\x47\x98\x7B\x5A\x44\x95\x6E\x85\x62"
    "\x88\x03\x02\x01\x01\x83\x00"s;
// Example 2 with the fields that the driver asks for: status, but no time stamp.
const std::string kGood =
    "\x53\x65\x78\x57\x8F\x82\x5C\x46\x7D\x58\x42\xA0\x77\x5F\x47\x98\x7B\x5A\x44\x95\x6E\x85\x62"
    "\x83\x00"s;

TEST(CybergloveParser, ReadsAnAnswerOf18) {
  const auto seen = parse(kPlain18, kExample1);
  ASSERT_EQ(seen.records.size(), 1u);
  EXPECT_TRUE(seen.records[0].single);
  EXPECT_EQ(values(seen.records[0], 18), (std::vector{101, 120, 87, 143, 130, 92, 125, 88, 160, 119,
                                                      95, 152, 123, 90, 149, 110, 133, 98}));
}

TEST(CybergloveParser, ReadsTimeStampAndStatus) {
  const auto seen = parse(kFull22, kExample2);
  ASSERT_EQ(seen.records.size(), 1u);
  EXPECT_FALSE(seen.records[0].single);
  EXPECT_EQ(seen.records[0].timestamp, 66051u);
  EXPECT_EQ(seen.records[0].status, 0x83);
  EXPECT_EQ(seen.records[0].values[21], 98);
}

TEST(CybergloveParser, TellsErrorsByTheirPlace) {
  const std::string body = kGood.substr(0, kGood.size() - 1);
  const auto seen = parse(kDriver22, body + "es\0"s + body + "eg\0"s + body + "eseg\0"s + kGood);
  ASSERT_EQ(seen.records.size(), 4u);
  EXPECT_TRUE(seen.records[0].too_fast && !seen.records[0].unplugged);
  EXPECT_TRUE(!seen.records[1].too_fast && seen.records[1].unplugged);
  EXPECT_TRUE(seen.records[2].too_fast && seen.records[2].unplugged);
  EXPECT_TRUE(!seen.records[3].too_fast && !seen.records[3].unplugged);
}

TEST(CybergloveParser, ReadsErrorReplies) {
  EXPECT_EQ(parse(kDriver22, "eg\0e?\0"s).refusals, (std::vector{'g', '?'}));
}

TEST(CybergloveParser, DropsWhatIsNoRecordAndCountsIt) {
  const std::string body = kGood.substr(0, kGood.size() - 1);
  const std::string bad[] = {
      body.substr(0, 23) + "\x03\0"s,  // a status byte without bit 7
      body + "ex\0"s,                  // an unknown error
      body + "e\0"s,                   // an incomplete error
      body + "esegeg\0"s,              // longer than any record
      "X" + body.substr(1) + "\0"s,
  };
  std::uint64_t bytes = 0;
  Parser parser;
  parser.expect(kDriver22);
  for (const std::string& packet : bad) {
    EXPECT_TRUE(parse(parser, packet).records.empty());
    bytes += packet.size();
  }
  EXPECT_EQ(parser.badPackets(), 5u);
  EXPECT_EQ(parser.badBytes(), bytes);
}

TEST(CybergloveParser, FindsRecordsAmongGarbageAndCountsEveryByteOfIt) {
  Parser parser;
  parser.expect(kDriver22);
  const auto seen = parse(parser, "mid-record\0"s + kGood + "\0"s + kGood + "xyz\0"s + kGood);
  EXPECT_EQ(seen.records.size(), 3u);
  EXPECT_EQ(parser.badPackets(), 2u);  // a lone NUL does not count as a packet
  EXPECT_EQ(parser.badBytes(), 11u + 1 + 4);
}

TEST(CybergloveParser, EncodingIsTheInverse) {
  for (const Layout& layout : {kPlain18, kFull22, kDriver22, Layout{24, true, true}}) {
    for (int first = 1; first < 256; ++first) {
      Record record;
      for (std::size_t i = 0; i < layout.values; ++i) {
        record.values[i] = static_cast<std::uint8_t>(1 + (first + 37 * static_cast<int>(i)) % 255);
      }
      record.timestamp = layout.timestamp ? 0x01000100u * static_cast<unsigned>(first) : 0;
      if (layout.status) record.status = static_cast<std::uint8_t>(0x80 | (first & 7));
      record.single = first & 1;
      record.too_fast = first & 2;
      record.unplugged = first & 4;
      const auto seen = parse(layout, encode(record, layout));
      ASSERT_EQ(seen.records.size(), 1u) << first;
      EXPECT_EQ(seen.records[0].values, record.values);
      EXPECT_EQ(seen.records[0].timestamp, record.timestamp);
      EXPECT_EQ(seen.records[0].status, record.status);
      EXPECT_EQ(seen.records[0].single, record.single);
      EXPECT_EQ(seen.records[0].too_fast, record.too_fast);
      EXPECT_EQ(seen.records[0].unplugged, record.unplugged);
    }
  }
}

TEST(CybergloveEncode, SendsAOneForAZero) {
  EXPECT_EQ(encode(Record{}, {2, false, false}), "S\1\1\0"s);
}

TEST(CybergloveTimestamp, StuffingLeavesNoZeroAndIsUndone) {
  for (const std::uint32_t count : {0u, 1u, 255u, 256u, 66051u, 0x00FF00FFu, 0x01000001u, ~0u}) {
    const Stamp stamp = stuffTimestamp(count);
    for (const std::uint8_t c : stamp) EXPECT_NE(c, 0) << count;
    EXPECT_EQ(unstuffTimestamp(stamp.data()), count);
  }
  EXPECT_EQ(stuffTimestamp(66051), (Stamp{0x88, 3, 2, 1, 1}));  // fact sheet, example 2
}

TEST(CybergloveMask, NamesTheSlotsOfEachGlove) {  // fact sheet, section 5
  EXPECT_EQ(encodeMask(kMask22), "\x7F\xFF\x7F");
  EXPECT_EQ(encodeMask(kMask18), "\x3F\xBB\x7B");
  EXPECT_EQ(decodeMask("\x3F\xBB\x7B"), kMask18);
  const SlotList all = slotsOf(kMask22);
  ASSERT_EQ(all.count, 22u);
  for (std::size_t i = 0; i < 22; ++i) EXPECT_EQ(all.slot[i], i < 7 ? i : i + 1);
  const SlotList few = slotsOf(kMask18);
  ASSERT_EQ(few.count, 18u);
  EXPECT_EQ(std::vector<int>(few.slot.begin(), few.slot.begin() + 18),
            (std::vector{0, 1, 2, 3, 4, 5, 8, 9, 11, 12, 13, 15, 16, 17, 19, 20, 21, 22}));
}

TEST(CybergloveRate, IsADivisorOf115200) {  // fact sheet, section 4.2 and example 3
  EXPECT_EQ(encodeRate(100), "T\x04\x80\x00\x01"s);
  EXPECT_EQ(encodeRate(80), "T\x05\xA0\x00\x01"s);
  EXPECT_EQ(encodeRate(2), "T\xE1\x00\x00\x01"s);
  EXPECT_EQ(encodeRate(1), "T\xE1\x00\x00\x02"s);
}

// The tests damage one packet of each kind.
class CybergloveDamage : public testing::TestWithParam<test::NamedPacket> {};

TEST_P(CybergloveDamage, EveryPrefixCostsAtMostItself) {
  for (std::size_t n = 0; n < GetParam().bytes.size(); ++n) {
    Parser parser;
    parser.expect(kDriver22);
    const auto seen = parse(parser, GetParam().bytes.substr(0, n) + "\0"s + kGood);
    ASSERT_FALSE(seen.records.empty()) << n;
    EXPECT_EQ(values(seen.records.back(), 22).back(), 98) << n;
    EXPECT_LE(parser.badPackets(), 1u) << n;
  }
}

TEST_P(CybergloveDamage, EveryPrefixWithoutItsEndCostsTheNextToo) {
  for (std::size_t n = 1; n + 1 < GetParam().bytes.size(); ++n) {
    Parser parser;
    parser.expect(kDriver22);
    const auto seen = parse(parser, GetParam().bytes.substr(0, n) + kGood + kGood);
    EXPECT_EQ(seen.records.size(), 1u) << n;
    EXPECT_EQ(parser.badPackets(), 1u) << n;
    EXPECT_EQ(parser.badBytes(), n + kGood.size()) << n;
  }
}

TEST_P(CybergloveDamage, EveryOneByteDamageCostsAtMostTwoPackets) {
  for (std::size_t at = 0; at < GetParam().bytes.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      std::string bytes = GetParam().bytes;
      bytes[at] = static_cast<char>(value);
      Parser parser;
      parser.expect(kDriver22);
      const auto seen = parse(parser, bytes + kGood + kGood);
      ASSERT_FALSE(seen.records.empty()) << at << " " << value;
      EXPECT_EQ(values(seen.records.back(), 22).back(), 98) << at << " " << value;
      EXPECT_LE(parser.badPackets(), 2u) << at << " " << value;
      EXPECT_FALSE(parser.inside());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Packets, CybergloveDamage,
    testing::Values(test::NamedPacket{"record", kGood},
                    test::NamedPacket{"record, es", kGood.substr(0, 24) + "es\0"s},
                    test::NamedPacket{"record, es eg", kGood.substr(0, 24) + "eseg\0"s},
                    test::NamedPacket{"another layout", kExample1},
                    test::NamedPacket{"record with time stamp", kExample2},
                    test::NamedPacket{"error reply", "eg\0"s},
                    test::NamedPacket{"too long", std::string(200, 'S') + "\0"s}));

TEST(CybergloveCalibration, IsALineWithAZeroAndASlope) {  // fact sheet, example 1
  CybergloveSettings settings;
  settings.offset[4] = 110;
  settings.gain[4] = 0.0115F;
  GloveSample sample{};
  calibrate(parse(kPlain18, kExample1).records.at(0), slotsOf(kMask18), settings, sample);
  EXPECT_NEAR(sample.angle_rad[4], 0.23, 1e-6);
  EXPECT_EQ(sample.raw[4], 130);
  EXPECT_EQ(sample.sensors, 18u);
}

TEST(CybergloveCalibration, ASpanIsTwoPointsOfIt) {  // fact sheet, example 5
  constexpr float kRightAngle = std::numbers::pi_v<float> / 2;
  constexpr GloveSpan kSpan{110, 0, 167, kRightAngle};
  EXPECT_FLOAT_EQ(kSpan.offset(), 110);
  EXPECT_FLOAT_EQ((167 - kSpan.offset()) * kSpan.gain(), kRightAngle);
}

// The defaults must be the values of the published file. The driver's README.md says which line
// belongs to which slot.
TEST(CybergloveCalibration, TheDefaultsAreThePublishedFile) {
  constexpr GloveSpan kFile[22] = {
      {46, 0.3F, 164, -0.5F}, {73, 0.9F, 181, -0.7F},  {216, -0.5F, 79, -0.2F},
      {74, 0, 98, -0.4F},     {111, 0, 182, -0.9F},    {90, 0, 130, -0.8F},
      {117, 0, 185, -1.5F},   {172, -0.2F, 121, 0.2F}, {69, 0, 198, -1.7F},
      {66, 0, 107, -1.3F},    {93, 0, 161, -1.5F},     {60, 0, 144, 0},
      {62, 0, 199, -1.7F},    {93, 0, 129, -1.3F},     {108, 0, 163, -1.5F},
      {134, 0.27F, 86, 0},    {58, 0, 202, -1.7F},     {73, 0, 122, -1.3F},
      {101, 0, 172, -1.5F},   {139, 0.5F, 55, -0.2F},  {46, 0, 209, -1.7F},
      {91, 0, 135, -1.3F}};
  constexpr std::size_t kValue[22] = {21, 20, 3, 0,  1,  2,  4,  10, 5,  6,  7,
                                      19, 8,  9, 11, 14, 12, 13, 15, 18, 16, 17};
  const CybergloveSettings settings;
  const SlotList slots = slotsOf(kMask22);
  for (std::size_t line = 0; line < 22; ++line) {
    const std::size_t slot = slots.slot[kValue[line]];
    const bool kept = slot == 15 || slot == 19 || slot >= 21;  // abductions, wrist
    if (slot == 20) continue;                                  // the file has no angles for it
    for (const auto& [raw, rad] : {std::pair{kFile[line].raw_a, kFile[line].rad_a},
                                   std::pair{kFile[line].raw_b, kFile[line].rad_b}}) {
      EXPECT_NEAR((raw - settings.offset[slot]) * settings.gain[slot], kept ? rad : -rad, 1e-5)
          << "line " << line << " slot " << slot;
    }
  }
  EXPECT_NEAR((144 - settings.offset[20]) * settings.gain[20], 0.5, 1e-6);
}

TEST(CybergloveCalibration, TheInverseComesBackWithinHalfACount) {
  const CybergloveSettings settings;
  const SlotList slots = slotsOf(kMask22);
  for (int raw = 1; raw < 256; ++raw) {
    Record record;
    record.values.fill(static_cast<std::uint8_t>(raw));
    GloveSample sample{};
    calibrate(record, slots, settings, sample);
    const auto back = rawOf(sample.angle_rad, settings);
    for (std::size_t i = 0; i < slots.count; ++i) EXPECT_EQ(back[slots.slot[i]], raw) << i;
  }
}

TEST(CybergloveCalibration, TheInverseNeverLeavesTheLegalRange) {
  CybergloveSettings settings;
  settings.gain[4] = 0;
  settings.offset[4] = 300;
  for (const float angle : {-100.0F, 0.0F, 100.0F}) {
    std::array<float, kGloveSlots> angles{};
    angles.fill(angle);
    const auto raw = rawOf(angles, settings);
    EXPECT_GE(*std::min_element(raw.begin(), raw.end()), 1);
    EXPECT_EQ(raw[4], 255);
  }
}

TEST(CybergloveCalibration, FillsTheDistalJointsOfAnEighteenSensorGlove) {
  CybergloveSettings settings;
  settings.offset.fill(100);
  settings.gain.fill(0.01F);
  Record record;
  record.values.fill(200);  // 1 rad
  GloveSample sample{};
  calibrate(record, slotsOf(kMask18), settings, sample);
  for (const std::size_t dip : {6u, 10u, 14u, 18u}) {
    EXPECT_NEAR(sample.angle_rad[dip], 0.32 + 0.17, 1e-6) << dip;
    EXPECT_EQ(sample.raw[dip], 0) << dip;
  }
  calibrate(record, slotsOf(kMask22), settings, sample);
  for (const std::size_t dip : {6u, 10u, 14u, 18u}) EXPECT_FLOAT_EQ(sample.angle_rad[dip], 1);
  EXPECT_EQ(sample.sensors, 22u);
}

TEST(CybergloveCalibration, FillsSlot7ByItsRuleUnlessItIsMeasured) {
  CybergloveSettings settings;
  settings.offset.fill(100);
  settings.gain.fill(0.01F);
  Record record;
  record.values.fill(100);
  record.values[3] = 150;   // thumb abduction: 0.5 rad
  record.values[10] = 110;  // slot 11: 0.1 rad
  record.status = 0x82;     // switch on, no glove
  const auto slot7 = [&](Slot7Rule rule, std::uint32_t mask) {
    settings.slot7 = rule;
    GloveSample sample{};
    calibrate(record, slotsOf(mask), settings, sample);
    return sample.angle_rad[7];
  };
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kZero, kMask22), 0);
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kNeutral, kMask22), 0.28F);
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kDerived, kMask22), 0.3F);
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kSwitch, kMask22), 1);
  // With a 23rd sensor, slot 7 is its measurement, here raw count 100.
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kSwitch, 0x7FFFFF), 0);
  record.status = 0x81;
  EXPECT_FLOAT_EQ(slot7(Slot7Rule::kSwitch, kMask22), 0);
}

}  // namespace
}  // namespace merlin::cyberglove
