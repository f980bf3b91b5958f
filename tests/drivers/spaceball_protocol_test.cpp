#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/spaceball/protocol.h"
#include "tests/support/named_packet.h"

namespace merlin::spaceball {
namespace {

using namespace std::string_literals;

struct Seen {
  std::vector<Displacement> displacements;
  std::vector<Keys> keys;
  std::vector<std::string> texts;
};

// Feeds `bytes` to the parser and returns the packets that it found, in order.
Seen parse(Parser& parser, std::string_view bytes) {
  Seen seen;
  for (const char c : bytes) {
    const auto packet = parser.feed(static_cast<std::byte>(c));
    if (!packet) continue;
    if (const auto* d = std::get_if<Displacement>(&*packet)) seen.displacements.push_back(*d);
    if (const auto* k = std::get_if<Keys>(&*packet)) seen.keys.push_back(*k);
    if (const auto* t = std::get_if<Text>(&*packet)) seen.texts.emplace_back(t->line);
  }
  return seen;
}

// Fact sheet, example 2: period 800 (50 ms), X = 256, Y = -512, Z = 1000, A = -1, B = 39, C = -10.
const std::string kGood = "D\x03\x20\x01\x00\xFE\x00\x03\xE8\xFF\xFF\x00\x27\xFF\xF6\r"s;

TEST(SpaceballParser, ReadsADisplacement) {
  Parser parser;
  const auto seen = parse(parser, kGood);
  ASSERT_EQ(seen.displacements.size(), 1u);
  EXPECT_EQ(seen.displacements[0].period, 800);
  EXPECT_EQ(seen.displacements[0].axes,
            (std::array<std::int16_t, 6>{256, -512, 1000, -1, 39, -10}));
  EXPECT_EQ(parser.badPackets(), 0u);
}

TEST(SpaceballParser, EscapesStandForTheirByte) {  // fact sheet, example 3
  Parser parser;
  const auto seen = parse(parser, "D^M^Q^M^M^Q^S^^\0\0^S\xFF\xFF\0\0\r"s);
  ASSERT_EQ(seen.displacements.size(), 1u);
  EXPECT_EQ(seen.displacements[0].period, 3345);
  EXPECT_EQ(seen.displacements[0].axes,
            (std::array<std::int16_t, 6>{3341, 4371, 24064, 19, -1, 0}));
}

TEST(SpaceballParser, ReadsTheBannerPastXonAndLineFeeds) {
  Parser parser;
  const auto seen = parse(parser, "\x11\r@1 Spaceball alive.\r\n@2 Firmware version 2.63\r\n"s);
  EXPECT_EQ(seen.texts,
            (std::vector<std::string>{"@1 Spaceball alive.", "@2 Firmware version 2.63"}));
  EXPECT_EQ(parser.badPackets(), 0u);
}

TEST(SpaceballKeys, OfEachModel) {  // fact sheet, example 4 and section 6
  Parser parser;
  const auto seen = parse(parser, "K\x58\x44\r.\x70\xC0\rK\x60\x50\r"s);
  EXPECT_EQ(seen.keys.size(), 3u);
  // Buttons 3, 8 and pick.
  EXPECT_EQ(buttonsOf(seen.keys[0], Model::k2003), 1u << 2 | 1u << 7 | 1u << 8);
  EXPECT_EQ(buttonsOf({true, 0x70, 0xC0}, Model::k4000), 1u << 6 | 1u << 11);  // buttons 7 and 12
  EXPECT_EQ(buttonsOf({false, 0x60, 0x50}, Model::k3003), 1u | 1u << 2);  // left button and rezero
}

TEST(SpaceballKeys, EncodingIsTheInverseForEveryCombination) {
  const struct {
    Model model;
    int buttons;
  } kModels[] = {{Model::k2003, 9}, {Model::k3003, 3}, {Model::k4000, 12}};
  for (const auto& [model, buttons] : kModels) {
    for (std::uint32_t mask = 0; mask < 1u << buttons; ++mask) {
      Parser parser;
      const auto seen = parse(parser, encodeKeys(mask, model));
      ASSERT_EQ(seen.keys.size(), 1u) << nameOf(model) << " " << mask;
      EXPECT_EQ(buttonsOf(seen.keys[0], model), mask) << nameOf(model);
    }
  }
}

TEST(SpaceballDisplacement, EncodingIsTheInverse) {
  for (int v = -32768; v <= 32767; v += 13) {
    const auto a = static_cast<std::int16_t>(v);
    const Displacement d{{a, 0x0D11, 0x135E, static_cast<std::int16_t>(~a), 0, 1}, 0x0D0D};
    Parser parser;
    const auto seen = parse(parser, encode(d));
    ASSERT_EQ(seen.displacements.size(), 1u) << v;
    EXPECT_EQ(seen.displacements[0].axes, d.axes);
    EXPECT_EQ(seen.displacements[0].period, d.period);
  }
}

// The tests damage one packet of each kind.
class SpaceballDamage : public testing::TestWithParam<test::NamedPacket> {};

// The packet after the next CR must be read, whatever came before: the parser keeps no state.
TEST_P(SpaceballDamage, EveryPrefixCostsAtMostItself) {
  for (std::size_t n = 0; n < GetParam().bytes.size(); ++n) {
    Parser parser;
    const auto seen = parse(parser, GetParam().bytes.substr(0, n) + "\r" + kGood);
    ASSERT_FALSE(seen.displacements.empty()) << n;
    EXPECT_EQ(seen.displacements.back().axes[2], 1000) << n;
    EXPECT_LE(parser.badPackets(), 1u) << n;
  }
}

TEST_P(SpaceballDamage, EveryOneByteDamageCostsAtMostTwoPackets) {
  for (std::size_t at = 0; at < GetParam().bytes.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      std::string bytes = GetParam().bytes;
      bytes[at] = static_cast<char>(value);
      Parser parser;
      const auto seen = parse(parser, bytes + kGood + kGood);
      ASSERT_FALSE(seen.displacements.empty()) << at << " " << value;
      EXPECT_EQ(seen.displacements.back().axes[2], 1000) << at << " " << value;
      EXPECT_LE(parser.badPackets(), 2u) << at << " " << value;
      EXPECT_FALSE(parser.inside());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Packets, SpaceballDamage,
    testing::Values(test::NamedPacket{"displacement", kGood},
                    test::NamedPacket{"escapes", "D^M^Q^M^M^Q^S^^\0\0^S\xFF\xFF\0\0\r"s},
                    test::NamedPacket{"keys", "K\x58\x44\r"s},
                    test::NamedPacket{"keys of a 4000", ".\x60^^\r"s},
                    test::NamedPacket{"reply", "MSSV\r"s},
                    test::NamedPacket{"banner",
                                      "@1 Spaceball alive and well after a software reset.\r"s},
                    test::NamedPacket{"too long", "D" + std::string(200, 'x') + "\r"}));

TEST(SpaceballParser, CountsEveryByteThatItDrops) {
  Parser parser;
  parse(parser, "D\x01\x02\r"s + "xyz\r" + kGood);
  EXPECT_EQ(parser.badPackets(), 2u);
  EXPECT_EQ(parser.badBytes(), 8u);
}

}  // namespace
}  // namespace merlin::spaceball
