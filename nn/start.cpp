#include "nn/start.h"

#include <cmath>

#include <Eigen/Dense>

#include "nn/phi.h"

namespace merlin::nn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kNodes = kHidden / kOutputs;  // hidden nodes for each output
constexpr double kHiddenJitter = 0.1, kOutputJitter = 0.15;
constexpr double kOutputWeight = 3.0;
constexpr float kEagerness = 1.5F;  // exponent of boosting's weights

// Returns tanh(y / 2) = 2 sigmoid(y) - 1, by arithmetic that gives the same bits on every machine.
double soft(double y) { return static_cast<double>(2 / (1 + expOf(static_cast<float>(-y))) - 1); }

// Returns the means with a column of ones.
MatrixXd withOnes(std::span<const Input> means) {
  MatrixXd m(static_cast<Eigen::Index>(means.size()), static_cast<Eigen::Index>(kInputs + 1));
  for (std::size_t k = 0; k < means.size(); ++k) {
    for (std::size_t i = 0; i <= kInputs; ++i)
      m(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          i < kInputs ? static_cast<double>(means[k][i]) : 1.0;
  }
  return m;
}

// Returns the least-squares hyperplane for the targets -1 and 1, scaled so that the spread of a
// posture has length 1.
VectorXd plane(const MatrixXd& means, const VectorXd& target, const VectorXd& weight,
               double variance) {
  const MatrixXd weighted = weight.asDiagonal() * means;
  MatrixXd normal = means.transpose() * weighted;
  for (Eigen::Index i = 0; i + 1 < normal.rows(); ++i) normal(i, i) += weight.sum() * variance;
  VectorXd w = normal.ldlt().solve(weighted.transpose() * target);
  const double length = w.head(w.size() - 1).norm() * std::sqrt(variance);
  // If one posture outweighs all others, the plane is not determined, and the result is not scaled.
  constexpr double kLeastLength = 1e-2;
  return length > kLeastLength ? VectorXd(w / length) : w;
}

}  // namespace

PackedWeights<float> startingWeights(std::span<const Input> means,
                                     std::span<const std::uint32_t> codes, float sigma,
                                     Random& random) {
  PackedWeights<float> packed;
  const MatrixXd points = withOnes(means);
  const double variance = static_cast<double>(sigma) * static_cast<double>(sigma);
  const auto postures = static_cast<Eigen::Index>(means.size());
  for (std::size_t b = 0; b < kOutputs; ++b) {
    VectorXd target(postures), weight = VectorXd::Ones(postures), sum = VectorXd::Zero(postures);
    for (Eigen::Index k = 0; k < postures; ++k)
      target(k) = codes[static_cast<std::size_t>(k)] >> b & 1 ? 1.0 : -1.0;
    for (std::size_t r = 0; r < kNodes; ++r) {
      const std::size_t node = b * kNodes + r;
      const VectorXd w = plane(points, target, weight, variance);
      const VectorXd side = points * w;
      for (Eigen::Index k = 0; k < postures; ++k) {
        sum(k) += soft(side(k));
        weight(k) =
            static_cast<double>(expOf(static_cast<float>(-target(k) * sum(k)) * kEagerness));
      }
      weight *= static_cast<double>(postures) / weight.sum();
      for (std::size_t i = 0; i <= kInputs; ++i)
        packed.hidden(i)[node] =
            static_cast<float>(w(static_cast<Eigen::Index>(i)) +
                               (i < kInputs ? kHiddenJitter * random.uniform(-0.2, 0.2) : 0.0));
      for (std::size_t k = 0; k < kOutputs; ++k)
        packed.output(node)[k] = static_cast<float>(kOutputJitter * random.uniform(-1, 1) +
                                                    (k == b ? kOutputWeight : 0.0));
    }
    packed.output(kHidden)[b] = static_cast<float>(-kOutputWeight * kNodes / 2);
  }
  return packed;
}

}  // namespace merlin::nn
