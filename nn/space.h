// Where training happens: what is remembered of each posture, and the coordinates in which the
// hands of one posture stray equally far in every direction. Pure.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "nn/data_set.h"
#include "nn/lanes.h"

namespace merlin::nn {

using Slots = std::array<bool, kInputs>;

// Statistics of a set of hands in the network's scaled inputs, sufficient to generate similar
// hands. A network's file keeps them, so that adapting can rehearse what the network knows.
struct Memory {
  std::vector<std::string> postures;
  std::vector<Input> mean;  // of each posture
  // Lower triangle L: the hands of one posture stray about its mean with the covariance L L^T,
  // pooled over the postures, and a share of its mean on the diagonal.
  std::array<std::array<float, kInputs>, kInputs> spread{};
};

// Each slot's mean +- 3 standard deviations over all hands. A slot that never changes keeps the
// range of `fallback` and is false in `used`: no sensor measures it.
InputRanges rangesOf(std::span<const LabelledHand> hands, const InputRanges& fallback, Slots& used);

// `posture[n]`: index into `names` of hand n.
Memory remember(std::span<const Input> hands, std::span<const std::size_t> posture,
                std::vector<std::string> names, const Slots& used);

// u = T (x - centre), where T whitens the spread and scales so that a component's variance over all
// postures is 1 on average.
class Space {
 public:
  Space(const Memory& memory, const Slots& used);

  Input toSpace(const Input& x) const noexcept;
  // Within a posture, of every component.
  float sigma() const noexcept { return sigma_; }

  // Likeness of two postures: 1 / their squared distance in standard deviations.
  std::vector<std::vector<double>> likeness() const;
  const std::vector<Input>& means() const noexcept { return means_; }  // of the postures, in u

  // Weights that take x, of weights that take u; and back. Unused slots get 0.
  Weights fold(const Lanes<float>& in_space) const;
  Lanes<float> unfold(const Weights& weights) const;

 private:
  using Matrix = std::array<std::array<double, kInputs>, kInputs>;
  Slots used_;
  std::array<double, kInputs> centre_{};
  Matrix whiten_{}, colour_{};  // T, and its inverse
  float sigma_ = 1;
  std::vector<Input> means_;
};

}  // namespace merlin::nn
