#include "nn/fit.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "nn/adapt.h"
#include "nn/codes.h"
#include "nn/cross_validation.h"
#include "nn/evaluate.h"
#include "nn/hold.h"
#include "nn/train.h"
#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

TrainingWeights someWeights(std::uint64_t seed) {
  TrainingWeights w = initialWeights(seed);
  for (auto& row : w.hidden) {
    for (double& v : row) v *= 4;
  }
  return w;
}

class LaneGradient : public testing::TestWithParam<Phi> {};

// The gradient used in training is a template, so this test with double also covers float.
TEST_P(LaneGradient, AgreesWithFiniteDifferences) {
  PackedWeights<double> packed = pack(someWeights(3));
  Random random(4);
  std::array<double, kInputs> x;
  for (double& v : x) v = random.uniform(-2, 2);
  constexpr std::uint32_t kCode = 0b10110;
  constexpr double kStep = 1e-5;
  PackedWeights<double> gradient;
  (void)addGradient(GetParam(), packed, x.data(), kCode, gradient);
  double largest = 0;
  for (std::size_t n = 0; n < packed.all.size(); ++n) {
    const auto error = [&](double w) {
      const double kept = std::exchange(packed.all[n], w);
      PackedPass<double> pass;
      propagate(GetParam(), packed, x.data(), pass);
      packed.all[n] = kept;
      double sum = 0;
      for (std::size_t k = 0; k < kOutputs; ++k)
        sum += std::pow(pass.output[k] - (kCode >> k & 1), 2);
      return sum;
    };
    const double slope =
        (error(packed.all[n] + kStep) - error(packed.all[n] - kStep)) / (2 * kStep);
    const bool hidden_pad = n < PackedWeights<double>::kOutputs0 && n % kHiddenWidth == kHidden;
    const bool pad =
        hidden_pad || (n >= PackedWeights<double>::kOutputs0 && n % kOutputWidth >= kOutputs);
    ASSERT_NEAR(gradient.all[n], pad ? 0 : slope, 1e-6 * std::abs(slope) + 1e-9) << n;
    largest = std::max(largest, std::abs(slope));
  }
  EXPECT_GT(largest, 1e-3);
}
INSTANTIATE_TEST_SUITE_P(Phis, LaneGradient, testing::Values(Phi::kSigmoid, Phi::kAtan),
                         [](const auto& phi) { return nameOf(phi.param); });

TEST(PackedWeights, GiveTheSameBitsAsTheNetwork) {
  for (const Phi phi : {Phi::kSigmoid, Phi::kAtan, Phi::kSignum}) {
    const PostureNetwork network = test::shippedNetwork();
    const auto packed = pack(network.weights);
    EXPECT_EQ(unpack(packed).hidden, network.weights.hidden);
    Random random(5);
    for (int n = 0; n < 1000; ++n) {
      Input x;
      for (float& v : x) v = static_cast<float>(random.uniform());
      PackedPass<float> pass;
      propagate(phi, packed, x.data(), pass);
      const Output want = forward(phi, network.weights, x);
      for (std::size_t k = 0; k < kOutputs; ++k) ASSERT_EQ(pass.output[k], want[k]);
    }
  }
}

TEST(Codes, OfEvenParityAreTwoBitsApartAndNeverZero) {
  EXPECT_EQ(codesFor(8, Parity::kEven).size(), 15u);
  EXPECT_EQ(codesFor(16, Parity::kEven).size(), 16u);
  EXPECT_EQ(codesFor(17, Parity::kEven).size(), 31u);
  EXPECT_EQ(codesFor(32, Parity::kAny).size(), 32u);
  for (const std::uint32_t c : codesFor(8, Parity::kEven)) EXPECT_EQ(std::popcount(c) % 2, 0);
}

TEST(Codes, OfPosturesThatLookAlikeDifferInOneBit) {
  Likeness pairs(32, std::vector<double>(32, 0.0));
  for (std::size_t k = 0; k < 32; k += 2) pairs[k][k + 1] = pairs[k + 1][k] = 1;
  Random random(1);
  const auto codes = assignCodes(pairs, codesFor(32, Parity::kAny), 20, random);
  int bits = 0;
  for (std::size_t k = 0; k < 32; k += 2) bits += std::popcount(codes[k] ^ codes[k + 1]);
  EXPECT_LE(bits, 18) << "16 is the least";
}

// Neither these synthetic people nor this seed were used in choosing the training method.
TEST(Fit, NamesUnseenPeopleBetterThanTheNearestNeighbour) {
  const DataSet train = test::people(hand::allShapes(), 1, 10, 5, 1);
  const DataSet unseen = test::people(hand::allShapes(), 7001, 10, 5, 2);
  const auto fitted = fit(train, {});
  ASSERT_TRUE(fitted) << fitted.error().what;
  const double accuracy = score(fitted->network, unseen).accuracy();
  EXPECT_GE(accuracy, 0.97);
  EXPECT_GT(accuracy, neighbours(train, unseen).nearest);
  const auto again = fit(train, {});
  EXPECT_EQ(fitted->network.weights.hidden, again->network.weights.hidden) << "one seed";
  EXPECT_EQ(formatNetwork({fitted->network, fitted->trained, fitted->statistics}),
            formatNetwork({again->network, again->trained, again->statistics}));
}

TEST(Fit, LearnsWithTheAtanToo) {
  const DataSet train = test::people(hand::shapes(), 1, 10, 5, 1);
  const auto fitted = fit(train, {.phi = Phi::kAtan, .passes = 100});
  ASSERT_TRUE(fitted);
  EXPECT_GE(score(fitted->network, test::people(hand::shapes(), 7001, 5, 5, 2)).accuracy(), 0.97);
}

TEST(Fit, AnErrorThatIsSmallEnoughEndsIt) {
  const DataSet hands = test::people(hand::shapes(), 1, 4, 5, 1);
  const auto passesWith = [&](double limit) {
    const auto fitted =
        fit(hands, {.starts = 1, .passes = 100, .validation_share = 0, .mse_limit = limit});
    EXPECT_TRUE(fitted) << fitted.error().what;
    return fitted ? fitted->curve.size() : 0;
  };
  const std::size_t to_the_end = passesWith(0), at_once = passesWith(1);
  EXPECT_LT(at_once + 10, to_the_end) << "it ends once the noise has settled";
  EXPECT_GT(at_once, 80u) << "not before";
  EXPECT_FALSE(fit(hands, {.mse_limit = -1}));
}

TEST(Fit, RefusesWhatItCannotLearn) {
  const auto why = [](const DataSet& hands, const FitSettings& s = {}) {
    const auto fitted = fit(hands, s);
    return fitted ? std::string() : fitted.error().what;
  };
  EXPECT_EQ(why({}),
            "the hands show 0 postures; needed are 2 to 32, one for each code of five bits: record "
            "hands of other postures too");
  EXPECT_EQ(why({{"a", {}}, {"a", {}}}),
            "the hands show 1 posture; needed are 2 to 32, one for each code of five bits: record "
            "hands of other postures too");
  EXPECT_EQ(why({{"a", {}}, {"b", {}}}),
            "the values of all sensors are constant; record hands that show different postures");
  EXPECT_EQ(why({{"a", {}}, {"b", {}}}, {.phi = Phi::kSignum}),
            "phi signum has no slope and cannot be trained; allowed: sigmoid, atan");
  DataSet bad = {{"a", {}}, {"b", {}}};
  bad[1].value[2] = std::nanf("");
  EXPECT_EQ(why(bad), "hand 1: the value of thumb-ip is nan; allowed: a finite number");
}

TEST(Fit, TwoHandsAreEnough) {
  DataSet two = {{"a", {}}, {"b", {}}};
  two[1].value[4] = 1;
  const auto fitted = fit(two, {});
  ASSERT_TRUE(fitted) << fitted.error().what;
  EXPECT_EQ(score(fitted->network, two).right, 2u);
}

TEST(ShippedNetwork, NamesPeopleItHasNotSeen) {
  const Score s = score(test::shippedNetwork(), test::people(hand::shapes(), 7001, 50, 10, 3, 2));
  EXPECT_EQ(s.total, 8000u);
  EXPECT_GE(s.right, 7990u);
}

TEST(ShippedNetwork, OneWrongBitIsNoPosture) {
  const PostureNetwork network = test::shippedNetwork();
  EXPECT_EQ(network.postures.size(), 8u);
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    if (network.postures.name(code).empty()) continue;
    for (std::uint32_t bit = 1; bit < kCodes; bit <<= 1)
      EXPECT_EQ(network.postures.name(code ^ bit), "") << formatCode(code ^ bit);
  }
}

TEST(Adapt, LearnsAPersonAndForgetsNobody) {
  const auto fitted = fit(test::people(hand::allShapes(), 1, 10, 5, 1), {});
  const DataSet others = test::people(hand::allShapes(), 5001, 10, 5, 7);
  const DataSet own = test::people(hand::allShapes(), 9003, 1, 200, 1);
  const DataSet later = test::people(hand::allShapes(), 9003, 1, 50, 2);
  const auto adapted = adapt(fitted->network, fitted->statistics, own, 1);
  ASSERT_TRUE(adapted);
  EXPECT_GT(score(adapted->network, later).accuracy(), score(fitted->network, later).accuracy());
  EXPECT_GE(score(adapted->network, later).accuracy(), 0.99);
  EXPECT_GE(score(adapted->network, others).accuracy(),
            score(fitted->network, others).accuracy() - 0.01);
  EXPECT_GE(adapted->drawn_after, adapted->drawn_before - 0.005);
  const auto refused = adapt(fitted->network, fitted->statistics, DataSet{{"wink", {}}}, 1);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().what.starts_with("posture \"wink\" is not one of the network's"));
}

Recognition shows(std::uint32_t code, float margin) {
  return {code, {}, code == 0 ? std::string_view() : std::string_view("fist"), margin};
}

TEST(PostureHold, CountsOnceItHasLastedAndEndsOnceItIsGone) {
  PostureHold hold({.hold_s = 0.10, .leave_s = 0.05, .least_margin = 0.4});
  const auto at = [](double s) { return static_cast<std::int64_t>(s * 1e9); };
  EXPECT_FALSE(hold.update(shows(3, 0.9F), at(1.00)).any);
  EXPECT_FALSE(hold.update(shows(3, 0.9F), at(1.09)).any);
  EXPECT_TRUE(hold.update(shows(3, 0.9F), at(1.10)).any);
  EXPECT_EQ(hold.update(shows(3, 0.25F), at(1.20)).code, 3u) << "half the margin keeps it";
  EXPECT_TRUE(hold.update(shows(3, 0.15F), at(1.21)).any);
  EXPECT_TRUE(hold.update(shows(3, 0.9F), at(1.25)).any) << "a blink is no end";
  EXPECT_TRUE(hold.update(shows(0, 0.9F), at(1.30)).any);
  EXPECT_FALSE(hold.update(shows(0, 0.9F), at(1.35)).any);
  EXPECT_FALSE(hold.update(shows(5, 0.3F), at(1.40)).any);
  EXPECT_FALSE(hold.update(shows(5, 0.3F), at(1.60)).any) << "too unsure";
  EXPECT_EQ(hold.update(shows(0, 0.9F), at(1.70)).entered, 1u);
}

TEST(PostureHold, TenPosturesOnTheirWayAreReportedOnceEach) {
  const auto fitted = fit(test::people(hand::allShapes(), 1, 10, 5, 1), {});
  const Recogniser recognise(fitted->network);
  const auto ten = hand::allShapes().first(10);
  PostureHold hold({});
  std::vector<std::string> reported;
  std::int64_t now = 0;
  std::uint32_t entered = 0;
  for (const hand::Shot& shot : hand::goThrough(ten, hand::Person(9001), 100, 35, 1)) {
    const Held& h = hold.update(recognise(shot.angle_rad), now += 10'000'000);
    if (h.entered != entered) reported.emplace_back(recognise.name(h.code));
    entered = h.entered;
  }
  ASSERT_EQ(reported.size(), 10u);
  for (std::size_t n = 0; n < 10; ++n) EXPECT_EQ(reported[n], ten[n].name);
}

// According to [GOURLEY98] B.3, an interactive response takes at most 0.1 s. A posture is
// recognised while the hand is on its way to it, so most of the hold time is over when the fingers
// have arrived. A frame of the wall takes another 0.033 s.
TEST(PostureHold, ActsWithinATenthOfASecondAndInventsNothing) {
  const PostureNetwork network = test::shippedNetwork();
  const Recogniser recognise(network);
  constexpr std::size_t kStays = 100, kWay = 35;  // records, 100 a second
  const auto shapes = hand::shapes();
  std::vector<std::int64_t> after;  // [records] from the fingers' arrival until the posture begins
  for (std::uint64_t person = 9001; person <= 9020; ++person) {
    PostureHold hold({});
    std::uint32_t entered = 0;
    std::int64_t record = 0;
    for (const hand::Shot& shot : hand::goThrough(shapes, hand::Person(person), kStays, kWay, 1)) {
      const Held& h = hold.update(recognise(shot.angle_rad), 10'000'000 * record++);
      if (h.entered == entered) continue;
      ASSERT_LT(entered, shapes.size()) << "a posture was invented";
      EXPECT_EQ(recognise.name(h.code), shapes[entered].name) << person;
      const auto arrived = static_cast<std::int64_t>(entered * (kStays + kWay));
      // there is no way to the first posture
      if (entered > 0) after.push_back(record - 1 - arrived);
      entered = h.entered;
    }
    EXPECT_EQ(entered, shapes.size()) << person;
  }
  std::sort(after.begin(), after.end());
  EXPECT_LE(after[after.size() / 2], 2);
  EXPECT_LE(after[after.size() * 95 / 100], 6) << "0.06 s, of the 0.067 s that a frame leaves";
}

TEST(Folds, EachHandIsTestedOnceAndEachPostureInEachFold) {
  DataSet hands;
  for (int n = 0; n < 10; ++n) {
    for (const char* name : {"fist", "open"}) {
      LabelledHand hand;
      hand.posture = name;
      hand.value.fill(static_cast<float>(n));
      hands.push_back(hand);
    }
  }
  std::vector<int> tested(10, 0);
  for (std::size_t fold = 0; fold < 5; ++fold) {
    const Fold split = splitFold(hands, 5, fold);
    ASSERT_EQ(split.test.size(), 4u);
    EXPECT_EQ(split.train.size(), 16u);
    for (const LabelledHand& hand : split.test) ++tested[static_cast<std::size_t>(hand.value[0])];
  }
  EXPECT_EQ(tested, std::vector<int>(10, 2));
}

TEST(Folds, AreScoredByANetworkOfTheOthersAndAveraged) {
  DataSet hands;
  for (int n = 0; n < 10; ++n) {
    for (const char* name : {"fist", "open"}) {
      LabelledHand hand;
      hand.posture = name;
      hand.value.fill(0.01F * static_cast<float>(n));
      // In the second half the label does not depend on the hand: both postures have the open
      // hand's angles.
      hand.value[4] += n >= 5 || *name == 'o' ? 0.0F : 1.0F;
      hands.push_back(hand);
    }
  }
  FitSettings settings;
  settings.starts = 2;
  settings.passes = 40;
  const auto first = scoreFold(hands, 2, 0, settings), second = scoreFold(hands, 2, 1, settings);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->hands, 10u);
  EXPECT_EQ(second->neighbours.mean, 0.5) << "half of what cannot be told apart";
  const std::vector<FoldScore> both = {*first, *second};
  const FoldScore mean = meanOf(both);
  EXPECT_EQ(mean.hands, 20u);
  EXPECT_DOUBLE_EQ(mean.accuracy, (first->accuracy + second->accuracy) / 2);
  EXPECT_DOUBLE_EQ(mean.neighbours.mean, (first->neighbours.mean + 0.5) / 2);
  settings.phi = Phi::kSignum;
  EXPECT_FALSE(scoreFold(hands, 2, 0, settings)) << "cannot be trained";
}

}  // namespace
}  // namespace merlin::nn
