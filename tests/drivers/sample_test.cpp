// The driver that is the template for a new device: its protocol and its dialogue.
#include <gtest/gtest.h>

#include "drivers/sample/device.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"

namespace merlin::sample {
namespace {

std::vector<Record> parse(Parser& parser, std::string_view bytes) {
  std::vector<Record> records;
  for (const char c : bytes) {
    if (const auto record = parser.feed(static_cast<std::byte>(c))) records.push_back(*record);
  }
  return records;
}

const std::string kGood = "0 0 500 0 0 -20 1\n";

TEST(SampleParser, ReadsARecord) {
  Parser parser;
  const auto records = parse(parser, kGood);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].axes, (std::array<int, 6>{0, 0, 500, 0, 0, -20}));
  EXPECT_EQ(records[0].buttons, 1u);
  EXPECT_EQ(encode(records[0]), kGood);
}

TEST(SampleParser, EveryPrefixCostsAtMostItself) {
  for (std::size_t n = 0; n < kGood.size(); ++n) {
    Parser parser;
    const auto records = parse(parser, kGood.substr(0, n) + "\n" + kGood);
    ASSERT_FALSE(records.empty()) << n;
    EXPECT_EQ(records.back().axes[2], 500) << n;
    EXPECT_LE(parser.badPackets(), 1u) << n;
  }
}

TEST(SampleParser, EveryDamagedByteCostsAtMostTwoRecords) {
  for (std::size_t at = 0; at < kGood.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      Parser parser;
      std::string damaged = kGood;
      damaged[at] = static_cast<char>(value);
      const auto records = parse(parser, damaged + kGood + kGood);
      ASSERT_GE(records.size(), 1u) << at << ' ' << value;
      ASSERT_EQ(records.back().axes[2], 500);
      ASSERT_LE(parser.badPackets(), 2u);
    }
  }
}

TEST(SampleDevice, SaysHelloAndStreams) {
  test::FakeClock clock;
  test::RecordingSink sink;
  test::FakeStream stream(clock, nullptr);
  SampleDevice device(clock, sink);
  stream.feed("made-up ball 1\n");
  const auto identity = device.open(stream);
  ASSERT_TRUE(identity);
  EXPECT_EQ(*identity, "made-up ball 1");
  EXPECT_EQ(stream.written(), "HELLO\n");
  stream.feed(kGood + "rubbish\n" + kGood);
  ASSERT_TRUE(device.poll(stream));
  ASSERT_EQ(sink.ball.size(), 2u);
  EXPECT_FLOAT_EQ(sink.ball[1].translation[2], 0.5F);
  EXPECT_EQ(sink.ball[1].counter, 2u);
  EXPECT_EQ(device.counters().bad_packets, 1u);
}

TEST(SampleDevice, FailsAfterASecondOfSilence) {
  test::FakeClock clock;
  test::RecordingSink sink;
  test::FakeStream stream(clock, nullptr);
  SampleDevice device(clock, sink);
  EXPECT_EQ(device.open(stream).error().code, Errc::kTimeout);
  stream.feed("ball\n");
  ASSERT_TRUE(device.open(stream));
  int polls = 0;
  while (device.poll(stream)) ++polls;
  EXPECT_EQ(polls, 3);  // each waited 0.25 s
}

}  // namespace
}  // namespace merlin::sample
