// Statistics of the postures, and the whitened coordinates used in training, in which the hands of
// a posture have the same variance in every direction. Pure.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "nn/data_set.h"
#include "nn/packed_weights.h"

namespace merlin::nn {

using Slots = std::array<bool, kInputs>;

// Statistics of a set of hands in the network's scaled inputs, sufficient to generate similar
// hands. A network's file keeps them, so that adapting can train on generated hands as well.
struct PostureStatistics {
  std::vector<std::string> postures;
  std::vector<Input> mean;  // one for each posture
  // Lower triangle L of the Cholesky factorisation of the hands' covariance L L^T about their
  // posture's mean, pooled over the postures, with a share of the mean variance on the diagonal.
  std::array<std::array<float, kInputs>, kInputs> spread{};
};

// Returns each slot's mean +- 3 standard deviations over all hands. A slot that never changes has
// no sensor: it keeps the range of `fallback` and is false in `used`.
InputRanges rangesOf(std::span<const LabelledHand> hands, const InputRanges& fallback, Slots& used);

// `posture[n]`: hand n's index into `names`.
PostureStatistics statisticsOf(std::span<const Input> hands, std::span<const std::size_t> posture,
                               std::vector<std::string> names, const Slots& used);

// u = T (x - centre). T whitens the spread and scales it so that the average variance of a
// component over all postures is 1.
class WhitenedSpace {
 public:
  WhitenedSpace(const PostureStatistics& statistics, const Slots& used);

  Input toSpace(const Input& x) const noexcept;
  // Standard deviation of every component within a posture.
  float sigma() const noexcept { return sigma_; }

  // Returns the likeness of each pair of postures: 1 / squared distance in standard deviations.
  std::vector<std::vector<double>> likeness() const;
  const std::vector<Input>& means() const noexcept { return means_; }  // the postures' means in u

  // Converts weights for inputs u into weights for inputs x, and back. Unused slots get 0.
  Weights fold(const PackedWeights<float>& in_space) const;
  PackedWeights<float> unfold(const Weights& weights) const;

 private:
  using Matrix = std::array<std::array<double, kInputs>, kInputs>;
  std::array<double, kInputs> centre_{};
  Matrix whiten_{}, colour_{};  // T and its inverse
  float sigma_ = 1;
  std::vector<Input> means_;
};

}  // namespace merlin::nn
