#include "nn/train.h"

#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin::nn {
namespace {

std::vector<Example> randomExamples(std::size_t count, std::uint64_t seed) {
  std::vector<Example> examples(count);
  Random random(seed);
  for (Example& e : examples) {
    for (float& v : e.x) v = static_cast<float>(random.uniform());
    e.code = static_cast<std::uint32_t>(random.below(kCodes));
  }
  return examples;
}

// Returns training examples: output 2 is the exclusive or of inputs 4 and 20, the other outputs are
// 0.
std::vector<Example> exclusiveOr() {
  std::vector<Example> examples(4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    examples[i].x[4] = i & 1 ? 1.0F : 0.0F;
    examples[i].x[20] = i & 2 ? 1.0F : 0.0F;
    examples[i].code = i == 1 || i == 2 ? 0b00100 : 0;
  }
  return examples;
}

// Calls f(weight) for each of the 440 weights, always in the same order.
template <typename W, typename F>
void forEach(W& weights, F f) {
  for (auto& row : weights.hidden) {
    for (auto& w : row) f(w);
  }
  for (auto& row : weights.output) {
    for (auto& w : row) f(w);
  }
}

template <typename W>
std::vector<double> flat(const W& weights) {
  std::vector<double> all;
  forEach(weights, [&](auto w) { all.push_back(double{w}); });
  return all;
}

TEST(BackPropagate, TheErrorIsTheMeanOfTheSquares) {  // with all weights 0, every output is 1/2
  const auto examples = randomExamples(7, 1);
  EXPECT_DOUBLE_EQ(backPropagate(Phi::kSigmoid, {}, examples).mse, 0.25);
  TrainingWeights sure;  // output 0 is 1, the others are 1/2
  sure.output[0][kHidden] = 100;
  const std::vector<Example> two = {{{}, 0b00001}, {{}, 0b00000}};
  EXPECT_NEAR(backPropagate(Phi::kSigmoid, sure, two).mse, (0 + 1 + 8 * 0.25) / 10, 1e-12);
}

class Gradient : public testing::TestWithParam<Phi> {};

TEST_P(Gradient, AgreesWithFiniteDifferences) {
  const auto examples = randomExamples(5, 2);
  constexpr double kStep = 1e-5;
  TrainingWeights weights = initialWeights(3);
  // These weights are outside of the range in which every activation function is nearly linear.
  forEach(weights, [](double& w) { w *= 4; });
  const auto gradient = flat(backPropagate(GetParam(), weights, examples).gradient);
  std::size_t n = 0;
  double largest = 0;
  forEach(weights, [&](double& w) {
    const double kept = w;
    w = kept + kStep;
    const double above = backPropagate(GetParam(), weights, examples).mse;
    w = kept - kStep;
    const double below = backPropagate(GetParam(), weights, examples).mse;
    w = kept;
    const double slope = (above - below) / (2 * kStep);
    ASSERT_NEAR(gradient[n], slope, 1e-6 * std::abs(slope) + 1e-10) << "weight " << n;
    largest = std::max(largest, std::abs(slope));
    ++n;
  });
  EXPECT_EQ(n, 440u);
  EXPECT_GT(largest, 1e-3);  // the gradient is not just zero
}

INSTANTIATE_TEST_SUITE_P(Phis, Gradient, testing::Values(Phi::kSigmoid, Phi::kAtan),
                         [](const auto& phi) { return nameOf(phi.param); });

TEST(InitialWeights, AreSmallAndOfTheirSeed) {
  const TrainingWeights weights = initialWeights(5);
  for (const auto& row : weights.hidden) {
    for (const double w : row) EXPECT_LE(std::abs(w), 0.20413);  // 1 / sqrt(24)
  }
  for (const auto& row : weights.output) {
    for (const double w : row) EXPECT_LE(std::abs(w), 0.25);
  }
  EXPECT_EQ(flat(weights), flat(initialWeights(5)));
  EXPECT_NE(flat(weights), flat(initialWeights(6)));
}

TEST(Train, StepsDownTheGradientWithMomentum) {
  const auto examples = randomExamples(9, 4);
  TrainSettings settings{.rate = 0.5, .momentum = 0.75, .max_iterations = 2, .mse_limit = 0};
  const auto w0 = flat(initialWeights(1));
  const auto g0 = flat(backPropagate(settings.phi, initialWeights(1), examples).gradient);
  TrainingWeights first = initialWeights(1);
  std::size_t n = 0;
  forEach(first, [&](double& w) { w -= 0.5 * g0[n++]; });
  const auto w1 = flat(first);
  const auto g1 = flat(backPropagate(settings.phi, first, examples).gradient);
  const auto trained = train(initialWeights(1), examples, settings);
  ASSERT_TRUE(trained);
  const auto w2 = flat(trained->weights);
  for (std::size_t i = 0; i < w2.size(); ++i) {
    ASSERT_NEAR(w2[i], w1[i] + 0.75 * (w1[i] - w0[i]) - 0.5 * g1[i], 1e-7) << i;
  }
}

TEST(Train, LearnsTheExclusiveOr) {
  TrainSettings settings{.rate = 5.0, .max_iterations = 3000, .mse_limit = 1e-3};
  for (const Phi phi : {Phi::kSigmoid, Phi::kAtan}) {
    settings.phi = phi;
    const auto trained = train(initialWeights(1), exclusiveOr(), settings);
    ASSERT_TRUE(trained);
    EXPECT_EQ(trained->report.accuracy, 1.0) << nameOf(phi);
    EXPECT_LT(trained->report.mse, 1e-3) << nameOf(phi);
  }
}

TEST(Train, StopsOnceTheErrorIsUnderItsLimit) {
  std::vector<double> errors;
  const auto trained = train(initialWeights(1), exclusiveOr(), {.mse_limit = 0.05},
                             [&](std::size_t iteration, double mse) {
                               EXPECT_EQ(iteration, errors.size());
                               errors.push_back(mse);
                               return true;
                             });
  ASSERT_TRUE(trained);
  EXPECT_EQ(trained->report.iterations + 1, errors.size());
  EXPECT_LT(errors.back(), 0.05);
  EXPECT_GE(errors[errors.size() - 2], 0.05);
  EXPECT_EQ(trained->report.mse, errors.back());
}

TEST(Train, StopsAtTheIterationLimit) {
  const auto trained =
      train(initialWeights(1), exclusiveOr(), {.max_iterations = 7, .mse_limit = 0});
  ASSERT_TRUE(trained);
  EXPECT_EQ(trained->report.iterations, 7u);
}

TEST(Train, StopsWhenItIsToldTo) {
  const auto trained = train(initialWeights(1), exclusiveOr(), {},
                             [](std::size_t iteration, double) { return iteration < 3; });
  ASSERT_TRUE(trained);
  EXPECT_EQ(trained->report.iterations, 3u);
}

TEST(Train, OneSeedGivesOneNetwork) {
  const auto examples = randomExamples(20, 6);
  const TrainSettings settings{.max_iterations = 50};
  const auto once = train(initialWeights(7), examples, settings);
  const auto again = train(initialWeights(7), examples, settings);
  const auto other = train(initialWeights(8), examples, settings);
  ASSERT_TRUE(once && again && other);
  EXPECT_EQ(flat(once->weights), flat(again->weights));
  EXPECT_NE(flat(once->weights), flat(other->weights));
}

TEST(Train, CountsOnlyExamplesWithAllFiveBitsRight) {
  TrainingWeights start;
  start.output[0][kHidden] = 50;
  for (std::size_t k = 1; k < kOutputs; ++k) start.output[k][kHidden] = -50;
  const std::vector<Example> examples = {{{}, 0b00001}, {{}, 0b00011}, {{}, 0}, {{}, 0b00001}};
  const auto trained = train(start, examples, {}, [](std::size_t, double) { return false; });
  ASSERT_TRUE(trained);
  EXPECT_EQ(trained->report.accuracy, 0.5);
}

std::string trainError(std::span<const Example> examples, const TrainSettings& settings) {
  const auto trained = train(initialWeights(1), examples, settings);
  if (trained) return "none";
  EXPECT_EQ(trained.error().code, Errc::kInvalidArgument);
  return trained.error().what;
}

TEST(Train, RefusesWhatItCannotTrain) {
  const auto good = exclusiveOr();
  EXPECT_EQ(trainError({}, {}), "no examples to train on");
  EXPECT_EQ(trainError(good, {.phi = Phi::kSignum}),
            "phi signum has no slope and cannot be trained; allowed: sigmoid, atan");
  EXPECT_EQ(trainError(good, {.rate = 0}), "rate 0 is not > 0");
  EXPECT_EQ(trainError(good, {.momentum = 1}), "momentum 1 is not in [0, 1)");
  EXPECT_EQ(trainError(good, {.max_iterations = 0}), "max_iterations is 0, not >= 1");
  EXPECT_EQ(trainError(good, {.mse_limit = -1}), "mse_limit -1 is not >= 0");
  auto bad = good;
  bad[2].code = 32;
  EXPECT_EQ(trainError(bad, {}), "an example with code 32");
  bad = good;
  bad[3].x[22] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(trainError(bad, {}), "an example with an input that is not finite");
  EXPECT_EQ(trainError(good, {.rate = 1e300, .max_iterations = 3}),
            "the weights diverged after 3 iterations: use a rate below 1e+300 or smaller initial "
            "weights");
}

}  // namespace
}  // namespace merlin::nn
