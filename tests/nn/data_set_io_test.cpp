#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "nn/io/data_set_file.h"
#include "tests/nn/files.h"
#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

using DataSetFiles = test::FilesTest;

std::string header() {
  return "posture,s0,s1,s2,s3,s4,s5,s6,s7,s8,s9,s10,s11,s12,s13,s14,s15,s16,s17,s18,s19,s20,s21,"
         "s22\n";
}
const std::string kFist = "fist,0,1,2,3,4,5,6,-1,-2,-3,-4,-5,-6,.5,1e-3,0.25,0,0,0,0,0,0,-0.125\n";

TEST(DataSetFormat, ReadsAHandALine) {
  const auto hands = parseDataSet(header() + kFist + kFist, "f.csv");
  ASSERT_TRUE(hands) << hands.error().what;
  ASSERT_EQ(hands->size(), 2u);
  EXPECT_EQ((*hands)[1].posture, "fist");
  EXPECT_EQ((*hands)[1].angle_rad[2], 2.0F);
  EXPECT_EQ((*hands)[1].angle_rad[12], -6.0F);
  EXPECT_EQ((*hands)[1].angle_rad[22], -0.125F);
  EXPECT_EQ(parseDataSet(header(), "f.csv")->size(), 0u);
}

TEST(DataSetFormat, IsItsOwnInverse) {
  const DataSet hands = makeHands(test::shippedShapes(), {.per_shape = 20}, 8);
  const std::string text = formatDataSet(hands);
  EXPECT_TRUE(text.starts_with(header()));
  const auto read = parseDataSet(text, "f");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->size(), hands.size());
  for (std::size_t n = 0; n < hands.size(); ++n) {
    EXPECT_EQ((*read)[n].posture, hands[n].posture);
    EXPECT_EQ((*read)[n].angle_rad, hands[n].angle_rad);
  }
}

TEST(DataSetDamage, ATruncationIsAnErrorOrEndsAfterAWholeLine) {
  const std::string text = header() + kFist + kFist;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool line_end = n > 0 && text[n - 1] == '\n';
    EXPECT_EQ(parseDataSet(text.substr(0, n), "f").ok(), line_end) << n;
  }
}

TEST(DataSetDamage, OneWrongByteNeverLoadsHalf) {
  const std::string good = header() + kFist + kFist;
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      std::string text = good;
      text[at] = static_cast<char>(value);
      const auto read = parseDataSet(text, "f");
      if (!read) continue;
      ASSERT_EQ(read->size(), 2u) << at;
      for (const LabelledHand& hand : *read) {
        ASSERT_TRUE(isPostureName(hand.posture));
        for (const float a : hand.angle_rad) ASSERT_LE(std::abs(a), 6.3F);
      }
    }
  }
}

TEST(DataSetFaults, NameFileLineFoundAndAllowed) {
  const auto error = [](const std::string& text) {
    return parseDataSet(text, "f.csv").error().what;
  };
  const auto hand = [&](const std::string& from, const std::string& to) {
    std::string line = kFist;
    return error(header() + kFist + line.replace(line.find(from), from.size(), to));
  };
  const std::string angle = "; allowed: an angle in radians, -6.3 to 6.3";
  EXPECT_EQ(error(""),
            "f.csv:1: found no end of the line; allowed: lines that end with a line feed");
  EXPECT_EQ(error(header() + kFist + "fist,0"),
            "f.csv:3: found no end of the line; allowed: lines that end with a line feed");
  EXPECT_TRUE(
      error("s0,posture\n").starts_with("f.csv:1: found \"s0,posture\"; allowed: posture,s0,"));
  EXPECT_EQ(hand("1e-3", "1e-3x"), "f.csv:3: found s14 \"1e-3x\"" + angle);
  EXPECT_EQ(hand("0.25", "nan"), "f.csv:3: found s15 \"nan\"" + angle);
  EXPECT_EQ(hand("0.25", "inf"), "f.csv:3: found s15 \"inf\"" + angle);
  EXPECT_EQ(hand("0.25", "1e999"), "f.csv:3: found s15 \"1e999\"" + angle);
  EXPECT_EQ(hand("0.25", "90"), "f.csv:3: found s15 \"90\"" + angle);
  EXPECT_EQ(hand("0.25", ""), "f.csv:3: found s15 \"\"" + angle);
  EXPECT_EQ(hand("-0.125", "-0.125\r"), "f.csv:3: found s22 \"-0.125\\x0D\"" + angle);
  EXPECT_EQ(hand(",-0.125", ""),
            "f.csv:3: found 23 fields; allowed: 24: the posture and 23 angles");
  EXPECT_EQ(hand("-0.125", "0,"),
            "f.csv:3: found 25 fields; allowed: 24: the posture and 23 angles");
  EXPECT_EQ(hand("fist", ""),
            "f.csv:3: found posture \"\"; allowed: 1 to 19 letters, digits, - or _");
  EXPECT_EQ(error(header() + "\n"),
            "f.csv:2: found posture \"\"; allowed: 1 to 19 letters, digits, - or _");
}

TEST_F(DataSetFiles, AreReplacedWholeOrNotAtAll) {
  const std::string file = path("hands.csv");
  DataSet hands = makeHands(test::shippedShapes(), {.per_shape = 2}, 9);
  ASSERT_TRUE(saveDataSet(file, hands));
  const auto read = loadDataSet(file);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(formatDataSet(*read), formatDataSet(hands));

  hands[3].angle_rad[5] = std::numeric_limits<float>::infinity();
  const auto refused = saveDataSet(file, hands);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_TRUE(refused.error().what.starts_with("not written: " + file + ":5: found s5 \"inf\""));
  EXPECT_EQ(test::contentOf(file), formatDataSet(*read));
  EXPECT_EQ(count(), 1u);
  EXPECT_EQ(loadDataSet(path("none.csv")).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace merlin::nn
