#include "nn/gesture/discriminant.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace merlin::nn {
namespace {

constexpr auto kTermCount = static_cast<Eigen::Index>(kTerms);
constexpr int kMostSteps = 25, kMostHalvings = 20;
constexpr double kConverged = 1e-6;  // relative change of the objective

using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1>;
using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

// Returns log(1 + exp(x)) without overflow.
double softPlus(double x) { return x > 0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x)); }

// Returns a matrix with one row of terms for each example.
Table termsOf(std::span<const DiscriminantExample> examples) {
  Table terms(static_cast<Eigen::Index>(examples.size()), kTermCount);
  for (std::size_t n = 0; n < examples.size(); ++n) {
    const StrokeFeatures& z = examples[n].whitened;
    const auto row = static_cast<Eigen::Index>(n);
    Eigen::Index at = 0;
    terms(row, at++) = 1;
    for (const float v : z) terms(row, at++) = static_cast<double>(v);
    for (std::size_t i = 0; i < kFeatures; ++i) {
      for (std::size_t j = 0; j <= i; ++j) terms(row, at++) = static_cast<double>(z[i] * z[j]);
    }
  }
  return terms;
}

double objective(const Table& terms, const Weights& meant, const Weights& weights, double decay) {
  const Weights odds = terms * weights;
  double sum = decay / 2 * weights.squaredNorm();
  for (Eigen::Index n = 0; n < odds.size(); ++n) sum += softPlus(odds[n]) - meant[n] * odds[n];
  return sum;
}

Weights newtonStep(const Table& terms, const Weights& meant, const Weights& weights, double decay) {
  const Weights odds = terms * weights;
  const Weights share = (1 + (-odds.array()).exp()).inverse();
  const Weights certainty = (share.array() * (1 - share.array())).sqrt();
  const Table scaled = certainty.asDiagonal() * terms;
  Table curvature = Table::Zero(kTermCount, kTermCount);
  curvature.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
  curvature.diagonal().array() += decay;
  const Weights slope = terms.transpose() * (share - meant) + decay * weights;
  return curvature.selfadjointView<Eigen::Lower>().ldlt().solve(slope);
}

}  // namespace

float oddsOf(const Discriminant& discriminant, const StrokeFeatures& whitened) noexcept {
  std::size_t at = 0;
  float odds = discriminant[at++];
  for (const float v : whitened) odds += discriminant[at++] * v;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    float sum = 0;
    for (std::size_t j = 0; j <= i; ++j) sum += discriminant[at++] * whitened[j];
    odds += sum * whitened[i];
  }
  return odds;
}

Discriminant fitDiscriminant(std::span<const DiscriminantExample> examples, double decay) {
  const Table terms = termsOf(examples);
  Weights meant(terms.rows());
  for (std::size_t n = 0; n < examples.size(); ++n)
    meant[static_cast<Eigen::Index>(n)] = examples[n].meant ? 1 : 0;
  Weights weights = Weights::Zero(kTermCount);
  double now = objective(terms, meant, weights, decay);
  for (int n = 0; n < kMostSteps; ++n) {
    Weights step = newtonStep(terms, meant, weights, decay);
    double next = objective(terms, meant, weights - step, decay);
    for (int h = 0; h < kMostHalvings && !(next < now); ++h) {
      step /= 2;
      next = objective(terms, meant, weights - step, decay);
    }
    if (!(next < now)) break;
    weights -= step;
    if (now - next < kConverged * now) break;
    now = next;
  }
  Discriminant result{};
  for (std::size_t i = 0; i < kTerms; ++i)
    result[i] = static_cast<float>(weights[static_cast<Eigen::Index>(i)]);
  return result;
}

}  // namespace merlin::nn
