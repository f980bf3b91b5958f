#include "nn/recall.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

constexpr Phi kPhis[] = {Phi::kSigmoid, Phi::kSignum, Phi::kAtan};

// Returns random weights as large as trained ones, whose magnitudes are at most 90 (hidden) and 17
// (output).
Weights randomWeights(std::uint64_t seed) {
  Weights weights;
  Random random(seed);
  for (auto& row : weights.hidden) {
    for (float& w : row) w = static_cast<float>(random.uniform(-90, 90));
  }
  for (auto& row : weights.output) {
    for (float& w : row) w = static_cast<float>(random.uniform(-17, 17));
  }
  return weights;
}

Input randomInput(Random& random) {
  Input x;
  for (float& v : x) v = static_cast<float>(random.uniform());
  return x;
}

BasicWeights<double> widen(const Weights& weights) {
  BasicWeights<double> wide;
  for (std::size_t j = 0; j < kHidden; ++j)
    std::copy(weights.hidden[j].begin(), weights.hidden[j].end(), wide.hidden[j].begin());
  for (std::size_t k = 0; k < kOutputs; ++k)
    std::copy(weights.output[k].begin(), weights.output[k].end(), wide.output[k].begin());
  return wide;
}

double errorOf(Phi phi, const Weights& weights, const Input& in) {
  std::array<double, kInputs> x{};
  std::copy(in.begin(), in.end(), x.begin());
  const auto exact = propagate(phi, widen(weights), x).output;
  const Output got = Recall(phi, weights)(in);
  double most = 0;
  for (std::size_t k = 0; k < kOutputs; ++k)
    most = std::max(most, std::abs(static_cast<double>(got[k]) - exact[k]));
  return most;
}

TEST(Recall, IsWithinAMillionthOfAPassInDouble) {
  Random random(6);
  const Weights shipped = test::shippedNetwork().weights;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Weights weights = randomWeights(seed);
    for (const Phi phi : {Phi::kSigmoid, Phi::kAtan}) {
      ASSERT_LE(errorOf(phi, shipped, randomInput(random)), 1e-6);
      ASSERT_LE(errorOf(phi, weights, randomInput(random)), 1e-6) << seed;
    }
  }
}

void expectSameBits(Phi phi, const Weights& weights, const Input& x) {
  const Recall recall(phi, weights);
  const Output fast = recall(x), portable = recall.portably(x);
  EXPECT_EQ(std::memcmp(fast.data(), portable.data(), sizeof fast), 0) << nameOf(phi);
}

// On a processor without AVX2 both versions are the same, so the test compares nothing there.
TEST(Recall, GivesTheSameBitsWithEveryProcessorsInstructions) {
  Random random(7);
  constexpr float kOdd[] = {
      0, -0.0F, 1e-40F, -3, 1e30F, -1e30F, std::numeric_limits<float>::infinity()};
  for (std::uint64_t seed = 0; seed < 2000 && !HasFailure(); ++seed) {
    Input x = randomInput(random);
    if (seed % 4 == 0) x[seed % kInputs] = kOdd[seed / 4 % std::size(kOdd)];
    for (const Phi phi : kPhis) expectSameBits(phi, randomWeights(seed), x);
  }
}

// Near 2^52 a double represents whole numbers only, so the result of a sum depends on the order.
TEST(Recall, AddsInTheSameOrderWithEveryProcessorsInstructions) {
  constexpr float kLarge = 0x1p52F;
  Random random(8);
  Input ones;
  ones.fill(1);
  for (int n = 0; n < 100 && !HasFailure(); ++n) {
    Weights weights;
    for (auto& row : weights.hidden) {
      for (float& w : row) w = static_cast<float>(random.uniform(-1, 1));
      const std::size_t at = random.below(8);
      row[at] = kLarge;
      row[at + 2 * (1 + random.below(7))] = -kLarge;
    }
    for (auto& row : weights.output) {
      for (float& w : row) w = static_cast<float>(random.uniform(-2, 2));
    }
    expectSameBits(Phi::kSigmoid, weights, ones);
  }
}

TEST(Recall, ANaNAmongTheInputsMakesEveryOutputNaN) {
  for (const Phi phi : kPhis) {
    const Recall recall(phi, randomWeights(3));
    for (std::size_t i = 0; i < kInputs; ++i) {
      Input x{};
      x[i] = std::numeric_limits<float>::quiet_NaN();
      for (const float v : recall(x)) EXPECT_TRUE(std::isnan(v)) << nameOf(phi) << " " << i;
      for (const float v : recall.portably(x)) EXPECT_TRUE(std::isnan(v)) << nameOf(phi) << i;
    }
  }
}

}  // namespace
}  // namespace merlin::nn
