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
// hands. They are stored in the network's file, so that adapt() can also train on generated hands.
struct PostureStatistics {
  std::vector<std::string> postures;
  std::vector<Input> mean;  // one for each posture
  // Lower Cholesky factor L of the covariance L L^T of the hands about the mean of their posture,
  // pooled over all postures. A share of the mean variance is added to the covariance's diagonal.
  std::array<std::array<float, kInputs>, kInputs> spread{};
};

// Returns each slot's mean +- 3 standard deviations over all hands. A slot that never changes has
// no sensor: it keeps the range of `fallback` and is false in `used`.
InputRanges rangesOf(std::span<const LabelledHand> hands, const InputRanges& fallback, Slots& used);

// Returns the statistics of hands in scaled inputs. `posture[n]`: index of hand n's posture in
// `names`. `used`: slots that have a sensor. REQUIRES: every posture has at least one hand.
PostureStatistics statisticsOf(std::span<const Input> hands, std::span<const std::size_t> posture,
                               std::vector<std::string> names, const Slots& used);

// Whitened coordinates u = T (x - centre) of scaled inputs x. T makes the covariance within a
// posture a multiple of the identity matrix, scaled so that the variance of a component over all
// postures is 1 on average.
class WhitenedSpace {
 public:
  WhitenedSpace(const PostureStatistics& statistics, const Slots& used);

  Input toSpace(const Input& x) const noexcept;
  // Returns the standard deviation of every component of u within a posture.
  float sigma() const noexcept { return sigma_; }

  // Returns the likeness of each pair of postures: 1 / squared distance of their means in standard
  // deviations, at most 4.
  std::vector<std::vector<double>> likeness() const;
  const std::vector<Input>& means() const noexcept { return means_; }  // the postures' means in u

  // fold() converts weights for inputs u into weights for inputs x; unfold() converts them back.
  // The weights of unused slots become 0.
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
