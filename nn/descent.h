// Gradient descent on the mean squared error, in the space of training: noisy hands, small batches,
// steps of Adam's size. Pure, seeded.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/random.h"
#include "nn/lanes.h"

namespace merlin::nn {

struct Sample {
  Input u{};
  std::uint32_t posture = 0;  // index
};

// Where a descent stands. D. P. Kingma, J. Ba, "Adam", 2015; weight decay apart from the gradient:
// I. Loshchilov, F. Hutter, 2019.
struct Descending {
  Lanes<float> weights, first, second;      // weights and the moments of their gradient
  float first_power = 1, second_power = 1;  // what of the moments' start is left
};

class Descent {
 public:
  // Both are borrowed: hands, and the mean of each posture.
  Descent(Phi phi, std::span<const Sample> samples, std::span<const Input> means, Random random);

  // One pass over the samples (of very many, a part; of few, several times over). Each hand is
  // drawn a little towards the mean of its posture, and strays from there by `noise` in every
  // component: the smoothed bootstrap, which keeps the spread about as it is.
  // `shrink`: what is left of its own distance from the mean. Returns the mean squared error
  // of [GOU] A.5.3 over what was shown.
  double pass(Descending& at, std::span<const std::uint32_t> codes, float rate, float noise,
              float shrink);

  // The outputs' mean by posture, without noise.
  std::vector<std::array<double, kOutputs>> meanOutputs(const Lanes<float>& weights) const;

 private:
  void step(Descending& at, const Lanes<float>& gradient, float rate);
  Input stray(const Sample& sample, float noise, float shrink);

  Phi phi_;
  std::span<const Sample> samples_;
  std::span<const Input> means_;
  Random random_;
  std::vector<float> noise_;  // normal, to be read from anywhere
  std::vector<std::uint32_t> order_;
  std::size_t next_ = 0;
};

// The mean squared error of [GOU] A.5.3 without noise; 0 where there are no samples.
double meanError(Phi phi, std::span<const Sample> samples, const Lanes<float>& weights,
                 std::span<const std::uint32_t> codes);

}  // namespace merlin::nn
