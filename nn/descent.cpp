#include "nn/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace merlin::nn {
namespace {

constexpr std::size_t kBatch = 32;
constexpr std::size_t kFewest = 640, kMost = 2048;  // limits of the number of samples in a pass
constexpr std::size_t kNoisePool = 1 << 14;
constexpr float kFirst = 0.9F, kSecond = 0.999F, kLittle = 1e-8F;
constexpr float kDecay = 1e-4F;

// Returns a nearly normal random number with mean 0 and standard deviation 1. It uses arithmetic
// alone: the last bits of libm's log and cos differ between processors, and one seed must give one
// network.
float bell(Random& random) {
  double sum = -2;
  for (int i = 0; i < 4; ++i) sum += random.uniform();
  constexpr double kRootOfThree = 1.7320508075688772;
  return static_cast<float>(kRootOfThree * sum);
}

}  // namespace

Descent::Descent(Phi phi, std::span<const Sample> samples, std::span<const Input> means,
                 Random random)
    : phi_(phi),
      samples_(samples),
      means_(means),
      random_(random),
      noise_(kNoisePool),
      order_(samples.size()) {
  for (float& v : noise_) v = bell(random_);
  std::iota(order_.begin(), order_.end(), 0U);
  next_ = order_.size();
  half_square_.fill(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < means.size(); ++k) {
    half_square_[k] = 0;
    for (std::size_t i = 0; i < kInputs; ++i) {
      component_[i][k] = means[k][i];
      half_square_[k] += means[k][i] * means[k][i] / 2;
    }
  }
  for (const Sample& sample : samples) own_side_.push_back(nearest(sample.u) == sample.posture);
}

// Compares |u - m|^2 = |u|^2 + 2 (|m|^2 / 2 - u m) for the means m of all postures; |u|^2 is the
// same for all and is left out.
std::uint32_t Descent::nearest(const Input& u) const noexcept {
  std::array<float, kCodes> far = half_square_;
  for (std::size_t i = 0; i < kInputs; ++i) {
    for (std::size_t k = 0; k < kCodes; ++k) far[k] -= u[i] * component_[i][k];
  }
  return static_cast<std::uint32_t>(std::min_element(far.begin(), far.end()) - far.begin());
}

// A varied hand that is nearer to another posture's mean would teach the wrong code. Therefore it
// is moved half of the way to its own posture's mean, up to three times, until that mean is the
// nearest.
Input Descent::stray(std::size_t n, const Straying& straying) {
  constexpr int kHalvings = 3;
  const Sample& sample = samples_[n];
  const float* away = &noise_[random_.below(kNoisePool - kInputs)];
  const Input& mean = means_[sample.posture];
  const float noise = own_side_[n] ? straying.noise : straying.noise_beyond;
  const float shrink = own_side_[n] ? straying.shrink : straying.shrink_beyond;
  Input u;
  for (std::size_t i = 0; i < kInputs; ++i)
    u[i] = mean[i] + shrink * (sample.u[i] - mean[i]) + noise * away[i];
  for (int halvings = 0; halvings < kHalvings && own_side_[n]; ++halvings) {
    if (nearest(u) == sample.posture) break;
    for (std::size_t i = 0; i < kInputs; ++i) u[i] = (u[i] + mean[i]) / 2;
  }
  return u;
}

double Descent::pass(Descending& at, std::span<const std::uint32_t> codes, float rate,
                     const Straying& straying) {
  const std::size_t all = std::clamp(samples_.size(), kFewest, kMost);
  double error = 0;
  for (std::size_t done = 0; done < all;) {
    PackedWeights<float> gradient;
    const std::size_t size = std::min(kBatch, all - done);
    for (std::size_t n = 0; n < size; ++n) {
      if (next_ == order_.size()) {
        for (std::size_t i = order_.size() - 1; i > 0; --i)
          std::swap(order_[i], order_[random_.below(i + 1)]);
        next_ = 0;
      }
      const std::size_t chosen = order_[next_++];
      const Input u = stray(chosen, straying);
      error += static_cast<double>(
          addGradient(phi_, at.weights, u.data(), codes[samples_[chosen].posture], gradient));
    }
    for (float& g : gradient.all) g /= static_cast<float>(size);
    step(at, gradient, rate);
    done += size;
  }
  return error / static_cast<double>(all * kOutputs);
}

void Descent::step(Descending& at, const PackedWeights<float>& gradient, float rate) {
  at.first_power *= kFirst;
  at.second_power *= kSecond;
  const float first = 1 / (1 - at.first_power), second = 1 / (1 - at.second_power);
  for (std::size_t i = 0; i < gradient.all.size(); ++i) {
    const float g = gradient.all[i];
    float &m = at.first.all[i], &v = at.second.all[i], &w = at.weights.all[i];
    m = kFirst * m + (1 - kFirst) * g;
    v = kSecond * v + (1 - kSecond) * g * g;
    w -= rate * (m * first / (std::sqrt(v * second) + kLittle) + kDecay * w);
  }
}

std::vector<std::array<double, kOutputs>> Descent::meanOutputs(
    const PackedWeights<float>& weights) const {
  std::vector<std::array<double, kOutputs>> mean(means_.size());
  std::vector<double> count(means_.size(), 0.0);
  PackedPass<float> pass;
  for (const Sample& sample : samples_) {
    propagate(phi_, weights, sample.u.data(), pass);
    for (std::size_t k = 0; k < kOutputs; ++k)
      mean[sample.posture][k] += static_cast<double>(pass.output[k]);
    ++count[sample.posture];
  }
  for (std::size_t k = 0; k < mean.size(); ++k) {
    for (double& m : mean[k]) m /= std::max(count[k], 1.0);
  }
  return mean;
}

double meanError(Phi phi, std::span<const Sample> samples, const PackedWeights<float>& weights,
                 std::span<const std::uint32_t> codes) {
  double error = 0;
  PackedPass<float> pass;
  for (const Sample& sample : samples) {
    propagate(phi, weights, sample.u.data(), pass);
    for (std::size_t k = 0; k < kOutputs; ++k) {
      const double e =
          static_cast<double>(pass.output[k]) - static_cast<double>(codes[sample.posture] >> k & 1);
      error += e * e;
    }
  }
  return error / static_cast<double>(std::max<std::size_t>(samples.size(), 1) * kOutputs);
}

}  // namespace merlin::nn
