#include "nn/network.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "nn/inputs.h"

namespace merlin::nn {
namespace {

constexpr Phi kPhis[] = {Phi::kSigmoid, Phi::kSignum, Phi::kAtan};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <typename Real>
BasicWeights<Real> randomWeights(std::uint64_t seed, double most) {
  BasicWeights<Real> weights;
  Random random(seed);
  const auto fill = [&](auto& rows) {
    for (auto& row : rows) {
      for (Real& w : row) w = static_cast<Real>(static_cast<float>(random.uniform(-most, most)));
    }
  };
  fill(weights.hidden);
  fill(weights.output);
  return weights;
}

// Returns weights with which hidden node 0 computes 2 x_2 - 1, the other hidden nodes 0, and output
// 3 computes 4 h_0 - 2 h_1 + 0.25.
Weights handWeights() {
  Weights weights;
  weights.hidden[0][2] = 2;
  weights.hidden[0][kInputs] = -1;
  weights.output[3][0] = 4;
  weights.output[3][1] = -2;
  weights.output[3][kHidden] = 0.25F;
  return weights;
}

// Computed by hand for x_2 = 0.75: hidden node 0 gets I = 2 * 0.75 - 1 = 0.5, the others get 0.
TEST(Network, IsEquationsA9AndA10WithTheSigmoid) {
  Input x{};
  x[2] = 0.75F;
  const auto pass = propagate(Phi::kSigmoid, handWeights(), x);
  EXPECT_FLOAT_EQ(pass.hidden_sum[0], 0.5F);
  EXPECT_FLOAT_EQ(pass.hidden[0], 0.62245933F);
  EXPECT_FLOAT_EQ(pass.hidden[1], 0.5F);
  EXPECT_FLOAT_EQ(pass.output_sum[3], 1.73983732F);
  EXPECT_FLOAT_EQ(pass.output[3], 0.85066640F);
  EXPECT_FLOAT_EQ(pass.output[0], 0.5F);
  EXPECT_EQ(forward(Phi::kSigmoid, handWeights(), x), pass.output);
}

TEST(Network, IsEquationsA9AndA10WithTheAtan) {
  Input x{};
  x[2] = 0.75F;
  const auto pass = propagate(Phi::kAtan, handWeights(), x);
  EXPECT_FLOAT_EQ(pass.hidden[0], 0.64758362F);
  EXPECT_FLOAT_EQ(pass.output_sum[3], 1.84033447F);
  EXPECT_FLOAT_EQ(pass.output[3], 0.84156250F);
  EXPECT_FLOAT_EQ(pass.output[0], 0.5F);
}

TEST(Network, SignumIsOneAboveZeroOnly) {
  Input x{};
  x[2] = 0.75F;
  const auto pass = propagate(Phi::kSignum, handWeights(), x);
  EXPECT_EQ(pass.hidden[0], 1.0F);
  EXPECT_EQ(pass.hidden[1], 0.0F);  // the sum is 0
  EXPECT_EQ(pass.output_sum[3], 4.25F);
  EXPECT_EQ(pass.output, (Output{0, 0, 0, 1, 0}));
}

// A reference implementation, written from the equations and not from the code: each node sums in
// long double.
Output reference(const BasicWeights<double>& w, const Input& x) {
  Output out{};
  for (std::size_t k = 0; k < kOutputs; ++k) {
    long double outer = w.output[k].back();
    for (std::size_t j = 0; j < kHidden; ++j) {
      long double inner = w.hidden[j].back();
      for (std::size_t i = 0; i < kInputs; ++i)
        inner += static_cast<long double>(w.hidden[j][i]) * x[i];
      outer += w.output[k][j] / (1 + std::exp(-inner));
    }
    out[k] = static_cast<float>(1 / (1 + std::exp(-outer)));
  }
  return out;
}

TEST(Network, AgreesWithAReferenceOfMoreDigits) {
  Random random(1);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Input x;
    for (float& v : x) v = static_cast<float>(random.uniform());
    const Output got = forward(Phi::kSigmoid, randomWeights<float>(seed, 5), x);
    const Output want = reference(randomWeights<double>(seed, 5), x);
    for (std::size_t k = 0; k < kOutputs; ++k) ASSERT_NEAR(got[k], want[k], 1e-5) << seed;
  }
}

TEST(Network, ANaNAmongTheInputsMakesEveryOutputNaN) {
  for (const Phi phi : kPhis) {
    for (std::size_t i = 0; i < kInputs; ++i) {
      Input x{};
      x[i] = kNaN;
      for (const float v : forward(phi, randomWeights<float>(3, 1), x)) {
        EXPECT_TRUE(std::isnan(v)) << nameOf(phi) << " " << i;
      }
    }
  }
}

TEST(Network, StaysWithinZeroAndOneHoweverLargeItsSums) {
  for (const Phi phi : kPhis) {
    for (const float scale : {-1e30F, -1e6F, 1e6F, 1e30F}) {
      Input x;
      x.fill(scale);
      for (const float v : forward(phi, randomWeights<float>(4, 1e6), x)) {
        EXPECT_GE(v, 0.0F) << nameOf(phi);
        EXPECT_LE(v, 1.0F) << nameOf(phi);
      }
    }
  }
}

TEST(Phi, HasANameEachWay) {
  for (const Phi phi : kPhis) EXPECT_EQ(phiNamed(nameOf(phi)), phi);
  EXPECT_STREQ(nameOf(Phi::kSigmoid), "sigmoid");
  EXPECT_STREQ(nameOf(Phi::kSignum), "signum");
  EXPECT_STREQ(nameOf(Phi::kAtan), "atan");
  EXPECT_EQ(phiNamed("tanh"), std::nullopt);
  EXPECT_EQ(phiNamed(""), std::nullopt);
}

TEST(Threshold, SetsBitIWhereOutputIIsAboveOneHalf) {
  EXPECT_EQ(threshold({0.6F, 0, 0, 0, 0}), 0b00001U);
  EXPECT_EQ(threshold({0, 0.51F, 0, 0, 1}), 0b10010U);
  EXPECT_EQ(threshold({0.5F, 0.5F, 0.5F, 0.5F, 0.5F}), 0U);
  EXPECT_EQ(threshold({1, 1, 1, 1, 1}), 31U);
  EXPECT_EQ(threshold({kNaN, 1, kNaN, kNaN, kNaN}), 2U);
}

TEST(Inputs, AreScaledFromTheirRangeAndHeldInIt) {
  Angles angles{};
  angles[4] = 0.75F;   // index MCP, range 0..1.5 rad
  angles[3] = 0.2F;    // thumb abduction, range 0.2..0.5 rad
  angles[21] = -0.3F;  // wrist pitch, range -0.7..0.9 rad
  angles[22] = 9.0F;
  angles[5] = -1.0F;
  angles[6] = kNaN;
  const Input x = normalise(kGloveRanges, angles);
  EXPECT_FLOAT_EQ(x[4], 0.5F);
  EXPECT_FLOAT_EQ(x[3], 0.0F);
  EXPECT_FLOAT_EQ(x[21], 0.25F);
  EXPECT_EQ(x[22], 1.0F);
  EXPECT_EQ(x[5], 0.0F);
  EXPECT_TRUE(std::isnan(x[6]));
}

TEST(Inputs, EveryRangeHasAWidth) {
  for (const InputRange& range : kGloveRanges) EXPECT_LT(range.low, range.high);
  for (const char* name : kInputNames) EXPECT_STRNE(name, "");
  EXPECT_STREQ(kInputNames[7], "index-abduction");
  EXPECT_STREQ(kInputNames[22], "wrist-yaw");
}

}  // namespace
}  // namespace merlin::nn
