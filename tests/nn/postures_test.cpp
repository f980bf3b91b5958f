#include "nn/postures.h"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/nn/shipped.h"
#include "tests/support/count_allocations.h"

namespace merlin::nn {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(PostureName, HasOneToNineteenSafeCharacters) {
  EXPECT_TRUE(isPostureName("thumb-up"));
  EXPECT_TRUE(isPostureName("A_9"));
  EXPECT_TRUE(isPostureName("1234567890123456789"));
  EXPECT_FALSE(isPostureName("12345678901234567890"));
  for (const char* name : {"", "two words", "a,b", "a\"b", "f\xC3\xBC"}) {
    EXPECT_FALSE(isPostureName(name)) << name;
  }
}

TEST(PostureTable, NamesACodeAndFindsIt) {
  PostureTable table;
  EXPECT_TRUE(table.add(31, "1234567890123456789"));
  EXPECT_TRUE(table.add(0, "rest"));
  EXPECT_EQ(table.name(31), "1234567890123456789");
  EXPECT_EQ(table.name(0), "rest");
  EXPECT_EQ(table.name(5), "");
  EXPECT_EQ(table.name(32), "");
  EXPECT_EQ(table.code("rest"), 0U);
  EXPECT_EQ(table.code("fist"), std::nullopt);
  EXPECT_EQ(table.code(""), std::nullopt);
  EXPECT_EQ(table.size(), 2u);
}

TEST(PostureTable, RefusesWhatIsAmbiguous) {
  PostureTable table;
  ASSERT_TRUE(table.add(3, "open"));
  EXPECT_EQ(table.add(32, "fist").error().what, "code 32; allowed: 0 to 31");
  EXPECT_EQ(table.add(3, "fist").error().what, "code 00011 is both \"open\" and \"fist\"");
  EXPECT_EQ(table.add(5, "open").error().what, "name \"open\" has two codes, 00011 and 00101");
  EXPECT_EQ(table.add(5, "a b").error().what,
            "name \"a b\" of code 00101; allowed: 1 to 19 letters, digits, - or _");
  EXPECT_EQ(table.size(), 1u);
}

TEST(Codes, AreWrittenWithOutputZeroLast) {
  EXPECT_EQ(formatCode(0b00001), "00001");
  EXPECT_EQ(formatCode(0b10010), "10010");
  for (std::uint32_t code = 0; code < kCodes; ++code) EXPECT_EQ(parseCode(formatCode(code)), code);
  for (const char* digits : {"", "0001", "000011", "0002 ", "abcde"}) {
    EXPECT_EQ(parseCode(digits), std::nullopt) << digits;
  }
}

Recognition recognise(const PostureNetwork& network, const Angles& value) {
  // A result refers to the recogniser's names, so the recogniser must outlive it.
  static std::vector<std::unique_ptr<Recogniser>> kept;
  return (*kept.emplace_back(std::make_unique<Recogniser>(network)))(value);
}

TEST(Recognise, SaysCodeActivationsAndName) {
  PostureNetwork network;  // all weights are 0; only the biases of outputs 1 and 4 are set below
  network.weights.output[1][kHidden] = 3;
  network.weights.output[4][kHidden] = 0.1F;
  network.weights.output[0][kHidden] = -0.1F;
  ASSERT_TRUE(network.postures.add(0b10010, "hook"));
  const Recognition r = recognise(network, {});
  EXPECT_EQ(r.code, 0b10010U);
  EXPECT_EQ(r.name, "hook");
  EXPECT_FLOAT_EQ(r.activation[1], 0.95257413F);
  EXPECT_FLOAT_EQ(r.activation[2], 0.5F);
}

TEST(Recognise, ScalesByTheNetworksOwnRanges) {
  PostureNetwork network;
  network.weights.hidden[0][4] = 100;
  // The hidden node is on if the index MCP angle is above the middle of its range.
  network.weights.hidden[0][kInputs] = -50;
  network.weights.output[0][0] = 100;
  network.weights.output[0][kHidden] = -50;
  Angles angles{};
  angles[4] = 0.8F;
  EXPECT_EQ(recognise(network, angles).code, 1U);  // 0.8 is above the middle of the range 0..1.5
  network.ranges[4].high = 2.0F;
  EXPECT_EQ(recognise(network, angles).code, 0U);
}

TEST(Recognise, KnowsEveryShippedShape) {
  const PostureNetwork network = test::shippedNetwork();
  for (const hand::Shape& shape : hand::shapes())
    EXPECT_EQ(recognise(network, shape.angle_rad).name, shape.name);
}

TEST(Recognise, AnAngleThatIsNotFiniteIsNeverAPosture) {
  PostureNetwork network;  // all weights are 0: every hand gives code 0
  ASSERT_TRUE(network.postures.add(0, "rest"));
  ASSERT_EQ(recognise(network, {}).name, "rest");
  for (std::size_t i = 0; i < kInputs; ++i) {
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
      Angles angles{};
      angles[i] = bad;
      const Recognition r = recognise(network, angles);
      EXPECT_EQ(r.name, "") << i;
      EXPECT_EQ(r.code, 0U);
      for (const float v : r.activation) EXPECT_TRUE(std::isnan(v));
    }
  }
}

TEST(Recognise, SaysHowSureItIs) {
  PostureNetwork network;
  for (auto& row : network.weights.output) row[kHidden] = 10;
  network.weights.output[3][kHidden] = 0;
  EXPECT_NEAR(recognise(network, {}).margin, 0, 1e-6);
  network.weights.output[3][kHidden] = -10;
  EXPECT_GT(recognise(network, {}).margin, 0.99F);
}

TEST(Recognise, AllocatesNothing) {
  const Recogniser shipped(test::shippedNetwork());
  const long before = merlin::test::allocations;
  std::size_t letters = 0;
  for (const hand::Shape& shape : hand::shapes()) letters += shipped(shape.angle_rad).name.size();
  EXPECT_EQ(merlin::test::allocations, before);
  EXPECT_EQ(letters, 42u);
}

}  // namespace
}  // namespace merlin::nn
