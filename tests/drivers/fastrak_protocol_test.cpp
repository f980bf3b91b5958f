#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "drivers/fastrak/protocol.h"
#include "tests/support/named_packet.h"

namespace merlin::fastrak {
namespace {

using namespace std::string_literals;

// Feeds `bytes`, each 1 ns after the previous one; returns the records that the parser found.
std::vector<Record> parse(Parser& parser, std::string_view bytes) {
  std::vector<Record> records;
  std::int64_t ns = 0;
  for (const char c : bytes) {
    if (const auto r = parser.feed(static_cast<std::byte>(c), ns++)) records.push_back(*r);
  }
  return records;
}

// Fact sheet, example 1: station 1, inches, list 2,11,0.
const std::string kGood =
    "\x30\x31\x20\x00\x00\x20\x41\x00\x00\xB0\xC0\x00\x00\x50\x40"
    "\xF3\x04\x35\x3F\x00\x00\x00\x00\x00\x00\x00\x00\xF3\x04\x35\x3F\x20"s;

void expectGood(const Record& r) {
  EXPECT_EQ(r.station, 1);
  EXPECT_EQ(r.error, ' ');
  EXPECT_EQ(r.position, (std::array{10.0F, -5.5F, 3.25F}));
  EXPECT_NEAR(r.orientation_wxyz[0], 0.70711, 1e-5);
  EXPECT_EQ(r.orientation_wxyz[1], 0);
  EXPECT_EQ(r.orientation_wxyz[2], 0);
  EXPECT_NEAR(r.orientation_wxyz[3], 0.70711, 1e-5);
}

// Returns kGood with another orientation.
std::string withQuaternion(const std::array<float, 4>& q) {
  std::string bytes = kGood.substr(0, 15);
  for (const float v : q) appendLeFloat(bytes, v);
  return bytes + " ";
}

TEST(FastrakParser, ReadsARecordWithItsLastByte) {
  Parser parser;
  const auto records = parse(parser, kGood);
  ASSERT_EQ(records.size(), 1u);
  expectGood(records[0]);
  EXPECT_EQ(records[0].received_ns, 0);
  EXPECT_EQ(parser.badBytes(), 0u);
}

TEST(FastrakParser, StampsEachRecordWithItsOwnFirstByte) {
  Parser parser;
  const auto records = parse(parser, kGood + "??" + kGood + kGood + kGood);
  ASSERT_EQ(records.size(), 4u);
  EXPECT_EQ(records[1].received_ns, 34);
  EXPECT_EQ(records[2].received_ns, 66);
  EXPECT_EQ(records[3].received_ns, 98);
}

TEST(FastrakParser, TakesErrorLettersAndEveryStation) {
  for (char station = '1'; station <= '4'; ++station) {
    for (const char error : {' ', 'a', 'k', 'Z'}) {
      std::string bytes = kGood;
      bytes[1] = station;
      bytes[2] = error;
      Parser parser;
      const auto records = parse(parser, bytes);
      ASSERT_EQ(records.size(), 1u);
      EXPECT_EQ(records[0].station, station - '0');
      EXPECT_EQ(records[0].error, error);
    }
  }
}

TEST(FastrakParser, RefusesWhatIsNoRotation) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const struct {
    std::array<float, 4> q;
    std::size_t records;
  } kCases[] = {{{0, 0, 0.981F, 0}, 1}, {{0, 1.019F, 0, 0}, 1}, {{0.979F, 0, 0, 0}, 0},
                {{0, 0, 0, 1.021F}, 0}, {{0, 0, 0, 0}, 0},      {{nan, 0, 0, 1}, 0}};
  for (const auto& [q, count] : kCases) {
    Parser parser;
    EXPECT_EQ(parse(parser, withQuaternion(q)).size(), count) << q[0] << q[1] << q[2] << q[3];
  }
}

TEST(FastrakParser, RefusesPositionsThatAreNoNumbers) {
  std::string bytes = kGood;
  bytes.replace(3, 4, "\x00\x00\x80\x7F"s);  // infinity
  Parser parser;
  EXPECT_TRUE(parse(parser, bytes).empty());
}

TEST(FastrakParser, FindsRecordsAmongGarbageAndCountsEveryByteOfIt) {
  Parser parser;
  // VRPN resynchronises after the same eight bytes (fact sheet, section 7).
  const std::string garbage = "\x30\x31\x07\x6A\x75\x6E\x6B\x30"s;
  const auto records = parse(parser, garbage + kGood + kGood + "2 E*ERROR*" + kGood + kGood);
  ASSERT_EQ(records.size(), 4u);
  for (const Record& r : records) expectGood(r);
  EXPECT_EQ(parser.badBytes(), 8u + 10);
  EXPECT_EQ(parser.badPackets(), 2u);
}

TEST(FastrakParser, OutOfStepItWaitsForTheNextRecordsFirstByte) {
  Parser parser;
  EXPECT_TRUE(parse(parser, "x" + kGood).empty());
  // The record is accepted once the next record's first byte comes.
  EXPECT_EQ(parse(parser, "0").size(), 1u);
  EXPECT_EQ(parse(parser, kGood.substr(1)).size(), 1u);  // in step, so accepted at once
  // The record is rejected, since the byte after it does not begin a record.
  EXPECT_TRUE(parse(parser, "x" + kGood + "x").empty());
  parser.reset();
  EXPECT_EQ(parse(parser, kGood).size(), 1u);
}

TEST(FastrakParser, EncodingIsTheInverse) {
  for (int i = 0; i < 1000; ++i) {
    Record record;
    record.station = 1 + i % 4;
    record.error = i % 7 ? ' ' : 'k';
    const float angle = 0.01F * static_cast<float>(i);
    record.position = {angle * 30 - 150, -angle, 1 / (angle + 1)};
    record.orientation_wxyz = {std::cos(angle), 0, std::sin(angle), 0};
    Parser parser;
    const auto records = parse(parser, encode(record, kDriverList, {}));
    ASSERT_EQ(records.size(), 1u) << i;
    EXPECT_EQ(records[0].station, record.station);
    EXPECT_EQ(records[0].error, record.error);
    EXPECT_EQ(records[0].position, record.position);
    EXPECT_EQ(records[0].orientation_wxyz, record.orientation_wxyz);
  }
}

// The tests damage one packet of each kind that can occur in a stream.
class FastrakDamage : public testing::TestWithParam<test::NamedPacket> {};

TEST_P(FastrakDamage, EveryPrefixCostsItselfAlone) {
  for (std::size_t n = 0; n < GetParam().bytes.size(); ++n) {
    Parser parser;
    const auto records = parse(parser, GetParam().bytes.substr(0, n) + kGood + kGood + "0");
    ASSERT_EQ(records.size(), 2u) << n;
    for (const Record& r : records) expectGood(r);
    EXPECT_EQ(parser.badBytes(), n);
    EXPECT_EQ(parser.badPackets(), n > 0 ? 1u : 0u);
  }
}

TEST_P(FastrakDamage, EveryOneByteDamageCostsItselfAlone) {
  for (std::size_t at = 0; at < GetParam().bytes.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      std::string bytes = GetParam().bytes;
      bytes[at] = static_cast<char>(value);
      Parser parser;
      const auto records = parse(parser, bytes + kGood + kGood + "0");
      ASSERT_GE(records.size(), 2u) << at << " " << value;
      expectGood(records[records.size() - 2]);
      expectGood(records.back());
      EXPECT_LE(parser.badPackets(), 1u) << at << " " << value;
      EXPECT_LE(parser.badBytes(), GetParam().bytes.size()) << at << " " << value;
    }
  }
}

std::string turned() {
  Record record;
  record.station = 3;
  record.position = {-30.48F, 48.0F, 0.1F};
  record.orientation_wxyz = {0.653281F, 0.270598F, -0.092296F, 0.701057F};
  return encode(record, kDriverList, {});
}

INSTANTIATE_TEST_SUITE_P(Packets, FastrakDamage,
                         testing::Values(test::NamedPacket{"record", kGood},
                                         test::NamedPacket{"turned record", turned()},
                                         test::NamedPacket{"status", encode(Status{})},
                                         test::NamedPacket{"stations", encode(Stations{true}, 1)},
                                         test::NamedPacket{
                                             "ASCII record",
                                             encode(Record{}, kDefaultList, {.binary = false})},
                                         test::NamedPacket{"zeros", std::string(200, '0')},
                                         test::NamedPacket{"heads", "01 01 01 01 01 "}));

TEST(FastrakEncode, AnglesInBinary) {  // fact sheet, example 2
  Record record;
  record.station = 2;
  record.position = {25.4F, 0, -12.7F};
  record.orientation_wxyz = {0.653281F, 0.270598F, -0.092296F, 0.701057F};
  const auto angles = anglesOf(record.orientation_wxyz);
  EXPECT_NEAR(angles[0], 90, 1e-3);
  EXPECT_NEAR(angles[1], -30, 1e-3);
  EXPECT_NEAR(angles[2], 15, 1e-3);
  const std::string bytes = encode(record, kDefaultList, {});
  ASSERT_EQ(bytes.size(), 29u);
  EXPECT_EQ(bytes.substr(0, 15), "\x30\x32\x20\x33\x33\xCB\x41\x00\x00\x00\x00\x33\x33\x4B\xC1"s);
  EXPECT_EQ(bytes.substr(27), "\r\n");
  const float expected[] = {90, -30, 15};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data()) + 15 + 4 * i;
    EXPECT_NEAR(loadLeFloat(p), expected[i], 1e-3);
  }
}

TEST(FastrakEncode, TheDefaultAsciiRecord) {  // fact sheet, example 3
  Record record;
  record.position = {10, -5.5F, 3.25F};
  record.orientation_wxyz = {0.653281F, 0.270598F, -0.092296F, 0.701057F};
  EXPECT_EQ(encode(record, kDefaultList, {.binary = false, .centimetres = false}),
            "01   10.00  -5.50   3.25  90.00 -30.00  15.00\r\n");
}

TEST(FastrakEncode, SixteenBitNumbers) {  // fact sheet, example 4
  Record record;
  record.position = {100, -50, 10};
  constexpr int kList[] = {18, 20, 0};
  EXPECT_EQ(encode(record, kList, {}),
            "01 \xAB\x15\x2B\x75\x11\x02"
            "\x7F\x3F\x00\x00\x00\x00\x00\x00 "s);
  constexpr int kLongest[] = {18, 19};
  EXPECT_EQ(encode(record, kLongest, {}).size(), 15u);
}

TEST(FastrakEncode, LengthsOfTheUsualLists) {  // fact sheet, section 4
  const auto length = [](std::vector<int> list, bool binary) {
    return encode(Record{}, list, {.binary = binary}).size();
  };
  EXPECT_EQ(length({2, 4, 1}, true), 29u);
  EXPECT_EQ(length({2, 4, 1}, false), 47u);
  EXPECT_EQ(length({2, 11, 0}, true), 32u);
  EXPECT_EQ(length({2, 11, 16, 0}, true), 34u);
  EXPECT_EQ(length({2, 11, 1}, true), 33u);
  EXPECT_EQ(length({2, 4, 16, 1}, true), 31u);
  EXPECT_EQ(length({2, 4, 16, 1}, false), 49u);
}

const std::string kStatus = "21S3F0  0        3.00OutputCompensat CPG2030-003-10  \r\n";

TEST(FastrakStatus, ReadsAndWritesTheExample) {  // fact sheet, example 5
  ASSERT_EQ(kStatus.size(), 55u);
  const auto status = parseStatus(kStatus);
  ASSERT_TRUE(status);
  EXPECT_FALSE(status->binary || status->centimetres || status->compensation || status->continuous);
  EXPECT_EQ(status->test_error, 0);
  EXPECT_EQ(status->firmware, "3.00");
  EXPECT_EQ(status->configuration, "OutputCompensat CPG2030-003-10");
  EXPECT_EQ(encode(*status), kStatus);
}

TEST(FastrakStatus, FlagsComeBack) {  // 3F1 binary, 3F2 centimetres, 3F8 continuous, 3FF all on
  for (int flags = 0; flags < 16; ++flags) {
    const Status sent{(flags & 1) != 0,
                      (flags & 2) != 0,
                      (flags & 4) != 0,
                      (flags & 8) != 0,
                      flags,
                      "2.10",
                      "lab"};
    const std::string bytes = encode(sent);
    EXPECT_EQ(bytes.substr(3, 3), "3F"s + "0123456789ABCDEF"[flags]);
    const auto got = parseStatus(bytes);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->binary, sent.binary);
    EXPECT_EQ(got->centimetres, sent.centimetres);
    EXPECT_EQ(got->compensation, sent.compensation);
    EXPECT_EQ(got->continuous, sent.continuous);
    EXPECT_EQ(got->test_error, flags);
  }
}

// Returns kGood with another position.
std::string withPosition(const std::array<float, 3>& position) {
  std::string bytes = kGood.substr(0, 3);
  for (const float v : position) appendLeFloat(bytes, v);
  return bytes + kGood.substr(15);
}

TEST(FastrakParser, TakesAPlaceThatNoReceiverCanHaveForDamage) {
  for (const float good : {-500.0F, 0.0F, 499.0F, 500.0F}) {
    Parser parser;
    EXPECT_EQ(parse(parser, withPosition({0, good, 0})).size(), 1u) << good;
  }
  for (const float bad : {500.1F, -501.0F, 1e6F, 1e10F, 1e30F, 3e38F, -3e38F}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<float, 3> position{};
      position[axis] = bad;
      Parser parser;
      const auto records = parse(parser, withPosition(position) + kGood + kGood);
      ASSERT_EQ(records.size(), 2u) << bad;
      expectGood(records[0]);
      EXPECT_EQ(parser.badPackets(), 1u) << bad;
      EXPECT_EQ(parser.badBytes(), 32u) << bad;
    }
  }
}

TEST(FastrakParser, OfDecimalsTheSame) {
  Parser parser;
  parser.expect({.numbers = Layout::Numbers::kText, .angles = true});
  const auto record = [](const char* place, const char* roll) {
    return "01 "s + place + "   0.00   0.00   0.00   0.00" + roll + " ";
  };
  EXPECT_EQ(parse(parser, record("-500.00", "-180.00")).size(), 1u);
  EXPECT_EQ(parse(parser, record("9999999", "   0.00")).size(), 0u);
  parser.reset();
  EXPECT_EQ(parse(parser, record("   0.00", " 181.00")).size(), 0u);
}

TEST(FastrakStatus, RefusesWhatIsNone) {
  for (std::size_t n = 0; n < kStatus.size(); ++n) EXPECT_FALSE(parseStatus(kStatus.substr(0, n)));
  for (const std::size_t at : {0u, 1u, 2u, 3u, 5u, 7u, 53u, 54u}) {
    std::string bytes = kStatus;
    bytes[at] = '!';
    EXPECT_FALSE(parseStatus(bytes)) << at;
  }
  std::string blank = kStatus;
  blank[8] = ' ';
  EXPECT_EQ(parseStatus(blank)->test_error, 0);  // as from an older unit
}

TEST(FastrakStations, ReadsAndWritesTheExample) {  // fact sheet, section 2
  EXPECT_EQ(parseStations("21l1000\r\n"), (Stations{true, false, false, false}));
  EXPECT_EQ(encode(Stations{true, true, false, true}, 2), "22l1101\r\n");
  const std::string good = "21l1000\r\n";
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_FALSE(parseStations(good.substr(0, n))) << n;
    std::string bytes = good;
    bytes[n] = '!';
    EXPECT_FALSE(parseStations(bytes)) << n;
  }
}

}  // namespace
}  // namespace merlin::fastrak
