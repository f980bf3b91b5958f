// Postures while the glove's sensors drift: how much drift the trained network tolerates, and how
// much of it DriftFollower corrects.
#include "nn/drift.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "nn/evaluate.h"
#include "nn/fit.h"
#include "tests/nn/drifting.h"

namespace merlin::nn {
namespace {

// Returns the number of hands whose posture is not recognised.
std::size_t faultsOf(DriftFollower& follower, const DataSet& hands) {
  return static_cast<std::size_t>(std::count_if(
      hands.begin(), hands.end(),
      [&](const LabelledHand& hand) { return follower(hand.value).name != hand.posture; }));
}

// The gloves of these three people drift more than most. 8.7 % of these 6975 hands were faults
// before the training kept straying hands on their own side of the border between postures.
TEST(Drift, TheTrainingBearsSomeAndTheFollowerNearlyAll) {
  std::size_t hands = 0, alone = 0, followed = 0;
  for (const std::uint64_t person : {3008U, 3013U, 3014U}) {
    const test::Session session = test::drifting(hand::allShapes(), person, {});
    const auto fitted = fit(session.first, {});
    ASSERT_TRUE(fitted);
    DriftFollower off(fitted->network, fitted->statistics, {.share = 0}),
        on(fitted->network, fitted->statistics, {});
    hands += session.second.size();
    alone += faultsOf(off, session.second);
    followed += faultsOf(on, session.second);
  }
  ASSERT_EQ(hands, 6975U);
  EXPECT_LT(alone, 330U) << "4.7 %";
  EXPECT_LT(followed, 35U) << "0.5 %";
}

// A network for the tests below: two postures that differ in slot 4, which determines every output.
class TwoPostures : public testing::Test {
 protected:
  TwoPostures() {
    (void)network_.postures.add(0b00000, "flat");
    (void)network_.postures.add(0b11111, "fist");
    network_.ranges.fill({0, 1});
    network_.weights.hidden[0][4] = 60;
    network_.weights.hidden[0][kInputs] = -30;
    for (auto& row : network_.weights.output) {
      row[0] = 20;
      row[kHidden] = -10;
    }
    statistics_.postures = {"flat", "fist", "unknown"};
    statistics_.mean.resize(3);
    statistics_.mean[0].fill(0.5F);
    statistics_.mean[1].fill(0.5F);
    statistics_.mean[0][4] = 0.2F;
    statistics_.mean[1][4] = 0.8F;
  }

  // Returns a hand that shows one of the two postures, with the same drift in every slot.
  static Angles hand(bool fist, float drift) {
    Angles value;
    value.fill(0.5F + drift);
    value[4] = (fist ? 0.8F : 0.2F) + drift;
    return value;
  }

  PostureNetwork network_;
  PostureStatistics statistics_;
};

TEST_F(TwoPostures, ADriftIsFollowedFromVisitToVisitAndForgottenAtAReset) {
  DriftFollower follow(network_, statistics_,
                       {.share = 0.5, .least_margin = 0.3, .most = 0.3, .least_hands = 1});
  (void)follow(hand(false, 0.1F));
  EXPECT_FLOAT_EQ(follow.offset()[4], 0) << "the visit has not ended";
  EXPECT_EQ(follow(hand(true, 0.1F)).name, "fist");
  EXPECT_FLOAT_EQ(follow.offset()[4], 0.05F) << "half of what the first visit showed";
  (void)follow(hand(false, 0.1F));
  EXPECT_NEAR(follow.offset()[4], 0.1F, 1e-6F)
      << "and the hand of the second was measured before the first was known";
  follow.reset();
  EXPECT_FLOAT_EQ(follow.offset()[4], 0);
  (void)follow(hand(false, 0.1F));
  (void)follow(hand(true, 0.1F));
  EXPECT_FLOAT_EQ(follow.offset()[4], 0.05F)
      << "of the visit before the reset nothing is counted, neither drift nor hands";
}

TEST_F(TwoPostures, APostureHeldForLongCountsOnce) {
  DriftFollower follow(network_, statistics_,
                       {.share = 0.5, .least_margin = 0.3, .most = 0.3, .least_hands = 1});
  for (int n = 0; n < 20'000; ++n) (void)follow(hand(false, 0.1F));
  EXPECT_FLOAT_EQ(follow.offset()[4], 0);
  (void)follow(hand(true, 0.1F));
  EXPECT_NEAR(follow.offset()[4], 0.05F, 1e-4F);
}

TEST_F(TwoPostures, AHandFarFromItsPostureTeachesNoMoreThanANearOne) {
  DriftFollower follow(network_, statistics_, {.share = 0.5, .most = 0.3, .least_hands = 1});
  Angles far = hand(false, 0);
  far[5] = 0.95F;
  (void)follow(far);
  (void)follow(hand(true, 0));
  EXPECT_FLOAT_EQ(follow.offset()[5], 0.075F) << "half of 0.15, not of 0.45";
}

TEST_F(TwoPostures, APostureThatAHandOnlyPassesDoesNotCount) {
  DriftFollower follow(network_, statistics_, {.share = 0.5, .most = 0.3, .least_hands = 5});
  for (int n = 0; n < 40; ++n) (void)follow(hand(n / 4 % 2 == 0, 0.1F));
  EXPECT_FLOAT_EQ(follow.offset()[4], 0) << "visits of four hands";
  for (int n = 0; n < 6; ++n) (void)follow(hand(n == 5, 0.1F));
  EXPECT_FLOAT_EQ(follow.offset()[4], 0.05F) << "one of five";
}

TEST_F(TwoPostures, TheDriftIsBoundedWhateverIsShown) {
  DriftFollower follow(network_, statistics_,
                       {.share = 1, .least_margin = 0, .most = 0.3, .least_hands = 1});
  for (int n = 0; n < 1000; ++n) {
    Angles value;
    value.fill(n % 3 == 0 ? 1e30F : -1e30F);
    value[4] = n % 2 == 0 ? 0.0F : 1e30F;
    (void)follow(value);
    for (const float o : follow.offset()) ASSERT_LE(std::abs(o), 0.3F);
  }
}

TEST_F(TwoPostures, AHandThatIsNotFiniteOrNotSureTeachesNothing) {
  DriftFollower follow(network_, statistics_,
                       {.share = 1, .least_margin = 0.3, .most = 0.3, .least_hands = 1});
  Angles broken = hand(true, 0);
  broken[7] = std::numeric_limits<float>::quiet_NaN();
  Angles between = hand(true, 0.1F);
  between[4] = 0.5F;
  for (int n = 0; n < 10; ++n) {
    EXPECT_TRUE(follow(broken).name.empty());
    EXPECT_LT(follow(between).margin, 0.3F);
    (void)follow(hand(n % 2 == 0, 0));
  }
  for (const float o : follow.offset()) EXPECT_NEAR(o, 0, 1e-6F);
}

// The hands drift beyond the border to the other posture.
TEST_F(TwoPostures, AnEvaluationShowsTheFollowerTheHandsInTheirOrder) {
  DataSet hands;
  for (int n = 0; n < 100; ++n)
    hands.push_back(
        {n % 2 == 0 ? "flat" : "fist", hand(n % 2 != 0, 0.004F * static_cast<float>(n))});
  DriftFollower follow(network_, statistics_,
                       {.share = 0.5, .least_margin = 0.3, .most = 0.4, .least_hands = 1});
  EXPECT_EQ(evaluate(follow, hands, 0.3).all.right, 100U);
  EXPECT_LT(evaluate(network_, hands, 0.3).all.right, 90U);
}

TEST_F(TwoPostures, OffItRecognisesAsTheRecogniserDoes) {
  DriftFollower follow(network_, statistics_, {.share = 0});
  const Recogniser recognise(network_);
  for (int n = 0; n < 100; ++n) {
    const Angles value = hand(n % 2 == 0, 0.005F * static_cast<float>(n));
    EXPECT_EQ(follow(value).activation, recognise(value).activation);
  }
  for (const float o : follow.offset()) EXPECT_FLOAT_EQ(o, 0);
}

}  // namespace
}  // namespace merlin::nn
