// The CyberGlove's ASCII dialogue, following the fact sheet, sections 2.4 and 4. What the sheet
// does not specify is inferred (drivers/cyberglove/README.md).
#include <algorithm>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "drivers/cyberglove/device.h"
#include "drivers/cyberglove/text.h"
#include "tests/support/count_allocations.h"
#include "tests/support/device_bench.h"

namespace merlin::cyberglove {
namespace {

using namespace std::string_literals;
using std::chrono::seconds;

TEST(CybergloveText, IsTheSameDialogueInDecimals) {
  const std::pair<std::string, std::string> same[] = {{"U\x01", "u 1"},
                                                      {"T\x04\x80\x00\x01"s, "t 1152 1"},
                                                      {"M\x7F\xFF\x7F", "m 127 255 127"},
                                                      {"?N", "?n"},
                                                      {"?N\x16", "?n 22"},
                                                      {"?D\0"s, "?d 0"},
                                                      {"?T\x04\x80\x00\x01"s, "?t 1152 1"},
                                                      {"S", "s"},
                                                      {"en", "e n"},
                                                      {"?i", "?i"},
                                                      {"\x03", "\x03"}};
  for (const auto& [binary, text] : same) {
    EXPECT_EQ(asText(binary), text);
    EXPECT_EQ(ofText(text), binary) << text;
    EXPECT_EQ(ofText(text + "\r\n"), binary) << text;
  }
  for (const char* wrong : {"u 256", "u -1", "u x", "u1", "t 65536 1", "U 1", "n 22,3", "5"})
    EXPECT_FALSE(ofText(wrong)) << wrong;
  for (const char* text : {"u", "?n", "t 1152"}) EXPECT_TRUE(isText(text)) << text;
  for (const char* binary : {"", "U", "?", "?N", "?i", "?v", "??", "\x03"})
    EXPECT_FALSE(isText(binary)) << binary;
}

constexpr Layout kThree{3, true, true, true};
const std::string kRecord = "s 101 7 255 66051 131 es eg\r\n\0"s;

std::vector<Packet> parse(Parser& parser, const std::string& bytes) {
  std::vector<Packet> packets;
  for (const char c : bytes) {
    if (const auto packet = parser.feed(static_cast<std::byte>(c))) packets.push_back(*packet);
  }
  return packets;
}

TEST(CybergloveText, ARecordIsReadAndWrittenAlike) {
  Parser parser;
  parser.expect(kThree);
  const auto packets = parse(parser, kRecord + "e y\r\n\0"s);
  ASSERT_EQ(packets.size(), 2u);
  const auto& record = std::get<Record>(packets[0]);
  EXPECT_EQ(record.values[0], 101);
  EXPECT_EQ(record.values[2], 255);
  EXPECT_EQ(record.timestamp, 66051u);
  EXPECT_EQ(record.status, 131);
  EXPECT_TRUE(record.too_fast && record.unplugged);
  EXPECT_FALSE(record.single);
  EXPECT_EQ(std::get<Refusal>(packets[1]).code, 'y');
  EXPECT_EQ(encode(record, kThree), kRecord);
}

// The buffer holds the longest possible record, so no allocation is needed.
TEST(CybergloveText, TheLongestRecordFits) {
  Record record;
  record.values.fill(200);
  record.timestamp = 4'000'000'000U;
  record.status = 0x87;
  record.too_fast = record.unplugged = true;
  const Layout all{kSlots, true, true, true};
  const std::string bytes = encode(record, all);
  Parser parser;
  parser.expect(all);
  std::size_t records = 0;
  const long before = test::allocations;
  for (const char c : bytes) records += parser.feed(static_cast<std::byte>(c)).has_value();
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_EQ(records, 1u);
}

TEST(CybergloveText, EveryPrefixAndEveryDamagedByteIsSurvived) {
  for (std::size_t cut = 0; cut < kRecord.size(); ++cut) {
    Parser parser;
    parser.expect(kThree);
    const auto packets = parse(parser, kRecord.substr(0, cut) + "\0"s + kRecord);
    ASSERT_FALSE(packets.empty());
    EXPECT_EQ(std::get<Record>(packets.back()).values[0], 101) << "cut at " << cut;
  }
  for (std::size_t at = 0; at < kRecord.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string damaged = kRecord;
      damaged[at] = static_cast<char>(byte);
      Parser parser;
      parser.expect(kThree);
      const auto packets = parse(parser, damaged + "\0"s + kRecord);
      ASSERT_FALSE(packets.empty());
      EXPECT_EQ(std::get<Record>(packets.back()).timestamp, 66051u) << at << ", " << byte;
    }
  }
}

struct TextGlove : test::DeviceBench {
  explicit TextGlove(CybergloveSettings::Dialogue dialogue)
      : DeviceBench("cyberglove", {.baud = 115200}, "still") {
    CybergloveSettings settings;
    settings.dialogue = dialogue;
    device = makeDevice(settings, clock, sink);
  }
  std::unique_ptr<Device> device;
};

TEST(CybergloveText, TheDeviceSpeaksItAndMeasuresTheSame) {
  TextGlove text(CybergloveSettings::Dialogue::kText);
  TextGlove binary(CybergloveSettings::Dialogue::kBinary);
  for (TextGlove* glove : {&text, &binary}) {
    const auto opened = glove->device->open(glove->stream);
    ASSERT_TRUE(opened) << opened.error().what;
    EXPECT_EQ(*opened, "CyberGlove, 22 sensors");
    ASSERT_TRUE(glove->pollFor(*glove->device, seconds(2)));
    EXPECT_NEAR(static_cast<double>(glove->sink.glove.size()), 200, 1);
    EXPECT_EQ(glove->device->counters().bad_bytes, 0u);
  }
  EXPECT_EQ(text.stream.written(),
            "\x03?i\r?g\r?s\r?k\rm 127 255 127\rn 22\ru 1\rd 0\rf 1\rj 1\rt 1152 1\rs\r");
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_TRUE(std::ranges::equal(text.sink.glove[i].raw, binary.sink.glove[i].raw)) << i;
}

TEST(CybergloveText, TheEmulatorRefusesWhatItDoesNotKnow) {
  TextGlove glove(CybergloveSettings::Dialogue::kText);
  const auto answer = [&](const std::string& command) {
    std::string out;
    const auto bytes = std::as_bytes(std::span(command));
    glove.emulator->receive(bytes, glove.clock.now());
    glove.emulator->advance(glove.clock.now(), out);
    return out;
  };
  EXPECT_EQ(answer("u 2\r"), "e n\r\n\0"s);
  EXPECT_EQ(answer("u\r"), "e n\r\n\0"s) << "a number is missing";
  EXPECT_EQ(answer("x\r"), "e ?\r\n\0"s);
  EXPECT_EQ(answer("n 2\x03"), "\x03\r\n\0"s) << "whoever began the line is gone";
  EXPECT_EQ(answer("?n\rN\x05?n\r"), "?n 22\r\n\0N\0?n 5\r\n\0"s) << "each in its own dialogue";
}

}  // namespace
}  // namespace merlin::cyberglove
