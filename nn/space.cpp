#include "nn/space.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace merlin::nn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kReach = 3.0;            // half width of a range, standard deviations
constexpr double kLeastDeviation = 1e-6;  // least deviation of a used slot, relative to 1 + |mean|
// Share of the mean variance that is added to each variance, because the next hand may vary in a
// direction in which no recorded hand did.
constexpr double kShrinkage = 0.1;

VectorXd wide(const Input& x) {
  return Eigen::Map<const Eigen::VectorXf>(x.data(), kInputs).cast<double>();
}

Input narrow(const VectorXd& v) {
  Input x;
  Eigen::Map<Eigen::VectorXf>(x.data(), kInputs) = v.cast<float>();
  return x;
}

constexpr auto kSize = static_cast<Eigen::Index>(kInputs);

}  // namespace

InputRanges rangesOf(std::span<const LabelledHand> hands, const InputRanges& fallback,
                     Slots& used) {
  InputRanges ranges = fallback;
  const auto n = static_cast<double>(hands.size());
  for (std::size_t i = 0; i < kInputs; ++i) {
    double mean = 0, square = 0;
    for (const LabelledHand& hand : hands) mean += static_cast<double>(hand.value[i]) / n;
    for (const LabelledHand& hand : hands) {
      const double d = static_cast<double>(hand.value[i]) - mean;
      square += d * d / n;
    }
    const double deviation = std::sqrt(square);
    used[i] = deviation > kLeastDeviation * (1 + std::abs(mean));
    if (!used[i]) continue;
    ranges[i] = {static_cast<float>(mean - kReach * deviation),
                 static_cast<float>(mean + kReach * deviation)};
    used[i] = ranges[i].low < ranges[i].high;
  }
  return ranges;
}

PostureStatistics statisticsOf(std::span<const Input> hands, std::span<const std::size_t> posture,
                               std::vector<std::string> names, const Slots& used) {
  PostureStatistics statistics;
  std::vector<VectorXd> mean(names.size(), VectorXd::Zero(kSize));
  std::vector<double> count(names.size(), 0.0);
  for (std::size_t n = 0; n < hands.size(); ++n) {
    mean[posture[n]] += wide(hands[n]);
    ++count[posture[n]];
  }
  for (std::size_t k = 0; k < names.size(); ++k) mean[k] /= count[k];
  MatrixXd within = MatrixXd::Zero(kSize, kSize);
  for (std::size_t n = 0; n < hands.size(); ++n) {
    const VectorXd d = wide(hands[n]) - mean[posture[n]];
    within.noalias() += d * d.transpose() / static_cast<double>(hands.size());
  }
  const auto measured = static_cast<double>(std::count(used.begin(), used.end(), true));
  const double more = kShrinkage * within.trace() / std::max(measured, 1.0) + 1e-9;
  for (Eigen::Index i = 0; i < kSize; ++i)
    within(i, i) += used[static_cast<std::size_t>(i)] ? more : 1.0;
  const MatrixXd factor = within.llt().matrixL();
  for (std::size_t i = 0; i < kInputs; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      statistics.spread[i][j] =
          static_cast<float>(factor(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }
  for (const VectorXd& m : mean) statistics.mean.push_back(narrow(m));
  statistics.postures = std::move(names);
  return statistics;
}

WhitenedSpace::WhitenedSpace(const PostureStatistics& statistics, const Slots& used) {
  MatrixXd factor = MatrixXd::Zero(kSize, kSize);
  for (std::size_t i = 0; i < kInputs; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      factor(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          static_cast<double>(statistics.spread[i][j]);
  }
  VectorXd centre = VectorXd::Zero(kSize);
  for (const Input& m : statistics.mean)
    centre += wide(m) / static_cast<double>(statistics.mean.size());
  MatrixXd whiten = factor.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(kSize, kSize));
  double squares = static_cast<double>(kInputs);
  for (const Input& m : statistics.mean)
    squares +=
        (whiten * (wide(m) - centre)).squaredNorm() / static_cast<double>(statistics.mean.size());
  const double scale = std::sqrt(squares / static_cast<double>(kInputs));
  whiten /= scale;
  sigma_ = static_cast<float>(1 / scale);
  const MatrixXd colour = factor * scale;
  for (std::size_t i = 0; i < kInputs; ++i) {
    centre_[i] = centre(static_cast<Eigen::Index>(i));
    for (std::size_t j = 0; j < kInputs; ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      whiten_[i][j] = used[i] && used[j] ? whiten(row, column) : 0.0;
      colour_[i][j] = used[i] && used[j] ? colour(row, column) : 0.0;
    }
  }
  for (const Input& m : statistics.mean) means_.push_back(toSpace(m));
}

Input WhitenedSpace::toSpace(const Input& x) const noexcept {
  Input u;
  for (std::size_t i = 0; i < kInputs; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j <= i; ++j)
      sum += whiten_[i][j] * (static_cast<double>(x[j]) - centre_[j]);
    u[i] = static_cast<float>(sum);
  }
  return u;
}

std::vector<std::vector<double>> WhitenedSpace::likeness() const {
  // Least squared distance: it limits the likeness of postures that are equal or nearly equal for
  // all sensors.
  constexpr double kNearest = 0.25;
  const std::size_t postures = means_.size();
  std::vector<std::vector<double>> like(postures, std::vector<double>(postures, 0.0));
  for (std::size_t a = 0; a < postures; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double far = (wide(means_[a]) - wide(means_[b])).norm() / static_cast<double>(sigma_);
      like[a][b] = like[b][a] = 1 / std::max(far * far, kNearest);
    }
  }
  return like;
}

Weights WhitenedSpace::fold(const PackedWeights<float>& in_space) const {
  Weights weights = unpack(in_space);
  for (auto& row : weights.hidden) {
    std::array<double, kInputs> folded{};
    double bias = static_cast<double>(row[kInputs]);
    for (std::size_t j = 0; j < kInputs; ++j) {
      for (std::size_t i = 0; i < kInputs; ++i)
        folded[j] += static_cast<double>(row[i]) * whiten_[i][j];
      bias -= folded[j] * centre_[j];
    }
    for (std::size_t j = 0; j < kInputs; ++j) row[j] = static_cast<float>(folded[j]);
    row[kInputs] = static_cast<float>(bias);
  }
  return weights;
}

PackedWeights<float> WhitenedSpace::unfold(const Weights& weights) const {
  Weights in_space = weights;
  for (auto& row : in_space.hidden) {
    std::array<double, kInputs> unfolded{};
    double bias = static_cast<double>(row[kInputs]);
    for (std::size_t i = 0; i < kInputs; ++i) {
      for (std::size_t j = 0; j < kInputs; ++j)
        unfolded[i] += static_cast<double>(row[j]) * colour_[j][i];
      bias += static_cast<double>(row[i]) * centre_[i];
    }
    for (std::size_t i = 0; i < kInputs; ++i) row[i] = static_cast<float>(unfolded[i]);
    row[kInputs] = static_cast<float>(bias);
  }
  return pack(in_space);
}

}  // namespace merlin::nn
