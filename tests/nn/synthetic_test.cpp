#include "nn/synthetic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kIndexMcp = 4, kIndexPip = 5, kPinkyPip = 17;

struct Moments {
  double mean, deviation, least, most;
};

Moments momentsOf(const DataSet& hands, std::size_t slot) {
  double sum = 0, squares = 0, least = 1e9, most = -1e9;
  for (const LabelledHand& hand : hands) {
    const double a = double{hand.angle_rad[slot]};
    sum += a;
    squares += a * a;
    least = std::min(least, a);
    most = std::max(most, a);
  }
  const double n = static_cast<double>(hands.size());
  return {sum / n, std::sqrt(squares / n - sum * sum / n / n), least, most};
}

HandShape straight(float angle_rad) {
  HandShape shape{"straight", {}};
  shape.angle_rad.fill(angle_rad);
  return shape;
}

TEST(Synthetic, MakesAsManyOfEachShapeAsAsked) {
  const auto shapes = test::shippedShapes();
  const DataSet hands = makeHands(shapes, {.per_shape = 3}, 1);
  ASSERT_EQ(hands.size(), 24u);
  for (std::size_t n = 0; n < hands.size(); ++n) EXPECT_EQ(hands[n].posture, shapes[n / 3].name);
}

TEST(Synthetic, OneSeedGivesOneSet) {
  const auto shapes = test::shippedShapes();
  const DataSet a = makeHands(shapes, {}, 1), b = makeHands(shapes, {}, 1);
  const DataSet other = makeHands(shapes, {}, 2);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) ASSERT_EQ(a[n].angle_rad, b[n].angle_rad);
  EXPECT_NE(a[0].angle_rad, other[0].angle_rad);
}

TEST(Synthetic, AJointVariesByItsShareOfItsSpan) {
  const HandShape shapes[] = {straight(0.0F)};  // 0: the stiffness scales nothing
  const DataSet hands = makeHands(shapes, {.per_shape = 20000}, 3);
  const Moments mcp = momentsOf(hands, kIndexMcp);
  EXPECT_NEAR(mcp.mean, 0.0, 0.004);
  EXPECT_NEAR(mcp.deviation, 0.1214, 0.003);  // 0.08 x 1.5, and the sensor's 0.0178 on top
}

TEST(Synthetic, OneStiffnessBendsAllJointsOfAHand) {
  const HandShape shapes[] = {straight(1.0F)};
  const SyntheticSettings settings{
      .per_shape = 5000, .joint_sigma = 0, .sensor_sigma = 0, .counts = 100000};
  const DataSet hands = makeHands(shapes, settings, 4);
  EXPECT_NEAR(momentsOf(hands, kIndexPip).deviation, 0.08, 0.003);
  for (const LabelledHand& hand : hands) {
    ASSERT_NEAR(hand.angle_rad[kIndexPip], hand.angle_rad[kPinkyPip], 1e-4);
  }
}

TEST(Synthetic, WristAndSlotSevenAreAnywhereInTheirSpans) {
  const HandShape shapes[] = {straight(0.1F)};
  const DataSet hands = makeHands(shapes, {.per_shape = 20000, .sensor_sigma = 0}, 5);
  for (const std::size_t slot : {7U, 21U, 22U}) {
    const auto [low, high] = kGloveRanges[slot];
    const double span = double{high} - double{low};
    const Moments m = momentsOf(hands, slot);
    EXPECT_NEAR(m.least, low, 0.01 * span) << slot;
    EXPECT_NEAR(m.most, high, 0.01 * span) << slot;
    EXPECT_NEAR(m.deviation, span / std::sqrt(12.0), 0.01 * span) << slot;
  }
}

TEST(Synthetic, AnglesAreWholeCountsOfTheSensor) {
  const DataSet hands = makeHands(test::shippedShapes(), {}, 6);
  for (const LabelledHand& hand : hands) {
    for (std::size_t i = 0; i < kInputs; ++i) {
      const auto [low, high] = kGloveRanges[i];
      const double counts =
          (double{hand.angle_rad[i]} - double{low}) / (double{high} - double{low}) * 64;
      ASSERT_NEAR(counts, std::round(counts), 1e-4);
    }
  }
}

TEST(DataSet, BecomesExamplesByRangesAndCodes) {
  PostureNetwork network;
  ASSERT_TRUE(network.postures.add(9, "pinch"));
  DataSet hands(2, {"pinch", {}});
  hands[1].angle_rad[kIndexMcp] = 0.75F;
  const auto examples = toExamples(hands, network);
  ASSERT_TRUE(examples);
  EXPECT_EQ((*examples)[1].code, 9u);
  EXPECT_FLOAT_EQ((*examples)[1].x[kIndexMcp], 0.5F);

  hands[1].angle_rad[21] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(toExamples(hands, network).error().what,
            "hand 1: the angle of wrist-pitch is inf; allowed: a finite number");
  hands[1] = {"fist", {}};
  EXPECT_EQ(toExamples(hands, network).error().what,
            "hand 1 shows \"fist\", which has no code among the 1 postures");
}

TEST(DataSet, TheScoreTellsRejectedFromMistaken) {
  PostureNetwork network;  // weights 0: every finite hand is code 0
  ASSERT_TRUE(network.postures.add(0, "rest"));
  DataSet hands(4, {"rest", {}});
  hands[1].posture = "fist";
  hands[2].angle_rad[0] = std::numeric_limits<float>::quiet_NaN();
  const Score s = score(network, hands);
  EXPECT_EQ(s.total, 4u);
  EXPECT_EQ(s.right, 2u);
  EXPECT_EQ(s.rejected, 1u);
  EXPECT_EQ(s.accuracy(), 0.5);
  EXPECT_EQ(Score{}.accuracy(), 0.0);
}

}  // namespace
}  // namespace merlin::nn
